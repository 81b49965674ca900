//! An outline that is added to a document with paint.

use std::path::{Path, PathBuf};

use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::domain::DomainCommand;
use crate::app::features::pins::PinsCommand;
use crate::app::tests::{
    TALL, Window, area, document, entries, fingerprint, folder, has_raster, level_at, paint, send, settings,
    wait_for_notice, wait_until, window, window_of, window_with,
};
use meshbrush_core::layers::RasterReading;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, LayerCommand, ShellCommand};
use meshbrush_mesh::geometry::Rect;

/// Writes a file with a square that has a square hole.
fn square(name: &str, min: DVec2, side: f64) -> PathBuf {
    let ring = |min: DVec2, side: f64| {
        let [x, y, u, v] = [min.x, min.y, min.x + side, min.y + side];
        format!("[[{x}, {y}], [{u}, {y}], [{u}, {v}], [{x}, {v}], [{x}, {y}]]")
    };
    let (outer, hole) = (ring(min, side), ring(min + 0.1 * side, 0.2 * side));
    let file = folder("app-outline", name).join("coast.geojson");
    std::fs::write(&file, format!("{{\"type\": \"Polygon\", \"coordinates\": [{outer}, {hole}]}}")).unwrap();
    file
}

/// Returns a new document with a stroke at x = 0.5.
fn painted() -> Window {
    // Frames so short that no message fades while the mesh is built.
    let mut window = window_with(Harness::builder().with_size(TALL).with_step_dt(0.01));
    send(&mut window, Command::from(FileCommand::New));
    paint(&mut window, 0.5);
    window
}

fn wait_for_outline(window: &mut Window) {
    wait_until(window, |window| {
        settings(window).domain.region().is_some() && window.state().session().derived().is_some()
    });
}

#[test]
fn a_coast_comes_after_the_paint() {
    let mut window = painted();
    let (before, level) = (document(&window).paint().clone(), level_at(&window, dvec2(0.5, 0.55)));
    send(&mut window, Command::from(DomainCommand::AddOutline(square("inside", dvec2(0.2, 0.2), 0.6))));
    let message = wait_for_notice(&mut window);
    assert!(message.contains("was added to the domain"), "{message}");
    wait_for_outline(&mut window);
    assert!(*document(&window).paint() == before, "the bounds are the same, so is the paint");
    assert_eq!((settings(&window).domain.bounds, entries(&window)), (Rect::UNIT, 2));
    assert_eq!(level_at(&window, dvec2(0.5, 0.55)), level);
    let square = 0.36 * (1.0 - 0.04);
    assert!((settings(&window).domain.region().unwrap().area() - square).abs() < 1e-6, "with its hole");

    // A second outline is added to the first, which keeps its hole.
    send(
        &mut window,
        Command::from(DomainCommand::AddOutline(self::square("second", dvec2(0.85, 0.85), 0.1))),
    );
    wait_until(&mut window, |window| entries(window) == 3);
    let both = square + 0.01 * (1.0 - 0.04);
    assert!((settings(&window).domain.region().unwrap().area() - both).abs() < 1e-6);

    send(&mut window, Command::from(EditCommand::Undo));
    send(&mut window, Command::from(EditCommand::Undo));
    assert!(settings(&window).domain.region().is_none() && *document(&window).paint() == before);
    wait_until(&mut window, |window| (area(window) - 1.0).abs() < 1e-9);
}

#[test]
fn the_frame_grows_to_hold_an_outline_that_reaches_beyond_it() {
    let mut window = painted();
    let level = level_at(&window, dvec2(0.5, 0.55));
    send(&mut window, Command::from(DomainCommand::AddOutline(square("beyond", DVec2::splat(-0.5), 1.6))));
    let message = wait_for_notice(&mut window);
    assert!(message.contains("The frame grew"), "{message}");
    wait_for_outline(&mut window);
    assert_eq!(settings(&window).domain.bounds, Rect::new(DVec2::splat(-0.5), DVec2::splat(1.1)));
    let level_after = level_at(&window, dvec2(0.5, 0.55));
    assert!(level_after.abs_diff(level) <= 2, "the paint stays where it was: {level_after} and {level}");
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(settings(&window).domain.bounds, Rect::UNIT);
}

