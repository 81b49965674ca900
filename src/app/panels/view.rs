//! How the mesh is shown.

use eframe::egui::{ThemePreference, Ui};

use crate::app::command::{Command, ViewCommand};
use crate::app::kit::FrameState;
use crate::app::view::{CanvasAid, FieldOverlay};
use crate::app::widgets::{choice_rows, segmented, toggle_row};
use meshbrush_render::colormap::Colormap;

/// What is shown in place of the colours of levels.
pub fn overlay_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut overlay = state.view.overlay;
    let choices = FieldOverlay::ALL.map(|overlay| (overlay, overlay.name()));
    if choice_rows(ui, "Overlay", &mut overlay, &choices).changed() {
        commands.push(Command::View(ViewCommand::SetOverlay(overlay)));
    }
}

/// Edges, aids, colours and theme.
pub fn rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let view = state.view;
    let mut edges = view.edges;
    if toggle_row(ui, "Edges", &mut edges).changed() {
        commands.push(Command::View(ViewCommand::ToggleEdges));
    }
    for (name, aid, mut shown) in [
        ("Coordinates", CanvasAid::Coordinates, view.aids.coordinates),
        ("Graticule", CanvasAid::Graticule, view.aids.graticule),
        ("Scale bar", CanvasAid::ScaleBar, view.aids.scale_bar),
        ("Contours of h̄", CanvasAid::Contours, view.aids.contours),
    ] {
        if toggle_row(ui, name, &mut shown).changed() {
            commands.push(Command::View(ViewCommand::ToggleAid(aid)));
        }
    }
    ui.add_space(4.0);
    let mut map = view.colormap;
    if choice_rows(ui, "Colours", &mut map, &Colormap::ALL.map(|map| (map, map.name()))).changed() {
        commands.push(Command::View(ViewCommand::Colormap(map)));
    }
    ui.add_space(8.0);
    let mut theme = view.theme;
    let themes = [
        (ThemePreference::Dark, "Dark"),
        (ThemePreference::Light, "Light"),
        (ThemePreference::System, "Desktop"),
    ];
    if segmented(ui, "Theme", &mut theme, &themes).changed() {
        commands.push(Command::View(ViewCommand::Theme(theme)));
    }
}
