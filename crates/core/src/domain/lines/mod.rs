//! Lines inside a domain, along which a mesh shall have edges; and the same lines on the lattice of a mesh.

mod arrangement;
mod clip;
mod crest_grid;
mod exact;
mod straight;
mod weir;

use glam::DVec2;

use crate::geometry::{Lattice, LatticePoint};
use arrangement::Arrangement;
use clip::{ClippedPart, clip};
pub use crest_grid::{CrestOnGrid, NoCrest};
pub(crate) use exact::{cross, crossing, is_near, lies_between, place};
use straight::without_straight_corners;
pub(crate) use weir::LineMeasure;
pub use weir::{Crest, LineKind, LineWeirError, Weir, WeirError};

/// A line along which a mesh shall have edges: a breakwater, a thalweg, a dam.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The name, for messages and files.
    pub name: String,
    /// The corners, in world units.
    pub points: Vec<DVec2>,
    /// Whether the last corner is joined to the first one.
    pub closed: bool,
    /// What it is for solvers.
    pub kind: LineKind,
}

/// Lines with their corners on the lattice of a mesh, overlaid: where lines meet there is a corner, and what
/// several lines have in common is one segment.
///
/// The segments do not depend on the order and the directions of the lines. A segment is at most a few
/// lattice steps beside the line in the world: corners within one step of the straight line between others
/// are left out, the others move to the nearest lattice point, corners within one step of each other become
/// one, and a segment bends to a corner that is within one step of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinesOnLattice {
    /// The lower end of each segment first, in ascending order. They meet in their ends only.
    pub(crate) segments: Vec<[LatticePoint; 2]>,
    /// In the order in which they were given.
    pub(crate) lines: Vec<LineOnLattice>,
}

/// One of [`LinesOnLattice`].
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LineOnLattice {
    pub(crate) name: String,
    /// The first corner that is a finite number, in world units.
    pub(crate) first: Option<DVec2>,
    /// In world units, with the parts beyond the grid.
    pub(crate) length: f64,
    /// Its parts, along the line.
    pub(crate) parts: Vec<LinePart>,
}

/// A part of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LinePart {
    /// A segment, from its lower end to the other one or back.
    Segment {
        /// The number of the segment.
        segment: u32,
        /// Whether the line follows it from the upper end to the lower one.
        backwards: bool,
    },
    /// A part beyond the grid.
    Beyond {
        /// The ends, in world units.
        ends: [DVec2; 2],
    },
    /// A part that crosses others within a few lattice steps, so that it has no edges.
    Tangled {
        /// The ends on the lattice.
        ends: [LatticePoint; 2],
    },
    /// A corner that is not a finite number.
    NotFinite {
        /// The first corner of the line that is, in world units.
        near: DVec2,
    },
}

impl LinesOnLattice {
    /// Puts lines on a lattice. Takes time n log n for n corners and crossings.
    pub fn of(lines: &[Line], lattice: &Lattice) -> Self {
        let clipped: Vec<Vec<ClippedPart>> =
            lines.iter().map(|line| clip(&without_straight_corners(line, lattice), lattice)).collect();
        let ends = clipped.iter().flatten().filter_map(|part| match *part {
            ClippedPart::Within { ends, .. } => Some(ends),
            _ => None,
        });
        let arrangement = Arrangement::of(ends);
        let lines = lines.iter().zip(clipped).map(|(line, clipped)| {
            let first = line.points.iter().copied().find(|p| p.is_finite());
            let mut parts = Vec::new();
            for part in clipped {
                match part {
                    ClippedPart::Beyond(ends) => parts.push(LinePart::Beyond { ends }),
                    ClippedPart::NotFinite => {
                        parts.push(LinePart::NotFinite { near: first.unwrap_or(DVec2::ZERO) })
                    }
                    ClippedPart::Within { ends, backwards } => {
                        let from = parts.len();
                        parts.extend(arrangement.parts_of(ends));
                        if backwards {
                            parts[from..].reverse();
                            parts[from..].iter_mut().for_each(LinePart::turn);
                        }
                    }
                }
            }
            LineOnLattice { name: line.name.clone(), first, length: line.length(), parts }
        });
        let lines = lines.collect();
        Self { segments: arrangement.into_segments(), lines }
    }

    /// Returns whether there is no line.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }
}

impl LinePart {
    fn turn(&mut self) {
        match self {
            Self::Segment { backwards, .. } => *backwards = !*backwards,
            Self::Beyond { ends } => ends.swap(0, 1),
            Self::Tangled { ends } => ends.swap(0, 1),
            Self::NotFinite { .. } => {}
        }
    }
}

impl Line {
    /// Returns the weir that it is, if it is one.
    pub fn weir(&self) -> Option<&Weir> {
        match &self.kind {
            LineKind::Edges => None,
            LineKind::Weir(weir) => Some(weir),
        }
    }

    /// Returns the bytes of its corners and its crest.
    pub fn bytes(&self) -> usize {
        let crest = self.weir().map_or(0, |weir| match &weir.crest {
            Crest::Height(_) => 0,
            Crest::Profile(pairs) => size_of_val(&pairs[..]),
        });
        size_of_val(self) + size_of_val(&self.points[..]) + crest
    }

    /// Returns the length in world units, without what is at corners that are not finite.
    pub fn length(&self) -> f64 {
        self.edges().map(|[a, b]| a.distance(b)).filter(|length| length.is_finite()).sum()
    }

    /// Returns the edges from each corner to the next.
    pub fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        let closing = match self.points[..] {
            [first, .., last] if self.closed => Some([last, first]),
            _ => None,
        };
        self.points.windows(2).map(|ends| [ends[0], ends[1]]).chain(closing)
    }
}
