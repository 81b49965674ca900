use eframe::egui::{Color32, Ui};

use super::super::App;
use super::super::view::deepest_level;
use super::super::widgets::{LevelLegend, LevelRow, Section, format};
use crate::colormap::LevelColors;

/// Height of the legend in points, however many levels there are: the sections below must not move away from under a
/// pointer that drags the coarse spacing or the smallest diameter.
const HEIGHT: f32 = 224.0;

impl App {
    /// The legend is the histogram: same colours as on the canvas, counts beside the bars.
    pub(super) fn levels_ui(&mut self, ui: &mut Ui) {
        let total = self.session.mesh().triangle_count();
        let note = format!("{} triangles", format::count(total as u64));
        Section::new("Levels").note(&note).show(ui, |ui| {
            let settings = self.session.follower().settings();
            let colors = self.view.level_colors(settings);
            let counts = self.session.level_counts();
            let rows = usize::from(deepest_level(settings)) + 1;
            let rows: Vec<_> =
                (0..counts.len().max(rows).min(64)).map(|level| self.level_row(level, &colors)).collect();
            let under_pointer =
                self.pointer_world.and_then(|point| self.session.mesh().locate(point).triangle());
            let lit = under_pointer.map(|id| self.session.mesh().triangle(id).level());
            ui.set_min_height(HEIGHT);
            let legend = LevelLegend::new(&rows).lit(lit).max_height(HEIGHT).show(ui);
            self.view.lone_level = legend.hovered;
        });
    }

    fn level_row(&self, level: usize, colors: &LevelColors) -> LevelRow {
        let [r, g, b, _] = colors.of(level as u8);
        LevelRow {
            level: level as u32,
            color: Color32::from_rgb(r, g, b),
            count: self.session.level_counts().get(level).copied().unwrap_or(0) as u64,
            diameter: self.session.mesh().diameter(level as u32),
        }
    }
}
