//! The settings of brush and eraser.

use eframe::egui::Ui;

use super::Panel;
use crate::app::command::Command;
use crate::app::frame::FrameState;
use crate::app::tools::{ERASER, PaintKind, Tools};
use crate::app::widgets::{Section, SliderRow, segmented, value_row};

/// What the brush paints, its size, strength and hardness.
pub static BRUSH: Panel = Panel { name: "brush", only_with_tool: true, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let erases = state.tools.tool == &ERASER;
    Section::new(state.tools.tool.name).id("brush").show(ui, |ui| {
        if !erases {
            kind_row(ui, state, commands);
        }
        size_row(ui, state, commands);
        if !erases && state.tools.kind == PaintKind::Diameter {
            diameter_rows(ui, state, commands);
        } else {
            strength_row(ui, state, commands);
        }
        hardness_row(ui, state, commands);
    });
}

fn kind_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut kind = state.tools.kind;
    let choices = [(PaintKind::Risk, "Risk"), (PaintKind::Diameter, "Diameter")];
    if segmented(ui, "What the brush paints", &mut kind, &choices).changed() {
        commands.push(Command::Paint(kind));
    }
    ui.add_space(4.0);
}

/// The size of the brush, which the domain tool shares.
pub fn size_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let extent = state.session.document().settings().domain.bounds.size().max_element();
    let mut radius = state.tools.radius;
    let usual = Tools::for_domain(extent, 0.0);
    let slider = SliderRow::new("Size", &mut radius, 1e-4 * extent..=0.5 * extent)
        .logarithmic()
        .typed_range(1e-4 * extent..=extent)
        .default(usual.radius)
        .unit(state.unit().symbol());
    if slider.help("Radius in world units. [ and ] change it, as does a drag with Shift.").show(ui).changed()
    {
        commands.push(Command::BrushRadius(radius));
    }
}

fn strength_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut strength = state.tools.strength();
    let slider = SliderRow::new("Strength", &mut strength, 0.01..=1.0).step(0.01);
    let slider = slider.default(usual_strength(state));
    if slider.help("How far one stroke moves the value. The digits 1 to 0 set it.").show(ui).changed() {
        commands.push(Command::BrushStrength(strength));
    }
}

/// The strength that the selected tool has at first.
fn usual_strength(state: &FrameState<'_>) -> f64 {
    let mut usual = Tools::for_domain(1.0, 0.0);
    usual.select(state.tools.tool);
    usual.strength()
}

fn hardness_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut hardness = state.tools.hardness;
    let slider = SliderRow::new("Hardness", &mut hardness, 0.0..=1.0).step(0.01);
    let slider = slider.default(Tools::for_domain(1.0, 0.0).hardness);
    let help = "Share of the radius with full strength. Shift+[ and Shift+] change it.";
    if slider.help(help).show(ui).changed() {
        commands.push(Command::BrushHardness(hardness));
    }
}

/// The painted diameter, with its level.
fn diameter_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let transfer = state.session.document().settings().transfer;
    let field = state.session.follower().field();
    let mut diameter = state.tools.diameter.clamp(transfer.h_min, transfer.h_max);
    let level = field.level_of_diameter(diameter).map_or("–".into(), |level| level.to_string());
    let slider = SliderRow::new("Diameter", &mut diameter, transfer.h_min..=transfer.h_max).logarithmic();
    let slider = slider.default((2.0 * transfer.h_min).min(transfer.h_max)).unit(state.unit().symbol());
    if slider.help("Target diameter that the brush paints.").show(ui).changed() {
        commands.push(Command::BrushDiameter(diameter));
    }
    value_row(ui, "Refines to level", &level);
}
