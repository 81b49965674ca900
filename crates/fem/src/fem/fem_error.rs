//! Why a problem has no solution here, in sentences.

use std::error::Error;
use std::fmt;

use glam::DVec2;

use super::problem::EVERY_PIECE;
use crate::text::{Grouped, Number};

/// Why a problem cannot be solved.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FemError {
    /// A formula is not finite somewhere.
    NotFinite {
        /// What the formula is.
        what: &'static str,
        /// Where, in world units.
        place: DVec2,
        /// Its value there.
        value: f64,
    },
    /// The diffusion is not positive somewhere.
    Diffusion {
        /// Where, in world units.
        place: DVec2,
        /// Its value there.
        value: f64,
    },
    /// The reaction, or the transfer of a Robin condition, is negative somewhere.
    Negative {
        /// What the formula is.
        what: &'static str,
        /// Where, in world units.
        place: DVec2,
        /// Its value there.
        value: f64,
    },
    /// No piece of the boundary has this name.
    UnknownPiece {
        /// The name.
        name: String,
        /// The name that is most like it.
        nearest: Option<String>,
        /// How many pieces there are.
        count: usize,
    },
    /// A piece has two conditions.
    TwoConditions {
        /// The name of the piece.
        piece: String,
    },
    /// Nothing holds the mean of u, and source and boundary do not balance.
    Unbalanced {
        /// The integral of the source.
        source: f64,
        /// The integral of the flux through the boundary into the domain.
        inflow: f64,
    },
    /// A part of the mesh has nothing that holds the mean of u.
    PartWithoutCondition {
        /// How many parts the mesh has.
        parts: usize,
        /// A place in that part, in world units.
        place: DVec2,
    },
    /// The solver did not reach its accuracy.
    NoConvergence {
        /// How many steps it did.
        steps: usize,
        /// By what factor the residual was reduced.
        reduction: f64,
    },
    /// The mesh has more triangles than fit.
    TooLarge {
        /// How many triangles.
        triangles: usize,
    },
}

impl FemError {
    /// Returns the error about a name of the boundary that does not exist.
    pub(crate) fn unknown_piece(name: &str, known: &[&str]) -> Self {
        let distance = |known: &&str| edit_distance(&name.to_lowercase(), &known.to_lowercase());
        let nearest = known.iter().copied().min_by_key(distance);
        Self::UnknownPiece { name: name.to_owned(), nearest: nearest.map(str::to_owned), count: known.len() }
    }
}

/// Returns how many letters must be changed, added or left out to make one word the other.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut before = std::mem::replace(&mut row[0], i + 1);
        for (j, other) in b.iter().enumerate() {
            let changed = before + usize::from(letter != *other);
            before = row[j + 1];
            row[j + 1] = changed.min(before + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

/// A place for a person.
struct At(DVec2);

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", Number(self.0.x), Number(self.0.y))
    }
}

impl fmt::Display for FemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { what, place, value } => write!(
                f,
                "The {what} is {value} at {}; it must be a finite number everywhere in the domain. Change the formula \
                 there, as with if(…) or max(…).",
                At(*place)
            ),
            Self::Diffusion { place, value } => write!(
                f,
                "The diffusion is {} at {}; it must be positive everywhere, because u is not determined where nothing \
                 diffuses. Keep it above a small number, as with max(…, 1e-6).",
                Number(*value),
                At(*place)
            ),
            Self::Negative { what, place, value } => write!(
                f,
                "The {what} is {} at {}; it must nowhere be negative, because u need not be unique then. Keep it at 0 or \
                 above, as with max(…, 0).",
                Number(*value),
                At(*place)
            ),
            Self::UnknownPiece { name, nearest, count } => {
                write!(f, "There is no piece of the boundary called “{name}”")?;
                match nearest {
                    Some(nearest) if *count == 1 => write!(f, ": its only one is “{nearest}”.")?,
                    Some(nearest) => {
                        write!(f, ", which has {count} pieces; the most similar name is “{nearest}”.")?;
                    }
                    None => write!(f, ": it has no pieces.")?,
                }
                write!(f, " “{EVERY_PIECE}” stands for every piece without a condition of its own.")
            }
            Self::TwoConditions { piece } => {
                write!(f, "“{piece}” has two conditions, and a piece of the boundary has one. Leave one out.")
            }
            _ => self.fmt_of_whole(f),
        }
    }
}

impl FemError {
    /// The sentences about the problem as a whole.
    fn fmt_of_whole(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unbalanced { source, inflow } => write!(
                f,
                "There is no solution: without a Dirichlet or Robin condition and without reaction, what the source brings \
                 must leave through the boundary, and the source brings {} while {} flow in. Give u on a \
                 piece of the boundary (--dirichlet NAME=FORMULA), a reaction, or a source that balances.",
                Number(*source),
                Number(*inflow)
            ),
            Self::PartWithoutCondition { parts, place } => write!(
                f,
                "The mesh has {parts} parts, and nothing determines u in the one at {}: no piece of its boundary has a \
                 Dirichlet or Robin condition, and there is no reaction. Give it a condition, or keep only the largest part.",
                At(*place)
            ),
            Self::NoConvergence { steps, reduction } => write!(
                f,
                "The solver stopped after {} steps with a residual of {} of the first one. Convection that is strong for \
                 the triangles can cause that; smaller triangles or more diffusion help.",
                Grouped(*steps),
                Number(*reduction)
            ),
            Self::TooLarge { triangles } => write!(
                f,
                "{} triangles are too many to solve on: at most 500 million. Ask for larger triangles.",
                Grouped(*triangles)
            ),
            _ => Ok(()),
        }
    }
}

impl Error for FemError {}
