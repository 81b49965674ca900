//! How far a mesh is from a surface.

use glam::DVec2;
use rayon::prelude::*;

use super::samples::SurfaceSamples;
use crate::layers::SurfaceNorm;
use crate::mesh::MeshView;

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
struct Sums {
    samples: usize,
    /// Integrals of the squares of differences, and of those of gradients.
    squares: [f64; 2],
    largest: f64,
    at: DVec2,
}

impl Sums {
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
}

fn places(mesh: MeshView) -> Vec<DVec2> {
    mesh.nodes().par_iter().map(|&node| mesh.lattice().world_from_lattice(node)).collect()
}

impl SurfaceSamples {
    /// Returns the height at each node of a mesh, as [`SurfaceFit::heights`].
    pub fn heights_at_nodes(&self, mesh: MeshView) -> Vec<Option<f64>> {
        self.heights(&places(mesh))
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
            let mut sums = Sums::default();
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
        let sums: Vec<Sums> = sums.collect();
        let Sums { samples, squares, largest, at } = sums.iter().fold(Sums::default(), Sums::joined);
        let [rms, gradient] = [0, 1].map(|n| self.root_of_mean(squares[n], SUMMED[n]));
        SurfaceFit { heights, largest, at, rms, gradient, samples }
    }
}
