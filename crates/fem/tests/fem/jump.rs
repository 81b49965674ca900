//! A coefficient that jumps across a line: order 2 in L² with the line in the mesh, and less without it.

use glam::{DVec2, dvec2};
use meshbrush_core::domain::{Domain, Line, LineKind};
use meshbrush_fem::fem::FemProblem;
use meshbrush_mesh::geometry::Rect;

use crate::runs::prints_table;
use crate::solved::{Solved, dirichlet, formula, solve_with_lines};

/// u is sin 4s on the one side of the line s = 0 and a hundredth of that on the other, where a is 100: value
/// and flux are the same on both sides.
fn exact(p: DVec2) -> f64 {
    let s = across(p);
    (4.0 * s).sin() / if s > 0.0 { 100.0 } else { 1.0 }
}

/// The distance from the line, which runs along no edge of the coarse grid.
fn across(p: DVec2) -> f64 {
    0.8 * p.x - 0.6 * p.y - 0.17
}

fn solved(size: f64, lines: &[Line]) -> Solved {
    let (s, jump) = ("(0.8*x-0.6*y-0.17)", "if(0.8*x-0.6*y-0.17>0, 100, 1)");
    let problem = FemProblem {
        diffusion: formula(jump),
        source: formula(&format!("16*sin(4*{s})")),
        conditions: vec![dirichlet("all", &format!("sin(4*{s})/{jump}"))],
        ..FemProblem::default()
    };
    solve_with_lines(&Domain::rectangle(Rect::UNIT), lines, size, &problem)
}

#[expect(clippy::print_stdout, reason = "a table of figures where it is asked for")]
fn order(lines: &[Line]) -> f64 {
    let errors = [0.08, 0.04, 0.02, 0.01].map(|size| solved(size, lines).errors(exact)[0]);
    if prints_table() {
        println!("{} lines: {errors:?}", lines.len());
    }
    (errors[0] / errors[3]).log2() / 3.0
}

#[test]
fn the_order_is_two_with_the_line_in_the_mesh() {
    let ends = [dvec2(0.2125, 0.0), dvec2(0.9625, 1.0)];
    let line = Line { name: "jump".into(), points: ends.to_vec(), closed: false, kind: LineKind::default() };
    let (with, without) = (order(&[line]), order(&[]));
    assert!(with > 1.85, "{with}");
    assert!(without < 1.5, "{without}");
}
