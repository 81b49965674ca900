//! The zero line of a formula as polygons: the boundary of the part of a rectangle where the formula is
//! neither zero nor NaN.
//!
//! Interval arithmetic excludes squares that lie wholly on one side, down to squares of a 4096th of the
//! longer side ([`grid`]). In the others, the line is where the corners of a square lie on different sides,
//! from edge to edge (marching squares). Only the *side* of a point is asked for, so jumps and NaN are no
//! special case. Each crossing is found by bisection, and each chord is divided until the line is at most
//! [`TOLERANCE`] beside it ([`chords`]); so corners of the line, too, are found to about that. Points that
//! lie between others on one line are left out, and the few points around a corner become one ([`thinning`]).
//!
//! The polygons depend on the formula and the rectangle alone. Parts, holes and gaps that are narrower than
//! the squares can be missed.

mod chords;
mod grid;
mod thinning;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use self::grid::{FormulaGrid, GridSquare};
use super::marching::{self, GridEdge};
use super::{MOST_CORNERS, Region, Ring};
use crate::field::Formula;
use crate::geometry::Rect;
use crate::mesh::Progress;
use crate::text::Grouped;

/// How far the line may be beside a chord, as a share of the longer side of the rectangle: half a step of the
/// grid of polygons.
const TOLERANCE: f64 = 1.0 / (1u64 << 31) as f64;
/// Most squares of one size that are looked at.
const MOST_SQUARES: usize = 1 << 20;
/// Most squares that the line passes through.
const MOST_CROSSED: usize = 1 << 18;
/// Squares and chords of one step.
const AT_ONCE: usize = 4096;

/// Why the zero line of a formula is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ZeroLineError {
    /// It is too long, or too crooked.
    #[error(
        "The line where the formula of the domain becomes false is too long to follow: it would take more than {} \
         corners. The mesh keeps whole coarse triangles, as in the report. A formula that changes more slowly would \
         help.",
        Grouped(MOST_CORNERS)
    )]
    TooLong,
    /// There is no area where the formula is neither zero nor NaN.
    #[error(
        "No square of the grid over the domain has a corner where its formula is true, so that no line can be \
         followed. The mesh keeps whole coarse triangles, as in the report."
    )]
    NoArea,
}

/// The part of a rectangle that a formula gives, or why it is not known.
pub(super) type ZeroLine = Result<Arc<Region>, ZeroLineError>;

/// Follows the zero line of a formula, in steps of some milliseconds.
#[derive(Clone, Debug)]
pub(super) struct ZeroLineTracer {
    grid: FormulaGrid,
    step: TraceStep,
}

#[derive(Clone, Debug)]
enum TraceStep {
    /// Squares that may be crossed are quartered, from this one on.
    Halving {
        squares: Vec<GridSquare>,
        next: usize,
        quarters: Vec<GridSquare>,
    },
    /// Smallest squares are looked at, from this one on.
    Crossing {
        squares: Vec<GridSquare>,
        next: usize,
        crossed: Vec<GridSquare>,
    },
    /// The line is followed through the squares that it crosses.
    Following(Vec<GridSquare>),
    /// The place on each edge is found, from this one on.
    Placing {
        chains: Chains,
        points: Vec<DVec2>,
    },
    /// Each chord is divided, from this one on.
    Dividing {
        chains: Chains,
        points: Vec<DVec2>,
        divided: Vec<Vec<DVec2>>,
        count: usize,
    },
    Done(ZeroLine),
}

/// The edges that all rings cross, one ring after the other.
#[derive(Clone, Debug)]
struct Chains {
    edges: Vec<GridEdge>,
    /// The end of each ring.
    ends: Vec<usize>,
}

impl Chains {
    fn new(rings: Vec<Vec<GridEdge>>) -> Self {
        let mut chains = Self { edges: Vec::new(), ends: Vec::new() };
        for ring in rings {
            chains.edges.extend(ring);
            chains.ends.push(chains.edges.len());
        }
        chains
    }

    /// Returns the number of the edge after one in its ring.
    fn next(&self, edge: usize) -> usize {
        let ring = self.ends.partition_point(|&end| end <= edge);
        let start = if ring == 0 { 0 } else { self.ends[ring - 1] };
        if edge + 1 == self.ends[ring] { start } else { edge + 1 }
    }

    /// Joins what was found for each edge to rings.
    fn rings(&self, of_edges: &[Vec<DVec2>]) -> Vec<Ring> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| of_edges[start..end].concat()).collect()
    }
}

impl ZeroLineTracer {
    /// Begins to follow the zero line of a formula in a proper rectangle.
    pub(super) fn new(formula: Formula, bounds: Rect) -> Self {
        let grid = FormulaGrid::new(formula, bounds);
        let step = TraceStep::Halving { squares: grid.roots(), next: 0, quarters: Vec::new() };
        Self { grid, step }
    }

