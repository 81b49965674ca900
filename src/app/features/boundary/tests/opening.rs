//! Opening the boundary in one step: by button, palette, menu, number, text and file.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};

use super::SIZE;
use crate::app::tests::{
    Window, choose_in_palette, click_button, entries, folder, key, notice, send, settings, show, step_until,
    type_into, wait_for_notice, wait_until, window_of,
};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryPieces, Domain};
use meshbrush_core::layers::{Layer, LayerId, LayerKind, RasterSource};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;

/// A sea whose longest sides are not on the frame: nothing of it is open by itself.
const SEA: [DVec2; 6] = [
    dvec2(-0.1, -1.0),
    dvec2(0.1, -1.0),
    dvec2(1.0, 0.0),
    dvec2(0.1, 1.0),
    dvec2(-0.1, 1.0),
    dvec2(-1.0, 0.0),
];

/// Depths of 100 m in the west and 10 m in the east.
fn depths() -> LayerKind {
    let values = [-100.0, -100.0, -10.0, -10.0].repeat(4);
    let raster = Raster::from_values(Rect::new(dvec2(-1.0, -1.0), dvec2(1.0, 1.0)), [4, 4], values);
    let raster = Arc::new(RasterPyramid::new(raster));
    let source = RasterSource { name: "depths".into(), raster };
    LayerKind::depths_without_sizes(source, &Settings::default().transfer).unwrap()
}

/// Returns a window on the sea with an island, with the boundary tool in hand.
fn window_on(layers: impl IntoIterator<Item = LayerKind>) -> Window {
    let island = [(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)].map(|(x, y)| dvec2(x, y)).to_vec();
    let domain = Domain::of_polygons(&[vec![SEA.to_vec(), island]]).unwrap();
    let mut settings = Settings::for_domain("sea".into(), domain);
    settings.layers.extend((100..).zip(layers).map(|(id, kind)| Layer::new(LayerId(id), kind.name(), kind)));
    let mut window = window_of(SIZE);
    send(&mut window, show(settings));
    key(&mut window, Modifiers::NONE, Key::N);
    wait_until(&mut window, |window| window.state().session().boundary_pieces().is_some());
    assert_eq!(open(&window), Vec::<DVec2>::new(), "nothing is open yet");
    window
}

/// Returns the middles of the open pieces.
fn open(window: &Window) -> Vec<DVec2> {
    let Settings { domain, boundary_marks, .. } = settings(window);
    let pieces = BoundaryPieces::of_domain(domain, boundary_marks).unwrap();
    pieces.list().iter().filter(|piece| piece.boundary_type().is_open()).map(|piece| piece.middle()).collect()
}

fn wait_for_news(window: &mut Window, part: &str) {
    step_until(window, |window| notice(window).contains(part));
}

#[test]
fn all_that_lies_on_the_frame_is_opened_and_undone() {
    let mut window = window_on([]);
    click_button(&mut window, "Along the frame");
    wait_for_news(&mut window, "2 pieces of the boundary were opened: ");
    let middles = open(&window);
    assert!(
        middles.len() == 2 && middles.iter().all(|at| at.y.abs() > 0.999 && at.x.abs() < 0.1),
        "{middles:?}"
    );
    assert_eq!(entries(&window), 1);
    choose_in_palette(&mut window, "Open the boundary along the frame");
    wait_for_news(&mut window, "is open already");
    assert_eq!((open(&window), entries(&window)), (middles, 1));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((open(&window), entries(&window)), (Vec::new(), 0));
}

