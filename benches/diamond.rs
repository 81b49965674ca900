//! The mesh of Figure 1 of the report (Section 5.4) on [−10, 10]², which the benches of the core build.

use std::convert::Infallible;

use glam::DVec2;
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{
    Element, InvalidTarget, LevelsWithin, Limits, Mesh, RuleAnswers, SharedRule, bisection_edge_length,
};

/// Returns the coarse grid of 20 × 20 cells.
pub fn coarse() -> Mesh {
    let bounds = Rect::around(DVec2::ZERO, 10.0);
    let lattice = Lattice::covering(bounds, 1.0, 1_000_000).expect("a square has a grid");
    Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).expect("within the default limits")
}

/// Returns the report's rule (Eqs. 12 and 13): `level` everywhere in the diamond ‖x‖₁ < 8, seen at the
/// vertices.
///
/// The diamond is tested in lattice coordinates, which is exact and takes a few integer operations: the
/// benches measure the mesh, not a formula.
pub fn rule(mesh: &Mesh, level: u32) -> impl Fn(&Element) -> Result<bool, InvalidTarget> + use<> {
    let target = bisection_edge_length(1.0, level) * (1.0 + 1e-12);
    let is_inside = is_inside(mesh);
    move |element| {
        let target = if element.corners.into_iter().any(is_inside) { target } else { 20.0 };
        Ok(element.diameter() > target)
    }
}

/// Returns the rule of the diamond by corners and level, for refinement in blocks.
pub fn rule_at(mesh: &Mesh, finest: u32) -> impl Fn([LatticePoint; 3], u32) -> bool + use<> {
    let is_inside = is_inside(mesh);
    move |corners, level| level < finest && corners.into_iter().any(&is_inside)
}

/// Returns the rule of the diamond, which also knows that a triangle with three vertices in it lies in it.
pub fn rule_within(mesh: &Mesh, finest: u32) -> impl SharedRule<Error = Infallible> + use<> {
    let is_inside = is_inside(mesh);
    move || Diamond { is_inside, finest }
}

struct Diamond<F> {
    is_inside: F,
    finest: u32,
}

impl<F: Fn(LatticePoint) -> bool> RuleAnswers for Diamond<F> {
    type Error = Infallible;

    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> Result<LevelsWithin, Infallible> {
        Ok(match corners.map(&self.is_inside) {
            [true, true, true] => LevelsWithin { exceed_below: self.finest, satisfied_from: self.finest },
            inside => LevelsWithin::single(level, level < self.finest && inside.contains(&true)),
        })
    }
}

/// Returns whether a lattice point lies in the diamond.
fn is_inside(mesh: &Mesh) -> impl Fn(LatticePoint) -> bool + Copy + Sync + use<> {
    let steps = mesh.lattice().cell_steps();
    move |p| p.x.abs_diff(10 * steps) + p.y.abs_diff(10 * steps) < 8 * steps
}

/// Returns the diamond refined to `level`.
pub fn mesh(level: u32) -> Mesh {
    let mut mesh = coarse();
    let rule = rule(&mesh, level);
    mesh.refine(&Limits::default(), rule).expect("within the default limits");
    mesh
}
