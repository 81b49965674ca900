//! Values of a raster at the nodes of a mesh: means over their cells.
//!
//! The cell of a node is the third of each triangle around it where the node is the nearest corner in
//! barycentric coordinates: its sides are lines from the middles of edges to the centroid. These cells have
//! no gap and no overlap, so every pixel counts for one node, the one in whose cell its centre is.

use glam::DVec2;
use rayon::prelude::*;

use super::node_depths::{FARTHEST_PIXEL, places};
use crate::geometry::Rect;
use crate::mesh::MeshView;
use crate::raster::Raster;

/// Triangles or nodes that a thread takes at a time.
const GRAIN: usize = 256;

/// Values of a raster at the nodes of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeMeans {
    /// The value at each node, in the order of the nodes.
    pub values: Vec<f64>,
    /// The number of pixels with a value that count for a node.
    pub pixels: usize,
    /// The number of nodes without a pixel with a value in their cells and around themselves: they have the
    /// value of the nearest pixel.
    pub filled: usize,
    /// The distance of the farthest of these pixels, in world units.
    pub farthest: f64,
}

/// Some nodes are far from every pixel with a value.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "{nodes} nodes have no value: no pixel within {FARTHEST_PIXEL} columns and rows of them has one. The first is at \
     x = {}, y = {}.", at.x, at.y
)]
pub struct NoNodeValue {
    /// The number of nodes.
    pub nodes: usize,
    /// The place of the first one, in world units.
    pub at: DVec2,
}

/// Values of pixels, of which the mean is asked for.
#[derive(Clone, Copy, Debug)]
struct PixelSum {
    sum: f64,
    count: usize,
    least: f64,
    greatest: f64,
}

impl PixelSum {
    const NOTHING: Self = Self { sum: 0.0, count: 0, least: f64::INFINITY, greatest: f64::NEG_INFINITY };

    fn of(value: f64) -> Self {
        Self { sum: value, count: 1, least: value, greatest: value }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            sum: self.sum + other.sum,
            count: self.count + other.count,
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
        }
    }

    /// Returns the mean, which by rounding is not outside the values: of equal ones it is their value.
    fn mean(self) -> Option<f64> {
        let mean = self.sum / self.count as f64;
        (self.count > 0).then(|| mean.max(self.least).min(self.greatest))
    }
}

/// What a raster gives at one node.
enum ValueAtNode {
    Value(f64),
    /// The value of the nearest pixel, and its distance.
    Nearest(f64, f64),
    Nothing,
}

impl NodeMeans {
    /// Returns the value at each node: the mean of the pixels whose centres are in its cell, after `meaning`
    /// where pixels have classes. Pixels without a value do not count.
    ///
    /// A node without such a pixel has the value at its own place: linear between the centres of pixels, or
    /// with a `meaning` that of the pixel there. Where there is none, it has that of the nearest pixel.
    ///
    /// # Errors
    /// Fails when nodes are far from every pixel with a value.
    pub fn of(
        mesh: MeshView,
        raster: &Raster,
        meaning: Option<&(dyn Fn(f32) -> f64 + Sync)>,
    ) -> Result<Self, NoNodeValue> {
        let nodes = places(mesh);
        let sums = sums_in_cells(mesh, &nodes, raster, meaning);
        let of_node = |(&node, sum): (&DVec2, &PixelSum)| {
            sum.mean().map_or_else(|| value_at(raster, node, meaning), ValueAtNode::Value)
        };
        let found: Vec<ValueAtNode> = nodes.par_iter().zip(&sums).with_min_len(GRAIN).map(of_node).collect();
        let lost = || found.iter().zip(&nodes).filter(|(found, _)| matches!(found, ValueAtNode::Nothing));
        if let Some((_, &at)) = lost().next() {
            return Err(NoNodeValue { nodes: lost().count(), at });
        }
        let distances = || {
            found.iter().filter_map(|f| if let ValueAtNode::Nearest(_, far) = f { Some(*far) } else { None })
        };
        let (filled, farthest) = (distances().count(), distances().fold(0.0, f64::max));
        let value = |found: &ValueAtNode| match found {
            ValueAtNode::Value(value) | ValueAtNode::Nearest(value, _) => *value,
            ValueAtNode::Nothing => f64::NAN, // none is left
        };
        let pixels = sums.iter().map(|sum| sum.count).sum();
        Ok(Self { values: found.iter().map(value).collect(), pixels, filled, farthest })
    }
}

