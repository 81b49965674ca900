use eframe::egui::{ThemePreference, Ui};

use super::super::App;
use super::super::command::Command;
use super::super::view::FieldOverlay;
use super::super::widgets::{Section, dropdown_row, segmented, toggle_row};
use crate::colormap::Colormap;

impl App {
    pub(super) fn view_ui(&mut self, ui: &mut Ui) {
        Section::new("View").closed().show(ui, |ui| {
            let mut edges = self.view.edges;
            if toggle_row(ui, "Edges", &mut edges).changed() {
                self.commands.push(Command::ToggleEdges);
            }
            let mut map = self.view.colormap;
            if dropdown_row(ui, "Colours", &mut map, &Colormap::ALL.map(|map| (map, map.name()))).changed() {
                self.commands.push(Command::Colormap(map));
            }
            let mut overlay = self.view.overlay;
            let overlays = [
                (FieldOverlay::None, "No overlay"),
                (FieldOverlay::Risk, "Risk"),
                (FieldOverlay::Target, "Target"),
            ];
            if segmented(ui, "Field overlay", &mut overlay, &overlays).changed() {
                let shown = if overlay == FieldOverlay::None { self.view.overlay } else { overlay };
                self.commands.push(Command::Overlay(shown));
            }
            let mut theme = self.theme;
            let themes = [
                (ThemePreference::Dark, "Dark"),
                (ThemePreference::Light, "Light"),
                (ThemePreference::System, "Desktop"),
            ];
            if segmented(ui, "Theme", &mut theme, &themes).changed() {
                self.commands.push(Command::Theme(theme));
            }
        });
    }
}
