//! Commands about strokes and the brush.

use eframe::egui::Context;
use glam::DVec2;

use crate::app::App;
use crate::app::command::{BrushCommand, Command, LayerCommand};
use crate::app::notices::Offer;
use crate::app::readout::{Quantity, value_at};
use crate::app::tools::{BrushMode, PaintKind};
use meshbrush_core::document::NoPaintLayer;
use meshbrush_core::layers::{Layer, LayerKind, Quantity as PaintedQuantity};

impl App {
    pub(in crate::app) fn execute_on_brush(&mut self, command: BrushCommand, _: &Context) {
        let tools = &mut self.tools;
        match command {
            BrushCommand::BeginStroke(point) => self.begin_stroke(point),
            BrushCommand::DrawTo(point) => self.draw_to(point),
            BrushCommand::EndStroke => self.session.document_mut().finish_stroke(),
            BrushCommand::LineTo(point) => self.line_to(point),
            BrushCommand::Kind(kind) => {
                tools.kind = kind;
                tools.select_brush();
                self.select_layer_painted_with(kind);
            }
            BrushCommand::Mode(mode) => {
                tools.mode = mode;
                tools.select_brush();
            }
            BrushCommand::Radius(radius) => self.set_brush_radius(radius),
            BrushCommand::Scale(factor) => self.set_brush_radius(self.tools.radius * factor),
            BrushCommand::Hardness(hardness) => tools.hardness = hardness.clamp(0.0, 1.0),
            BrushCommand::Strength(strength) => tools.set_strength(strength),
            BrushCommand::Risk(risk) => tools.risk = risk.clamp(0.0, 1.0),
            BrushCommand::Diameter(diameter) => self.set_brush_diameter(diameter),
            BrushCommand::Pick(point) => self.pick_value(point),
            BrushCommand::Smoothing(smoothing) => tools.smoothing = smoothing.clamp(0.0, 1.0),
            BrushCommand::MirrorX(mirrored) => tools.mirrored[0] = mirrored,
            BrushCommand::MirrorY(mirrored) => tools.mirrored[1] = mirrored,
            BrushCommand::PenEffect(effect) => tools.pen.effect = effect,
            BrushCommand::Pen(pressure) => tools.pen.set_pressure(pressure),
        }
    }

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

    fn begin_stroke(&mut self, point: DVec2) {
        let Some(brush) = self.tools.brush() else { return };
        let mirror = self.tools.mirror(self.session.document().settings().domain.bounds);
        self.session.notices_mut().dismiss_news();
        // Record the last stroke before the next begins: both may come in one frame.
        self.session.document_mut().end_stroke();
        self.record_edits();
        if let Err(problem) = self.session.document().layer_for(&brush.medium) {
            return self.offer_paint_layer(&problem);
        }
        let document = self.session.document_mut();
        document.begin_mirrored_stroke(brush, mirror);
        document.extend_stroke(self.tools.path_point(point));
        self.tools.last_painted = Some(point);
        self.tools.note_use(self.tools.tool);
    }

    fn draw_to(&mut self, point: DVec2) {
        self.session.document_mut().extend_stroke(self.tools.path_point(point));
        self.tools.last_painted = Some(point);
    }

    fn line_to(&mut self, point: DVec2) {
        self.begin_stroke(self.tools.last_painted.unwrap_or(point));
        self.draw_to(point);
        self.session.document_mut().finish_stroke();
    }

    fn set_brush_radius(&mut self, radius: f64) {
        let extent = self.session.document().settings().domain.bounds.size().max_element();
        if radius.is_finite() {
            self.tools.radius = radius.clamp(1e-4 * extent, extent);
        }
    }

    fn set_brush_diameter(&mut self, diameter: f64) {
        let transfer = self.session.document().settings().transfer;
        if diameter.is_finite() {
            self.tools.diameter = diameter.clamp(transfer.h_min, transfer.h_max);
        }
    }

    /// Makes a picked risk or diameter the brush's own: painted in the mode *Set*, it is reproduced.
    fn pick_value(&mut self, point: DVec2) {
        let value = |quantity| value_at(point, self.session.document(), self.session.follower(), quantity);
        match self.tools.kind {
            PaintKind::Risk => {
                let risk = value(Quantity::Risk);
                if risk.is_nan() {
                    return;
                }
                self.tools.risk = risk;
            }
            PaintKind::Diameter => self.set_brush_diameter(value(Quantity::TargetDiameter)),
        }
        self.tools.mode = BrushMode::Set;
        self.tools.select_brush();
    }

    /// Selects a layer that the brush can paint a quantity on, if there is one and none is selected: rather
    /// one that is visible and not locked, the highest of several.
    fn select_layer_painted_with(&mut self, kind: PaintKind) {
        let document = self.session.document_mut();
        let quantity = quantity_of(kind);
        let takes = |layer: &&Layer| layer.paints() == Some(quantity);
        if document.active_layer().filter(takes).is_some() {
            return;
        }
        let fitting = || document.settings().layers.iter().rev().filter(takes);
        let usable = fitting().find(|layer| layer.visible && !layer.locked);
        if let Some(id) = usable.or_else(|| fitting().next()).map(|layer| layer.id) {
            document.activate_layer(id);
        }
    }

    /// Says why nothing can be painted, and offers what would help.
    fn offer_paint_layer(&mut self, problem: &NoPaintLayer) {
        let (label, command) = match problem {
            NoPaintLayer::Locked { id, .. } => ("Unlock the layer", LayerCommand::Lock(*id, false)),
            NoPaintLayer::Hidden { id, .. } => ("Show the layer", LayerCommand::Show(*id, true)),
            NoPaintLayer::Missing(quantity) => {
                let quantity = quantity.unwrap_or(quantity_of(self.tools.kind));
                ("Add a paint layer", LayerCommand::Add(Box::new(LayerKind::Paint(quantity))))
            }
        };
        let offer = Offer { label, command: Command::Layer(command) };
        self.session.notices_mut().report_with_offer(problem, offer);
    }
}

fn quantity_of(kind: PaintKind) -> PaintedQuantity {
    match kind {
        PaintKind::Risk => PaintedQuantity::Risk,
        PaintKind::Diameter => PaintedQuantity::Diameter,
    }
}
