//! The work of a planner in steps.

use super::leg::LegSearch;
use super::place::MeshPlace;
use super::{CostDensity, PathError, PathRequest, Planner, Solution};
use crate::mesh::Progress;
use glam::DVec2;

/// The work of [`Planner::solve`] in steps. Where there are more threads than one, they do it in one step.
#[derive(Clone, Debug)]
pub struct PathSearch {
    places: Vec<MeshPlace>,
    request: PathRequest,
    step: SearchStep,
    found: Vec<Solution>,
}

/// What is done next.
#[derive(Clone, Debug)]
enum SearchStep {
    /// The march with this number.
    March(usize),
    Leg(Box<LegSearch>),
}

impl PathSearch {
    /// Nodes that a march accepts in some milliseconds.
    pub const NODES_AT_ONCE: usize = 16_384;

    /// Begins the search for the path of least cost from the first of the places to the last by way of the
    /// others.
    ///
    /// # Errors
    /// Fails when a place is not in the domain.
    pub fn new(planner: &Planner, places: &[DVec2], request: PathRequest) -> Result<Self, PathError> {
        let places = planner.places(places)?;
        Ok(Self { places, request, step: SearchStep::March(0), found: Vec::new() })
    }

    /// Takes a step, in which a march accepts a limited number of nodes. Returns the path at the end, which
    /// is that of [`Planner::solve`]. Planner and cost are always the same, and nobody else uses the planner
    /// meanwhile.
    ///
    /// # Errors
    /// Fails when no path leads from one place to the next.
    pub fn advance(
        &mut self,
        planner: &mut Planner,
        density: &dyn CostDensity,
        nodes: usize,
    ) -> Result<Option<Solution>, PathError> {
        let nodes = nodes.max(1);
        if rayon::current_num_threads() > 1 {
            let legs = planner.legs_between(density, &self.places, self.request)?;
            return Ok(Some(Solution::joined(legs)));
        }
        match &mut self.step {
            SearchStep::March(number) => {
                match planner.march_one(&self.places, self.request.has_bounds, *number, nodes) {
                    Some(Progress::More) => {}
                    Some(Progress::Done) => *number += 1,
                    None => self.step = self.next_leg(),
                }
            }
            SearchStep::Leg(search) => {
                if let Some(found) = search.advance(planner, density, self.places.len(), nodes)? {
                    self.found.push(found);
                    if self.found.len() == self.places.len() - 1 {
                        return Ok(Some(Solution::joined(std::mem::take(&mut self.found))));
                    }
                    self.step = self.next_leg();
                }
            }
        }
        Ok(None)
    }

    fn next_leg(&self) -> SearchStep {
        let leg = self.found.len();
        SearchStep::Leg(Box::new(LegSearch::new(leg, [self.places[leg], self.places[leg + 1]], self.request)))
    }
}