#[test]
fn an_outline_elsewhere_or_far_too_large_is_refused_with_a_sentence() {
    for (name, min, side, reason) in [
        ("elsewhere", dvec2(5.0, 5.0), 1.0, "lies outside this document"),
        ("large", dvec2(-1e5, -1e5), 4e5, "reaches too far beyond this document"),
    ] {
        let mut window = painted();
        let version = document(&window).version();
        send(&mut window, Command::from(DomainCommand::AddOutline(square(name, min, side))));
        let message = wait_for_notice(&mut window);
        assert!(message.contains(reason) && message.contains("coast.geojson"), "{message}");
        assert_eq!(document(&window).version(), version);
    }
}

/// Pins a point: an empty document would take the extent of the first grid.
fn keep_extent(window: &mut Window) {
    send(window, Command::from(PinsCommand::Add(dvec2(0.5, 0.5))));
}

/// Writes a grid of two pixels, of which the right one has no value.
fn write_grid(file: &Path, corner: f64, value: f64) -> PathBuf {
    let header = format!("ncols 2\nnrows 1\nxllcorner {corner}\nyllcorner 0.25\ncellsize 0.25\n");
    std::fs::write(file, format!("{header}NODATA_value -9\n{value} -9\n")).unwrap();
    file.to_owned()
}

#[test]
fn a_grid_opens_as_target_diameters_and_is_saved_with_the_document() {
    let folder = folder("app-outline", "diameters");
    let file = |name: &str| folder.join(name);
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    keep_extent(&mut window);
    send(&mut window, Command::from(LayerCommand::OpenDiameters(write_grid(&file("zero.asc"), 0.25, 0.0))));
    assert!(wait_for_notice(&mut window).contains("it must be positive"));
    send(
        &mut window,
        Command::from(LayerCommand::OpenDiameters(write_grid(&file("lengths.asc"), 0.25, 0.02))),
    );
    wait_until(&mut window, |window| has_raster(window, &RasterReading::Diameter));
    wait_until(&mut window, |window| level_at(window, dvec2(0.3, 0.4)) == 4);
    assert_eq!(level_at(&window, dvec2(0.9, 0.9)), 0);
    assert_eq!(crate::app::tests::value_of(&window, Role::Definition, "File"), "lengths.asc");
    let before = fingerprint(&window);
    let project = file("grid.meshbrush");
    send(&mut window, Command::from(FileCommand::SaveTo(project.clone())));
    wait_until(&mut window, |_| project.exists());
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(FileCommand::OpenProject(project.clone())));
    wait_until(&mut window, |window| has_raster(window, &RasterReading::Diameter));
    wait_until(&mut window, |window| fingerprint(window) == before);
}

#[test]
fn a_grid_opens_as_risk_at_its_own_place() {
    let folder = folder("app-outline", "grid");
    let grid = |name: &str, corner: f64, value: f64| write_grid(&folder.join(name), corner, value);
    let mut window = window();
    send(&mut window, Command::from(FileCommand::New));
    keep_extent(&mut window);
    send(&mut window, Command::from(FileCommand::Open(grid("large.asc", 0.25, 7.0))));
    assert!(wait_for_notice(&mut window).contains("it must lie from 0 to 1"));
    send(&mut window, Command::from(ShellCommand::Escape));
    send(&mut window, Command::from(FileCommand::Open(grid("far.asc", 9.0, 0.5))));
    assert!(wait_for_notice(&mut window).contains("outside this document"));
    send(&mut window, Command::from(FileCommand::Open(grid("risk.asc", 0.25, 1.0))));
    wait_until(&mut window, |window| has_raster(window, &RasterReading::Risk));
    wait_until(&mut window, |window| level_at(window, dvec2(0.3, 0.4)) > 5);
    assert_eq!(level_at(&window, dvec2(0.9, 0.9)), 0);
    crate::app::tests::open_menu(&mut window, "File");
    assert!(window.query_by_label("Open recent risk.asc").is_some());
}
