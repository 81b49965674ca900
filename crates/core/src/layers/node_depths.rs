//! Depths at the nodes of a mesh, and how far the mesh is from the rasters that they come from.

use glam::DVec2;
use rayon::prelude::*;

use super::depth_surface::{covers, has_value};
use super::{DepthSurface, Depths, Layer};
use crate::geometry::Rect;
use crate::mesh::MeshView;
use crate::raster::{PixelRect, Raster};

/// Pixels by side of a triangle from which on a node has the mean of the pixels around it. Below that, the
/// value at the node itself is closer to the surface.
const PIXELS_TO_AVERAGE: f64 = 4.0;
/// Farthest that a node without a value may be from a pixel with one, in pixels.
pub(super) const FARTHEST_PIXEL: u32 = 64;
/// Nodes or triangles that a thread takes at a time.
const GRAIN: usize = 256;

/// Depths at the nodes of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeDepths {
    /// The depth at each node, in metres, positive downwards, in the order of the nodes.
    pub depths: Vec<f64>,
    /// The number of nodes where no layer has a value: they have that of the nearest pixel.
    pub filled: usize,
    /// The distance of the farthest of these pixels, in world units.
    pub farthest: f64,
    /// How far the mesh is from the pixels.
    pub fit: DepthFit,
}

/// How far depths that are linear over triangles are from the pixels in them. A difference is the depth of
/// the mesh less that of the pixel, at its centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthFit {
    /// The number of pixels.
    pub pixels: usize,
    /// The largest difference of either sign, in metres.
    pub largest: f64,
    /// The place of the largest difference, in world units.
    pub at: DVec2,
    /// The square root of the mean of the squares, in metres, by area.
    pub rms: f64,
    /// The mean, in metres, by area: positive where the mesh holds more water.
    pub mean: f64,
}

/// Some nodes are far from every pixel with a value.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "{nodes} nodes have no depth: no layer of depths has a value within {FARTHEST_PIXEL} pixels of them. The first is \
     at x = {}, y = {}. Add a layer of depths that covers the domain below the others.", at.x, at.y
)]
pub struct NoDepth {
    /// The number of nodes.
    pub nodes: usize,
    /// The place of the first one, in world units.
    pub at: DVec2,
}

/// The depth of a node.
struct FoundDepth {
    depth: f64,
    /// The distance of the nearest pixel, if the depth is its.
    distance: Option<f64>,
}

impl NodeDepths {
    /// Returns the depths at the nodes of a mesh from a stack of layers, from the bottom to the top; `None`
    /// if no visible layer is one of depths.
    ///
    /// # Errors
    /// Fails when nodes are far from every pixel with a value.
    pub fn of(layers: &[Layer], mesh: MeshView) -> Option<Result<Self, NoDepth>> {
        DepthSurface::of(layers).map(|surface| surface.at_nodes(mesh))
    }
}

