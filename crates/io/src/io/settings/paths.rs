//! Paths and keep-out regions. They do not change the mesh.

use std::path::Path;

use glam::DVec2;

use super::{SavedKeepOut, SavedPaths};
use crate::io::KeyFault;
use crate::io::layers::{SavedPolygon, TextError, each, points, rings, saved_polygon};
use meshbrush_core::document::{KeepOut, PathCost, PathPlan};
use meshbrush_core::domain::Polygon;
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::Weights;
use meshbrush_mesh::text::excerpt;

/// The name of a keep-out region that has neither a name nor a file.
pub(super) const DEFAULT_NAME: &str = "Keep-out region";

impl SavedPaths {
    /// Returns the paths of a document, without its keep-out regions.
    pub(super) fn of(plan: &PathPlan) -> Self {
        let route = |route: &Vec<DVec2>| route.iter().map(DVec2::to_array).collect();
        let routes = plan.routes.iter().map(route).collect();
        let clearance = (plan.clearance != 0.0).then_some(plan.clearance.into());
        let default = Self { routes, names: plan.names.clone(), clearance, ..Self::default() };
        match &plan.cost {
            cost if *cost == PathCost::default() => default,
            PathCost::Weighted(Weights { length, risk }) => {
                Self { length_weight: Some(*length), risk_weight: Some(*risk), ..default }
            }
            PathCost::Formula(formula) => Self { cost: Some(formula.source().to_owned()), ..default },
        }
    }

    /// Returns the places of each path, in world units.
    pub(super) fn routes(&self) -> Result<Vec<Vec<DVec2>>, KeyFault> {
        if self.names.len() > self.routes.len() {
            return Err(KeyFault::value(
                "names",
                "there are more names than paths; leave the last ones out.",
            ));
        }
        each("routes", &self.routes, |places: &Vec<[f64; 2]>| points(places, 2, "a path"))
    }

    /// Returns the clearance of paths, in world units.
    pub(super) fn checked_clearance(&self) -> Result<f64, KeyFault> {
        let clearance = self.clearance.map_or(0.0, Into::into);
        let plan = PathPlan { clearance, ..PathPlan::default() };
        plan.check().map_err(|error| KeyFault::value("clearance", error.to_string()))?;
        Ok(clearance)
    }

    /// Returns the cost of paths.
    pub(super) fn checked_cost(&self) -> Result<PathCost, KeyFault> {
        let weight = match (self.length_weight, self.risk_weight) {
            (None, None) => None,
            (Some(_), None) => Some("length_weight"),
            _ => Some("risk_weight"),
        };
        match (&self.cost, weight) {
            (Some(_), Some(key)) => {
                Err(KeyFault::key(key, "what paths cost is given by `cost` or by weights, not by both."))
            }
            (Some(text), None) => CostFormula::parse(text)
                .map(PathCost::Formula)
                .map_err(|mistake| KeyFault::mistake("cost", text, 0, &mistake)),
            (None, None) => Ok(PathCost::default()),
            (None, Some(key)) => {
                let default = Weights::default();
                let cost = PathCost::Weighted(Weights {
                    length: self.length_weight.unwrap_or(default.length),
                    risk: self.risk_weight.unwrap_or(default.risk),
                });
                let plan = PathPlan { cost, ..PathPlan::default() };
                plan.check().map_err(|error| KeyFault::value(key, error.to_string()))?;
                Ok(plan.cost)
            }
        }
    }
}

impl SavedKeepOut {
    /// Returns a region with its polygons in place.
    pub fn of(KeepOut { name, mask }: &KeepOut) -> Self {
        let polygons = mask.polygons().iter().map(saved_polygon).collect();
        Self { name: Some(name.clone()), polygons: Some(polygons), file: None }
    }

    /// Returns the polygons, if they are in place.
    pub(super) fn check(&self) -> Result<Option<Vec<Polygon>>, KeyFault> {
        match (&self.polygons, &self.file) {
            (Some(_), Some(_)) => {
                Err(KeyFault::key("file", "a keep-out region has `polygons` or `file`, not both."))
            }
            (None, None) => Err(KeyFault::entry("polygons", "a keep-out region needs `polygons` or `file`.")),
            (None, Some(_)) => Ok(None),
            (Some(polygons), None) if polygons.is_empty() => {
                let sentence = "a keep-out region needs a polygon at least; leave the region out.";
                Err(KeyFault::value("polygons", sentence))
            }
            (Some(polygons), None) => {
                each("polygons", polygons, |polygon: &SavedPolygon| rings(polygon)).map(Some)
            }
        }
    }

    /// Returns the region; `read` reads the polygons of a file.
    pub(super) fn load<E: From<KeyFault> + From<TextError>>(
        &self,
        read: impl FnOnce(&Path) -> Result<Vec<Polygon>, E>,
    ) -> Result<KeepOut, E> {
        let in_place = self.check()?;
        let polygons = match (in_place, &self.file) {
            (None, Some(file)) => read(file)?,
            (polygons, _) => polygons.unwrap_or_default(),
        };
        let name = self.name.clone().unwrap_or_else(|| DEFAULT_NAME.into());
        let mask = Mask::new(&polygons).map_err(|problem| {
            TextError(format!("The keep-out region “{}” cannot be used. {problem}", excerpt(40, &name)))
        })?;
        Ok(KeepOut { name, mask })
    }
}
