//! How the mesh is shown.

use eframe::egui::{ThemePreference, Ui};

use crate::app::command::{Command, ViewCommand};
use crate::app::kit::{FrameState, Panel, PanelGroup};
use crate::app::view::{CanvasAid, FieldOverlay};
use crate::app::widgets::{Section, dropdown_row, segmented, toggle_row};
use meshbrush_render::colormap::Colormap;

/// Edges, colours, overlay and theme.
pub static VIEW: Panel = Panel { name: "view", group: PanelGroup::View, only_with_tool: false, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let view = state.view;
    Section::new("View").closed().show(ui, |ui| {
        let mut edges = view.edges;
        if toggle_row(ui, "Edges", &mut edges).changed() {
            commands.push(Command::View(ViewCommand::ToggleEdges));
        }
        for (name, aid, mut shown) in [
            ("Coordinates", CanvasAid::Coordinates, view.aids.coordinates),
            ("Scale bar", CanvasAid::ScaleBar, view.aids.scale_bar),
            ("Contours of h̄", CanvasAid::Contours, view.aids.contours),
        ] {
            if toggle_row(ui, name, &mut shown).changed() {
                commands.push(Command::View(ViewCommand::ToggleAid(aid)));
            }
        }
        let mut map = view.colormap;
        if dropdown_row(ui, "Colours", &mut map, &Colormap::ALL.map(|map| (map, map.name()))).changed() {
            commands.push(Command::View(ViewCommand::Colormap(map)));
        }
        let mut overlay = view.overlay;
        let overlays = [
            (FieldOverlay::None, "No overlay"),
            (FieldOverlay::Risk, "Risk"),
            (FieldOverlay::Target, "Target"),
            (FieldOverlay::Layer, "Layer"),
            (FieldOverlay::Slack, "Slack"),
            (FieldOverlay::Forced, "Forced"),
            (FieldOverlay::Age, "Age"),
        ];
        if dropdown_row(ui, "Overlay", &mut overlay, &overlays).changed() {
            commands.push(Command::View(ViewCommand::SetOverlay(overlay)));
        }
        let mut theme = view.theme;
        let themes = [
            (ThemePreference::Dark, "Dark"),
            (ThemePreference::Light, "Light"),
            (ThemePreference::System, "Desktop"),
        ];
        if segmented(ui, "Theme", &mut theme, &themes).changed() {
            commands.push(Command::View(ViewCommand::Theme(theme)));
        }
    });
}