impl DepthSurface<'_> {
    fn at_nodes(&self, mesh: MeshView) -> Result<NodeDepths, NoDepth> {
        let nodes = places(mesh);
        let found = self.found_at(mesh, &nodes)?;
        let distances = || found.iter().filter_map(|found| found.distance);
        let depths: Vec<f64> = found.iter().map(|found| found.depth).collect();
        let fit = self.fit(mesh, &nodes, &depths);
        Ok(NodeDepths { depths, filled: distances().count(), farthest: distances().fold(0.0, f64::max), fit })
    }

    /// Returns the depth at each node of a mesh, as [`NodeDepths::depths`].
    ///
    /// # Errors
    /// Fails when nodes are far from every pixel with a value.
    pub fn depths_at_nodes(&self, mesh: MeshView) -> Result<Vec<f64>, NoDepth> {
        let found = self.found_at(mesh, &places(mesh))?;
        Ok(found.iter().map(|found| found.depth).collect())
    }

    /// Returns the depth at a point in world units, in metres, positive downwards: where no layer has a
    /// value, that of the nearest pixel; `None` far from every pixel with a value.
    pub fn depth_near(&self, at: DVec2) -> Option<f64> {
        self.around(at, 0.0).map(|found| found.depth)
    }

    fn found_at(&self, mesh: MeshView, nodes: &[DVec2]) -> Result<Vec<FoundDepth>, NoDepth> {
        let sides = mean_sides(mesh, nodes);
        let found: Vec<Option<FoundDepth>> = nodes
            .par_iter()
            .zip(&sides)
            .with_min_len(GRAIN)
            .map(|(&node, &side)| self.around(node, side))
            .collect();
        let lost = || found.iter().zip(nodes).filter(|(found, _)| found.is_none());
        if let Some((_, &at)) = lost().next() {
            return Err(NoDepth { nodes: lost().count(), at });
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// Returns the depth for a node whose triangles have sides of about `side`, in world units; `None` far
    /// from every pixel with a value.
    fn around(&self, node: DVec2, side: f64) -> Option<FoundDepth> {
        let covering = |(layer, _): &&(&Layer, &Depths)| covers(layer, node);
        if let Some(depth) = self.0.iter().filter(covering).find_map(|(_, depths)| around(depths, node, side))
        {
            return Some(FoundDepth { depth, distance: None });
        }
        let nearest = self.0.iter().filter_map(|(_, depths)| nearest(depths, node));
        let nearest = nearest.min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map(|(depth, distance)| FoundDepth { depth, distance: Some(distance) })
    }

    /// Compares the mesh with the pixels: each counts where its layer is the first with a value.
    fn fit(&self, mesh: MeshView, nodes: &[DVec2], depths: &[f64]) -> DepthFit {
        let sums = mesh.triangles().par_iter().with_min_len(GRAIN).map(|triangle| {
            let corners = triangle.vertices.map(|node| nodes[node.index()]);
            let values = triangle.vertices.map(|node| depths[node.index()]);
            self.compare(corners, values)
        });
        // In the order of the triangles, so that the sum is the same for any number of threads.
        let sums: Vec<DepthSums> = sums.collect();
        sums.iter().fold(DepthSums::default(), DepthSums::joined).fit()
    }

    /// Compares a triangle with the pixels whose centres are in it.
    fn compare(&self, corners: [DVec2; 3], values: [f64; 3]) -> DepthSums {
        let mut sums = DepthSums::default();
        let bounds = Rect::holding(corners);
        let Some(bounds) = bounds else { return sums };
        for (place, (layer, depths)) in self.0.iter().enumerate() {
            let raster = depths.source().raster.raster();
            let area = raster.pixel_size().element_product();
            for (x, y) in raster.pixels_touching(&bounds).pixels() {
                let (value, at) = (raster.get(x, y), raster.pixel_center(x, y));
                let Some(weights) = weights(corners, at) else { continue };
                let is_hidden = || {
                    let above = self.0[..place].iter().filter(|(layer, _)| covers(layer, at));
                    above.map(|(_, depths)| depths).any(|depths| has_value(depths, at))
                };
                if value.is_nan() || !covers(layer, at) || is_hidden() {
                    continue;
                }
                let mesh: f64 = (0..3).map(|n| weights[n] * values[n]).sum();
                sums.add(mesh - depths.sizes().depth_of(f64::from(value)), area, at);
            }
        }
        sums
    }
}

/// Returns the places of the nodes, in world units.
pub(super) fn places(mesh: MeshView) -> Vec<DVec2> {
    mesh.nodes().par_iter().map(|&node| mesh.lattice().world_from_lattice(node)).collect()
}

/// Returns the weights of the corners at a point in a triangle. A point on an edge that runs up, or to the
/// left, belongs to the triangle on its left, so that no point counts twice.
fn weights([a, b, c]: [DVec2; 3], at: DVec2) -> Option<[f64; 3]> {
    let whole = (b - a).perp_dot(c - a);
    let parts = [(b, c), (c, a), (a, b)].map(|(from, to)| {
        let along = if whole > 0.0 { to - from } else { from - to };
        let part = (to - from).perp_dot(at - from) / whole;
        let is_own = along.y > 0.0 || (along.y == 0.0 && along.x < 0.0);
        (part > 0.0 || (part == 0.0 && is_own)).then_some(part)
    });
    match parts {
        [Some(u), Some(v), Some(w)] => Some([u, v, w]),
        _ => None,
    }
}

/// Returns the mean length of the sides of the triangles around each node, in world units.
fn mean_sides(mesh: MeshView, nodes: &[DVec2]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0u32); nodes.len()];
    for triangle in mesh.triangles() {
        for n in 0..3 {
            let [from, to] = [triangle.vertices[n], triangle.vertices[(n + 1) % 3]].map(|node| node.index());
            let length = nodes[from].distance(nodes[to]);
            for node in [from, to] {
                sums[node] = (sums[node].0 + length, sums[node].1 + 1);
            }
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::from(count.max(1))).collect()
}