#[test]
fn all_that_is_deep_is_opened_where_there_are_depths() {
    let mut window = window_on([]);
    let button = window.get_by_role_and_label(Role::Button, "Open where deeper");
    assert!(button.accesskit_node().is_disabled(), "there are no depths");
    choose_in_palette(&mut window, "Open the boundary deeper than 50 m");
    assert!(
        wait_for_notice(&mut window).contains("Add a grid of them with “Add data…”"),
        "{}",
        notice(&window)
    );

    let mut window = window_on([depths()]);
    click_button(&mut window, "Open where deeper");
    wait_for_news(&mut window, "1 piece of the boundary was opened: ");
    let middles = open(&window);
    assert!(middles.len() == 1 && middles[0].x < -0.4, "{middles:?}");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(open(&window), Vec::new());
    type_into(&mut window, "Deeper than", "200");
    click_button(&mut window, "Open where deeper");
    wait_for_news(&mut window, "“depth>200”: it opens nothing");
    assert_eq!((open(&window), entries(&window)), (Vec::new(), 0));
}

#[test]
fn the_boundary_is_opened_in_a_box_that_is_typed() {
    let mut window = window_on([]);
    for (text, sentence) in
        [("frame", "is no box"), ("3, 3", "is no box"), ("5, 5, 6, 6", "it opens nothing")]
    {
        type_into(&mut window, "In a box", text);
        wait_for_news(&mut window, sentence);
        assert_eq!(entries(&window), 0, "{text}");
    }
    type_into(&mut window, "In a box", "0.5, -1, 1, 1");
    wait_for_news(&mut window, "1 piece of the boundary was opened: ");
    let middles = open(&window);
    assert!(middles.len() == 1 && middles[0].distance(dvec2(1.0, 0.0)) < 1e-6, "{middles:?}");
}

fn polygons(name: &str, [west, east]: [f64; 2]) -> PathBuf {
    let file = folder("open-boundary", name).join("open.geojson");
    let ring = format!("[[{west}, -2], [{east}, -2], [{east}, 2], [{west}, 2], [{west}, -2]]");
    fs::write(&file, format!("{{\"type\": \"Polygon\", \"coordinates\": [{ring}]}}")).unwrap();
    file
}

#[test]
fn the_boundary_is_opened_in_the_polygons_of_a_file() {
    let mut window = window_on([]);
    click_button(&mut window, "In polygons…");
    type_into(&mut window, "Path", &polygons("far", [7.0, 8.0]).display().to_string());
    wait_until(&mut window, |window| window.query_by_label_contains("it opens nothing").is_some());
    assert!(window.query_by_label("Open the boundary in polygons").is_some(), "another file can be given");
    type_into(&mut window, "Path", &polygons("west", [-2.0, -0.5]).display().to_string());
    wait_for_news(&mut window, "1 piece of the boundary was opened: ");
    let middles = open(&window);
    assert!(middles.len() == 1 && middles[0].distance(dvec2(-1.0, 0.0)) < 1e-6, "{middles:?}");
    assert_eq!(entries(&window), 1);
}

#[test]
fn a_domain_by_a_formula_says_how_its_boundary_is_opened() {
    let mut window = window_of(SIZE);
    let domain = Domain {
        shape: "x^2 + y^2 < 1".parse::<meshbrush_core::field::Formula>().unwrap().into(),
        ..Domain::rectangle(Rect::new(dvec2(-1.0, -1.0), dvec2(1.0, 1.0)))
    };
    send(&mut window, show(Settings::for_domain("disc".into(), domain)));
    choose_in_palette(&mut window, "Open the boundary along the frame");
    assert!(wait_for_notice(&mut window).contains("“Type” in the tab Domain"), "{}", notice(&window));
}

#[test]
fn sides_that_are_open_already_are_not_split() {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| dvec2(x, y)).to_vec();
    let mut settings = Settings::for_domain("sea".into(), Domain::of_polygons(&[vec![corners]]).unwrap());
    let kind = depths();
    settings.layers.push(Layer::new(LayerId(100), kind.name(), kind));
    let mut window = window_of(SIZE);
    send(&mut window, show(settings));
    key(&mut window, Modifiers::NONE, Key::N);
    let before = open(&window);
    assert_eq!(before.len(), 4, "all sides of a square are open");
    choose_in_palette(&mut window, "Open the boundary deeper than 50 m");
    wait_for_news(&mut window, "is open already");
    assert_eq!((open(&window), entries(&window)), (before, 0));
}
