//! The legend of the levels.

use eframe::egui::{Color32, Ui};

use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::view::deepest_level;
use meshbrush_kit::kit::{FrameState, Panel, Tab, light_level};
use meshbrush_render::colormap::LevelColors;
use meshbrush_ui::widgets::{ActionButton, LevelLegend, LevelRow, Section, format};

/// Height of the legend in points, for any number of levels: the sections below must not move while the
/// pointer drags the coarse spacing or the smallest diameter.
const HEIGHT: f32 = 224.0;

/// Room for the button that shows all levels again, in points.
const BUTTON_HEIGHT: f32 = 36.0;

/// The legend, which is the histogram as well: colours as on the canvas, counts beside the bars.
pub static LEVELS: Panel = Panel { name: "levels", tab: Tab::Mesh, place: 0, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let note = format!("{} triangles", format::count(state.session.triangle_count() as u64));
    let section = Section::new("Levels").note(&note).show(ui, |ui| {
        let settings = state.session.follower().settings();
        let colors = state.view.level_colors(settings);
        let counts = state.session.level_counts();
        let deepest = usize::from(deepest_level(settings)) + 1;
        let count = counts.len().max(deepest).min(64);
        let rows: Vec<_> = (0..count).map(|level| row(state, level, &counts, &colors)).collect();
        let under_pointer = state.pointer.and_then(|point| state.session.locate(point).triangle());
        let lit = under_pointer.map(|id| state.session.view().triangle(id).level());
        ui.set_min_height(HEIGHT);
        let hidden = state.view.hidden_levels;
        let height = if hidden == 0 { HEIGHT } else { HEIGHT - BUTTON_HEIGHT };
        let legend = LevelLegend::new(&rows).unit(state.unit()).lit(lit).hidden(hidden);
        let answer = legend.max_height(height).show(ui);
        if hidden != 0 && ui.add(ActionButton::new("Show all levels")).clicked() {
            commands.push(Command::from(ViewCommand::ShowAllLevels));
        }
        answer
    });
    let answer = section.unwrap_or_default();
    light_level(ui, "panel", answer.hovered, state, commands);
    commands.extend(answer.toggled.map(|level| Command::from(ViewCommand::ToggleLevel(level))));
    commands.extend(answer.isolated.map(|level| Command::from(ViewCommand::IsolateLevel(level))));
}

fn row(state: &FrameState<'_>, level: usize, counts: &[usize], colors: &LevelColors) -> LevelRow {
    let [r, g, b, _] = colors.of(level as u8);
    LevelRow {
        level: level as u32,
        color: Color32::from_rgb(r, g, b),
        count: counts.get(level).copied().unwrap_or(0) as u64,
        diameter: state.session.mesh().diameter(level as u32),
    }
}
