//! Checks a mesh with nodes on the outline, and measures its angles.

use std::collections::HashMap;
use std::fmt;

use super::OutlineMesh;
use super::angles::Angles;
use crate::mesh::{Extract, NodeId};

/// A rule that a mesh with nodes on the outline breaks. Numbers are those of the extract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OutlineViolation {
    /// A triangle whose corners do not run anticlockwise.
    Area {
        /// Its number.
        triangle: usize,
    },
    /// An angle below the bound, away from sharp corners of the outline.
    Angle {
        /// The number of the triangle.
        triangle: usize,
    },
    /// Two triangles have an edge in the same direction.
    Edge {
        /// The number of the second one.
        triangle: usize,
    },
    /// The triangle says something else about a neighbour than the edges.
    Neighbour {
        /// Its number.
        triangle: usize,
    },
    /// The domain touches itself in a node.
    Pinched {
        /// Its number.
        node: usize,
    },
}

impl fmt::Display for OutlineViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Area { triangle } => write!(f, "triangle {triangle} on the outline has no positive area"),
            Self::Angle { triangle } => {
                write!(f, "triangle {triangle} on the outline has too small an angle")
            }
            Self::Edge { triangle } => {
                write!(
                    f,
                    "triangle {triangle} on the outline has an edge in the direction of another triangle"
                )
            }
            Self::Neighbour { triangle } => {
                write!(f, "triangle {triangle} on the outline has a wrong neighbour")
            }
            Self::Pinched { node } => write!(f, "the domain touches itself in node {node}"),
        }
    }
}

impl OutlineMesh {
    /// All rules that the mesh breaks, as files get it: `extract` must be the result of [`Self::extract`].
    pub fn violations(&self, extract: &Extract) -> Vec<OutlineViolation> {
        let mut found = Vec::new();
        let mut owners: HashMap<[usize; 2], usize> = HashMap::with_capacity(3 * extract.triangles().len());
        for (triangle, cell) in extract.cells().enumerate() {
            let [a, b, c] = cell.corners;
            for edge in [[a, b], [b, c], [c, a]] {
                if owners.insert(edge, triangle).is_some() {
                    found.push(OutlineViolation::Edge { triangle });
                }
            }
        }
        for (triangle, cell) in extract.cells().enumerate() {
            let [a, b, c] = cell.corners;
            let across = [[c, b], [a, c], [b, a]].map(|edge| owners.get(&edge).copied());
            if cell.opposite != across {
                found.push(OutlineViolation::Neighbour { triangle });
            }
        }
        self.check_angles(extract, &mut found);
        let mut ends = vec![0u8; extract.nodes().len()];
        extract
            .boundary_edges()
            .flat_map(|edge| edge.ends)
            .for_each(|node| ends[node] = ends[node].saturating_add(1));
        let pinched = ends.iter().enumerate().filter(|(_, count)| **count > 2);
        found.extend(pinched.map(|(node, _)| OutlineViolation::Pinched { node }));
        found
    }

    fn check_angles(&self, extract: &Extract, found: &mut Vec<OutlineViolation>) {
        let angles = Angles::new(extract.lattice().step());
        let limit = angles.limit().max(self.corner_limit());
        for (triangle, cell) in extract.cells().enumerate() {
            let worst = angles.worst(cell.corners.map(|node| extract.node(NodeId::from_index(node))));
            if worst == f64::INFINITY {
                found.push(OutlineViolation::Area { triangle });
            } else if worst > limit {
                found.push(OutlineViolation::Angle { triangle });
            }
        }
    }
}

/// The smallest and the largest angle of all triangles, in degrees.
pub fn angle_range(extract: &Extract) -> [f64; 2] {
    let angles = Angles::new(extract.lattice().step());
    let all = extract.cells().flat_map(|cell| {
        let [a, b, c] = cell.corners.map(|node| extract.node(NodeId::from_index(node)));
        [(a, b, c), (b, c, a), (c, a, b)]
    });
    all.fold([180.0f64, 0.0], |[least, most], (at, from, to)| {
        let (from, to) = (angles.vector(at, from), angles.vector(at, to));
        let angle = libm::atan2(from.perp_dot(to), from.dot(to)).to_degrees();
        [least.min(angle), most.max(angle)]
    })
}
