//! Values at places within cells.

use glam::DVec2;

use super::{CellNodes, MeshCell};

/// Returns the value at a place in a cell that is `value` at its nodes and linear on each triangle.
pub(super) fn interpolate(
    mesh: CellNodes<'_>,
    cell: &MeshCell,
    place: DVec2,
    value: impl Fn(usize) -> f64,
) -> f64 {
    let weighed = |triangle: usize| {
        let corners = mesh.triangles[triangle];
        let [p, q, r] = corners.map(|node| mesh.nodes[node]);
        let doubled_area = (q - p).perp_dot(r - p);
        let of_q = (place - p).perp_dot(r - p) / doubled_area;
        let of_r = (q - p).perp_dot(place - p) / doubled_area;
        (corners, [of_q, of_r])
    };
    // How far inside a triangle the place is: the least of its three weights.
    let least = |[of_q, of_r]: [f64; 2]| of_q.min(of_r).min(1.0 - of_q - of_r);
    let [first, second] = cell.triangles.map(weighed);
    let ([p, q, r], [of_q, of_r]) = if least(second.1) > least(first.1) { second } else { first };
    // From one node on, so that equal values stay as they are.
    let start = value(p);
    start + of_q * (value(q) - start) + of_r * (value(r) - start)
}
