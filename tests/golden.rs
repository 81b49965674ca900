//! The report's own numbers (Section 5.4).

use glam::DVec2;
use meshbrush::geometry::Rect;
use meshbrush::mesh::{Limits, Mesh, bisection_edge_length};

/// The mesh of Figure 1 on [−10, 10]², where every coordinate is exact, with the report's vertex rule (Eq. 12).
fn diamond(target: f64) -> Mesh {
    let bounds = Rect::around(DVec2::ZERO, 10.0);
    let mut mesh = Mesh::coarse_grid(bounds, 1.0, |_| true, &Limits::default()).unwrap();
    mesh.refine(&Limits::default(), |element| {
        let inside = element.world_corners().iter().any(|x| x.x.abs() + x.y.abs() < 8.0);
        Ok(element.diameter() > if inside { target } else { 20.0 })
    })
    .unwrap();
    mesh
}

const TRIANGLES: [usize; 13] =
    [1088, 1600, 2888, 4936, 9560, 17752, 35176, 67944, 135544, 266616, 532872, 1057160, 2113944];

#[test]
fn the_series_of_section_5_4_comes_out_at_every_level() {
    for (level, triangles) in (1..).zip(TRIANGLES) {
        // A hair above the diameter of the level: at even levels it is irrational.
        let mesh = diamond(bisection_edge_length(1.0, level) * (1.0 + 1e-12));
        assert_eq!(mesh.triangles().len(), triangles, "level {level}");
        assert_eq!(mesh.level_counts().len() as u32, level + 1);
        if triangles < 20_000 {
            assert_eq!(mesh.violations(), []);
        }
    }
}
