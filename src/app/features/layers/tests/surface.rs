//! Layers of surfaces that the mesh is close to.

use std::fs;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

use super::depth::click_on;
use crate::app::command::{Command, FileCommand, LayerCommand, ViewCommand};
use crate::app::tests::{
    TALL, Window, active, folder, send, settings, triangles, type_into, wait_for_jobs, wait_until, window_of,
};
use crate::app::view::FieldOverlay;
use meshbrush_core::layers::{LayerKind, SurfaceGoal};

fn goal(window: &Window) -> SurfaceGoal {
    let LayerKind::Surface(surface) = &active(window).kind else { panic!("a surface: {:?}", active(window)) };
    surface.goal
}

/// The error of the panel; NaN while it is measured.
fn error(window: &Window) -> f64 {
    let row = window.query_by_role_and_label(Role::Button, "Error");
    row.and_then(|row| row.value()).and_then(|error| error.parse().ok()).unwrap_or(f64::NAN)
}

#[test]
fn the_mesh_follows_an_error_or_a_number_of_triangles() {
    let file = folder("app-surface", "goals").join("hills.asc");
    let height = |n: u32| 100.0 * (f64::from(n % 65) / 9.0).sin() * (f64::from(n / 65) / 7.0).cos();
    let rows =
        (0..65).map(|row| (0..65).map(|x| height(65 * row + x).to_string()).collect::<Vec<_>>().join(" "));
    let header = "ncols 65\nnrows 65\nxllcorner -5\nyllcorner -5\ncellsize 10\n";
    fs::write(&file, header.to_owned() + &rows.collect::<Vec<_>>().join("\n")).unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::File(FileCommand::New));
    send(&mut window, Command::Layer(LayerCommand::OpenSurface(file)));
    wait_until(&mut window, |window| matches!(active(window).kind, LayerKind::Surface(_)));
    let bounds = settings(&window).domain.bounds;
    assert_eq!([bounds.min.x, bounds.max.y], [0.0, 640.0], "nodes are at the centres of pixels");
    assert_eq!((goal(&window), settings(&window).spacing), (SurfaceGoal::Within(1.0), 40.0));
    type_into(&mut window, "Largest error", "5");
    wait_until(&mut window, |window| (2.0..=5.0).contains(&error(window)));
    let within = triangles(&window);
    type_into(&mut window, "Largest error", "20");
    wait_until(&mut window, |window| (5.0..=20.0).contains(&error(window)));
    assert!(triangles(&window) < within, "{} {within}", triangles(&window));
    let coarse = triangles(&window);
    click_on(&mut window, Role::RadioButton, "Triangles");
    wait_for_jobs(&mut window);
    assert_eq!((goal(&window), triangles(&window)), (SurfaceGoal::AtMost(coarse), coarse));
    type_into(&mut window, "Most triangles", &within.to_string());
    wait_until(&mut window, |window| (2.0..=5.0).contains(&error(window)));
    assert!(triangles(&window) <= within && triangles(&window) > coarse);
    send(&mut window, Command::View(ViewCommand::SetOverlay(FieldOverlay::SurfaceError)));
    wait_for_jobs(&mut window);
    assert!(window.query_by_label_contains("Legend: surface error").is_some());
    // Fewer triangles than the coarse grid has.
    type_into(&mut window, "Most triangles", "9");
    wait_until(&mut window, |window| window.query_by_label_contains("more triangles already").is_some());
}
