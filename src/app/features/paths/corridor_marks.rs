//! The corridor of nearly best paths over the mesh.

use eframe::egui::{Color32, Mesh, Pos2, Rect, Shape, pos2};

use crate::app::features::paths::Paths;
use meshbrush_kit::kit::marks::paint_line;
use meshbrush_kit::kit::{FrameState, OverMesh};

/// The colours of the corridor and of its outline.
pub const FILL: Color32 = Color32::from_rgba_premultiplied(0x44, 0x3b, 0x10, 0x44);
const LINE: Color32 = Color32::from_rgb(0xf4, 0xe6, 0xa0);
const LINE_WIDTH: f32 = 0.8;
/// How much fainter it is while it is that of an earlier state.
const OUTDATED: f32 = 0.5;

/// Draws the corridor.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let place = |line: &Vec<_>| line.iter().map(|&point| (over.screen_from_world)(point)).collect();
    let lines: Vec<Vec<Pos2>> = state.feature::<Paths>().finder.corridor.lines().iter().map(place).collect();
    if lines.is_empty() {
        return;
    }
    let is_current = state.feature::<Paths>().finder.is_current(state.session);
    let [fill, line] =
        [FILL, LINE].map(|color| if is_current { color } else { color.gamma_multiply(OUTDATED) });
    let row = 1.0 / over.painter.pixels_per_point();
    over.painter.add(Shape::mesh(filled(&lines, over.painter.clip_rect(), row, fill)));
    for outline in lines {
        paint_line(over.painter, outline.into_iter(), line, LINE_WIDTH);
    }
}

/// Fills the points within an odd number of closed lines, in rows of a height of `row` points. The lines hide
/// the steps at their ends.
fn filled(lines: &[Vec<Pos2>], view: Rect, row: f32, color: Color32) -> Mesh {
    let count = (view.height() / row).ceil() as usize;
    let middle = |number: usize| view.top() + (number as f32 + 0.5) * row;
    let mut crossings: Vec<Vec<f32>> = vec![Vec::new(); count];
    for ends in lines.iter().flat_map(|line| line.windows(2)) {
        let [low, high] = if ends[0].y < ends[1].y { [ends[0], ends[1]] } else { [ends[1], ends[0]] };
        // Rows with low.y <= middle < high.y.
        let first = |y: f32| ((y - view.top()) / row - 0.5).ceil().clamp(0.0, count as f32) as usize;
        for (number, crossings) in crossings.iter_mut().enumerate().take(first(high.y)).skip(first(low.y)) {
            let share = (middle(number) - low.y) / (high.y - low.y);
            crossings.push((low.x + share * (high.x - low.x)).clamp(view.left(), view.right()));
        }
    }
    let mut mesh = Mesh::default();
    for (number, crossings) in crossings.iter_mut().enumerate() {
        crossings.sort_unstable_by(f32::total_cmp);
        let top = view.top() + number as f32 * row;
        for span in crossings.chunks_exact(2).filter(|span| span[0] < span[1]) {
            let place = Rect::from_min_max(pos2(span[0], top), pos2(span[1], top + row));
            mesh.add_colored_rect(place, color);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_between_two_squares_is_filled() {
        let square = |low: f32, high: f32| {
            [(low, low), (high, low), (high, high), (low, high), (low, low)].map(|(x, y)| pos2(x, y)).to_vec()
        };
        let view = Rect::from_min_max(pos2(5.0, 0.0), pos2(100.0, 60.0));
        let mesh = filled(&[square(10.0, 50.0), square(20.0, 30.0), square(-50.0, -10.0)], view, 0.5, FILL);
        let area: f32 = mesh
            .vertices
            .chunks_exact(4)
            .map(|corners| {
                let size = corners[3].pos - corners[0].pos;
                size.x * size.y
            })
            .sum();
        assert!((area - 1500.0).abs() < 1.0, "{area}");
    }
}
