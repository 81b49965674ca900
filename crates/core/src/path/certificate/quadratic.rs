//! Quadratic (P2) functions on a mesh: one value at each node and at the middle of each edge.
//!
//! ```text
//!          2
//!          | \           value 3 belongs to the middle of the edge from 1 to 2,
//!          4   3         4 to the edge from 2 to 0, 5 to the edge from 0 to 1
//!          |     \
//!          0---5---1
//! ```

use glam::DVec2;

use super::triangle::FlatTriangle;
use crate::mesh::{Mesh, TriangleId};

/// The triangles that count, and the numbers of the values in each.
#[derive(Clone, Debug)]
pub(super) struct QuadraticSpace {
    pub elements: Vec<QuadraticElement>,
    /// How many values a function has: nodes first, then edges.
    pub values: usize,
    /// How many of them belong to nodes.
    pub nodes: usize,
}

/// A triangle and the numbers of its six values, in the order of the drawing above.
#[derive(Clone, Copy, Debug)]
pub(super) struct QuadraticElement {
    pub id: TriangleId,
    pub flat: FlatTriangle,
    pub values: [u32; 6],
}

impl QuadraticSpace {
    /// Returns the functions on the given triangles of a mesh. Values are numbered without gaps.
    pub(super) fn new(mesh: &Mesh, triangles: &[TriangleId]) -> Self {
        let mut number_of_node = vec![u32::MAX; mesh.raw_nodes().len()];
        let mut nodes = 0;
        let mut edges = Vec::with_capacity(3 * triangles.len());
        let mut elements = Vec::with_capacity(triangles.len());
        for (index, &id) in triangles.iter().enumerate() {
            let vertices = mesh.triangle(id).vertices.map(|node| {
                let number = &mut number_of_node[node.index()];
                if *number == u32::MAX {
                    *number = nodes;
                    nodes += 1;
                }
                *number
            });
            for opposite in 0..3 {
                let [from, to] = [1, 2].map(|step| vertices[(opposite + step) % 3]);
                edges.push((from.min(to), from.max(to), index, opposite));
            }
            let [a, b, c] = vertices;
            let flat = FlatTriangle::new(mesh.world_corners(id));
            elements.push(QuadraticElement { id, flat, values: [a, b, c, 0, 0, 0] });
        }
        edges.sort_unstable();
        let (mut values, mut last) = (nodes, None);
        for (from, to, index, opposite) in edges {
            if last != Some((from, to)) {
                last = Some((from, to));
                values += 1;
            }
            elements[index].values[3 + opposite] = values - 1;
        }
        Self { elements, values: values as usize, nodes: nodes as usize }
    }
}

impl QuadraticElement {
    /// Returns the weights of the six values in the value at a point.
    pub(super) fn weights_at(&self, point: DVec2) -> [f64; 6] {
        let [a, b, c] = self.flat.barycentric(point);
        let corner = |share: f64| share * (2.0 * share - 1.0);
        [corner(a), corner(b), corner(c), 4.0 * b * c, 4.0 * c * a, 4.0 * a * b]
    }

    /// Returns the derivative at corner `corner` along an edge that ends there, as weights of three values:
    /// those at the corner, at the middle of the edge and at its other end. `step` is 1 or 2 and says which
    /// edge: it leads to corner `corner + step`, counted cyclically. The unit of length is the edge.
    pub(super) fn along_edge(&self, corner: usize, step: usize) -> [(u32, f64); 3] {
        let other = (corner + step) % 3;
        let middle = 6 - corner - other;
        [(self.values[corner], -3.0), (self.values[middle], 4.0), (self.values[other], -1.0)]
    }

    /// Returns an orthonormal frame at a corner that makes the rows of a program sparse: one axis along an
    /// edge.
    pub(super) fn frame(&self, corner: usize) -> CornerFrame {
        let [first, second] =
            [1, 2].map(|step| self.flat.corners[(corner + step) % 3] - self.flat.corners[corner]);
        // The shorter of the two edges. At the right angle the other one is the second axis.
        let (step, along, other) =
            if first.length() <= second.length() { (1, first, second) } else { (2, second, first) };
        let axis = along.normalize();
        CornerFrame {
            step,
            length: along.length(),
            axis,
            skew: axis.dot(other),
            across: axis.perp_dot(other),
        }
    }
}

/// Axes at a corner of a triangle: the first along an edge, the second perpendicular to it.
///
/// With d and e the derivatives along the two edges ([`QuadraticElement::along_edge`]), the components of the
/// gradient are g₁ = d / length and g₂ = (e − skew · g₁) / across.
#[derive(Clone, Copy, Debug)]
pub(super) struct CornerFrame {
    /// Which edge the first axis follows.
    pub step: usize,
    pub length: f64,
    pub axis: DVec2,
    pub skew: f64,
    pub across: f64,
}

impl CornerFrame {
    /// Returns a vector in world coordinates, from its components along the axes.
    pub(super) fn world(&self, components: [f64; 2]) -> DVec2 {
        components[0] * self.axis + components[1] * self.axis.perp()
    }

    /// Returns the gradient from the derivatives along the edge of the first axis and the other edge.
    pub(super) fn gradient(&self, along: f64, other: f64) -> [f64; 2] {
        let first = along / self.length;
        [first, (other - self.skew * first) / self.across]
    }
}
