//! Which steps to export, and how.

use eframe::egui::Ui;

use super::export::MOST_FILES;
use super::files::EXPORT_STEPS;
use super::{StepCommand, Steps};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{FrameState, remark};
use meshbrush_render::colormap::Ground;
use meshbrush_ui::widgets::{ActionButton, NumberRow, Section, segmented, tips};

const NAME: &str = "Export steps…";
const GROUNDS: [(Ground, &str); 2] = [(Ground::Dark, "On dark"), (Ground::Light, "On light")];

/// The first step, the last one, the ground, and the button that asks for the file.
pub fn section(
    ui: &mut Ui,
    state: &FrameState<'_>,
    steps: &Steps,
    count: usize,
    commands: &mut Vec<Command>,
) {
    Section::new("Export").closed().show(ui, |ui| {
        let (range, ground) = (steps.export_range(), steps.export_ground.unwrap_or(state.view.ground));
        let (mut first, mut last) = (*range.start() as f64, *range.end() as f64);
        let steps = 0.0..=count as f64;
        let from = NumberRow::new("From step", &mut first).range(steps.clone()).integer().show(ui);
        let to = NumberRow::new("To step", &mut last).range(steps).integer().show(ui);
        if from.changed() || to.changed() {
            let command = StepCommand::ExportRange(first.max(0.0) as usize, last.max(0.0) as usize);
            commands.push(Command::from(command));
        }
        let mut ground = ground;
        let response = segmented(ui, "Ground of the drawings", &mut ground, &GROUNDS);
        if response.changed() {
            commands.push(Command::from(StepCommand::ExportGround(ground)));
        }
        let files = range.count();
        ui.add_space(4.0);
        let button = ActionButton::new(NAME);
        let fits = (1..=MOST_FILES).contains(&files);
        let response = ui.add_enabled(fits, button);
        if tips::explain(ui, response, tips::sentence(NAME)).clicked() {
            commands.push(Command::from(FileCommand::Ask(&EXPORT_STEPS)));
        }
        let text = match files {
            1 => "One drawing will be written.".into(),
            _ if fits => format!("{files} drawings will be written."),
            0 => "The first step comes after the last one.".into(),
            _ => format!("At most {MOST_FILES} drawings are written at once."),
        };
        remark(ui, &text);
    });
}
