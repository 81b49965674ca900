//! The mesh of Figure 1 of the report (Section 5.4) on [−10, 10]², which the benches of the core build.

use glam::DVec2;
use meshbrush::internals::geometry::{Lattice, LatticePoint, Rect};
use meshbrush::internals::mesh::{Element, InvalidTarget, Limits, Mesh, bisection_edge_length};

/// The coarse grid of 20 × 20 cells.
pub fn coarse() -> Mesh {
    let bounds = Rect::around(DVec2::ZERO, 10.0);
    let lattice = Lattice::covering(bounds, 1.0, 1_000_000).expect("a square has a grid");
    Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).expect("within the default limits")
}

/// The report's rule (Eqs. 12 and 13): `level` everywhere in the diamond ‖x‖₁ < 8, seen at the vertices.
///
/// The diamond is tested in lattice coordinates, which is exact and takes a few integer operations: the
/// benches measure the mesh, not a formula.
pub fn rule(mesh: &Mesh, level: u32) -> impl Fn(&Element) -> Result<bool, InvalidTarget> + use<> {
    let target = bisection_edge_length(1.0, level) * (1.0 + 1e-12);
    let steps = mesh.lattice().cell_steps();
    let inside = move |p: LatticePoint| p.x.abs_diff(10 * steps) + p.y.abs_diff(10 * steps) < 8 * steps;
    move |element| {
        let target = if element.corners.into_iter().any(inside) { target } else { 20.0 };
        Ok(element.diameter() > target)
    }
}

/// The same rule by corners and level, for refinement in blocks.
pub fn rule_at(mesh: &Mesh, finest: u32) -> impl Fn([LatticePoint; 3], u32) -> bool + use<> {
    let steps = mesh.lattice().cell_steps();
    let inside = move |p: LatticePoint| p.x.abs_diff(10 * steps) + p.y.abs_diff(10 * steps) < 8 * steps;
    move |corners, level| level < finest && corners.into_iter().any(inside)
}

/// The diamond refined to `level`.
pub fn mesh(level: u32) -> Mesh {
    let mut mesh = coarse();
    let rule = rule(&mesh, level);
    mesh.refine(&Limits::default(), rule).expect("within the default limits");
    mesh
}
