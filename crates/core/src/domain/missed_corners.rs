//! Sharp corners of an outline at which a mesh has no node.

use std::collections::HashSet;

use glam::DVec2;

use super::{Region, Ring};
use crate::geometry::LatticePoint;
use crate::mesh::Extract;

/// The cosine of 30°, the smallest turn of a sharp corner.
pub(crate) const COS_30: f64 = 0.866_025_403_784_438_6;

impl Region {
    /// Returns the corners at which the outline turns by more than 30° and a mesh has no node, in the order
    /// of the rings, in world units. Nodes are on the lattice: of a corner, the nearest lattice point counts.
    pub fn missed_corners(&self, mesh: &Extract) -> Vec<DVec2> {
        let nodes: HashSet<LatticePoint> = mesh.nodes().iter().copied().collect();
        let is_missed = |at: &DVec2| !nodes.contains(&mesh.lattice().nearest(*at));
        self.rings().flat_map(sharp_corners).filter(is_missed).collect()
    }
}

fn sharp_corners(ring: &Ring) -> impl Iterator<Item = DVec2> + '_ {
    let count = ring.len();
    (0..count).filter_map(move |n| {
        let [before, at, after] = [ring[(n + count - 1) % count], ring[n], ring[(n + 1) % count]];
        let [along, onward] = [at - before, after - at];
        (along.dot(onward) < COS_30 * along.length() * onward.length()).then_some(at)
    })
}
