//! What the window asks of a desktop: to be opened, a folder for the data of the program, and file dialogs.
//! In a browser [`web`](super) does the same.

mod assets;
mod file_dialog;
pub mod journal;

use std::path::PathBuf;

use eframe::egui::{self, DroppedFileHandle, vec2};

use super::{App, NO_DRIVER, SMALLEST_SIZE, set_up_gpu};
pub use assets::{asset, fetch};
pub use file_dialog::{ask, has_dialog};
use meshbrush_kit::kit::background::Background;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::jobs::Jobs;

/// Identifies the window to the desktop: the name of the desktop entry in `packaging`.
const APP_ID: &str = "org.meshbrush.Meshbrush";
/// The name of the program's folder among the user's data.
const DATA_FOLDER: &str = "meshbrush";
/// Initial size of the window, in points: it fits a screen of 1440 × 900 with its frame.
const FIRST_SIZE: [f32; 2] = [1360.0, 800.0];

/// Returns the address of the page: a desktop shows none.
pub fn address() -> String {
    String::new()
}

/// Returns the folder for the data of the program, where the system has one.
pub fn data_folder() -> Option<PathBuf> {
    eframe::storage_dir(DATA_FOLDER)
}

/// Returns the commands for files that were dropped on the window.
pub fn take_dropped(files: &[DroppedFileHandle], _: &mut Background, _: &Jobs) -> Vec<Command> {
    files.iter().map(|file| Command::from(FileCommand::AddData(file.path().to_owned()))).collect()
}

/// Returns the command that notes the pressure of a pen: on a desktop it comes with the events of touches.
pub fn take_pen() -> Option<Command> {
    None
}

/// Opens the window on a file or on the first example, and returns when it is closed.
///
/// # Errors
/// Fails with a sentence when there is no display or no usable graphics driver.
pub fn run(file: Option<PathBuf>) -> Result<(), String> {
    let mut options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Meshbrush")
            .with_app_id(APP_ID)
            .with_icon(window_icon())
            .with_inner_size(FIRST_SIZE)
            .with_min_inner_size(vec2(SMALLEST_SIZE[0], SMALLEST_SIZE[1])),
        persistence_path: data_folder().map(|folder| folder.join("app.ron")),
        ..eframe::NativeOptions::default()
    };
    set_up_gpu(&mut options.wgpu_options);
    let create = |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        Ok(Box::new(App::in_window(cc, file)?))
    };
    eframe::run_native(APP_ID, options, Box::new(create)).map_err(failure_to_open)
}

fn window_icon() -> egui::IconData {
    let icon = include_bytes!("../../../assets/icon.png");
    eframe::icon_data::from_png_bytes(icon).unwrap_or_default()
}

/// Returns the message when the window did not open.
fn failure_to_open(error: eframe::Error) -> String {
    match error {
        eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => {
            "There is no display to open a window on. Set DISPLAY or WAYLAND_DISPLAY, or use the command line: \
             meshbrush mesh --help."
                .into()
        }
        eframe::Error::Wgpu(_) => NO_DRIVER.into(),
        other => format!("The window could not be opened: {other}."),
    }
}
