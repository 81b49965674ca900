//! Between which places paths are sought, and what they cost.

use std::sync::Arc;

use glam::DVec2;

use crate::field::CostFormula;
use crate::layers::RiskField;
use crate::path::{CostDensity, FormulaCost, PathError, Waypoint, WeightedCost, Weights};

/// The paths of a document. They do not change the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathPlan {
    /// The places of each path, in world units: the start, the places in between in order, and the goal.
    pub routes: Vec<Vec<DVec2>>,
    /// What paths cost.
    pub cost: PathCost,
}

/// What a path costs per unit of length.
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
    /// The cost density over a risk.
    ///
    /// # Errors
    /// When the weights make no cost.
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
    /// For the first place that is not finite, a route of fewer than two places, and weights that make no
    /// cost.
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

    /// Bytes of memory on the heap.
    pub fn bytes(&self) -> usize {
        self.routes.iter().map(|route| size_of_val(route) + size_of_val(&route[..])).sum()
    }
}
