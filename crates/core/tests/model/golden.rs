//! The report's own numbers (Section 5.4).

use crate::closure;
use crate::formula_mesh::formula_mesh;
use glam::DVec2;
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_mesh::geometry::{LatticePoint, Rect};
use meshbrush_mesh::mesh::{Mesh, bisection_edge_length, fingerprint_of};

/// Returns the mesh of Figure 1 on [−10, 10]², where every coordinate is exact, with the report's vertex rule
/// (Eq. 12).
fn diamond(target: f64) -> Mesh {
    let domain = Domain::rectangle(Rect::around(DVec2::ZERO, 10.0));
    let target = format!("if(abs(x) + abs(y) < 8, {target:?}, 20)");
    formula_mesh(&domain, 1.0, BoundaryTreatment::Report, &target).mesh
}

const TRIANGLES: [usize; 13] =
    [1088, 1600, 2888, 4936, 9560, 17752, 35176, 67944, 135544, 266616, 532872, 1057160, 2113944];

#[test]
fn the_series_of_section_5_4_comes_out_at_every_level() {
    for (level, triangles) in (1..).zip(TRIANGLES) {
        // A hair above the diameter of the level: at even levels it is irrational.
        let mesh = diamond(bisection_edge_length(1.0, level) * (1.0 + 1e-12));
        assert_eq!(mesh.raw_triangle_count(), triangles, "level {level}");
        assert_eq!(mesh.level_counts().len() as u32, level + 1);
        if triangles < 20_000 {
            assert_eq!(mesh.violations(), []);
        }
    }
}

/// Checks the series by the fixed-point closure, in whole numbers only: ‖x‖₁ < 8 about the middle of the
/// grid.
#[test]
fn the_fixed_point_closure_has_the_same_triangles() {
    for (level, triangles) in (1..).zip(TRIANGLES) {
        let mesh = diamond(bisection_edge_length(1.0, level) * (1.0 + 1e-12));
        let cell = i64::from(mesh.lattice().cell_steps());
        let inside = |&[x, y]: &closure::Point| (x - 10 * cell).abs() + (y - 10 * cell).abs() < 8 * cell;
        let exceeds = |triangle: &closure::Triangle| {
            // Outside the target is as long as the whole grid: nothing exceeds it.
            closure::level(cell, triangle) < level && triangle.iter().any(inside)
        };
        let found = closure::refine(closure::coarse(20, 20, cell, |_, _| true), exceeds);
        assert_eq!(found.len(), triangles, "level {level}");
        if triangles < 20_000 {
            let points = mesh.raw_triangles().iter().map(|t| t.vertices.map(|v| mesh.node(v)));
            let mine = points.map(|t| t.map(|p| [i64::from(p.x), i64::from(p.y)]));
            assert_eq!(closure::set_of(mine), closure::set_of(found.iter().copied()), "level {level}");
        }
        let corners = found.iter().map(|t| t.map(|[x, y]| LatticePoint::new(x as u32, y as u32)));
        assert_eq!(fingerprint_of(corners), mesh.fingerprint(), "level {level}");
    }
}
