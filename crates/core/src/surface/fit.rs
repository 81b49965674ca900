//! How far a mesh is from a surface.

use glam::DVec2;
use rayon::prelude::*;

use super::samples::SurfaceSamples;
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
    /// The square root of the mean of the squares of the differences.
    pub rms: f64,
    /// The number of samples. One on an edge or at a corner counts for each triangle that has it.
    pub samples: usize,
}

/// Sums over samples.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    samples: usize,
    squares: f64,
    largest: f64,
    at: DVec2,
}

impl Sums {
    fn add(&mut self, at: DVec2, difference: f64) {
        self.samples += 1;
        self.squares += difference * difference;
        if difference.abs() > self.largest {
            (self.largest, self.at) = (difference.abs(), at);
        }
    }

    fn joined(self, other: &Self) -> Self {
        let is_larger = other.largest > self.largest;
        let (largest, at) = if is_larger { (other.largest, other.at) } else { (self.largest, self.at) };
        Self { samples: self.samples + other.samples, squares: self.squares + other.squares, largest, at }
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
                }
            }
            sums
        });
        // In the order of the triangles, so that the sum is the same for any number of threads.
        let sums: Vec<Sums> = sums.collect();
        let Sums { samples, squares, largest, at } = sums.iter().fold(Sums::default(), Sums::joined);
        let rms = if samples == 0 { 0.0 } else { libm::sqrt(squares / samples as f64) };
        SurfaceFit { heights, largest, at, rms, samples }
    }
}
