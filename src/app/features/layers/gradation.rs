//! How fast the target diameter may change.

use eframe::egui::Ui;

use meshbrush_core::document::{Setting, Settings};
use meshbrush_kit::kit::command::{Command, EditCommand, LayerCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab, end_gesture_when_released, size_price_row};
use meshbrush_ui::widgets::{Section, SliderRow, toggle_row};

/// Whether h̄ may change abruptly, or how fast it may change.
pub static GRADATION: Panel = Panel { name: "gradation", tab: Tab::Size, place: 1, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Gradation").show(ui, |ui| rows(ui, state, commands));
}

fn rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let gradation = state.session.document().settings().gradation;
    let mut limits = gradation.is_some();
    let toggle = toggle_row(ui, "Limit gradation", &mut limits);
    if toggle.changed() {
        commands.push(Command::from(LayerCommand::LimitGradation(limits)));
    }
    if let Some(slope) = gradation {
        slope_row(ui, slope, commands);
    }
    let other = if gradation.is_some() { None } else { Some(Settings::DEFAULT_GRADATION) };
    let typed = SliderRow::typed_so_far(ui, SLOPE, "").filter(|_| gradation.is_some());
    let candidate = typed.map(Some).or((toggle.hovered() && !toggle.changed()).then_some(other));
    let kinds = [Setting::Gradation(None).kind()];
    size_price_row(ui, state, &kinds, candidate.map(Setting::Gradation), commands);
}

/// The name of the number.
const SLOPE: &str = "Gradation g";

fn slope_row(ui: &mut Ui, mut slope: f64, commands: &mut Vec<Command>) {
    let row = SliderRow::new(SLOPE, &mut slope, 0.02..=2.0).logarithmic();
    let row = row.typed_range(f64::MIN_POSITIVE..=f64::MAX).default(Settings::DEFAULT_GRADATION);
    let help = "Largest change of h̄ per unit of length, over the whole stack: the smaller, the more slowly \
                triangles grow with the distance from fine places.";
    let response = row.help(help).show(ui);
    if response.changed() {
        commands.push(Command::from(EditCommand::Set(Setting::Gradation(Some(slope)))));
    }
    end_gesture_when_released(&response, commands);
}