/// Returns the value of a node in whose cell no pixel has its centre.
fn value_at(raster: &Raster, node: DVec2, meaning: Option<&(dyn Fn(f32) -> f64 + Sync)>) -> ValueAtNode {
    let own = match meaning {
        None => raster.linear_at(node),
        Some(meaning) => raster.sample(node).filter(|value| !value.is_nan()).map(meaning),
    };
    if let Some(value) = own {
        return ValueAtNode::Value(value);
    }
    raster.nearest(node, FARTHEST_PIXEL).map_or(ValueAtNode::Nothing, |nearest| {
        // It is the value of a pixel.
        let value = meaning.map_or(nearest.value, |meaning| meaning(nearest.value as f32));
        ValueAtNode::Nearest(value, nearest.distance)
    })
}

/// Returns the sum of the values in the cell of each node. Sums are in the order of the
/// triangles, so that they are the same for any number of threads.
fn sums_in_cells(
    mesh: MeshView,
    nodes: &[DVec2],
    raster: &Raster,
    meaning: Option<&(dyn Fn(f32) -> f64 + Sync)>,
) -> Vec<PixelSum> {
    let of_triangle = |triangle: &crate::mesh::Triangle| {
        let corners = triangle.vertices.map(|node| node.index());
        (corners, sums_in_thirds(corners, nodes, raster, meaning))
    };
    let parts: Vec<_> = mesh.triangles().par_iter().with_min_len(GRAIN).map(of_triangle).collect();
    let mut sums = vec![PixelSum::NOTHING; nodes.len()];
    for (corners, thirds) in parts {
        for (node, third) in corners.into_iter().zip(thirds) {
            sums[node] = sums[node].plus(third);
        }
    }
    sums
}

/// Returns the sum of the values in the third of each corner of a triangle.
fn sums_in_thirds(
    corners: [usize; 3],
    nodes: &[DVec2],
    raster: &Raster,
    meaning: Option<&(dyn Fn(f32) -> f64 + Sync)>,
) -> [PixelSum; 3] {
    let mut sums = [PixelSum::NOTHING; 3];
    let Some(bounds) = Rect::holding(corners.map(|node| nodes[node])) else { return sums };
    for (x, y) in raster.pixels_touching(&bounds).pixels() {
        let value = raster.get(x, y);
        if value.is_nan() {
            continue;
        }
        let Some(corner) = nearest_corner(corners, nodes, raster.pixel_center(x, y)) else { continue };
        let value = meaning.map_or(f64::from(value), |meaning| meaning(value));
        sums[corner] = sums[corner].plus(PixelSum::of(value));
    }
    sums
}

/// Returns the corner in whose third of a triangle a point is; `None` outside.
///
/// Two triangles compute the side of their common edge alike, and a point on it belongs to the one on its
/// left, seen upwards, so that no point counts twice. Of equally near corners the one with the lower number
/// counts.
fn nearest_corner(corners: [usize; 3], nodes: &[DVec2], at: DVec2) -> Option<usize> {
    let [a, b, c] = corners.map(|node| nodes[node]);
    let turn = (b - a).perp_dot(c - a).signum();
    let mut parts = [0.0; 3];
    for (n, part) in parts.iter_mut().enumerate() {
        let (from, to) = (corners[(n + 1) % 3], corners[(n + 2) % 3]);
        let (low, high) = (nodes[from.min(to)], nodes[from.max(to)]);
        let direction = if from < to { turn } else { -turn };
        *part = direction * (high - low).perp_dot(at - low);
        let along = direction * (high - low);
        let is_own = along.y > 0.0 || (along.y == 0.0 && along.x < 0.0);
        if !(*part > 0.0 || (*part == 0.0 && is_own)) {
            return None;
        }
    }
    (0..3).min_by(|&m, &n| parts[n].total_cmp(&parts[m]).then(corners[m].cmp(&corners[n])))
}
