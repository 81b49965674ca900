//! Checks a derived mesh.

use std::collections::HashMap;
use std::fmt;

use super::DerivedMesh;
use super::angles::Angles;
use crate::mesh::{Extract, NodeId};

/// A rule that a derived mesh breaks. Triangles and nodes have the numbers of the extract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DerivedViolation {
    /// A triangle whose corners do not run anticlockwise.
    Area {
        /// The number of the triangle.
        triangle: usize,
    },
    /// An angle below the bound, away from sharp corners of the outline.
    Angle {
        /// The number of the triangle.
        triangle: usize,
    },
    /// Two triangles have an edge in the same direction.
    Edge {
        /// The number of the second triangle.
        triangle: usize,
    },
    /// The neighbour that a triangle names is not the one that its edges show.
    Neighbour {
        /// The number of the triangle.
        triangle: usize,
    },
    /// The domain touches itself in a node.
    Pinched {
        /// The number of the node.
        node: usize,
    },
}

impl fmt::Display for DerivedViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (triangle, problem) = match self {
            Self::Pinched { node } => return write!(f, "the domain touches itself in node {node}"),
            Self::Area { triangle } => (triangle, "no positive area"),
            Self::Angle { triangle } => (triangle, "an angle below the bound"),
            Self::Edge { triangle } => (triangle, "an edge in the direction of another triangle"),
            Self::Neighbour { triangle } => (triangle, "a wrong neighbour"),
        };
        write!(f, "triangle {triangle} of the finished mesh has {problem}")
    }
}

impl DerivedMesh {
    /// Returns all rules that the derived mesh breaks; `extract` must be the result of [`Self::extract`].
    pub fn violations(&self, extract: &Extract) -> Vec<DerivedViolation> {
        let mut found = Vec::new();
        let mut owners: HashMap<[usize; 2], usize> = HashMap::with_capacity(3 * extract.triangles().len());
        for (triangle, cell) in extract.cells().enumerate() {
            let [a, b, c] = cell.corners;
            for edge in [[a, b], [b, c], [c, a]] {
                if owners.insert(edge, triangle).is_some() {
                    found.push(DerivedViolation::Edge { triangle });
                }
            }
        }
        for (triangle, cell) in extract.cells().enumerate() {
            let [a, b, c] = cell.corners;
            let across = [[c, b], [a, c], [b, a]].map(|edge| owners.get(&edge).copied());
            if cell.opposite != across {
                found.push(DerivedViolation::Neighbour { triangle });
            }
        }
        self.check_angles(extract, &mut found);
        if !self.allows_pinches() {
            found.extend(
                extract.pinches().into_iter().map(|node| DerivedViolation::Pinched { node: node.index() }),
            );
        }
        found
    }

    fn check_angles(&self, extract: &Extract, found: &mut Vec<DerivedViolation>) {
        let angles = Angles::new(extract.lattice().step());
        let limit = self.largest_cotangent(&angles);
        for (triangle, cell) in extract.cells().enumerate() {
            let worst = angles.worst(cell.corners.map(|node| extract.node(NodeId::from_index(node))));
            if worst == f64::INFINITY {
                found.push(DerivedViolation::Area { triangle });
            } else if worst > limit {
                found.push(DerivedViolation::Angle { triangle });
            }
        }
    }
}
