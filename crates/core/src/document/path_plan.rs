//! The plan of paths: their waypoints and their cost.

use std::sync::Arc;

use glam::DVec2;

use crate::domain::{BoundaryTreatment, Domain};
use crate::field::CostFormula;
use crate::layers::{Mask, RiskField};
use crate::path::{
    CostDensity, FormulaCost, PathArea, PathError, Waypoint, WeightedCost, Weights, check_clearance, in_plane,
};

/// The paths of a document. They do not change the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPlan {
    /// The places of each path, in world units: the start, the places in between in order, and the goal.
    pub routes: Vec<Vec<DVec2>>,
    /// The names given to paths, in the order of the routes. An empty or a missing one is no name, and the
    /// last one is not empty.
    pub names: Vec<String>,
    /// The cost of paths.
    pub cost: PathCost,
    /// The regions that paths do not enter.
    pub keep_out: Arc<[KeepOut]>,
    /// The least distance of paths from the outline of the domain and from keep-out regions, in world units.
    pub clearance: f64,
}

/// A region that paths stay out of. Clones share its polygons.
#[derive(Clone, Debug, PartialEq)]
pub struct KeepOut {
    /// The name of its file, or of the layer whose mask it is, for a person.
    pub name: String,
    /// The area of the region.
    pub mask: Mask,
}

/// The cost of a path per unit of length: on the Earth, per metre on the ellipsoid.
#[derive(Clone, Debug, PartialEq)]
pub enum PathCost {
    /// λ + κ · risk.
    Weighted(Weights),
    /// A formula of x, y and the risk.
    Formula(CostFormula),
}

impl Default for PathCost {
    fn default() -> Self {
        Self::Weighted(Weights::default())
    }
}

impl PathCost {
    /// Returns the cost density over a risk in a domain: on the Earth, of lengths on the ellipsoid.
    ///
    /// # Errors
    /// Fails when the weights make no cost.
    pub fn density(&self, risk: RiskField, domain: &Domain) -> Result<Arc<dyn CostDensity>, PathError> {
        let ground = domain.ground();
        Ok(match self {
            Self::Weighted(weights) => in_plane(WeightedCost::new(*weights, risk)?, &ground),
            Self::Formula(formula) => in_plane(FormulaCost { formula: formula.clone(), risk }, &ground),
        })
    }

    /// Checks the weights.
    fn check(&self) -> Result<(), PathError> {
        match self {
            Self::Weighted(weights) => WeightedCost::new(*weights, RiskField::default()).map(|_| ()),
            Self::Formula(_) => Ok(()),
        }
    }
}

impl PathPlan {
    /// Checks the places, the clearance and the weights.
    ///
    /// # Errors
    /// Fails for the first place that is not finite, a route of fewer than two places, a clearance that is no
    /// distance, and weights that make no cost.
    pub fn check(&self) -> Result<(), PathError> {
        for route in &self.routes {
            if route.len() < 2 {
                return Err(PathError::TooFewPlaces);
            }
            if let Some((n, &at)) = route.iter().enumerate().find(|(_, at)| !at.is_finite()) {
                return Err(PathError::NotAPlace { which: Waypoint::of(n, route.len()), at });
            }
        }
        check_clearance(self.clearance)?;
        self.cost.check()
    }

    /// Returns the name of a path by the number of its route: the one given to it, or its number from 1.
    pub fn name(&self, route: usize) -> String {
        let given = self.names.get(route).filter(|name| !name.is_empty());
        given.cloned().unwrap_or_else(|| format!("Path {}", route + 1))
    }

    /// Gives a path a name, or none where it is empty. Control characters and what is beyond
    /// [`Self::LONGEST_NAME`] are left out.
    pub fn set_name(&mut self, route: usize, name: &str) {
        let valid = name.chars().filter(|c| !c.is_control()).take(Self::LONGEST_NAME).collect();
        if route >= self.names.len() {
            self.names.resize(route + 1, String::new());
        }
        self.names[route] = valid;
        self.forget_empty_names();
    }

    /// Most letters of a name.
    pub const LONGEST_NAME: usize = 80;

    /// Removes a path with its name.
    pub fn remove(&mut self, route: usize) {
        self.routes.remove(route);
        if route < self.names.len() {
            self.names.remove(route);
            self.forget_empty_names();
        }
    }

    /// Removes all paths with their names.
    pub fn clear(&mut self) {
        self.routes.clear();
        self.names.clear();
    }

    /// Returns the plan with other names. Names beyond those of the routes and empty ones at the end are left
    /// out.
    pub fn with_names(mut self, names: impl IntoIterator<Item = String>) -> Self {
        self.names.clear();
        for (route, name) in names.into_iter().enumerate().take(self.routes.len()) {
            self.set_name(route, &name);
        }
        self
    }

    fn forget_empty_names(&mut self) {
        let count = self.names.iter().rposition(|name| !name.is_empty()).map_or(0, |last| last + 1);
        self.names.truncate(count);
    }

    /// Returns all places with the number of their route and their number there, from 0.
    pub fn places(&self) -> impl Iterator<Item = ((usize, usize), DVec2)> + '_ {
        self.routes.iter().enumerate().flat_map(|(route, places)| {
            places.iter().enumerate().map(move |(place, &at)| ((route, place), at))
        })
    }

    /// Returns the part of a domain where the paths may go, for a way of treating its boundary.
    ///
    /// # Errors
    /// Fails when the clearance is negative, NaN or infinite.
    pub fn area(&self, domain: &Domain, boundary: BoundaryTreatment) -> Result<PathArea, PathError> {
        PathArea::new(domain, boundary, self.keep_out_masks(), self.clearance)
    }

    /// Returns the area of each keep-out region.
    pub fn keep_out_masks(&self) -> Vec<Mask> {
        self.keep_out.iter().map(|region| region.mask.clone()).collect()
    }

    /// Returns the bytes of memory on the heap, without the polygons of keep-out regions.
    pub fn bytes(&self) -> usize {
        let routes: usize =
            self.routes.iter().map(|route| size_of_val(route) + size_of_val(&route[..])).sum();
        let path_names: usize = self.names.iter().map(|name| size_of_val(name) + name.capacity()).sum();
        let names: usize =
            self.keep_out.iter().map(|region| size_of_val(region) + region.name.capacity()).sum();
        routes + path_names + names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_with_their_paths() {
        let routes = vec![vec![DVec2::ZERO, DVec2::ONE]; 3];
        let mut plan = PathPlan { routes, ..PathPlan::default() };
        assert_eq!(plan.name(1), "Path 2");
        plan.set_name(1, "Ferry\n");
        plan.set_name(2, "Λιμάνι");
        assert_eq!([plan.name(0), plan.name(1), plan.name(2)], ["Path 1", "Ferry", "Λιμάνι"]);
        plan.remove(1);
        assert_eq!([plan.name(0), plan.name(1)], ["Path 1", "Λιμάνι"]);
        plan.set_name(1, "");
        assert!(plan.names.is_empty(), "no name is given");
        let plan = plan.with_names(["a", "", "b"].map(String::from));
        assert_eq!(plan.names, ["a"]);
    }
}
