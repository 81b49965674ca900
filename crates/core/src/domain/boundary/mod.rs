//! The boundary of a domain in named pieces, and the piece of each boundary edge of a mesh.
//!
//! Pieces come from the domain, not from the mesh: a piece keeps its number and its name when the mesh is
//! refined. They are made in three steps.
//!
//! ```text
//!   rings                  stretches                     pieces
//!
//!   o------------o         |--------------|              |--------------|
//!   |    o--o    |         :   island 1   :  named and   :  Port   ,----.  `Port` is a name that a person
//!   |    o--o    |   =>    :    o--o      :  split  =>   :  island 1    :  anchored on the coast
//!   o_         _o          :_  mainland  _:              :_   ,---'    _:
//!     `~~x~~~~'              `~~~~~~~~~~'                  `~~x~~~~~~'    x is a place where it is split
//! ```
//!
//! - A *stretch* is a maximal part of a ring along one side of a rectangle that cuts the domain off from its
//!   surroundings ([`CutFrame`](super::CutFrame); open), or along none (coast). A coast is mainland on an
//!   outer ring, and an island on the ring of a hole.
//! - A *piece* is a stretch, or a part of one between places where it is split ([`BoundaryMarks`]). What it
//!   is for a solver follows from its kind and its name, unless its [`BoundaryType`] is set.
//!
//! [`MeshBoundary`] then finds the piece of each edge of a mesh.

mod choice;
mod coasts;
mod idle_marks;
mod labels;
mod marks;
mod mesh_boundary;
mod opening;
mod pieces;
mod stretches;
mod types;

pub use choice::PieceChoice;
pub use coasts::{CoastEdge, Coasts, coasts};
pub use marks::{BoundaryMarks, LONGEST_NAME, NamedPolygon};
pub use mesh_boundary::{MeshBoundary, PieceFigures, PieceRun};
pub use pieces::{BoundaryPiece, BoundaryPieces};
pub use stretches::BoundaryKind;
pub use types::BoundaryType;
