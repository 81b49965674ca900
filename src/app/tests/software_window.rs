//! The window that is drawn in software.

use eframe::egui::{Context, Key, Modifiers};
use glam::dvec2;

use super::pictures::{Picture, picture, window_drawn_by};
use super::{FREE, Window, click, key, move_to, send, stroke};
use crate::app::App;
use crate::app::software_window::SoftwareWindow;
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;

/// A channel may differ by this much: the driver dithers, and rounds in other places.
const TOLERANCE: u8 = 10;

/// Each frame waits for its jobs: two pictures of one state would differ where one of them shows more.
fn with_its_mesh_in_software(app: &mut App) {
    app.canvas.draw_in_software();
    app.jobs.wait_for_all();
}

fn in_software() -> Window {
    window_drawn_by(|app: &mut App, ctx: &Context| {
        with_its_mesh_in_software(app);
        ctx.add_plugin(app.canvas.software_window().expect("it has a driver"));
    })
}

/// Actions of a person.
const ACTIONS: [fn(&mut Window); 8] = [
    |window| move_to(window, FREE),
    |window| move_to(window, dvec2(0.8, 0.55)),
    |window| stroke(window, FREE, dvec2(0.8, 0.55)),
    |window| key(window, Modifiers::COMMAND, Key::Z),
    |window| key(window, Modifiers::NONE, Key::Q),
    |window| click(window, FREE, Modifiers::NONE),
    |window| send(window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Risk))),
    |window| send(window, Command::from(ViewCommand::SetOverlay(FieldOverlay::None))),
];

/// Returns the share of pixels that differ, and the first of them.
fn difference(a: &Picture, b: &Picture) -> (f64, Option<[usize; 2]>) {
    assert_eq!((a.width, a.rgba.len()), (b.width, b.rgba.len()));
    let pairs = a.rgba.as_chunks::<4>().0.iter().zip(b.rgba.as_chunks::<4>().0);
    let differ = |(a, b): (&[u8; 4], &[u8; 4])| (0..3).any(|i| a[i].abs_diff(b[i]) > TOLERANCE);
    let indices: Vec<usize> = pairs.enumerate().filter(|(_, pair)| differ(*pair)).map(|(i, _)| i).collect();
    let first = indices.first().map(|index| [index % a.width, index / a.width]);
    (indices.len() as f64 / (a.rgba.len() / 4) as f64, first)
}

#[test]
fn it_looks_like_a_window_that_the_driver_draws() {
    let mut windows = [window_drawn_by(|app, _| with_its_mesh_in_software(app)), in_software()];
    for (number, act) in ACTIONS.iter().enumerate() {
        let [driver, software] = windows.each_mut().map(|window| {
            act(window);
            picture(window)
        });
        let (share, first) = difference(&driver, &software);
        assert!(share < 0.001, "action {number}: {share} of the pixels differ, the first at {first:?}");
    }
}

#[test]
fn what_is_drawn_again_in_part_is_what_is_drawn_whole() {
    let mut window = in_software();
    for (number, act) in ACTIONS.iter().enumerate() {
        act(&mut window);
        let in_parts = picture(&mut window);
        window.ctx.with_plugin(SoftwareWindow::forget);
        window.step();
        let whole = picture(&mut window);
        let differing = in_parts.rgba.iter().zip(&whole.rgba).position(|(a, b)| a != b).map(|at| at / 4);
        let at = differing.map(|index| [index % whole.width, index / whole.width]);
        assert_eq!(at, None, "action {number}");
    }
}
