//! The pictures of the manual.

use std::path::{Path, PathBuf};

use eframe::egui::{Rect, Vec2, vec2};
use glam::dvec2;

use super::{OffscreenWindow, boundary, look_at, make_folder, point_at, write_picture};
use crate::app::features::inspection::InspectCommand;
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_render::render::Image;
use meshbrush_ui::theme::metrics::PANEL_WIDTH;

/// Size of the windows of which a picture shows the most part, in points.
const WINDOW: Vec2 = vec2(980.0, 640.0);
/// Size of a window of which a picture shows the canvas only.
const SQUARE: Vec2 = vec2(360.0, 460.0);
/// Height of a window whose lower dock shows all of the tab *Size*, and of that dock, in points.
const TALL: f32 = 1140.0;
const LOWER_DOCK: f32 = 582.0;
/// Height of the hint at the bottom of the canvas, in points.
const HINT: f32 = 56.0;
/// A level beyond those of the first example.
const NO_LEVEL: u32 = 62;
/// Pixels between two pictures side by side, and their colour.
const GAP: usize = 12;
const GAP_COLOR: [u8; 4] = [0x15, 0x18, 0x1e, 0xff];

/// Writes every picture of the manual into a folder, and returns the files.
///
/// # Errors
/// Fails with a sentence when there is no graphics driver or a file cannot be written.
pub fn write(folder: &Path) -> Result<Vec<PathBuf>, String> {
    make_folder(folder)?;
    let pictures = [
        ("window", window()?),
        ("how-it-works", how_it_works()?),
        ("panel", panel()?),
        ("triangle", triangle()?),
    ];
    let boundary = ("boundary", sea()?);
    pictures.iter().chain([&boundary]).map(|(name, picture)| write_picture(folder, name, picture)).collect()
}

/// Returns the first example, about to be painted on.
fn window() -> Result<Image, String> {
    let mut window = OffscreenWindow::open(WINDOW, 1.0)?;
    window.send(Command::from(InspectCommand::Query(dvec2(0.651, 0.464))));
    point_at(&mut window, dvec2(0.56, 0.66));
    window.picture()
}

/// Returns the lower dock of the first example: the transfer curve, gradation and budgets.
fn panel() -> Result<Image, String> {
    let mut window = OffscreenWindow::open(vec2(WINDOW.x, TALL), 1.0)?;
    let picture = window.picture()?;
    let canvas = window.canvas_rect().ok_or("The window has no canvas.")?;
    let corner = canvas.right_bottom() - vec2(0.0, LOWER_DOCK);
    Ok(cropped(&picture, Rect::from_min_size(corner, vec2(PANEL_WIDTH, LOWER_DOCK))))
}

/// Returns a queried triangle with its neighbours.
fn triangle() -> Result<Image, String> {
    let mut window = canvas_window(SQUARE)?;
    let place = dvec2(0.593, 0.2215);
    look_at(&mut window, place, 6.0);
    window.send(Command::from(InspectCommand::Query(place)));
    canvas_of(&mut window)
}

/// Returns the pieces of a coast.
fn sea() -> Result<Image, String> {
    let mut window = canvas_window(vec2(560.0, 560.0))?;
    boundary(&mut window);
    canvas_of(&mut window)
}

/// Painted risk, the target diameter made from it, and the mesh.
fn how_it_works() -> Result<Image, String> {
    let mut window = canvas_window(SQUARE)?;
    look_at(&mut window, dvec2(0.72, 0.74), 2.2);
    window.send(Command::from(ViewCommand::ToggleEdges));
    // No triangle has this level: the overlay alone is drawn.
    window.send(Command::from(ViewCommand::ShowLevel(Some(NO_LEVEL))));
    window.send(Command::from(ViewCommand::SetOverlay(FieldOverlay::Risk)));
    let risk = canvas_of(&mut window)?;
    window.send(Command::from(ViewCommand::SetOverlay(FieldOverlay::Target)));
    let target = canvas_of(&mut window)?;
    window.send(Command::from(ViewCommand::SetOverlay(FieldOverlay::None)));
    window.send(Command::from(ViewCommand::ShowLevel(None)));
    window.send(Command::from(ViewCommand::ToggleEdges));
    let mesh = canvas_of(&mut window)?;
    Ok(side_by_side(&[risk, target, mesh]))
}

/// Returns a window without panels that shows the whole first example.
fn canvas_window(size: Vec2) -> Result<OffscreenWindow, String> {
    let mut window = OffscreenWindow::open(size, 1.0)?;
    window.send(Command::from(ViewCommand::TogglePanels));
    window.send(Command::from(ViewCommand::Fit));
    Ok(window)
}

/// Returns the canvas without the hint below it.
fn canvas_of(window: &mut OffscreenWindow) -> Result<Image, String> {
    let picture = window.picture()?;
    let canvas = window.canvas_rect().ok_or("The window has no canvas.")?;
    Ok(cropped(&picture, canvas.with_max_y(canvas.bottom() - HINT)))
}

/// Returns the part of a picture within a rectangle in points; a point is a pixel.
fn cropped(picture: &Image, part: Rect) -> Image {
    let [width, _] = picture.size.map(|side| side as usize);
    let (left, right) = (part.left() as usize, part.right() as usize);
    let rows = part.top() as usize..part.bottom() as usize;
    let size = [(right - left) as u32, rows.len() as u32];
    let rgba =
        rows.flat_map(|y| &picture.rgba[4 * (y * width + left)..4 * (y * width + right)]).copied().collect();
    Image { size, rgba }
}

/// Pictures of one height in a row.
fn side_by_side(pictures: &[Image]) -> Image {
    let mut rgba = Vec::new();
    let height = pictures[0].size[1];
    for y in 0..height as usize {
        for (number, picture) in pictures.iter().enumerate() {
            if number > 0 {
                rgba.extend(GAP_COLOR.repeat(GAP));
            }
            let width = 4 * picture.size[0] as usize;
            rgba.extend(&picture.rgba[y * width..(y + 1) * width]);
        }
    }
    let width = rgba.len() / 4 / height as usize;
    Image { size: [width as u32, height], rgba }
}
