//! The paths of a document in a project.

use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::part_names::{PartData, PartNames};
use super::part_reader::PartReader;
use crate::io::Flaw;
use crate::io::error::PlacedFlaw;
use crate::io::layers::{SavedPolygon, rings, saved_polygon};
use meshbrush_core::document::{KeepOut, PathCost, PathPlan};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::Weights;
use meshbrush_mesh::text::excerpt;

/// The waypoints, the cost and the keep-out regions of paths.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredPaths {
    /// x and y of each place of each path, from the start to the goal.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    routes: Vec<Vec<[f64; 2]>>,
    /// The names of paths, in their order; an empty one is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    names: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cost: Option<SavedCost>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    keep_out: Vec<StoredKeepOut>,
    /// The least distance from the outline and from keep-out regions.
    #[serde(default, skip_serializing_if = "is_zero")]
    clearance: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredKeepOut {
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    polygons: Option<Vec<SavedPolygon>>,
    /// The part with its polygons, where they have many points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    part: Option<String>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum SavedCost {
    Weights { length: f64, risk: f64 },
    Formula(String),
}

impl StoredPaths {
    pub(super) fn of(paths: &PathPlan, names: &PartNames) -> Self {
        let route = |route: &Vec<DVec2>| route.iter().map(DVec2::to_array).collect();
        let cost = match &paths.cost {
            PathCost::Weighted(Weights { length, risk }) => {
                SavedCost::Weights { length: *length, risk: *risk }
            }
            PathCost::Formula(formula) => SavedCost::Formula(formula.source().into()),
        };
        let is_default = paths.cost == PathCost::default();
        Self {
            routes: paths.routes.iter().map(route).collect(),
            names: paths.names.clone(),
            cost: (!is_default).then_some(cost),
            keep_out: paths.keep_out.iter().map(|region| StoredKeepOut::of(region, names)).collect(),
            clearance: paths.clearance,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.routes.is_empty() && self.cost.is_none() && self.keep_out.is_empty() && self.clearance == 0.0
    }

    /// Returns the paths; their places and weights are checked with all settings.
    ///
    /// # Errors
    /// Fails when the formula or a region is not valid.
    pub(super) fn load(self, parts: &mut PartReader) -> Result<Arc<PathPlan>, PlacedFlaw> {
        let route = |route: Vec<[f64; 2]>| route.into_iter().map(DVec2::from_array).collect();
        let cost = match self.cost {
            None => PathCost::default(),
            Some(SavedCost::Weights { length, risk }) => PathCost::Weighted(Weights { length, risk }),
            Some(SavedCost::Formula(text)) => {
                PathCost::Formula(CostFormula::parse(&text).map_err(|mistake| {
                    Flaw::Syntax(format!("the cost of paths is no valid formula. {mistake}"))
                })?)
            }
        };
        let keep_out =
            self.keep_out.into_iter().map(|region| region.load(parts)).collect::<Result<_, _>>()?;
        let routes = self.routes.into_iter().map(route).collect();
        let plan = PathPlan { routes, names: Vec::new(), cost, keep_out, clearance: self.clearance };
        Ok(Arc::new(plan.with_names(self.names)))
    }
}

impl StoredKeepOut {
    fn of(KeepOut { name, mask }: &KeepOut, names: &PartNames) -> Self {
        let part = PartData::of_mask(mask).and_then(|data| names.of(&data).map(str::to_owned));
        let polygons = part.is_none().then(|| mask.polygons().iter().map(saved_polygon).collect());
        Self { name: name.clone(), polygons, part }
    }

    fn load(self, parts: &mut PartReader) -> Result<KeepOut, PlacedFlaw> {
        let Self { name, polygons, part } = self;
        let invalid = |problem: String| {
            let name = excerpt(40, &name);
            Flaw::Syntax(format!("the keep-out region “{name}” is not valid: {problem}"))
        };
        let mask = match (part, polygons) {
            (Some(part), _) => parts.mask(&part)?,
            (None, polygons) => {
                let rings = polygons.iter().flatten().map(|polygon| rings(polygon));
                let polygons =
                    rings.collect::<Result<Vec<_>, _>>().map_err(|fault| invalid(fault.to_string()))?;
                Mask::new(&polygons).map_err(|error| invalid(error.to_string()))?
            }
        };
        Ok(KeepOut { name, mask })
    }
}
