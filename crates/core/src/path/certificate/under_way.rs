//! A program of a certificate, from its triangles to its solution.

use rayon::prelude::*;

use super::Certificate;
use super::conic_program::ConicSolution;
use super::edges::lower_at_edges;
use super::minorant::Minorant;
use super::quadratic::{QuadraticElement, QuadraticSpace};
use super::setup::ReachableTriangles;
use super::solver::ConeSolver;
use crate::mesh::Progress;
use crate::path::PathError;

/// Number of triangles whose minorants a thread computes at a time.
const TOGETHER: usize = 16;
/// Number of such groups per thread that a slice computes.
const IN_SLICE: usize = 4;

/// A program that is not solved yet, and its triangles.
pub(super) struct ProgramUnderWay {
    pub kept: ReachableTriangles,
    pub space: QuadraticSpace,
    /// The functional v(goal) − v(start), as weights of values.
    pub gain: Vec<(u32, f64)>,
}

/// What is done next, with what is there for it.
pub(super) enum ProgramStage {
    /// Affine functions below the cost are found for the other triangles, each with its level.
    Minorants(Vec<(u32, Minorant)>),
    /// They are compared at the edges.
    Edges(Vec<(u32, Minorant)>),
    /// The program is made.
    Begin(Vec<Minorant>),
    Solve(Vec<Minorant>, Box<ConeSolver>),
    Solved(Vec<Minorant>, ConicSolution),
}

/// The program that is under way, if there is one. A clone begins it again, with the same result.
#[derive(Default)]
pub(super) struct UnderWay(Option<Box<(ProgramUnderWay, ProgramStage)>>);

impl UnderWay {
    pub fn new(work: ProgramUnderWay, next: ProgramStage) -> Self {
        Self(Some(Box::new((work, next))))
    }

    pub fn take(&mut self) -> Option<(ProgramUnderWay, ProgramStage)> {
        self.0.take().map(|work| *work)
    }
}

impl Clone for UnderWay {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Certificate {
    /// Finds affine functions below the cost for some more triangles of the space, with their levels.
    pub(super) fn find_minorants(
        &self,
        work: &ProgramUnderWay,
        found: &mut Vec<(u32, Minorant)>,
    ) -> Progress {
        let inset = self.inset();
        let of_element = |element: &QuadraticElement| {
            let level = self.mesh.triangle(element.id).level();
            match self.minorants[element.id.index()] {
                Some((at, minorant)) if at == level => (level, minorant),
                _ => (level, Minorant::new(&*self.task.cost, &element.flat, inset)),
            }
        };
        let left = &work.space.elements[found.len()..];
        let some = &left[..left.len().min(IN_SLICE * TOGETHER * rayon::current_num_threads())];
        let more: Vec<(u32, Minorant)> = some.par_iter().with_min_len(TOGETHER).map(of_element).collect();
        found.extend(more);
        if some.len() == left.len() { Progress::Done } else { Progress::More }
    }

    /// Returns an affine function below the cost for each triangle of the space, on the edges too.
    pub(super) fn minorants_of(
        &mut self,
        space: &QuadraticSpace,
        found: Vec<(u32, Minorant)>,
    ) -> Result<Vec<Minorant>, PathError> {
        let inset = self.inset();
        let mut all = Vec::with_capacity(space.elements.len());
        for (element, known) in space.elements.iter().zip(found) {
            self.minorants[element.id.index()] = Some(known);
            all.push(known.1.at_most(100.0 * self.task.upper / element.flat.diameter()));
        }
        lower_at_edges(&*self.task.cost, space, &mut all, inset);
        for (element, minorant) in space.elements.iter().zip(&all) {
            if minorant.least.is_nan() || minorant.least <= 0.0 {
                return Err(PathError::UnboundedCost { at: element.flat.centroid() });
            }
        }
        Ok(all)
    }
}
