//! The deepest way between two clicks.

use std::sync::Arc;

use eframe::egui::{Key, Modifiers};
use glam::{DVec2, dvec2};

use super::{lines, names, tool, wait_for_fits};
use crate::app::features::lines::{LineToolMode, LinesCommand};
use crate::app::tests::{
    Window, click, entries, key, notice, send, settings, show, wait_for_jobs, wait_until, window,
};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::{DepthRule, DepthSizes, Depths, Layer, LayerKind, PositiveDepth, RasterSource};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_mesh::geometry::Rect;

/// Side of the grid of depths in pixels.
const SIDE: u32 = 160;

/// Returns a document with these depths, and the mode that follows the deepest way.
fn with_depths(depth: impl Fn(DVec2) -> f64) -> Window {
    let at = |n: u32| (dvec2((n % SIDE).into(), (n / SIDE).into()) + 0.5) / f64::from(SIDE);
    let values = (0..SIDE * SIDE).map(|n| depth(at(n)) as f32).collect();
    let raster = Arc::new(RasterPyramid::new(Raster::from_values(Rect::UNIT, [SIDE; 2], values)));
    let source = RasterSource { name: "soundings".into(), raster };
    let (positive, rule) = (PositiveDepth::Down, DepthRule::Nothing);
    let sizes = DepthSizes { positive, offset: 0.0, between: DepthSizes::ALL_WATER, rule };
    let layers = Layer::stack([LayerKind::constant(0.05), Depths::new(source, sizes).into()]);
    let mut window = window();
    send(&mut window, show(Settings { layers, ..Settings::default() }));
    send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::DeepestWay)));
    wait_until(&mut window, |window| {
        let session = window.state().session();
        session.follower().is_in_step(session.document())
    });
    window
}

fn thalweg(x: f64) -> f64 {
    0.5 + 0.2 * (std::f64::consts::TAU * x).sin()
}

#[test]
fn two_clicks_follow_a_trough_and_the_way_is_a_line_on_edges() {
    let trough = |at: DVec2| 30.0 - 28.0 * ((at.y - thalweg(at.x)) / 0.15).powi(2).min(1.0);
    let mut window = with_depths(trough);
    let ends = [0.05, 0.95].map(|x| dvec2(x, thalweg(x)));
    click(&mut window, ends[0], Modifiers::NONE);
    assert!(tool(&window).way_from.is_some());
    click(&mut window, ends[1], Modifiers::NONE);
    wait_until(&mut window, |window| !lines(window).is_empty());
    assert_eq!(
        (names(&window), entries(&window), tool(&window).selected),
        (vec!["deepest way 1"], 1, Some(0))
    );
    let line = lines(&window)[0].clone();
    assert!((6..80).contains(&line.points.len()) && !line.closed, "{} corners", line.points.len());
    for pair in line.points.windows(2) {
        for n in 0..=10 {
            let at = pair[0].lerp(pair[1], f64::from(n) / 10.0);
            assert!((at.y - thalweg(at.x)).abs() < 0.04, "{at} is beside the thalweg");
        }
    }
    wait_for_fits(&mut window);
    let fit = window.state().session().derived().unwrap().line_fits[0].clone();
    assert!(fit.length_on_edges > 0.8 * fit.length, "{} of {}", fit.length_on_edges, fit.length);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(lines(&window).is_empty());
}

#[test]
fn a_dam_and_an_end_on_land_are_told() {
    let dam = |at: DVec2| if (at.x - 0.5).abs() < 0.03 { -1.0 } else { 8.0 };
    let mut window = with_depths(dam);
    click(&mut window, dvec2(0.2, 0.5), Modifiers::NONE);
    click(&mut window, dvec2(0.8, 0.5), Modifiers::NONE);
    wait_until(&mut window, |window| notice(window).contains("No way in water was found"));
    click(&mut window, dvec2(0.2, 0.5), Modifiers::NONE);
    click(&mut window, dvec2(0.5, 0.5), Modifiers::NONE);
    wait_until(&mut window, |window| notice(window).contains("has no goal in water"));
    assert_eq!((lines(&window).len(), entries(&window)), (0, 0));
}

#[test]
fn without_depths_the_window_says_what_is_missing() {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::DeepestWay)));
    assert!(notice(&window).contains("needs depths"), "{}", notice(&window));
    click(&mut window, dvec2(0.2, 0.5), Modifiers::NONE);
    click(&mut window, dvec2(0.8, 0.5), Modifiers::NONE);
    assert!(tool(&window).way_from.is_none() && settings(&window).lines.is_empty());
}

#[test]
fn escape_takes_the_first_end_back_and_another_document_drops_the_search() {
    let mut window = with_depths(|_| 8.0);
    click(&mut window, dvec2(0.2, 0.5), Modifiers::NONE);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(tool(&window).way_from.is_none());
    window.state_mut().send(Command::from(LinesCommand::WayAt(dvec2(0.2, 0.5))));
    window.state_mut().send(Command::from(LinesCommand::WayAt(dvec2(0.8, 0.5))));
    window.state_mut().send(Command::from(FileCommand::New));
    window.run();
    wait_for_jobs(&mut window);
    assert!(lines(&window).is_empty() && notice(&window).is_empty(), "{}", notice(&window));
}