    /// Takes a step.
    pub(super) fn advance(&mut self) -> Progress {
        let done = TraceStep::Done(Err(ZeroLineError::NoArea));
        let step = std::mem::replace(&mut self.step, done);
        self.step = match step {
            TraceStep::Halving { squares, next, quarters } => self.quarter(squares, next, quarters),
            TraceStep::Crossing { squares, next, crossed } => self.cross(squares, next, crossed),
            TraceStep::Following(crossed) => self.follow(crossed),
            TraceStep::Placing { chains, points } => self.place(chains, points),
            TraceStep::Dividing { chains, points, divided, count } => {
                self.divide(chains, points, divided, count)
            }
            done @ TraceStep::Done(_) => done,
        };
        if matches!(self.step, TraceStep::Done(_)) { Progress::Done } else { Progress::More }
    }

    /// Returns the polygons. Work that is left is done in one go.
    pub(super) fn finish(mut self) -> ZeroLine {
        while self.advance() == Progress::More {}
        match self.step {
            TraceStep::Done(line) => line,
            _ => unreachable!("the last step was taken"),
        }
    }

    fn quarter(&mut self, squares: Vec<GridSquare>, next: usize, mut quarters: Vec<GridSquare>) -> TraceStep {
        let last = squares.len().min(next + AT_ONCE);
        let undecided =
            |square: &GridSquare| self.grid.may_be_crossed(square).then(|| self.grid.quarters(square));
        let found: Vec<Option<Vec<GridSquare>>> = squares[next..last].par_iter().map(undecided).collect();
        quarters.extend(found.into_iter().flatten().flatten());
        if last < squares.len() {
            return TraceStep::Halving { squares, next: last, quarters };
        }
        // Of the smallest squares, the corners are asked about.
        self.grid.halve();
        let is_last = self.grid.is_smallest() || 4 * quarters.len() > MOST_SQUARES;
        match is_last {
            true => TraceStep::Crossing { squares: quarters, next: 0, crossed: Vec::new() },
            false => TraceStep::Halving { squares: quarters, next: 0, quarters: Vec::new() },
        }
    }

    fn cross(&self, squares: Vec<GridSquare>, next: usize, mut crossed: Vec<GridSquare>) -> TraceStep {
        let last = squares.len().min(next + AT_ONCE);
        let found: Vec<bool> =
            squares[next..last].par_iter().map(|square| self.grid.is_crossed(square)).collect();
        let of_step = squares[next..last].iter().zip(found);
        crossed.extend(of_step.filter(|(_, is_crossed)| *is_crossed).map(|(square, _)| *square));
        if crossed.len() > MOST_CROSSED {
            return TraceStep::Done(Err(ZeroLineError::TooLong));
        }
        match last < squares.len() {
            true => TraceStep::Crossing { squares, next: last, crossed },
            false => TraceStep::Following(crossed),
        }
    }

    fn follow(&self, crossed: Vec<GridSquare>) -> TraceStep {
        let squares = crossed.into_iter().chain(self.grid.squares_around());
        let chains = Chains::new(marching::rings(&self.grid, squares.map(GridSquare::node)));
        TraceStep::Placing { chains, points: Vec::new() }
    }

    fn place(&self, chains: Chains, mut points: Vec<DVec2>) -> TraceStep {
        let last = chains.edges.len().min(points.len() + AT_ONCE);
        let of_step = chains.edges[points.len()..last].par_iter();
        let found: Vec<DVec2> = of_step.map(|&edge| self.grid.crossing(edge)).collect();
        points.extend(found);
        match last < chains.edges.len() {
            true => TraceStep::Placing { chains, points },
            false => TraceStep::Dividing { chains, points, divided: Vec::new(), count: 0 },
        }
    }

    fn divide(
        &self,
        chains: Chains,
        points: Vec<DVec2>,
        mut divided: Vec<Vec<DVec2>>,
        count: usize,
    ) -> TraceStep {
        let (first, last) = (divided.len(), points.len().min(divided.len() + AT_ONCE));
        let chord = |edge: usize| chords::divided(&self.grid, [points[edge], points[chains.next(edge)]]);
        let found: Vec<Vec<DVec2>> = (first..last).into_par_iter().map(chord).collect();
        let count = count + found.iter().map(Vec::len).sum::<usize>();
        divided.extend(found);
        if count > 2 * MOST_CORNERS {
            return TraceStep::Done(Err(ZeroLineError::TooLong));
        }
        match last < points.len() {
            true => TraceStep::Dividing { chains, points, divided, count },
            false => TraceStep::Done(self.region(&chains.rings(&divided))),
        }
    }

    fn region(&self, rings: &[Ring]) -> ZeroLine {
        let thinned = |ring: &Ring| thinning::thinned(ring, self.grid.tolerance());
        let rings: Vec<Ring> = rings.par_iter().map(thinned).collect();
        if rings.iter().map(Vec::len).sum::<usize>() > MOST_CORNERS {
            return Err(ZeroLineError::TooLong);
        }
        let region = Region::enclosed_on_left(&rings, *self.grid.bounds());
        if region.is_empty() { Err(ZeroLineError::NoArea) } else { Ok(Arc::new(region)) }
    }
}
