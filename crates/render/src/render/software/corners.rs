//! The nodes of a mesh as corners of triangles on the screen.

use std::ops::Range;

use rayon::prelude::*;

use super::rasterizer::snapped;
use crate::scene::Camera;
use meshbrush_mesh::geometry::LatticePoint;

/// Nodes that a thread maps at a time.
const NODES_PER_TASK: usize = 8192;

/// The position of each node on the screen of one camera, on the grid of corners. Each node is mapped once
/// for its six triangles on average, since a mesh has twice as many triangles as nodes.
#[derive(Debug, Default)]
pub(super) struct Corners {
    corners: Vec<[i32; 2]>,
}

impl Corners {
    pub(super) fn new(nodes: &[LatticePoint], camera: &Camera) -> Self {
        let mut corners = Self::default();
        corners.map(nodes, camera);
        corners
    }

    /// Maps all nodes again.
    pub(super) fn map(&mut self, nodes: &[LatticePoint], camera: &Camera) {
        let screen = camera.lattice_map();
        let mapped = nodes.par_iter().with_min_len(NODES_PER_TASK).map(|&p| snapped(screen(p)));
        mapped.collect_into_vec(&mut self.corners);
    }

    /// Maps the nodes of the changed ranges again, and adapts to the length of the array.
    pub(super) fn follow(&mut self, nodes: &[LatticePoint], changed: &[Range<usize>], camera: &Camera) {
        let screen = camera.lattice_map();
        self.corners.resize(nodes.len(), [0; 2]);
        for range in changed {
            let range = range.start.min(nodes.len())..range.end.min(nodes.len());
            for (corner, &node) in self.corners[range.clone()].iter_mut().zip(&nodes[range]) {
                *corner = snapped(screen(node));
            }
        }
    }

    #[inline]
    pub(super) fn of_node(&self, index: usize) -> [i32; 2] {
        self.corners[index]
    }
}
