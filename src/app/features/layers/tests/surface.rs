//! Layers of surfaces that the mesh is close to.

use std::fs;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::depth::click_on;
use crate::app::features::domain::DomainCommand;
use crate::app::tests::pictures::{drawn_window, picture, pixel};
use crate::app::tests::{
    RESTING_PLACE, TALL, Window, active, folder, on_screen, send, settings, triangles, type_into, value_of,
    wait_for_jobs, wait_until, window_of,
};
use meshbrush_core::document::Setting;
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    Layer, LayerId, LayerKind, Quantity, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource,
};
use meshbrush_kit::kit::command::{
    BrushCommand, Command, EditCommand, FileCommand, LayerCommand, ViewCommand,
};
use meshbrush_kit::kit::tools::PaintKind;
use meshbrush_kit::kit::view::FieldOverlay;

fn goal(window: &Window) -> SurfaceGoal {
    let Some(surface) = active(window).kind.get::<Surface>() else {
        panic!("a surface: {:?}", active(window))
    };
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
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(LayerCommand::OpenSurface(file)));
    wait_until(&mut window, |window| active(window).kind.is::<Surface>());
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
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::SurfaceError)));
    wait_for_jobs(&mut window);
    assert!(window.query_by_label_contains("Legend: surface error").is_some());
    // Fewer triangles than the coarse grid has.
    type_into(&mut window, "Most triangles", "9");
    wait_until(&mut window, |window| window.query_by_label_contains("more triangles already").is_some());
}

#[test]
fn the_error_of_a_surface_is_said_to_be_measured_until_it_is() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    wait_for_jobs(&mut window);
    window.state().jobs.hold();
    let source = SurfaceSource::Formula(Formula::parse("sin(9 * x)").unwrap());
    let surface = Surface { source, goal: SurfaceGoal::Within(0.05), norm: SurfaceNorm::Largest };
    let mut layers = settings(&window).layers.clone();
    layers.push(Layer::new(LayerId(70), "Hills", surface));
    window.state_mut().send(Command::from(EditCommand::Set(Setting::Layers(layers))));
    window.state_mut().send(Command::from(LayerCommand::Select(LayerId(70))));
    window.run_steps(20);
    assert_eq!(value_of(&window, Role::Definition, "Error"), "being measured");
}

#[test]
fn a_painted_error_counts_in_place_of_that_of_the_surface() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    let bounds = settings(&window).domain.bounds;
    send(&mut window, Command::from(LayerCommand::Add(Box::new(LayerKind::default_surface(&bounds)))));
    wait_for_jobs(&mut window);
    let before = triangles(&window);
    send(&mut window, Command::from(LayerCommand::Add(Box::new(LayerKind::paint(Quantity::Error)))));
    assert_eq!(window.state().tools().kind, PaintKind::Error, "the layer chooses what is painted");
    let SurfaceGoal::Within(own) = settings(&window).surfaces().next().unwrap().1.goal else {
        panic!("an error")
    };
    send(&mut window, Command::from(BrushCommand::Error(0.05 * own)));
    send(&mut window, Command::from(BrushCommand::BeginStroke(bounds.center())));
    send(&mut window, Command::from(BrushCommand::EndStroke));
    wait_for_jobs(&mut window);
    let painted = triangles(&window);
    assert!(painted > before, "{painted} {before}");
    // The brush picks what is allowed here.
    send(&mut window, Command::from(BrushCommand::Error(123.0)));
    send(&mut window, Command::from(BrushCommand::Pick(bounds.center())));
    assert!((window.state().tools().error / (0.05 * own) - 1.0).abs() < 1e-6);
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::SurfaceError)));
    wait_for_jobs(&mut window);
    assert!(window.query_by_label_contains("−100 %").is_some(), "errors differ by place");
    send(&mut window, Command::from(EditCommand::Undo));
    wait_for_jobs(&mut window);
    assert_eq!(triangles(&window), before);
}

#[test]
fn the_area_with_values_becomes_the_domain() {
    let file = folder("app-surface", "nodata").join("gap.asc");
    let value = |n: u32| if (n % 20) < 6 && n / 20 > 12 { "-9".to_owned() } else { (n % 7).to_string() };
    let rows = (0..20).map(|row| (0..20).map(|x| value(20 * row + x)).collect::<Vec<_>>().join(" "));
    let header = "ncols 20\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n";
    fs::write(&file, header.to_owned() + &rows.collect::<Vec<_>>().join("\n")).unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(LayerCommand::OpenSurface(file)));
    wait_until(&mut window, |window| active(window).kind.is::<Surface>());
    wait_for_jobs(&mut window);
    let shown = window.query_by_label_contains("Without a value").is_some();
    assert!(shown && settings(&window).domain.region().is_none());
    let id = active(&window).id;
    click_on(&mut window, Role::Button, "Use the area with values as the domain");
    wait_until(&mut window, |window| settings(window).domain.region().is_some());
    wait_for_jobs(&mut window);
    assert!(window.query_by_label_contains("Without a value").is_none());
    send(&mut window, Command::from(DomainCommand::UseValues(id)));
    wait_for_jobs(&mut window);
}

#[test]
fn the_relief_of_a_surface_has_the_colours_of_its_legend() {
    let file = folder("app-surface", "relief").join("slope.asc");
    // From 1000 in the west to 1190 in the east.
    let rows = (0..20).map(|_| (0..20).map(|x| (1000 + 10 * x).to_string()).collect::<Vec<_>>().join(" "));
    let header = "ncols 20\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    fs::write(&file, header.to_owned() + &rows.collect::<Vec<_>>().join("\n")).unwrap();
    let mut window = drawn_window();
    send(&mut window, Command::from(FileCommand::New));
    wait_for_jobs(&mut window);
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Surface)));
    assert!(window.query_by_label_contains("Legend: no layer of a surface").is_some());
    send(&mut window, Command::from(LayerCommand::OpenSurface(file)));
    wait_until(&mut window, |window| active(window).kind.is::<Surface>());
    // A document of the extent of the surface has taken the place of the empty one.
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Surface)));
    window.hover_at(RESTING_PLACE);
    window.run();
    wait_for_jobs(&mut window);
    assert!(window.query_by_label_contains("Legend: surface 1,000 to 1,190").is_some());
    let image = picture(&mut window);
    let colors = |x: f64| pixel(&image, on_screen(&window, dvec2(x, 9.3)));
    let [low, middle, high] = [1.2, 9.7, 18.6].map(colors);
    assert!(low[1] > low[0] && high[0] > 180 && high[2] > 170, "green below, pale above: {low:?} {high:?}");
    assert!(middle[0] > low[0] && middle[2] < high[2], "{middle:?}");
}