/// Returns the depth around a point where the pixel there has a value: linear between the centres of pixels,
/// or the mean of those in a square of this side, if it has several in each direction.
fn around(depths: &Depths, at: DVec2, side: f64) -> Option<f64> {
    let raster = depths.source().raster.raster();
    if side < PIXELS_TO_AVERAGE * raster.pixel_size().max_element() {
        return raster.linear_at(at).map(|value| depths.sizes().depth_of(value));
    }
    if !has_value(depths, at) {
        return None;
    }
    let half = DVec2::splat(0.5 * side);
    let square = Rect::new(at - half, at + half);
    let (sum, count) = pixels_within(raster, &square)
        .pixels()
        .map(|(x, y)| raster.get(x, y))
        .filter(|value| !value.is_nan())
        .fold((0.0, 0.0), |(sum, count), value| (sum + f64::from(value), count + 1.0));
    Some(depths.sizes().depth_of(sum / count))
}

/// Returns the pixels whose centres are in a rectangle.
fn pixels_within(raster: &Raster, area: &Rect) -> PixelRect {
    let size = raster.size();
    let bound = |at: f64, axis: usize| (at - 0.5).ceil().clamp(0.0, f64::from(size[axis])) as u32;
    let [low, high] = [area.min, area.max].map(|at| raster.pixel_from_world(at));
    PixelRect { min: [bound(low.x, 0), bound(low.y, 1)], max: [bound(high.x, 0), bound(high.y, 1)] }
}

/// Returns the depth of the nearest pixel with a value, and the distance of its centre.
fn nearest(depths: &Depths, at: DVec2) -> Option<(f64, f64)> {
    let nearest = depths.source().raster.raster().nearest(at, FARTHEST_PIXEL)?;
    Some((depths.sizes().depth_of(nearest.value), nearest.distance))
}

/// Sums over pixels, by area.
#[derive(Clone, Copy, Debug, Default)]
struct DepthSums {
    pixels: usize,
    largest: f64,
    at: DVec2,
    area: f64,
    differences: f64,
    squares: f64,
}

impl DepthSums {
    fn add(&mut self, difference: f64, area: f64, at: DVec2) {
        self.pixels += 1;
        self.area += area;
        self.differences += area * difference;
        self.squares += area * difference * difference;
        if difference.abs() > self.largest {
            (self.largest, self.at) = (difference.abs(), at);
        }
    }

    fn joined(self, other: &Self) -> Self {
        let is_larger = other.largest > self.largest;
        let (largest, at) = if is_larger { (other.largest, other.at) } else { (self.largest, self.at) };
        Self {
            pixels: self.pixels + other.pixels,
            largest,
            at,
            area: self.area + other.area,
            differences: self.differences + other.differences,
            squares: self.squares + other.squares,
        }
    }

    fn fit(self) -> DepthFit {
        let Self { pixels, largest, at, area, differences, squares } = self;
        let mean = |sum: f64| if pixels == 0 { 0.0 } else { sum / area };
        DepthFit { pixels, largest, at, rms: mean(squares).sqrt(), mean: mean(differences) }
    }
}
