//! A choice of pieces of a boundary.

use glam::DVec2;

use super::super::Domain;
use super::{BoundaryMarks, BoundaryPiece, BoundaryPieces, BoundaryType};

/// Some pieces of a boundary: those with one of these names, and those of one of these types.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PieceChoice {
    /// Names of pieces. A name that no piece has chooses nothing.
    pub names: Vec<String>,
    /// Types of pieces, as they were set, or as they usually are.
    pub types: Vec<BoundaryType>,
}

impl PieceChoice {
    /// Returns the pieces of land: no water flows across them.
    pub fn of_land() -> Self {
        let is_land = |of_piece: &BoundaryType| !of_piece.lets_water_through();
        Self { names: Vec::new(), types: BoundaryType::ALL.into_iter().filter(is_land).collect() }
    }

    /// Returns whether it chooses a piece.
    pub fn includes(&self, piece: &BoundaryPiece) -> bool {
        self.names.contains(&piece.name) || self.types.contains(&piece.boundary_type())
    }

    /// Returns the chosen pieces of a domain as polylines in world units. None of a domain that is given by a
    /// formula: its boundary is that of its mesh.
    pub fn lines(&self, domain: &Domain, marks: &BoundaryMarks) -> Vec<Vec<DVec2>> {
        let Some(pieces) = BoundaryPieces::of_domain(domain, marks) else { return Vec::new() };
        let chosen = pieces.list().iter().filter(|piece| self.includes(piece));
        chosen.map(|piece| piece.points.clone()).collect()
    }

    /// Returns the names that no piece of a boundary has.
    pub fn unknown_names<'a>(&'a self, pieces: &'a BoundaryPieces) -> impl Iterator<Item = &'a str> {
        let is_known = |name: &str| pieces.list().iter().any(|piece| piece.name == name);
        self.names.iter().map(String::as_str).filter(move |name| !is_known(name))
    }
}
