//! Rules on nodes and the triangles at them.

use super::{BrokenPlace, WrittenMesh};
use meshbrush_mesh::text::{Number, digits};

/// The cells that may meet in an inner node, for SWAN.
const CELLS_AT_NODE: std::ops::RangeInclusive<usize> = 4..=10;

/// Finds triangles that do not run anticlockwise around an area.
pub(super) fn clockwise_triangles(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let is_clockwise = |&triangle: &usize| {
        let [a, b, c] = mesh.corners(triangle);
        (b - a).perp_dot(c - a) <= 0.0
    };
    let found = |triangle| {
        BrokenPlace::new(
            mesh.middle(triangle),
            format!("Triangle {} runs clockwise, or has no area.", triangle + 1),
        )
    };
    (0..mesh.triangles.len()).filter(is_clockwise).map(found).collect()
}

/// Finds nodes at the place of another one.
pub(super) fn repeated_nodes(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let place = |node: usize| mesh.nodes[node];
    let mut order: Vec<usize> = (0..mesh.nodes.len()).collect();
    order.sort_by(|&a, &b| {
        let (p, q) = (place(a), place(b));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(a.cmp(&b))
    });
    let same = order.windows(2).filter(|pair| place(pair[0]) == place(pair[1]));
    let found = |pair: &[usize]| {
        BrokenPlace::new(
            place(pair[1]),
            format!("The nodes {} and {} are at one place.", pair[0] + 1, pair[1] + 1),
        )
    };
    same.map(found).collect()
}

/// Finds nodes that no triangle has.
pub(super) fn lone_nodes(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let counts = mesh.triangles_at_nodes();
    let lone = (0..counts.len()).filter(|&node| counts[node] == 0);
    let found =
        |node| BrokenPlace::new(mesh.nodes[node], format!("Node {} belongs to no triangle.", node + 1));
    lone.map(found).collect()
}

/// Finds inner nodes with too few or too many triangles.
pub(super) fn cells_at_nodes(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let counts = mesh.triangles_at_nodes();
    let is_inner = |&node: &usize| counts[node] > 0 && !mesh.is_on_boundary(node);
    let broken = (0..counts.len()).filter(is_inner).filter(|&node| !CELLS_AT_NODE.contains(&counts[node]));
    let found = |node: usize| {
        BrokenPlace::new(
            mesh.nodes[node],
            format!(
                "{} triangles meet in node {}, and {} to {} may meet in an inner node.",
                counts[node],
                node + 1,
                CELLS_AT_NODE.start(),
                CELLS_AT_NODE.end()
            ),
        )
    };
    broken.map(found).collect()
}

/// Finds nodes with depth 0 or less, if there are depths.
pub(super) fn dry_nodes(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let depths = mesh.depths.as_deref().unwrap_or_default();
    let dry = depths.iter().enumerate().filter(|(_, depth)| **depth <= 0.0);
    let found = |(node, &depth): (usize, &f64)| {
        let depth = if depth == 0.0 { Number(0.0).to_string() } else { digits(depth, 4) };
        BrokenPlace::new(mesh.nodes[node], format!("The depth at node {} is {depth} m.", node + 1))
    };
    dry.map(found).collect()
}

/// Finds cells whose bottom, minus the depth at their centre, is not below the height of the surface there or
/// 0, if there are depths.
pub(super) fn cells_without_thickness(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let Some(depths) = &mesh.depths else { return Vec::new() };
    let (nodes, cells) = (mesh.cell_nodes(), mesh.cells());
    let centers = cells.centers(nodes);
    let top = |node: usize| mesh.heights.as_ref().map_or(0.0, |heights| heights[node]);
    let thickness = cells.at_centers(nodes, &centers, |node| top(node) + depths[node]);
    let broken = thickness.iter().zip(0..).filter(|(thickness, _)| **thickness <= 0.0);
    let found = |(thickness, cell): (&f64, usize)| {
        BrokenPlace::new(centers[cell], format!("Cell {} is {} thick.", cell + 1, digits(*thickness, 4)))
    };
    broken.map(found).collect()
}
