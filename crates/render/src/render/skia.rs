//! Outlines and colours in the terms of tiny-skia.

use meshbrush_study::drawing::OutlinePart;
use tiny_skia::{Paint, Path, PathBuilder};

/// Returns the path along an outline; `None` where it encloses nothing.
pub fn path_of(outline: &[OutlinePart]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for &part in outline {
        let px = |[x, y]: [f64; 2]| [x as f32, y as f32];
        match part {
            OutlinePart::Move(to) => {
                let [x, y] = px(to);
                path.move_to(x, y);
            }
            OutlinePart::Line(to) => {
                let [x, y] = px(to);
                path.line_to(x, y);
            }
            OutlinePart::Quadratic(points) => {
                let [[ax, ay], [x, y]] = points.map(px);
                path.quad_to(ax, ay, x, y);
            }
            OutlinePart::Cubic(points) => {
                let [[ax, ay], [bx, by], [x, y]] = points.map(px);
                path.cubic_to(ax, ay, bx, by, x, y);
            }
            OutlinePart::Close => path.close(),
        }
    }
    path.finish()
}

/// Returns the paint of a colour: red, green, blue and opacity.
pub fn paint([r, g, b, a]: [u8; 4]) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, a);
    paint
}
