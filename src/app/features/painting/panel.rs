//! The settings of brush and eraser.

use std::ops::RangeInclusive;

use eframe::egui::Ui;

use super::{BrushCommand, BrushMode, ERASER, PenEffect};
use crate::app::command::Command;
use crate::app::kit::{FrameState, Panel, PanelGroup, radius_row};
use crate::app::tools::{PaintKind, Tools};
use crate::app::widgets::{Section, SliderRow, format, segmented, toggle_row, value_row};
use meshbrush_core::field::{RiskToDiameter, Transfer};

/// The panel with the brush's paint, radius, strength and hardness, and the drawing of strokes.
pub static BRUSH_PANEL: Panel = Panel { name: "brush", group: PanelGroup::Size, only_with_tool: true, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut sent = Vec::new();
    Section::new(state.tools.tool.name).id("brush").show(ui, |ui| {
        if state.tools.tool != &ERASER {
            kind_rows(ui, state, &mut sent);
        }
        // The same number of rows for all kinds and modes, so that nothing below moves.
        radius_row(ui, state, commands);
        amount_row(ui, state, &mut sent);
        hardness_row(ui, state, &mut sent);
        if state.tools.tool != &ERASER {
            value_row(ui, "h̄ · level", &painted(state));
        }
    });
    Section::new("Stroke").id("stroke").closed().show(ui, |ui| {
        smoothing_row(ui, state, &mut sent);
        mirror_rows(ui, state, &mut sent);
        pen_row(ui, state, &mut sent);
    });
    commands.extend(sent.into_iter().map(Command::Brush));
}

fn kind_rows(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let (mut kind, mut mode) = (state.tools.kind, state.tools.mode);
    let choices = [(PaintKind::Risk, "Risk"), (PaintKind::Diameter, "Diameter")];
    if segmented(ui, "What the brush paints", &mut kind, &choices).changed() {
        sent.push(BrushCommand::Kind(kind));
    }
    ui.add_space(4.0);
    if segmented(ui, "How a stroke changes the paint", &mut mode, &BrushMode::ALL).changed() {
        sent.push(BrushCommand::Mode(mode));
    }
    ui.add_space(4.0);
}

/// Shows the amount that the brush paints: a strength, a risk or a diameter.
fn amount_row(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let tools = state.tools;
    match (tools.kind, tools.mode) {
        _ if tools.tool == &ERASER => strength_row(ui, state, sent),
        (PaintKind::Diameter, _) => diameter_row(ui, state, sent),
        (PaintKind::Risk, BrushMode::Set) => risk_row(ui, state, sent),
        (PaintKind::Risk, BrushMode::BuildUp | BrushMode::Lower) => strength_row(ui, state, sent),
    }
}

fn strength_row(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let mut strength = state.tools.strength();
    let slider = SliderRow::new("Strength", &mut strength, 0.01..=1.0).step(0.01);
    let slider = slider.default(usual_strength(state));
    if slider.help("How far one stroke moves the value, 0 to 1. The digits 1 to 0 set it.").show(ui).changed()
    {
        sent.push(BrushCommand::Strength(strength));
    }
}

/// Returns the strength that the selected tool has at first.
fn usual_strength(state: &FrameState<'_>) -> f64 {
    let mut usual = Tools::for_domain(1.0, 0.0);
    usual.select(state.tools.tool);
    usual.strength()
}

fn risk_row(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let mut risk = state.tools.risk;
    let slider = SliderRow::new("Value", &mut risk, 0.0..=1.0).step(0.01).default(0.5);
    let help = "The risk that a stroke leaves, 0 to 1. The digits 1 to 0 set it; Alt+click picks it.";
    if slider.help(help).show(ui).changed() {
        sent.push(BrushCommand::Risk(risk));
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

fn diameter_row(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let transfer = state.session.document().settings().transfer;
    let range = brush_diameters(&transfer);
    let mut diameter = state.tools.diameter.clamp(*range.start(), *range.end());
    let slider = SliderRow::new("Diameter", &mut diameter, range).logarithmic();
    let slider = slider.default((2.0 * transfer.h_min).min(transfer.h_max)).unit(state.unit().symbol());
    let help = "Target diameter that the brush paints, in the unit of the document. Below h_min it offers to \
                lower that. Alt+click picks it.";
    if slider.help(help).show(ui).changed() {
        sent.push(BrushCommand::Diameter(diameter));
    }
}

fn hardness_row(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let mut hardness = state.tools.hardness;
    let slider = SliderRow::new("Hardness", &mut hardness, 0.0..=1.0).step(0.01);
    let slider = slider.default(Tools::for_domain(1.0, 0.0).hardness);
    let help = "Share of the radius with full strength, 0 to 1. Shift+[ and Shift+] change it.";
    if slider.help(help).show(ui).changed() {
        sent.push(BrushCommand::Hardness(hardness));
    }
}

fn smoothing_row(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let mut smoothing = state.tools.smoothing;
    let slider = SliderRow::new("Smoothing", &mut smoothing, 0.0..=1.0).step(0.01).default(0.0);
    let help = "Steadies the hand, 0 to 1: the pointer pulls the brush on a string, the longer the more.";
    if slider.help(help).show(ui).changed() {
        sent.push(BrushCommand::Smoothing(smoothing));
    }
}

/// Returns the target diameter and the level that a stroke paints.
fn painted(state: &FrameState<'_>) -> String {
    let (tools, transfer) = (state.tools, state.session.document().settings().transfer);
    let diameter = match (tools.kind, tools.mode) {
        (PaintKind::Diameter, _) => tools.diameter.clamp(transfer.h_min, transfer.h_max),
        (PaintKind::Risk, BrushMode::BuildUp) => transfer.diameter(tools.paint_strength),
        (PaintKind::Risk, BrushMode::Set) => transfer.diameter(tools.risk),
        (PaintKind::Risk, BrushMode::Lower) => transfer.diameter(1.0 - tools.paint_strength),
    };
    let level = state.session.follower().field().level_of_diameter(diameter);
    let level = level.map_or("–".into(), |level| level.to_string());
    format!("{} · {level}", format::length(diameter, state.unit()))
}

fn mirror_rows(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    let [mut x, mut y] = state.tools.mirrored;
    ui.columns(2, |columns| {
        if toggle_row(&mut columns[0], "Mirror x", &mut x).changed() {
            sent.push(BrushCommand::MirrorX(x));
        }
        if toggle_row(&mut columns[1], "Mirror y", &mut y).changed() {
            sent.push(BrushCommand::MirrorY(y));
        }
    });
}

/// Shows the effect of a pen's pressure, once a pen has reported one.
fn pen_row(ui: &mut Ui, state: &FrameState<'_>, sent: &mut Vec<BrushCommand>) {
    if !state.tools.pen.is_known() {
        return;
    }
    let mut effect = state.tools.pen.effect;
    let choices =
        [(PenEffect::None, "No pressure"), (PenEffect::Size, "Radius"), (PenEffect::Strength, "Strength")];
    let row = segmented(ui, "What the pressure of the pen changes", &mut effect, &choices);
    if row.changed() {
        sent.push(BrushCommand::PenEffect(effect));
    }
}
