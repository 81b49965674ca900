//! The letters of a step on the canvas: `i = 57` at the triangle, `v₁ = 12` at the node.

use std::sync::Arc;

use eframe::egui::{Color32, Galley, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use meshbrush_study::steps::{LabelSize, placed};
use meshbrush_ui::theme::NUMBER_DISC;
use meshbrush_ui::theme::font;

/// Free space around the letters on their ground, in points.
const MARGIN: Vec2 = vec2(4.0, 1.0);
/// A name this far from its place has a line to it, in points.
const LINE_FROM: f32 = 6.0;

/// A name, and what it stands for on the screen.
pub struct Letter {
    /// The corners of a triangle, the ends of an edge, or a node.
    pub corners: Vec<Pos2>,
    /// Letters and number.
    pub text: String,
    /// The colour of the part of the step.
    pub color: Color32,
}

impl Letter {
    /// Returns the mean of the corners.
    fn at(&self) -> Pos2 {
        let sum = self.corners.iter().fold(Vec2::ZERO, |sum, corner| sum + corner.to_vec2());
        (sum / self.corners.len() as f32).to_pos2()
    }
}

/// Letters that have their places.
pub struct PlacedLetters(Vec<(Letter, Arc<Galley>, Rect)>);

impl PlacedLetters {
    /// Finds room for letters in a rectangle, those of what lies outside it left out.
    pub fn new(painter: &Painter, area: Rect, letters: Vec<Letter>) -> Self {
        let inside: Vec<Letter> = letters.into_iter().filter(|letter| area.contains(letter.at())).collect();
        let galley =
            |letter: &Letter| painter.layout_no_wrap(letter.text.clone(), font::strong(), letter.color);
        let galleys: Vec<Arc<Galley>> = inside.iter().map(galley).collect();
        let size = |galley: &Galley| galley.size() + 2.0 * MARGIN;
        let corner = |at: Pos2| [at.x, at.y].map(f64::from);
        let sizes = inside.iter().zip(&galleys).map(|(letter, galley)| {
            let corners: Vec<_> = letter.corners.iter().copied().map(corner).collect();
            LabelSize::of(&corners, [size(galley).x, size(galley).y].map(f64::from))
        });
        let middles = placed(&sizes.collect::<Vec<_>>(), [corner(area.min), corner(area.max)]);
        let all = inside.into_iter().zip(galleys).zip(middles).map(|((letter, galley), [x, y])| {
            let room = Rect::from_center_size(pos2(x as f32, y as f32), size(&galley));
            (letter, galley, room)
        });
        Self(all.collect())
    }

    /// Returns whether something in a rectangle would cover a name.
    pub fn are_covered_by(&self, room: Rect) -> bool {
        self.0.iter().any(|(_, _, taken)| taken.intersects(room))
    }

    /// Draws the names, each with a line to its place where it is beside it.
    pub fn paint(&self, painter: &Painter) {
        for (letter, _, room) in &self.0 {
            let at = letter.at();
            if letter.corners.len() == 1 {
                painter.circle(at, 3.5, Color32::WHITE, Stroke::new(1.5, NUMBER_DISC));
            }
            let end = room.clamp(at);
            if end.distance(at) > LINE_FROM {
                painter.line_segment([at, end], Stroke::new(3.5, NUMBER_DISC));
                painter.line_segment([at, end], Stroke::new(1.5, letter.color));
            }
        }
        for (letter, galley, room) in &self.0 {
            painter.rect_filled(*room, 4.0, NUMBER_DISC);
            painter.galley(room.center() - galley.size() / 2.0, galley.clone(), letter.color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_is_at_the_mean_of_its_corners() {
        let corners = vec![pos2(1.0, 10.0), pos2(3.0, 20.0), pos2(8.0, 60.0)];
        let letter = Letter { corners, text: "v₁ = 12".into(), color: Color32::WHITE };
        assert_eq!(letter.at(), pos2(4.0, 30.0));
    }
}
