//! A sheet as shapes of a vector picture: texts are outlines, which need no font.

use std::fmt::Write as _;

use glam::DVec2;

use super::glyphs;
use super::sheet::{Sheet, SheetMark};
use meshbrush_io::io::svg::{ShapePaint, SvgShape};

/// Returns the shapes of a sheet, in pixels.
pub fn shapes_of(sheet: &Sheet) -> Vec<SvgShape> {
    sheet.marks.iter().map(shape_of).collect()
}

fn shape_of(mark: &SheetMark) -> SvgShape {
    match mark {
        SheetMark::Fill { corners: [from, to], color } => {
            let path = format!("M{} {}H{}V{}H{}Z", n(from.x), n(from.y), n(to.x), n(to.y), n(from.x));
            SvgShape { path, paint: ShapePaint::Fill(*color), title: None }
        }
        SheetMark::Line { points, width, color } => {
            let mut path = String::new();
            for (index, at) in points.iter().enumerate() {
                match index {
                    0 => path.push('M'),
                    last if last + 1 == points.len() && last > 1 && *at == points[0] => {
                        path.push('Z');
                        break;
                    }
                    _ => path.push('L'),
                }
                push(&mut path, *at);
            }
            SvgShape { path, paint: ShapePaint::Stroke(*color, *width), title: None }
        }
        SheetMark::Text { at, size, text, color } => {
            let mut path = String::new();
            for part in glyphs::outline(text, *at, *size) {
                let (letter, points) = part.letter_and_points();
                path.push(letter);
                for (number, at) in points.iter().enumerate() {
                    path.push_str(if number == 0 { "" } else { " " });
                    push(&mut path, (*at).into());
                }
            }
            SvgShape { path, paint: ShapePaint::Fill(*color), title: Some(text.clone()) }
        }
    }
}

fn push(path: &mut String, at: DVec2) {
    let _ = write!(path, "{} {}", n(at.x), n(at.y));
}

/// Returns a number with at most two decimals.
fn n(value: f64) -> f64 {
    // A negative zero would have a sign.
    (100.0 * value).round() / 100.0 + 0.0
}
