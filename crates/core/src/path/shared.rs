//! What two meshes have in common.

use rayon::prelude::*;

use super::path_mesh::{NONE, PathMesh, PathTriangle, order_on_curve};

/// A thread looks at so many triangles at a time.
const TOGETHER: usize = 4096;

/// The nodes and triangles of a new mesh that an old one has, too: those whose coordinates are the same.
///
/// Shared nodes are in the same order in both.
pub(super) struct Shared {
    /// For each node of the new mesh, the number of the same one in the old mesh; [`NONE`] without one.
    pub nodes: Vec<u32>,
    /// For each triangle of the new mesh, the number of that with the same corners, in the same order, in the
    /// old mesh; [`NONE`] where there is none, or one of both is closed.
    pub triangles: Vec<u32>,
    /// The reverse: for each node and each triangle of the old mesh, its number in the new one.
    pub new_nodes: Vec<u32>,
    pub new_triangles: Vec<u32>,
}

impl Shared {
    /// Compares two meshes. Those around whose nodes another rectangle lies share nothing.
    pub fn of(old: &PathMesh, new: &PathMesh) -> Self {
        let nodes = shared_nodes(old, new);
        let of_triangle = |triangle: &PathTriangle| {
            let corners = triangle.corners.map(|node| nodes[node as usize]);
            if !triangle.is_passable() || corners.contains(&NONE) {
                return NONE;
            }
            let is_same = |&&t: &&u32| old.triangles[t as usize].corners == corners;
            old.around(corners[0]).iter().find(is_same).copied().unwrap_or(NONE)
        };
        let triangles: Vec<u32> = new.triangles.par_iter().with_min_len(TOGETHER).map(of_triangle).collect();
        let (new_nodes, new_triangles) =
            (reverse(&nodes, old.node_count()), reverse(&triangles, old.triangle_count()));
        Self { nodes, triangles, new_nodes, new_triangles }
    }
}

/// Returns for each node of a new mesh the one of an old mesh at the same place. Both are sorted.
fn shared_nodes(old: &PathMesh, new: &PathMesh) -> Vec<u32> {
    let mut shared = vec![NONE; new.node_count()];
    let Some(extent) = new.extent().filter(|_| old.extent() == new.extent()) else { return shared };
    let key = |mesh: &PathMesh, node: usize| mesh.nodes.get(node).map(|&at| order_on_curve(at, &extent));
    let (mut n, mut o) = (0, 0);
    while let (Some(of_new), Some(of_old)) = (key(new, n), key(old, o)) {
        if of_new == of_old {
            shared[n] = o as u32;
        }
        (n, o) = (n + usize::from(of_new <= of_old), o + usize::from(of_old <= of_new));
    }
    shared
}

fn reverse(of_new: &[u32], count: usize) -> Vec<u32> {
    let mut of_old = vec![NONE; count];
    for (new, &old) in (0..).zip(of_new).filter(|&(_, &old)| old != NONE) {
        of_old[old as usize] = new;
    }
    of_old
}
