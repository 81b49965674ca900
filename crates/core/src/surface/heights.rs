//! The height of the ground, for views in space.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::{SurfaceRule, SurfaceSamples};
use crate::geometry::{Lattice, LatticePoint};
use crate::layers::{DepthSurface, Layer};

/// Nodes that a thread takes at a time.
const GRAIN: usize = 256;

/// Where a document has heights. Clones share the pixels.
#[derive(Clone, Debug)]
pub enum HeightSource {
    /// The surface of its layers.
    Surface(Arc<SurfaceSamples>),
    /// Its layers of depths, from the bottom to the top. Heights are depths with the other sign, in metres.
    Depths(Vec<Layer>),
}

impl HeightSource {
    /// Returns the surface that a mesh was made for, or else the depths of a stack of layers; `None` where
    /// there is neither.
    pub fn new(rule: Option<&SurfaceRule>, layers: &[Layer]) -> Option<Self> {
        let depths = || DepthSurface::of(layers).map(|_| Self::Depths(layers.to_vec()));
        rule.map(|rule| Self::Surface(rule.samples().clone())).or_else(depths)
    }

    /// Returns whether heights are depths with the other sign.
    pub fn is_of_depths(&self) -> bool {
        matches!(self, Self::Depths(_))
    }

    /// Returns the height at each of these nodes; `None` far from every sample.
    pub fn at_nodes(&self, lattice: &Lattice, nodes: &[LatticePoint]) -> Vec<Option<f64>> {
        let each = |height: &(dyn Fn(DVec2) -> Option<f64> + Sync)| {
            let nodes = nodes.par_iter().with_min_len(GRAIN);
            nodes.map(|&node| height(lattice.world_from_lattice(node))).collect()
        };
        match self {
            Self::Surface(samples) => each(&|at| samples.height_at(at)),
            Self::Depths(layers) => match DepthSurface::of(layers) {
                Some(surface) => each(&|at| surface.depth_near(at).map(|depth| -depth)),
                None => vec![None; nodes.len()],
            },
        }
    }
}
