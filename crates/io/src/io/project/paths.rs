//! The paths of a document in a project.

use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::io::Flaw;
use crate::io::layers::{SavedPolygon, rings, saved_polygon};
use meshbrush_core::document::{KeepOut, PathCost, PathPlan};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::Weights;
use meshbrush_mesh::text::excerpt;

/// The waypoints, the cost and the keep-out regions of paths.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedPaths {
    /// x and y of each place of each path, from the start to the goal.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    routes: Vec<Vec<[f64; 2]>>,
    /// Since version 4: the names of paths, in their order; an empty one is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    names: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cost: Option<SavedCost>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    keep_out: Vec<SavedKeepOut>,
    /// Since version 7: the least distance from the outline and from keep-out regions.
    #[serde(default, skip_serializing_if = "is_zero")]
    clearance: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedKeepOut {
    name: String,
    polygons: Vec<SavedPolygon>,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum SavedCost {
    Weights { length: f64, risk: f64 },
    Formula(String),
}

impl SavedPaths {
    pub(super) fn of(paths: &PathPlan) -> Self {
        let route = |route: &Vec<DVec2>| route.iter().map(DVec2::to_array).collect();
        let cost = match &paths.cost {
            PathCost::Weighted(Weights { length, risk }) => {
                SavedCost::Weights { length: *length, risk: *risk }
            }
            PathCost::Formula(formula) => SavedCost::Formula(formula.source().into()),
        };
        let is_usual = paths.cost == PathCost::default();
        Self {
            routes: paths.routes.iter().map(route).collect(),
            names: paths.names.clone(),
            cost: (!is_usual).then_some(cost),
            keep_out: paths.keep_out.iter().map(SavedKeepOut::of).collect(),
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
    pub(super) fn load(self) -> Result<Arc<PathPlan>, Flaw> {
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
        let keep_out = self.keep_out.into_iter().map(SavedKeepOut::load).collect::<Result<_, _>>()?;
        let routes = self.routes.into_iter().map(route).collect();
        let plan = PathPlan { routes, names: Vec::new(), cost, keep_out, clearance: self.clearance };
        Ok(Arc::new(plan.with_names(self.names)))
    }
}

impl SavedKeepOut {
    fn of(KeepOut { name, mask }: &KeepOut) -> Self {
        Self { name: name.clone(), polygons: mask.polygons().iter().map(saved_polygon).collect() }
    }

    fn load(self) -> Result<KeepOut, Flaw> {
        let Self { name, polygons } = self;
        let polygons = polygons.iter().map(|polygon| rings(polygon)).collect::<Result<Vec<_>, _>>();
        let mask = polygons.map_err(|fault| fault.to_string());
        let mask = mask.and_then(|polygons| Mask::new(&polygons).map_err(|error| error.to_string()));
        match mask {
            Ok(mask) => Ok(KeepOut { name, mask }),
            Err(problem) => {
                let name = excerpt(40, &name);
                Err(Flaw::Syntax(format!("the keep-out region “{name}” is not valid: {problem}")))
            }
        }
    }
}
