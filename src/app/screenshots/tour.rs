//! The first steps of a person, in one window.

use std::path::{Path, PathBuf};

use eframe::egui::{Event, Modifiers, PointerButton, Vec2, vec2};
use glam::{DVec2, dvec2};

use super::{OffscreenWindow, look_at, make_folder, on_screen, point_at, write_picture};
use crate::app::features::domain::{DomainCommand, DomainToolMode};
use crate::app::features::inspection::{InspectCommand, QUERY};
use crate::app::features::painting::ERASER;
use crate::app::file_kinds::{EXPORT_MESH, SAVE_PROJECT};
use crate::app::files::AEGEAN_SEA;
use crate::app::host::asset;
use meshbrush_io::io;
use meshbrush_kit::kit::command::{BrushCommand, Command, FileCommand, ShellCommand, ViewCommand};
use meshbrush_kit::kit::tools::BrushMode;

/// Size of the window, in points.
const WINDOW: Vec2 = vec2(980.0, 640.0);

/// A step: the name of its picture, and what is done before it is taken.
type TourStep = (&'static str, fn(&mut OffscreenWindow));

const STEPS: [TourStep; 8] = [
    ("1-open", |window| point_at(window, dvec2(26.4, 38.9))),
    ("2-paint", paint),
    ("3-erase", erase),
    ("4-pick", pick),
    ("5-query", query),
    ("6-cut", cut),
    ("7-save", |window| window.send(Command::from(FileCommand::Ask(&SAVE_PROJECT)))),
    ("8-export", export),
];

/// Writes a picture of each step into a folder, and returns the files.
///
/// # Errors
/// Fails with a sentence when there is no graphics driver or a file cannot be written.
pub fn write(folder: &Path) -> Result<Vec<PathBuf>, String> {
    make_folder(folder)?;
    let scratch = std::env::temp_dir().join("meshbrush-tour");
    make_folder(&scratch)?;
    let coast = scratch.join("coast.geojson");
    let sea = asset(AEGEAN_SEA).expect("it is part of the program");
    let written = io::write_file(&coast, |mut out| std::io::Write::write_all(&mut out, sea));
    written.map_err(|error| format!("{} cannot be written: {error}.", coast.display()))?;
    let mut window = OffscreenWindow::open_file(WINDOW, 1.0, coast)?;
    let pictures = STEPS.iter().map(|(name, act)| {
        act(&mut window);
        write_picture(folder, name, &window.picture()?)
    });
    pictures.collect()
}

/// A stroke along the middle of the sea.
fn paint(window: &mut OffscreenWindow) {
    window.send(Command::from(BrushCommand::Radius(0.25)));
    drag(window, &[dvec2(24.4, 38.9), dvec2(24.9, 38.4), dvec2(25.3, 37.9), dvec2(25.6, 37.2)]);
    point_at(window, dvec2(25.9, 36.9));
}

fn erase(window: &mut OffscreenWindow) {
    window.send(Command::from(ShellCommand::Use(&ERASER)));
    drag(window, &[dvec2(25.0, 38.3), dvec2(25.2, 38.1)]);
}

/// The value of the stroke, painted elsewhere.
fn pick(window: &mut OffscreenWindow) {
    window.send(Command::from(BrushCommand::Mode(BrushMode::BuildUp)));
    window.send(Command::from(BrushCommand::Pick(dvec2(25.5, 37.5))));
    drag(window, &[dvec2(25.9, 39.0), dvec2(25.6, 39.3)]);
    point_at(window, dvec2(25.2, 39.3));
}

fn query(window: &mut OffscreenWindow) {
    let place = dvec2(25.15, 37.75);
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    look_at(window, place, 8.0);
    window.send(Command::from(InspectCommand::Query(place)));
}

fn cut(window: &mut OffscreenWindow) {
    window.send(Command::from(ViewCommand::Fit));
    window.send(Command::from(DomainCommand::Mode(DomainToolMode::Polygon)));
    for corner in [dvec2(23.4, 40.2), dvec2(24.6, 40.5), dvec2(24.4, 39.6)] {
        window.send(Command::from(DomainCommand::AddCorner(corner)));
    }
    point_at(window, dvec2(23.6, 39.5));
}

fn export(window: &mut OffscreenWindow) {
    window.send(Command::from(ShellCommand::CloseDialog));
    window.send(Command::from(DomainCommand::ClosePolygon));
    window.send(Command::from(FileCommand::Ask(&EXPORT_MESH)));
}

fn drag(window: &mut OffscreenWindow, points: &[DVec2]) {
    point_at(window, points[0]);
    press(window, points[0], true);
    for &point in &points[1..] {
        point_at(window, point);
    }
    press(window, points[points.len() - 1], false);
}

fn press(window: &mut OffscreenWindow, world: DVec2, pressed: bool) {
    let pos = on_screen(window, world);
    let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
    window.event(Event::PointerButton { pos, button, pressed, modifiers });
}
