//! Lines: from files and drawn, their list, their corners, and which parts are on edges.

mod deepest;
mod drawing;
mod editing;
mod files;
mod fit;
mod snapping;

use eframe::egui::Modifiers;
use glam::DVec2;

use super::{LineTool, LineToolMode, LinesCommand};
use crate::app::tests::{Window, click, key, send, settings, wait_until, window};
use eframe::egui::Key;
use meshbrush_core::domain::Line;
use meshbrush_kit::kit::command::{Command, FileCommand};

/// Returns a new document, with the line tool.
fn with_tool(mode: LineToolMode) -> Window {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(LinesCommand::Mode(mode)));
    wait_until(&mut window, |window| window.state().session().boundary_pieces().is_some());
    window
}

/// Clicks corners, and ends the line.
fn draw(window: &mut Window, corners: &[DVec2]) {
    for &corner in corners {
        click(window, corner, Modifiers::NONE);
    }
    key(window, Modifiers::NONE, Key::Enter);
}

fn tool(window: &Window) -> &LineTool {
    window.state().tools().settings::<LineTool>()
}

fn lines(window: &Window) -> &[Line] {
    &settings(window).lines
}

fn names(window: &Window) -> Vec<&str> {
    lines(window).iter().map(|line| &*line.name).collect()
}

/// Returns whether points are where a person pointed: a click is at most a pixel beside.
fn are_near(points: &[DVec2], wanted: &[DVec2]) -> bool {
    let near = |(a, b): (&DVec2, &DVec2)| a.distance(*b) < 2e-3;
    points.len() == wanted.len() && points.iter().zip(wanted).all(near)
}

/// Waits until it is known how the mesh fits the lines.
fn wait_for_fits(window: &mut Window) {
    wait_until(window, |window| {
        let fits = window.state().session().derived().map(|derived| derived.line_fits.clone());
        fits.is_some_and(|fits| {
            let names = fits.iter().map(|fit| &*fit.name);
            names.eq(settings(window).lines.iter().map(|line| &*line.name))
        })
    });
}
