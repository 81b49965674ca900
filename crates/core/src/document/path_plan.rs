//! The plan of paths: their waypoints and their cost.

use std::sync::Arc;

use glam::DVec2;

use crate::field::CostFormula;
use crate::layers::{Mask, RiskField};
use crate::path::{CostDensity, FormulaCost, PathError, Waypoint, WeightedCost, Weights};

/// The paths of a document. They do not change the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPlan {
    /// The places of each path, in world units: the start, the places in between in order, and the goal.
    pub routes: Vec<Vec<DVec2>>,
    /// The cost of paths.
    pub cost: PathCost,
    /// The regions that paths do not enter.
    pub keep_out: Arc<[KeepOut]>,
}

/// A region that paths stay out of. Clones share its polygons.
#[derive(Clone, Debug, PartialEq)]
pub struct KeepOut {
    /// The name of its file, or of the layer whose mask it is, for a person.
    pub name: String,
    /// The area of the region.
    pub mask: Mask,
}

/// The cost of a path per unit of length.
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
    /// Returns the cost density over a risk.
    ///
    /// # Errors
    /// Fails when the weights make no cost.
    pub fn density(&self, risk: RiskField) -> Result<Arc<dyn CostDensity>, PathError> {
        Ok(match self {
            Self::Weighted(weights) => Arc::new(WeightedCost::new(*weights, risk)?),
            Self::Formula(formula) => Arc::new(FormulaCost { formula: formula.clone(), risk }),
        })
    }
}

impl PathPlan {
    /// Checks the places and the weights.
    ///
    /// # Errors
    /// Fails for the first place that is not finite, a route of fewer than two places, and weights that make
    /// no cost.
    pub fn check(&self) -> Result<(), PathError> {
        for route in &self.routes {
            if route.len() < 2 {
                return Err(PathError::TooFewPlaces);
            }
            if let Some((n, &at)) = route.iter().enumerate().find(|(_, at)| !at.is_finite()) {
                return Err(PathError::NotAPlace { which: Waypoint::of(n, route.len()), at });
            }
        }
        self.cost.density(RiskField::default()).map(|_| ())
    }

    /// Returns all places with the number of their route and their number there, from 0.
    pub fn places(&self) -> impl Iterator<Item = ((usize, usize), DVec2)> + '_ {
        self.routes.iter().enumerate().flat_map(|(route, places)| {
            places.iter().enumerate().map(move |(place, &at)| ((route, place), at))
        })
    }

    /// Returns the area of each keep-out region.
    pub fn keep_out_masks(&self) -> Vec<Mask> {
        self.keep_out.iter().map(|region| region.mask.clone()).collect()
    }

    /// Returns the bytes of memory on the heap, without the polygons of keep-out regions.
    pub fn bytes(&self) -> usize {
        let routes: usize =
            self.routes.iter().map(|route| size_of_val(route) + size_of_val(&route[..])).sum();
        let names: usize =
            self.keep_out.iter().map(|region| size_of_val(region) + region.name.capacity()).sum();
        routes + names
    }
}
