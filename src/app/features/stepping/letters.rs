//! The letters and numbers of a step on the canvas: `i = 57` at the triangle, `v₁ = 12` at the node, and the
//! bare numbers of the others. None covers another: a number without room is left out.

use std::sync::Arc;

use eframe::egui::{Color32, Galley, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use meshbrush_study::steps::{LabelRoom, LabelSize, placed};
use meshbrush_ui::theme::NUMBER_DISC;
use meshbrush_ui::theme::font;

/// Free space around the letters on their ground, in points.
const MARGIN: Vec2 = vec2(4.0, 1.0);
/// Radius of the dot at a node with a name or a number, in points.
const DOT: f32 = 3.0;

/// What a label is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelKind {
    /// Letters that text, data and code of the step use. They move where there is no room, with a line.
    Name,
    /// The number of a triangle of the step, in its middle.
    OfStep,
    /// The number of another triangle, in its middle.
    Triangle,
    /// The number of a node, beside it.
    Node,
}

/// A name or a number, and what it stands for on the screen.
pub struct StepLabel {
    /// The corners of a triangle, the ends of an edge, or a node.
    pub corners: Vec<Pos2>,
    /// Letters and number.
    pub text: String,
    /// The colour of the part of the step.
    pub color: Color32,
    /// What it is about.
    pub kind: LabelKind,
}

impl StepLabel {
    /// Returns the mean of the corners.
    fn at(&self) -> Pos2 {
        let sum = self.corners.iter().fold(Vec2::ZERO, |sum, corner| sum + corner.to_vec2());
        (sum / self.corners.len() as f32).to_pos2()
    }

    fn galley(&self, painter: &Painter) -> Arc<Galley> {
        let font = match self.kind {
            LabelKind::Name | LabelKind::OfStep => font::strong(),
            LabelKind::Triangle | LabelKind::Node => font::caption(),
        };
        painter.layout_no_wrap(self.text.clone(), font, self.color)
    }

    fn size(&self, galley: &Galley) -> LabelSize {
        let size = galley.size() + 2.0 * MARGIN;
        let (at, size) = (numbers(self.at()), [size.x, size.y].map(f64::from));
        match self.kind {
            LabelKind::Name => {
                let corners: Vec<_> = self.corners.iter().copied().map(numbers).collect();
                LabelSize::of(&corners, size)
            }
            LabelKind::OfStep | LabelKind::Triangle => LabelSize::fixed(at, size),
            LabelKind::Node => LabelSize::beside(at, size),
        }
    }

    fn ground(&self) -> Color32 {
        match self.kind {
            LabelKind::Name | LabelKind::OfStep => NUMBER_DISC,
            LabelKind::Triangle => Color32::from_black_alpha(150),
            LabelKind::Node => Color32::from_black_alpha(190),
        }
    }
}

fn numbers(at: Pos2) -> [f64; 2] {
    [at.x, at.y].map(f64::from)
}

/// Labels that have their places.
pub struct PlacedLabels(Vec<PlacedLabel>);

struct PlacedLabel {
    label: StepLabel,
    galley: Arc<Galley>,
    size: LabelSize,
    middle: [f64; 2],
}

impl PlacedLabel {
    fn room(&self) -> Rect {
        let [width, height] = self.size.size.map(|length| length as f32);
        Rect::from_center_size(pos2(self.middle[0] as f32, self.middle[1] as f32), vec2(width, height))
    }
}

impl PlacedLabels {
    /// Finds room for labels in a rectangle, the most important ones first: beside the `avoided` triangles,
    /// where that is possible. What lies outside the rectangle has no label.
    pub fn new(painter: &Painter, area: Rect, labels: Vec<StepLabel>, avoided: &[[Pos2; 3]]) -> Self {
        let inside: Vec<StepLabel> = labels.into_iter().filter(|label| area.contains(label.at())).collect();
        let galleys: Vec<Arc<Galley>> = inside.iter().map(|label| label.galley(painter)).collect();
        let sizes: Vec<LabelSize> =
            inside.iter().zip(&galleys).map(|(label, galley)| label.size(galley)).collect();
        let avoided: Vec<_> = avoided.iter().map(|corners| corners.map(numbers)).collect();
        let area = [numbers(area.min), numbers(area.max)];
        let middles = placed(&sizes, &LabelRoom { area, obstacles: &[], avoided: &avoided });
        let all = inside.into_iter().zip(galleys).zip(sizes).zip(middles);
        let with_room = all.filter_map(|(((label, galley), size), middle)| {
            Some(PlacedLabel { label, galley, size, middle: middle? })
        });
        Self(with_room.collect())
    }

    /// Draws the labels, each with a line to its place where it is beside it.
    pub fn paint(&self, painter: &Painter) {
        for PlacedLabel { label, size, middle, .. } in &self.0 {
            let at = label.at();
            if label.corners.len() == 1 {
                painter.circle(at, DOT, Color32::WHITE, Stroke::new(1.5, NUMBER_DISC));
            }
            if let Some([x, y]) = size.leader(*middle) {
                let line = [at, pos2(x as f32, y as f32)];
                painter.line_segment(line, Stroke::new(3.5, NUMBER_DISC));
                painter.line_segment(line, Stroke::new(1.5, label.color));
                painter.circle(at, 2.0, label.color, Stroke::new(1.0, NUMBER_DISC));
            }
        }
        for one in &self.0 {
            let room = one.room();
            painter.rect_filled(room, 4.0, one.label.ground());
            painter.galley(room.center() - one.galley.size() / 2.0, one.galley.clone(), one.label.color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_at_the_mean_of_its_corners() {
        let corners = vec![pos2(1.0, 10.0), pos2(3.0, 20.0), pos2(8.0, 60.0)];
        let kind = LabelKind::Name;
        let label = StepLabel { corners, text: "v₁ = 12".into(), color: Color32::WHITE, kind };
        assert_eq!(label.at(), pos2(4.0, 30.0));
    }
}
