//! How far a mesh is from a surface.

use std::collections::BTreeMap;

use glam::DVec2;
use rayon::prelude::*;

use super::samples::SurfaceSamples;
use crate::layers::SurfaceNorm;
use crate::mesh::{MeshView, Triangle};

/// Triangles that a thread takes at a time.
const GRAIN: usize = 256;

/// How far a surface that is linear over the triangles of a mesh is from the samples in them.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceFit {
    /// The height at each node, in the order of the nodes; `None` far from every sample.
    pub heights: Vec<Option<f64>>,
    /// The largest difference from a sample, of either sign.
    pub largest: f64,
    /// The place of the largest difference, in world units.
    pub at: DVec2,
    /// The error of the norm [`SurfaceNorm::RootMeanSquare`].
    pub rms: f64,
    /// The error of the norm [`SurfaceNorm::Gradient`].
    pub gradient: f64,
    /// The number of samples. One on an edge or at a corner counts for each triangle that has it.
    pub samples: usize,
}

/// The norms whose squares are summed.
const SUMMED: [SurfaceNorm; 2] = [SurfaceNorm::RootMeanSquare, SurfaceNorm::Gradient];

/// Sums over samples.
#[derive(Clone, Copy, Debug, Default)]
struct FitSums {
    samples: usize,
    /// Integrals of the squares of differences, and of those of gradients.
    squares: [f64; 2],
    largest: f64,
    at: DVec2,
}

impl FitSums {
    fn add(&mut self, at: DVec2, difference: f64) {
        self.samples += 1;
        if difference.abs() > self.largest {
            (self.largest, self.at) = (difference.abs(), at);
        }
    }

    fn joined(self, other: &Self) -> Self {
        let is_larger = other.largest > self.largest;
        let (largest, at) = if is_larger { (other.largest, other.at) } else { (self.largest, self.at) };
        let squares = [0, 1].map(|n| self.squares[n] + other.squares[n]);
        Self { samples: self.samples + other.samples, squares, largest, at }
    }
}

impl SurfaceFit {
    /// Returns the error by a norm.
    pub fn error(&self, norm: SurfaceNorm) -> f64 {
        match norm {
            SurfaceNorm::Largest => self.largest,
            SurfaceNorm::RootMeanSquare => self.rms,
            SurfaceNorm::Gradient => self.gradient,
        }
    }

    /// Returns a height for each node of the mesh, as [`SurfaceSamples::filled_heights`].
    pub fn filled_heights(&self, mesh: MeshView) -> Vec<f64> {
        filled(&self.heights, mesh)
    }
}

/// Returns the heights of nodes: where there is none, the mean of the nodes around it that have one, from
/// node to node; 0 without any.
fn filled(heights: &[Option<f64>], mesh: MeshView) -> Vec<f64> {
    let mut known = heights.to_vec();
    let lacks = |known: &[Option<f64>], triangle: &Triangle| {
        triangle.vertices.iter().any(|node| known[node.index()].is_none())
    };
    let inside = mesh.triangles().iter().filter(|triangle| !triangle.is_outside());
    let mut open: Vec<&Triangle> = inside.filter(|triangle| lacks(&known, triangle)).collect();
    while !open.is_empty() {
        let mut sums: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
        for triangle in &open {
            let corners = triangle.vertices.map(|node| node.index());
            let around = corners.iter().filter_map(|&node| known[node]);
            let (sum, count) = around.fold((0.0, 0.0), |(sum, count), height| (sum + height, count + 1.0));
            for node in corners.into_iter().filter(|&node| count > 0.0 && known[node].is_none()) {
                let of_node = sums.entry(node).or_default();
                *of_node = (of_node.0 + sum, of_node.1 + count);
            }
        }
        if sums.is_empty() {
            break;
        }
        sums.into_iter().for_each(|(node, (sum, count))| known[node] = Some(sum / count));
        open.retain(|triangle| lacks(&known, triangle));
    }
    known.into_iter().map(|height| height.unwrap_or(0.0)).collect()
}

fn places(mesh: MeshView) -> Vec<DVec2> {
    mesh.nodes().par_iter().map(|&node| mesh.lattice().world_from_lattice(node)).collect()
}

impl SurfaceSamples {
    /// Returns the height at each node of a mesh, as [`SurfaceFit::heights`].
    pub fn heights_at_nodes(&self, mesh: MeshView) -> Vec<Option<f64>> {
        self.heights(&places(mesh))
    }

    /// Returns a height for each node of a mesh: where the surface has none, the mean of the nodes around it
    /// that have one, from node to node; 0 without any.
    pub fn filled_heights(&self, mesh: MeshView) -> Vec<f64> {
        filled(&self.heights_at_nodes(mesh), mesh)
    }

    fn heights(&self, places: &[DVec2]) -> Vec<Option<f64>> {
        places.par_iter().with_min_len(GRAIN).map(|&place| self.height_at(place)).collect()
    }

    /// Compares the triangles of a mesh with the samples in them. Triangles without a height at a corner are
    /// left out, and so are those outside the domain.
    pub fn fit(&self, mesh: MeshView) -> SurfaceFit {
        let places = places(mesh);
        let heights = self.heights(&places);
        let sums = mesh.triangles().par_iter().with_min_len(GRAIN).map(|triangle| {
            let mut sums = FitSums::default();
            let corners = triangle.vertices.map(|node| places[node.index()]);
            if let ([Some(a), Some(b), Some(c)], false) =
                (triangle.vertices.map(|node| heights[node.index()]), triangle.is_outside())
            {
                for layer in &self.layers {
                    layer.each(corners, [a, b, c], |at, difference| sums.add(at, difference));
                    for (sum, norm) in sums.squares.iter_mut().zip(SUMMED) {
                        *sum += layer.squares(corners, [a, b, c], norm);
                    }
                }
            }
            sums
        });
        // In the order of the triangles, so that the sum is the same for any number of threads.
        let sums: Vec<FitSums> = sums.collect();
        let FitSums { samples, squares, largest, at } = sums.iter().fold(FitSums::default(), FitSums::joined);
        let [rms, gradient] = [0, 1].map(|n| self.root_of_mean(squares[n], SUMMED[n]));
        SurfaceFit { heights, largest, at, rms, gradient, samples }
    }
}
