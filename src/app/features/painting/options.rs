//! The settings of brush and eraser, on the strip above the canvas.

use std::ops::RangeInclusive;

use eframe::egui::Ui;

use super::ERASER;
use meshbrush_core::field::{RiskToDiameter, Transfer};
use meshbrush_kit::kit::command::{BrushCommand, Command};
use meshbrush_kit::kit::tools::{BrushMode, FIRST_HARDNESS, PaintKind, PenResponse};
use meshbrush_kit::kit::{FrameState, StripItem, button_rows, name_field, radius_row};
use meshbrush_ui::widgets::{NumberRow, SliderRow, dropdown_row, format, segmented, toggle_row, value_row};

/// What the brush paints and how, its size, and how strokes are drawn.
pub static BRUSH_OPTIONS: [StripItem; 13] = [
    StripItem::new(136.0, 0, kind_row).only(|state| !can_paint_errors(state)),
    StripItem::new(200.0, 0, kind_row).only(can_paint_errors),
    StripItem::new(184.0, 3, mode_row),
    StripItem::new(136.0, 1, radius_row).stretching(),
    StripItem::new(136.0, 2, amount_row).stretching(),
    StripItem::new(128.0, 4, hardness_row).stretching(),
    StripItem::new(144.0, 5, painted_row).stretching(),
    StripItem::new(112.0, 1, mirror_chip).only(|state| state.stroke_mirror().is_some()),
    StripItem::rare(preset_row),
    StripItem::rare(preset_rows),
    StripItem::rare(smoothing_row),
    StripItem::rare(mirror_rows),
    StripItem::rare(pen_rows).only(|state| state.tools.pen.is_known()),
];

/// The same of the eraser.
pub static ERASER_OPTIONS: [StripItem; 9] = [
    StripItem::new(136.0, 0, radius_row).stretching(),
    StripItem::new(136.0, 1, amount_row).stretching(),
    StripItem::new(128.0, 2, hardness_row).stretching(),
    StripItem::new(112.0, 0, mirror_chip).only(|state| state.stroke_mirror().is_some()),
    StripItem::rare(preset_row),
    StripItem::rare(preset_rows),
    StripItem::rare(smoothing_row),
    StripItem::rare(mirror_rows),
    StripItem::rare(pen_rows).only(|state| state.tools.pen.is_known()),
];

fn send(command: BrushCommand, commands: &mut Vec<Command>) {
    commands.push(Command::from(command));
}

/// Returns whether errors can be painted: there is a surface.
pub fn can_paint_errors(state: &FrameState<'_>) -> bool {
    state.tools.kind == PaintKind::Error || state.session.document().settings().has_surface()
}

fn kind_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut kind = state.tools.kind;
    let choices = [(PaintKind::Risk, "Risk"), (PaintKind::Diameter, "Diameter"), (PaintKind::Error, "Error")];
    let choices = if can_paint_errors(state) { &choices[..] } else { &choices[..2] };
    if segmented(ui, "What the brush paints", &mut kind, choices).changed() {
        send(BrushCommand::Kind(kind), commands);
    }
}

fn mode_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut mode = state.tools.mode;
    if segmented(ui, "How a stroke changes the paint", &mut mode, &BrushMode::ALL).changed() {
        send(BrushCommand::Mode(mode), commands);
    }
}

fn painted_row(ui: &mut Ui, state: &FrameState<'_>, _: &mut Vec<Command>) {
    value_row(ui, "h̄ · level", &painted(state));
}

/// Shows the amount that the brush paints: a strength, a risk or a diameter.
fn amount_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let tools = state.tools;
    match (tools.kind, tools.mode) {
        _ if tools.tool == &ERASER => strength_row(ui, state, commands),
        (PaintKind::Diameter, _) => diameter_row(ui, state, commands),
        (PaintKind::Error, _) => error_row(ui, state, commands),
        (PaintKind::Risk, BrushMode::Set) => risk_row(ui, state, commands),
        (PaintKind::Risk, BrushMode::BuildUp | BrushMode::Lower) => strength_row(ui, state, commands),
    }
}

fn strength_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut strength = state.tools.strength();
    let slider = SliderRow::new("Strength", &mut strength, 0.01..=1.0).step(0.01);
    let slider = slider.default(state.tools.first_strength());
    if slider.help("How far one stroke moves the value, 0 to 1. The digits 1 to 0 set it.").show(ui).changed()
    {
        send(BrushCommand::Strength(strength), commands);
    }
}

fn risk_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut risk = state.tools.risk;
    let slider = SliderRow::new("Value", &mut risk, 0.0..=1.0).step(0.01).default(0.5);
    let help = "The risk that a stroke leaves, 0 to 1. The digits 1 to 0 set it; Alt+click picks it.";
    if slider.help(help).show(ui).changed() {
        send(BrushCommand::Risk(risk), commands);
    }
}

/// How far below the smallest diameter of the document the brush goes.
const BELOW_SMALLEST: f64 = 0.01;

/// Returns the diameters that the brush paints, in world units. Below the smallest diameter of the document
/// it offers to lower that.
pub fn brush_diameters(transfer: &Transfer) -> RangeInclusive<f64> {
    let least = (BELOW_SMALLEST * transfer.h_min).max(f64::MIN_POSITIVE);
    least..=transfer.h_max
}

fn diameter_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let transfer = state.session.document().settings().transfer;
    let range = brush_diameters(&transfer);
    let mut diameter = state.tools.diameter.clamp(*range.start(), *range.end());
    let slider = SliderRow::new("Diameter", &mut diameter, range).logarithmic();
    let slider = slider.default((2.0 * transfer.h_min).min(transfer.h_max)).unit(state.unit().symbol());
    let help = "Target diameter that the brush paints, in the unit of the document. Below h_min it offers to \
                lower that. Alt+click picks it.";
    if slider.help(help).show(ui).changed() {
        send(BrushCommand::Diameter(diameter), commands);
    }
}

