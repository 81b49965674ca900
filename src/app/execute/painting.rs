//! Commands about strokes and the brush.

use glam::DVec2;

use crate::app::App;
use crate::app::readout::{Quantity, value_at};
use crate::app::tools::PaintKind;

impl App {
    /// Runs an undo or a redo. Where that changes the domain, the brush keeps its share of it.
    pub(super) fn keep_brush_share(&mut self, step: fn(&mut Self)) {
        let extent = |app: &Self| app.session.document().settings().domain.bounds.size().max_element();
        let before = extent(self);
        step(self);
        let ratio = extent(self) / before;
        if ratio != 1.0 {
            self.tools.radius *= ratio;
            self.tools.diameter *= ratio;
        }
    }

    pub(super) fn begin_stroke(&mut self, point: DVec2) {
        let Some(brush) = self.tools.brush() else { return };
        self.session.notices_mut().dismiss_news();
        // Record the last stroke before the next begins: both may come in one frame.
        self.session.document_mut().end_stroke();
        self.record_edits();
        let document = self.session.document_mut();
        document.begin_stroke(brush);
        document.extend_stroke(point);
        self.tools.last_painted = Some(point);
        self.tools.note_use(self.tools.tool);
    }

    pub(super) fn draw_to(&mut self, point: DVec2) {
        self.session.document_mut().extend_stroke(point);
        self.tools.last_painted = Some(point);
    }

    pub(super) fn line_to(&mut self, point: DVec2) {
        self.begin_stroke(self.tools.last_painted.unwrap_or(point));
        self.draw_to(point);
        self.session.document_mut().finish_stroke();
    }

    pub(super) fn set_brush_radius(&mut self, radius: f64) {
        let extent = self.session.document().settings().domain.bounds.size().max_element();
        if radius.is_finite() {
            self.tools.radius = radius.clamp(1e-4 * extent, extent);
        }
    }

    pub(super) fn set_brush_diameter(&mut self, diameter: f64) {
        let transfer = self.session.document().settings().transfer;
        if diameter.is_finite() {
            self.tools.diameter = diameter.clamp(transfer.h_min, transfer.h_max);
        }
    }

    /// Risk becomes the brush's strength, a diameter the brush's diameter.
    pub(super) fn pick_value(&mut self, point: DVec2) {
        let value = |quantity| value_at(point, self.session.document(), self.session.follower(), quantity);
        match self.tools.kind {
            PaintKind::Risk => {
                let risk = value(Quantity::Risk);
                if risk > 0.0 {
                    self.tools.paint_strength = risk.clamp(0.01, 1.0);
                }
            }
            PaintKind::Diameter => self.set_brush_diameter(value(Quantity::TargetDiameter)),
        }
    }
}
