//! The bar under the canvas: to go from step to step.

use eframe::egui::{Align, Layout, Rect, RichText, Sense, Slider, Ui, UiBuilder, WidgetInfo, vec2};

use super::steps::SPEEDS;
use super::{StepCommand, Steps};
use meshbrush_kit::kit::command::Command;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{Icon, ToolButton, format, segmented, tips};

/// Height of the bar, in points.
pub const HEIGHT: f32 = 52.0;
/// Room for the number of the step, and for the speeds.
const COUNTER: f32 = 170.0;
const SPEED: f32 = 220.0;

/// First, back, play, forward, last; which step of how many; a slider; the speed.
pub fn step_bar(ui: &mut Ui, steps: &Steps, commands: &mut Vec<Command>) {
    let (position, count) = steps.player().map_or((0, 0), |player| (player.position(), player.len()));
    let mut send = |command| commands.push(Command::from(command));
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let play = if steps.is_playing() {
            (Icon::PAUSE, "Pause the steps")
        } else {
            (Icon::PLAY, "Play the steps")
        };
        let buttons = [
            (Icon::FIRST, "First step", "First step", position > 0, StepCommand::GoTo(0)),
            (Icon::BACK, "Previous step", "Previous step", position > 0, StepCommand::Move(-1)),
            (play.0, play.1, "Play the steps", count > 0, StepCommand::TogglePlay),
            (Icon::FORWARD, "Next step", "Next step", position < count, StepCommand::Move(1)),
            (Icon::LAST, "Last step", "Last step", position < count, StepCommand::GoTo(count)),
        ];
        for (icon, name, entry, is_enabled, command) in buttons {
            let button = ToolButton::new(icon, name).entry(entry);
            if ui.add_enabled_ui(is_enabled, |ui| button.show(ui)).inner.clicked() {
                send(command);
            }
        }
        let (counter, _) = ui.allocate_exact_size(vec2(COUNTER, HEIGHT), Sense::hover());
        let mut step = position;
        ui.spacing_mut().slider_width = (ui.available_width() - SPEED - 100.0).max(60.0);
        let slider = ui.add_enabled(count > 0, Slider::new(&mut step, 0..=count.max(1)).show_value(false));
        slider.widget_info(|| WidgetInfo::slider(true, position as f64, "Step"));
        let slider = tips::explain(ui, slider, tips::sentence("Step"));
        if slider.changed() {
            send(StepCommand::GoTo(step));
        }
        // After the slider: the number is that of its thumb, in the same frame.
        show_counter(ui, counter, step, count);
        ui.add_space(8.0);
        ui.label(RichText::new("Steps per second").font(font::caption()).color(tokens(ui).label));
        let mut speed = steps.speed();
        ui.allocate_ui_with_layout(vec2(SPEED - 20.0, 28.0), Layout::top_down(Align::Min), |ui| {
            if segmented(ui, "Steps per second", &mut speed, &SPEEDS).changed() {
                send(StepCommand::Speed(speed));
            }
        });
    });
}

/// Which step of how many.
fn show_counter(ui: &mut Ui, room: Rect, step: usize, count: usize) {
    let text = format!("Step {} of {}", format::count(step as u64), format::count(count as u64));
    let text = RichText::new(text).font(font::strong()).color(tokens(ui).value);
    // A child of its own, which does not move what follows.
    let left = UiBuilder::new().max_rect(room).layout(Layout::left_to_right(Align::Center));
    let mut ui = ui.new_child(left);
    ui.add_space(8.0);
    ui.label(text);
}
