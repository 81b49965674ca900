//! Length against risk: the best paths as the weights change.

use std::sync::Arc;

use glam::DVec2;

use super::{PathError, PathMesh, PathRequest, Planner, Solution, WeightedCost, Weights, in_plane};
use crate::earth::Ground;
use crate::layers::RiskField;
use crate::text::rounded;

/// A path of the front, and the weights for which it is best.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontPoint {
    /// The weights.
    pub weights: Weights,
    /// The path.
    pub solution: Solution,
}

/// The Pareto front of length against risk, computed one path at a time: from the shortest path to the
/// safest.
///
/// The length counts 1, and the risk from 0 up to 1,000 by equal factors. Paths that are longer than another
/// without less risk are left out. Weights find the paths on the convex hull of the front only.
#[doc(alias = "Pareto front")]
#[derive(Clone, Debug)]
pub struct Front {
    mesh: Arc<PathMesh>,
    risk: RiskField,
    ground: Ground,
    places: Vec<DVec2>,
    /// The risk weights still to do, the smallest last.
    waiting: Vec<f64>,
    points: Vec<FrontPoint>,
}

/// The smallest and the largest risk weight, besides 0.
const WEIGHTS: [f64; 2] = [0.1, 1000.0];

/// Digits of a weight.
const WEIGHT_DIGITS: usize = 3;

/// Differences below this share count as none.
const EQUAL: f64 = 1e-6;

impl Front {
    /// Returns the front between places, in order, with at most `count` paths, at least three.
    pub fn new(mesh: impl Into<Arc<PathMesh>>, risk: RiskField, places: Vec<DVec2>, count: usize) -> Self {
        let steps = count.max(3) - 2;
        let [least, greatest] = WEIGHTS;
        // Few digits: a person may take a weight, and read it.
        let weight =
            |n: usize| rounded(least * libm::pow(greatest / least, n as f64 / steps as f64), WEIGHT_DIGITS);
        let waiting = (0..=steps).rev().map(weight).chain([0.0]).collect();
        Self { mesh: mesh.into(), risk, ground: Ground::default(), places, waiting, points: Vec::new() }
    }

    /// Measures lengths as a domain does.
    #[must_use]
    pub fn measured_on(self, ground: Ground) -> Self {
        Self { ground, ..self }
    }

    /// Returns how many paths are still to be found.
    pub fn remaining(&self) -> usize {
        self.waiting.len()
    }

    /// Returns the front so far, from the shortest path to the safest.
    pub fn points(&self) -> &[FrontPoint] {
        &self.points
    }

    /// Finds the next path. Returns whether there are more.
    ///
    /// # Errors
    /// Fails as [`Planner::solve`] does; nothing is left to do then.
    pub fn advance(&mut self) -> Result<bool, PathError> {
        let Some(risk) = self.waiting.pop() else { return Ok(false) };
        let weights = Weights { length: 1.0, risk };
        match self.solve(weights) {
            Ok(solution) => self.insert(FrontPoint { weights, solution }),
            Err(error) => {
                self.waiting.clear();
                return Err(error);
            }
        }
        Ok(!self.waiting.is_empty())
    }

    fn solve(&self, weights: Weights) -> Result<Solution, PathError> {
        let density = in_plane(WeightedCost::new(weights, self.risk.clone())?, &self.ground);
        let request = PathRequest { has_bounds: false, ..PathRequest::FULL };
        Planner::new(self.mesh.clone(), &*density)?.solve(&*density, &self.places, request)
    }

    /// Adds a path, unless one in the list is as good in both respects; removes those that it dominates.
    fn insert(&mut self, point: FrontPoint) {
        let is_covered = |a: &Solution, by: &Solution| {
            by.length_on_ground <= a.length_on_ground * (1.0 + EQUAL) && by.risk <= a.risk * (1.0 + EQUAL)
        };
        if self.points.iter().any(|other| is_covered(&point.solution, &other.solution)) {
            return;
        }
        self.points.retain(|other| !is_covered(&other.solution, &point.solution));
        let length = |point: &FrontPoint| point.solution.length_on_ground;
        let place = self.points.partition_point(|other| length(other) < length(&point));
        self.points.insert(place, point);
    }
}
