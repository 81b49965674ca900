//! A window without a display, and a folder for its files.

use std::fs;
use std::path::{Path, PathBuf};

use eframe::egui::vec2;
use egui_kittest::Harness;
use glam::dvec2;
use meshbrush::app::App;
use meshbrush::app::command::Command;
use meshbrush::document::Document;

pub type Window = Harness<'static, App>;

/// The title of the first example once it is edited.
pub const EDITED: &str = "Radar threats — edited";

pub fn window() -> Window {
    let mut window = Harness::builder()
        .with_size(vec2(1440.0, 900.0))
        .with_max_steps(4000)
        .build_eframe(|cc| App::new(&cc.egui_ctx, None).unwrap());
    window.run();
    window
}

/// An empty folder of its own for each test `name` of the file `of`.
pub fn folder(of: &str, name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(of).join(name);
    let _ = fs::remove_dir_all(&folder); // absent at the first run
    fs::create_dir_all(&folder).unwrap();
    folder
}

pub fn send(window: &mut Window, command: Command) {
    window.state_mut().send(command);
    window.run();
}

/// A short stroke upwards at an x of the unit square.
pub fn paint(window: &mut Window, at: f64) {
    send(window, Command::BeginStroke(dvec2(at, 0.5)));
    send(window, Command::DrawTo(dvec2(at, 0.6)));
    send(window, Command::EndStroke);
}

pub fn document(window: &Window) -> &Document {
    window.state().session().document()
}
