//! Runs the commands about strokes and the brush.

use glam::DVec2;

use super::{BRUSH, ERASER, GESTURES, LimitOffer, Painting, brush_diameters, entries};
use meshbrush_core::document::{NoPaintLayer, Setting};
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_kit::kit::command::{BrushCommand, Command, LayerCommand};
use meshbrush_kit::kit::notices::Offer;
use meshbrush_kit::kit::readout::{Quantity, value_at};
use meshbrush_kit::kit::tools::{BrushMode, MOST_PRESETS, PaintKind};
use meshbrush_kit::kit::{Ctx, Feature, Row};

impl Feature for Painting {
    type Command = BrushCommand;
    const ROW: Row =
        Row { tools: &[&BRUSH, &ERASER], gestures: &GESTURES, entries: entries::entries, ..Row::EMPTY };

    fn execute(&mut self, command: BrushCommand, ctx: &mut Ctx<'_>) {
        let tools = &mut *ctx.tools;
        match command {
            BrushCommand::BeginStroke(point) => self.begin_stroke(point, ctx),
            BrushCommand::DrawTo(point) => self.draw_to(point, ctx),
            BrushCommand::EndStroke => self.end_stroke(ctx),
            BrushCommand::LineTo(point) => self.line_to(point, ctx),
            BrushCommand::LowerLimit => self.lower_limit(Setting::SmallestDiameter, ctx),
            BrushCommand::LowerLimitAndRisk => self.lower_limit(Setting::DiameterAtRiskOne, ctx),
            BrushCommand::KeepLimit => self.offer = None,
            BrushCommand::Kind(kind) => {
                tools.kind = kind;
                tools.select_brush();
                select_layer_painted_with(kind, ctx);
            }
            BrushCommand::Mode(mode) => {
                tools.mode = mode;
                tools.select_brush();
            }
            BrushCommand::Radius(radius) => set_brush_radius(radius, ctx),
            BrushCommand::Scale(factor) => set_brush_radius(ctx.tools.radius * factor, ctx),
            BrushCommand::Hardness(hardness) => tools.hardness = hardness.clamp(0.0, 1.0),
            BrushCommand::Strength(strength) => tools.set_strength(strength),
            BrushCommand::Risk(risk) => tools.risk = risk.clamp(0.0, 1.0),
            BrushCommand::Diameter(diameter) => set_brush_diameter(diameter, ctx),
            BrushCommand::Error(error) => set_brush_error(error, ctx),
            BrushCommand::Pick(point) => pick_value(point, ctx),
            BrushCommand::Smoothing(smoothing) => tools.smoothing = smoothing.clamp(0.0, 1.0),
            BrushCommand::MirrorX(mirrored) => tools.mirrored[0] = mirrored,
            BrushCommand::MirrorY(mirrored) => tools.mirrored[1] = mirrored,
            BrushCommand::PenResponse(response) => tools.pen.response = response,
            BrushCommand::UsePreset(number) => use_preset(number, ctx),
            BrushCommand::KeepPreset => keep_preset(ctx),
            BrushCommand::RenamePreset(number, name) => tools.rename_preset(number, &name),
            BrushCommand::RemovePreset(number) => tools.remove_preset(number),
            BrushCommand::Pen(pressure) => tools.pen.set_pressure(pressure),
        }
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        self.suit_selected_layer(ctx);
        let session = &*ctx.session;
        let counts = self.offer.as_mut().is_some_and(|offer| offer.advance(session, ctx.reproducible));
        self.offer.take_if(|offer| !offer.is_open(session));
        counts
    }

    fn put_down(&mut self, _ctx: &mut Ctx<'_>) -> bool {
        self.offer.take().is_some()
    }
}

impl Painting {
    /// Where another layer is selected, however that came about, the brush paints the quantity of that layer
    /// from then on. Without a selected layer it paints what a layer takes, rather what it paints already.
    fn suit_selected_layer(&mut self, ctx: &mut Ctx<'_>) {
        let document = ctx.session.document();
        let selected = document.active_layer();
        if self.suited.replace(selected.map(|layer| layer.id)) == Some(selected.map(|layer| layer.id)) {
            return;
        }
        let own = ctx.tools.kind.quantity();
        let others = || document.settings().layers.iter().rev().filter_map(Layer::paints);
        let quantity = match selected {
            Some(layer) => layer.paints(),
            None => others().find(|quantity| *quantity == own).or_else(|| others().next()),
        };
        if let Some(quantity) = quantity {
            ctx.tools.kind = PaintKind::of(quantity);
        }
    }

    fn begin_stroke(&mut self, point: DVec2, ctx: &mut Ctx<'_>) {
        let Some(brush) = ctx.tools.brush() else { return };
        (self.next_offer, self.offer) = (None, None);
        let settings = ctx.session.document().settings();
        let (mirror, transfer) = (ctx.tools.mirror(settings.domain.bounds), settings.transfer);
        ctx.session.notices_mut().dismiss_news();
        // Record the last stroke before the next begins: both may come in one frame.
        ctx.session.document_mut().end_stroke();
        ctx.record_edits();
        if let Err(problem) = ctx.session.document().layer_for(&brush.medium) {
            return offer_paint_layer(&problem, ctx);
        }
        ctx.session.document_mut().begin_mirrored_stroke(brush, mirror);
        self.next_offer = LimitOffer::of(&brush, &transfer);
        self.draw_to(point, ctx);
        ctx.tools.note_use(ctx.tools.tool);
    }

