//! The parameters of the selected layer.

use eframe::egui::Ui;

use super::OPEN_MASK;
use super::kinds::kind_of;
use crate::app::features::regions::{RegionCommand, RegionTarget};
use meshbrush_core::layers::{Combine, Layer, Surface};
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};
use meshbrush_kit::kit::{FrameState, area_text, button_rows, remark};
use meshbrush_ui::widgets::{Section, ValueRow, segmented};

/// The name of the group of choices.
const COMBINE: &str = "How the layer combines";

/// Returns the name of a way to combine.
pub fn combine_name(combine: Combine) -> &'static str {
    match combine {
        Combine::Finest => "Finest",
        Combine::Floor => "Floor",
        Combine::Replace => "Replace",
    }
}

/// Shows the section.
pub fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(layer) = state.session.document().active_layer() else { return };
    let section = Section::new("Selected layer").note(&layer.name);
    section.show(ui, |ui| {
        if layer.locked {
            remark(ui, "The layer is locked: unlock it to change it.");
        }
        ui.push_id(layer.id.0, |ui| {
            ui.add_enabled_ui(!layer.locked, |ui| {
                // A surface has no diameters to combine.
                if !layer.kind.is::<Surface>() && !layer.is_of_errors() {
                    combine_rows(ui, layer, commands);
                }
                (kind_of(state.layer_kinds, &layer.kind).parameters)(ui, state, layer, commands);
                mask_rows(ui, state, layer, commands);
            });
        });
    });
}

fn combine_rows(ui: &mut Ui, layer: &Layer, commands: &mut Vec<Command>) {
    let mut combine = layer.combine;
    let choices = Combine::ALL.map(|combine| (combine, combine_name(combine)));
    if segmented(ui, COMBINE, &mut combine, &choices).changed() {
        commands.push(Command::from(LayerCommand::Combine(layer.id, combine)));
    }
    ui.add_space(4.0);
}

/// Shows the mask in which the layer counts.
fn mask_rows(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    let area = layer.mask.as_ref().map_or_else(|| "none".to_owned(), |mask| area_text(ui, state, mask, 6));
    let help = "Area of the polygons in which the layer counts; without a mask it counts everywhere.";
    ValueRow::new("Mask", &area).help(help).show(ui);
    let row = [
        ("Draw mask", true, Command::from(RegionCommand::Target(RegionTarget::Mask))),
        ("Mask from file…", true, Command::from(FileCommand::Ask(&OPEN_MASK))),
        ("Remove mask", layer.mask.is_some(), Command::from(LayerCommand::Mask(layer.id, None))),
    ];
    button_rows(ui, [row], commands);
}
