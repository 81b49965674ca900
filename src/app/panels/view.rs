//! How the mesh is shown.

use std::ops::RangeInclusive;

use eframe::egui::{Response, ThemePreference, Ui};

use meshbrush_core::earth::EarthPlane;
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::command::{Command, SpaceCommand, ViewCommand};
use meshbrush_kit::kit::coordinates::CoordinateStyle;
use meshbrush_kit::kit::view::{CanvasAid, FieldOverlay};
use meshbrush_render::colormap::Colormap;
use meshbrush_render::scene::{Light, ViewDirection};
use meshbrush_ui::widgets::{NumberRow, choice_rows, segmented, toggle_row};

/// What is shown in place of the colours of levels.
pub fn overlay_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut overlay = state.view.overlay;
    let choices: Vec<_> = FieldOverlay::ALL.iter().map(|&overlay| (overlay, overlay.name())).collect();
    if choice_rows(ui, "Overlay", &mut overlay, &choices).changed() {
        commands.push(Command::from(ViewCommand::SetOverlay(overlay)));
    }
}

/// Edges, aids, colours and theme.
pub fn rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let view = state.view;
    let mut edges = view.edges;
    if toggle_row(ui, "Edges", &mut edges).changed() {
        commands.push(Command::from(ViewCommand::ToggleEdges));
    }
    for (name, aid, mut shown) in [
        ("Coordinates", CanvasAid::Coordinates, view.aids.coordinates),
        ("Graticule", CanvasAid::Graticule, view.aids.graticule),
        ("Scale bar", CanvasAid::ScaleBar, view.aids.scale_bar),
        ("Levels", CanvasAid::Levels, view.aids.levels),
        ("Contours of h̄", CanvasAid::Contours, view.aids.contours),
    ] {
        if toggle_row(ui, name, &mut shown).changed() {
            commands.push(Command::from(ViewCommand::ToggleAid(aid)));
        }
    }
    coordinate_rows(ui, state, commands);
    space_rows(ui, state, commands);
    ui.add_space(4.0);
    let mut map = view.colormap;
    if choice_rows(ui, "Colours", &mut map, &Colormap::ALL.map(|map| (map, map.name()))).changed() {
        commands.push(Command::from(ViewCommand::Colormap(map)));
    }
    ui.add_space(8.0);
    let mut theme = view.theme;
    let themes = [
        (ThemePreference::Dark, "Dark"),
        (ThemePreference::Light, "Light"),
        (ThemePreference::System, "Desktop"),
    ];
    if segmented(ui, "Theme", &mut theme, &themes).changed() {
        commands.push(Command::from(ViewCommand::Theme(theme)));
    }
}

/// The coordinates of places, in documents on the Earth.
fn coordinate_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    if EarthPlane::new(settings.domain.projection, settings.unit).is_none() {
        return;
    }
    let mut style = state.view.coordinates;
    if choice_rows(ui, "Places in", &mut style, &CoordinateStyle::ALL.map(|style| (style, style.name())))
        .changed()
    {
        commands.push(Command::from(ViewCommand::Coordinates(style)));
    }
}

/// The view in space: whether it is shown, from where, and in which light.
fn space_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let space = &state.view.space;
    let mut send = |command| commands.push(Command::from(ViewCommand::Space(command)));
    let mut is_on = space.is_on;
    if toggle_row(ui, "In space", &mut is_on).changed() {
        send(SpaceCommand::Toggle);
    }
    if !space.is_on {
        return;
    }
    let default = space.default_factor(state.session.mesh().lattice());
    let mut factor = space.exaggeration.unwrap_or(default);
    if number(ui, "Heights ×", &mut factor, 1e-6..=1e6, default, "").changed() {
        send(SpaceCommand::Exaggerate((factor != default).then_some(factor)));
    }
    let (mut direction, standard) = (space.direction, ViewDirection::default());
    let azimuth = number(ui, "Look to", &mut direction.azimuth, 0.0..=360.0, standard.azimuth, "°");
    let altitude = number(ui, "From above", &mut direction.altitude, 5.0..=90.0, standard.altitude, "°");
    if azimuth.changed() || altitude.changed() {
        send(SpaceCommand::LookFrom(direction));
    }
    let (mut light, standard) = (space.light, Light::default());
    let azimuth = number(ui, "Light from", &mut light.azimuth, 0.0..=360.0, standard.azimuth, "°");
    let altitude = number(ui, "Light above", &mut light.altitude, 5.0..=90.0, standard.altitude, "°");
    if azimuth.changed() || altitude.changed() {
        send(SpaceCommand::Light(light));
    }
}

fn number(
    ui: &mut Ui,
    name: &'static str,
    value: &mut f64,
    range: RangeInclusive<f64>,
    default: f64,
    unit: &str,
) -> Response {
    NumberRow::new(name, value).aligned_with("Light above").range(range).default(default).unit(unit).show(ui)
}