    fn draw_to(&mut self, point: DVec2, ctx: &mut Ctx<'_>) {
        let document = ctx.session.document_mut();
        document.extend_stroke(ctx.tools.path_point(point));
        if let Some(offer) = &mut self.next_offer {
            let mirror = ctx.tools.mirror(document.settings().domain.bounds);
            offer.extend(point, ctx.tools.radius, &mirror);
        }
        ctx.tools.last_painted = Some(point);
    }

    fn end_stroke(&mut self, ctx: &mut Ctx<'_>) {
        ctx.session.document_mut().finish_stroke();
        self.offer = self.next_offer.take();
    }

    fn line_to(&mut self, point: DVec2, ctx: &mut Ctx<'_>) {
        self.begin_stroke(ctx.tools.last_painted.unwrap_or(point), ctx);
        self.draw_to(point, ctx);
        self.end_stroke(ctx);
    }

    fn lower_limit(&mut self, setting: fn(f64) -> Setting, ctx: &mut Ctx<'_>) {
        if let Some(offer) = self.offer.take() {
            ctx.session.set(setting(offer.diameter));
            ctx.session.end_gesture();
        }
    }
}

fn set_brush_radius(radius: f64, ctx: &mut Ctx<'_>) {
    let extent = ctx.session.document().settings().domain.bounds.size().max_element();
    if radius.is_finite() {
        ctx.tools.radius = radius.clamp(ctx.view.least_brush_radius(extent).min(extent), extent);
    }
}

fn set_brush_diameter(diameter: f64, ctx: &mut Ctx<'_>) {
    let range = brush_diameters(&ctx.session.document().settings().transfer);
    if diameter.is_finite() {
        ctx.tools.diameter = diameter.clamp(*range.start(), *range.end());
    }
}

fn use_preset(number: usize, ctx: &mut Ctx<'_>) {
    ctx.tools.use_preset(number);
    // What a brush of another document has may not suit this one.
    set_brush_radius(ctx.tools.radius, ctx);
    set_brush_diameter(ctx.tools.diameter, ctx);
    if !ctx.tools.paints() {
        ctx.tools.select_brush();
    }
    select_layer_painted_with(ctx.tools.kind, ctx);
}

fn keep_preset(ctx: &mut Ctx<'_>) {
    if !ctx.tools.keep_preset() {
        let sentence = format!("The brush was not kept: there are {MOST_PRESETS} presets. Remove one first.");
        ctx.session.tell(sentence);
    }
}

fn set_brush_error(error: f64, ctx: &mut Ctx<'_>) {
    if error > 0.0 && error < f64::from(f32::MAX) {
        ctx.tools.error = error;
    }
}

/// Makes a picked risk, diameter or error the brush's own: painted in the mode *Set*, it is reproduced.
fn pick_value(point: DVec2, ctx: &mut Ctx<'_>) {
    let value = |quantity| value_at(point, ctx.session.document(), ctx.session.follower(), quantity);
    match ctx.tools.kind {
        PaintKind::Risk => {
            let risk = value(Quantity::Risk);
            if risk.is_nan() {
                return;
            }
            ctx.tools.risk = risk;
        }
        PaintKind::Diameter => set_brush_diameter(value(Quantity::TargetDiameter), ctx),
        PaintKind::Error => {
            let surface = ctx.session.follower().surface();
            let Some((_, error)) = surface.and_then(|rule| rule.allowed_at(point)) else { return };
            set_brush_error(error, ctx);
        }
    }
    ctx.tools.mode = BrushMode::Set;
    ctx.tools.select_brush();
}

/// Selects a layer that the brush can paint a quantity on, if there is one and none is selected: rather
/// one that is visible and not locked, the highest of several.
fn select_layer_painted_with(kind: PaintKind, ctx: &mut Ctx<'_>) {
    let document = ctx.session.document_mut();
    let quantity = kind.quantity();
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
fn offer_paint_layer(problem: &NoPaintLayer, ctx: &mut Ctx<'_>) {
    let (label, command) = match problem {
        NoPaintLayer::Locked { id, .. } => ("Unlock the layer", LayerCommand::Lock(*id, false)),
        NoPaintLayer::Hidden { id, .. } => ("Show the layer", LayerCommand::Show(*id, true)),
        NoPaintLayer::Missing(quantity) => {
            let quantity = quantity.unwrap_or(ctx.tools.kind.quantity());
            ("Add a paint layer", LayerCommand::Add(Box::new(LayerKind::paint(quantity))))
        }
    };
    let offer = Offer { label, command: Command::from(command) };
    ctx.session.notices_mut().report_with_offer(problem, offer);
}
