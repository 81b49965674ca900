//! What two meshes have in common.

use rayon::prelude::*;

use super::path_mesh::{NONE, PathMesh, PathTriangle, order_on_curve};

/// Number of triangles that a thread looks at at a time.
const TOGETHER: usize = 4096;

/// The nodes and triangles that a new mesh shares with an old one: those with the same coordinates.
///
/// Shared nodes are in the same order in both.
pub(super) struct SharedParts {
    /// For each node of the new mesh, the number of the same one in the old mesh; [`NONE`] without one.
    pub nodes: Vec<u32>,
    /// For each triangle of the new mesh, the number of that with the same corners, in the same order, in the
    /// old mesh; [`NONE`] where there is none, or one of both is closed.
    pub triangles: Vec<u32>,
    /// The reverse: for each node and each triangle of the old mesh, its number in the new one.
    pub new_nodes: Vec<u32>,
    pub new_triangles: Vec<u32>,
}

impl SharedParts {
    /// Compares two meshes. Those around whose nodes another rectangle lies share nothing.
    pub fn between(old: &PathMesh, new: &PathMesh) -> Self {
        let nodes = shared_nodes(old, new);
        let parts = new.triangles.par_chunks(TOGETHER);
        let triangles: Vec<u32> = parts.flat_map_iter(|part| shared_triangles(old, part, &nodes)).collect();
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

/// Returns for each of some successive triangles of a new mesh the one of an old mesh with the same corners.
/// Both are sorted by their least nodes, so those of the old mesh are looked through once.
fn shared_triangles(old: &PathMesh, new: &[PathTriangle], nodes: &[u32]) -> Vec<u32> {
    // The first triangle of the old mesh that may be the next shared one.
    let mut at: Option<usize> = None;
    let mut of_triangle = |triangle: &PathTriangle| {
        let corners = triangle.corners.map(|node| nodes[node as usize]);
        if !triangle.is_passable() || corners.contains(&NONE) {
            return NONE;
        }
        let wanted = PathTriangle { corners, ..*triangle }.least_node();
        let is_before = |of_old: &PathTriangle| of_old.least_node() < wanted;
        let mut first = at.unwrap_or_else(|| old.triangles.partition_point(is_before));
        while old.triangles.get(first).is_some_and(is_before) {
            first += 1;
        }
        at = Some(first);
        let fan = old.triangles[first..].iter().take_while(|of_old| of_old.least_node() == wanted);
        let is_same = |(_, of_old): &(u32, &PathTriangle)| of_old.corners == corners && of_old.is_passable();
        (first as u32..).zip(fan).find(is_same).map_or(NONE, |(t, _)| t)
    };
    new.iter().map(&mut of_triangle).collect()
}

fn reverse(of_new: &[u32], count: usize) -> Vec<u32> {
    let mut of_old = vec![NONE; count];
    for (new, &old) in (0..).zip(of_new).filter(|&(_, &old)| old != NONE) {
        of_old[old as usize] = new;
    }
    of_old
}
