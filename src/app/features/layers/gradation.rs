//! How fast the target diameter may change.

use eframe::egui::Ui;

use super::LayerCommand;
use crate::app::command::{Command, EditCommand};
use crate::app::kit::{FrameState, Panel, Tab, end_gesture_when_released};
use crate::app::widgets::{Section, SliderRow, toggle_row};
use meshbrush_core::document::{Setting, Settings};

/// Whether h̄ may change abruptly, or how fast it may change.
pub static GRADATION: Panel = Panel { name: "gradation", tab: Tab::Size, place: 1, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Gradation").show(ui, |ui| rows(ui, state, commands));
}

fn rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let gradation = state.session.document().settings().gradation;
    let mut limits = gradation.is_some();
    if toggle_row(ui, "Limit gradation", &mut limits).changed() {
        commands.push(Command::Layer(LayerCommand::LimitGradation(limits)));
    }
    let Some(mut slope) = gradation else { return };
    let row = SliderRow::new("Gradation g", &mut slope, 0.02..=2.0).logarithmic();
    let row = row.typed_range(f64::MIN_POSITIVE..=f64::MAX).default(Settings::USUAL_GRADATION);
    let help = "Largest change of h̄ per unit of length, over the whole stack: the smaller, the more slowly \
                triangles grow with the distance from fine places.";
    let response = row.help(help).show(ui);
    if response.changed() {
        commands.push(Command::Edit(EditCommand::Set(Setting::Gradation(Some(slope)))));
    }
    end_gesture_when_released(&response, commands);
}
