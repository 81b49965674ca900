//! What is solved.

use glam::DVec2;

use super::fem_error::FemError;
use crate::domain::MeshBoundary;
use crate::field::Formula;

/// −∇·(a∇u) + b·∇u + c u = f, with conditions on named pieces of the boundary.
///
/// Formulas are of x and y in world units. Lengths in derivatives are world units; for a domain on the Earth,
/// metres on the ellipsoid. Where nothing is said about a piece, nothing flows through it: a ∂u/∂n = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct FemProblem {
    /// a, positive everywhere.
    pub diffusion: Formula,
    /// b along x and y.
    pub convection: Option<[Formula; 2]>,
    /// c, nowhere negative.
    pub reaction: Formula,
    /// f.
    pub source: Formula,
    /// Conditions by the name of a piece, each name once.
    pub conditions: Vec<NamedCondition>,
}

/// A condition on a piece of the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCondition {
    /// The name of the piece; [`EVERY_PIECE`] for all pieces that no other condition names.
    pub piece: String,
    /// What holds there.
    pub condition: BoundaryCondition,
}

/// The name that stands for all pieces, unless one has it.
pub const EVERY_PIECE: &str = "all";

/// What holds on a piece of the boundary; n points out of the domain.
#[derive(Clone, Debug, PartialEq)]
pub enum BoundaryCondition {
    /// u = g.
    Dirichlet(Formula),
    /// a ∂u/∂n = g.
    Neumann(Formula),
    /// a ∂u/∂n + α u = g, with α nowhere negative.
    Robin {
        /// α.
        transfer: Formula,
        /// g.
        flux: Formula,
    },
}

impl Default for FemProblem {
    /// −∇·∇u = 0 with nothing on the boundary.
    fn default() -> Self {
        Self {
            diffusion: Formula::constant_of(1.0),
            convection: None,
            reaction: Formula::constant_of(0.0),
            source: Formula::constant_of(0.0),
            conditions: Vec::new(),
        }
    }
}

impl FemProblem {
    /// Returns for each boundary edge of a mesh which condition it has, by its place in
    /// [`Self::conditions`].
    ///
    /// # Errors
    /// Fails when a name is not that of a piece, or stands twice.
    pub fn conditions_on(&self, boundary: &MeshBoundary) -> Result<Vec<Option<usize>>, FemError> {
        let pieces = boundary.pieces().list();
        let names: Vec<&str> = pieces.iter().map(|piece| piece.name.as_str()).collect();
        let mut of_piece = vec![None; names.len()];
        let mut of_others = None;
        for (number, named) in self.conditions.iter().enumerate() {
            let name = named.piece.trim();
            let slot = match names.iter().position(|known| *known == name) {
                Some(piece) => &mut of_piece[piece],
                None if name == EVERY_PIECE => &mut of_others,
                None => return Err(FemError::unknown_piece(name, &names)),
            };
            if slot.replace(number).is_some() {
                return Err(FemError::TwoConditions { piece: name.to_owned() });
            }
        }
        let of_edge = |piece: &u32| of_piece[*piece as usize].or(of_others);
        Ok(boundary.piece_of_edge().iter().map(of_edge).collect())
    }

    /// Returns the names of pieces that have a condition and no edge in the mesh.
    pub fn conditions_without_edges(&self, boundary: &MeshBoundary) -> Vec<String> {
        let (pieces, figures) = (boundary.pieces().list(), boundary.figures());
        let is_absent = |named: &&NamedCondition| {
            let piece = pieces.iter().position(|piece| piece.name == named.piece.trim());
            piece.is_some_and(|piece| figures[piece].edges == 0)
        };
        self.conditions.iter().filter(is_absent).map(|named| named.piece.trim().to_owned()).collect()
    }
}

/// A formula that is evaluated often: a number where it is one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Values<'a> {
    formula: &'a Formula,
    constant: Option<f64>,
}

impl<'a> Values<'a> {
    pub fn of(formula: &'a Formula) -> Self {
        Self { formula, constant: formula.constant() }
    }

    #[inline]
    pub fn at(&self, point: DVec2) -> f64 {
        self.constant.unwrap_or_else(|| self.formula.eval(point.x, point.y))
    }

    /// Returns the value everywhere, if the formula uses no coordinate.
    pub fn constant(&self) -> Option<f64> {
        self.constant
    }

    pub fn formula(&self) -> &'a Formula {
        self.formula
    }
}