fn error_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut error = state.tools.error;
    let help = "The largest error that the brush paints, in the unit of the surface. It counts at samples of surfaces in \
                place of their own. Alt+click picks the error that is allowed.";
    let row = NumberRow::new("Error", &mut error).range(f64::MIN_POSITIVE..=f64::from(f32::MAX) / 2.0);
    if row.help(help).show(ui).changed() {
        send(BrushCommand::Error(error), commands);
    }
}

fn hardness_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut hardness = state.tools.hardness;
    let slider = SliderRow::new("Hardness", &mut hardness, 0.0..=1.0).step(0.01);
    let slider = slider.default(FIRST_HARDNESS);
    let help =
        "Share of the radius with full strength, 0 to 1[; {softer-brush} and {harder-brush} change it].";
    if slider.help(help).show(ui).changed() {
        send(BrushCommand::Hardness(hardness), commands);
    }
}

fn smoothing_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut smoothing = state.tools.smoothing;
    let slider = SliderRow::new("Smoothing", &mut smoothing, 0.0..=1.0).step(0.01).default(0.0);
    let help = "Steadies the hand, 0 to 1: the pointer pulls the brush on a string, the longer the more.";
    if slider.help(help).show(ui).changed() {
        send(BrushCommand::Smoothing(smoothing), commands);
    }
}

/// Returns the target diameter and the level that a stroke paints.
fn painted(state: &FrameState<'_>) -> String {
    let (tools, transfer) = (state.tools, state.session.document().settings().transfer);
    let diameter = match (tools.kind, tools.mode) {
        (PaintKind::Error, _) => return "–".into(),
        (PaintKind::Diameter, _) => tools.diameter.clamp(transfer.h_min, transfer.h_max),
        (PaintKind::Risk, BrushMode::BuildUp) => transfer.diameter(tools.paint_strength),
        (PaintKind::Risk, BrushMode::Set) => transfer.diameter(tools.risk),
        (PaintKind::Risk, BrushMode::Lower) => transfer.diameter(1.0 - tools.paint_strength),
    };
    let level = state.session.follower().field().level_of_diameter(diameter, state.place());
    let level = level.map_or("–".into(), |level| level.to_string());
    format!("{} · {level}", format::length(diameter, state.unit()))
}

/// Says that strokes are repeated, and stops it with a click.
fn mirror_chip(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut on = true;
    let name = match state.tools.mirrored {
        [true, true] => "Mirrored x, y",
        [true, false] => "Mirrored x",
        [false, _] => "Mirrored y",
    };
    if toggle_row(ui, name, &mut on).changed() {
        send(BrushCommand::MirrorX(false), commands);
        send(BrushCommand::MirrorY(false), commands);
    }
}

/// Shows which preset the brush is, and chooses another one.
fn preset_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let chosen = state.tools.chosen_preset();
    let own = chosen.is_none().then_some((None, "own"));
    let presets =
        state.tools.presets().iter().enumerate().map(|(number, preset)| (Some(number), &*preset.name));
    let choices: Vec<(Option<usize>, &str)> = own.into_iter().chain(presets).collect();
    let mut choice = chosen;
    if dropdown_row(ui, "Preset", &mut choice, &choices).changed()
        && let Some(number) = choice
    {
        send(BrushCommand::UsePreset(number), commands);
    }
}

/// Keeps the brush as a preset; names or removes the preset that it is.
fn preset_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(number) = state.tools.chosen_preset() else {
        return button_rows(
            ui,
            [[("Keep the brush as a preset", true, Command::from(BrushCommand::KeepPreset))]],
            commands,
        );
    };
    if let Some(name) = name_field(ui, "brush preset", &state.tools.presets()[number].name) {
        send(BrushCommand::RenamePreset(number, name), commands);
    }
    button_rows(
        ui,
        [[("Remove the preset", true, Command::from(BrushCommand::RemovePreset(number)))]],
        commands,
    );
}

fn mirror_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let [mut x, mut y] = state.tools.mirrored;
    ui.columns(2, |columns| {
        if toggle_row(&mut columns[0], "Mirror x", &mut x).changed() {
            send(BrushCommand::MirrorX(x), commands);
        }
        if toggle_row(&mut columns[1], "Mirror y", &mut y).changed() {
            send(BrushCommand::MirrorY(y), commands);
        }
    });
}

/// Shows what a pen's pressure changes, and its curve.
fn pen_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut response = state.tools.pen.response;
    ui.columns(2, |columns| {
        toggle_row(&mut columns[0], "Pen: radius", &mut response.changes_radius);
        toggle_row(&mut columns[1], "Pen: strength", &mut response.changes_strength);
    });
    if response.changes_radius || response.changes_strength {
        let row = SliderRow::new("Pen curve", &mut response.exponent, PenResponse::EXPONENTS).logarithmic();
        let help = "Exponent of the curve from the pressure of the pen to the share of radius or strength, 0.25 to 4. \
                    Below 1 a light touch does much; above 1 only a firm one.";
        row.default(1.0).help(help).show(ui);
    }
    if response != state.tools.pen.response {
        send(BrushCommand::PenResponse(response), commands);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_brush_goes_below_the_smallest_diameter_and_never_to_zero() {
        let range = |h_min: f64| brush_diameters(&Transfer::between(h_min, 0.2));
        assert_eq!(range(0.004), BELOW_SMALLEST * 0.004..=0.2);
        assert!(*range(0.004).start() < 0.004);
        assert_eq!(*range(f64::MIN_POSITIVE).start(), f64::MIN_POSITIVE);
    }
}
