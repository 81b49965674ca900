//! Layers of data from files: bands, curves of values and distances to shapes.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::stack::{choose_in, select};
use crate::app::tests::{
    RESTING_PLACE, TALL, Window, active, choose_in_palette, click_button, entries, folder, key, level_at,
    move_to, notice, open_menu, send, settings, triangles, type_into, value_of, wait_for_notice, wait_until,
    window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::domain::{BoundaryMarks, BoundaryType};
use meshbrush_core::layers::{
    BandLayer, DistanceLayer, DistanceTo, FormulaLayer, LayerId, LayerKind, RasterLayer, RasterReading,
    RasterSource,
};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, LayerCommand};

/// Four pixels over the unit square; the last has no value.
const DEPTHS: &str = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.5\nNODATA_value -9999\n\
                      -30 0\n60 -9999\n";

fn written(test: &str, name: &str, text: &str) -> PathBuf {
    let file = folder("app-layer-data", test).join(name);
    fs::write(&file, text).unwrap();
    file
}

/// Chooses in the list of *Add layer*.
fn add_by_button(window: &mut Window, entry: &str) {
    click_button(window, "Add layer");
    click_button(window, entry);
}

/// Returns a window with a raster of risk at the bottom, which is selected.
fn window_with_terrain() -> Window {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Terrain)));
    select(&mut window, "Base");
    window
}

fn source(window: &Window) -> RasterSource {
    active(window).kind.raster_source().expect("a layer with a raster").clone()
}

fn band(window: &Window) -> ([f64; 2], f64) {
    let LayerKind::Band(BandLayer { between, diameter, .. }) = active(window).kind else { panic!("a band") };
    (between, diameter)
}

fn knots(window: &Window) -> Vec<[f64; 2]> {
    match &active(window).kind {
        LayerKind::Raster(RasterLayer { reading: RasterReading::Curve(curve), .. }) => curve.knots().to_vec(),
        other => panic!("no curve: {other:?}"),
    }
}

/// Returns whether a sentence below a field has these words.
fn warns(window: &Window, words: &str) -> bool {
    let mut alerts = window.query_all_by_role(Role::Alert);
    alerts.any(|alert| alert.accesskit_node().label().is_some_and(|text| text.contains(words)))
}

#[test]
fn a_band_is_made_of_the_raster_at_hand() {
    let mut window = window_with_terrain();
    let raster = source(&window).raster;
    let values = raster.raster().values().iter().map(|&value| f64::from(value));
    let (least, greatest) = values.fold((f64::MAX, f64::MIN), |(a, b), value| (a.min(value), b.max(value)));
    add_by_button(&mut window, "band of a raster…");
    assert!(Arc::ptr_eq(&source(&window).raster, &raster), "the pixels are shared");
    let transfer = settings(&window).transfer;
    let (between, diameter) = band(&window);
    let third = (greatest - least) / 3.0;
    assert!((between[0] - least - third).abs() + (between[1] - greatest + third).abs() < 1e-9, "{between:?}");
    assert!((diameter * diameter / (transfer.h_min * transfer.h_max) - 1.0).abs() < 1e-12, "{diameter}");
    assert_eq!(entries(&window), 1);
    let before = triangles(&window);
    type_into(&mut window, "Values from", &greatest.to_string());
    assert_ne!(triangles(&window), before, "the mesh follows the band");
    // A layer of another kind is selected: the highest raster counts.
    send(&mut window, Command::from(LayerCommand::Add(Box::new(LayerKind::constant(1.0)))));
    choose_in_palette(&mut window, "Add layer: band of a raster…");
    assert!(Arc::ptr_eq(&source(&window).raster, &raster));
    assert_eq!(settings(&window).layers.len(), 6);
}

#[test]
fn without_a_raster_a_band_is_made_of_a_file() {
    let depths = written("band", "depths.asc", DEPTHS);
    let mut window = window_of(TALL);
    add_by_button(&mut window, "band of a raster…");
    assert!(window.query_by_label_contains("Open picture or grid as band").is_some(), "it asks for a file");
    let before = triangles(&window);
    type_into(&mut window, "Path", depths.to_str().unwrap());
    wait_until(&mut window, |window| active(window).kind.is::<BandLayer>());
    assert_eq!((band(&window).0, active(&window).name.as_str()), ([0.0, 30.0], "depths.asc"));
    assert!(triangles(&window) > before && entries(&window) == 1);
    // The pixel of value 0 is the upper right one.
    assert!(level_at(&window, dvec2(0.75, 0.6)) > level_at(&window, dvec2(0.25, 0.1)));
    add_by_button(&mut window, "band of a file…");
    assert!(window.query_by_label_contains("Open picture or grid as band").is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    let empty = written(
        "empty",
        "empty.asc",
        "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n\
                                               NODATA_value -1\n-1\n",
    );
    send(&mut window, Command::from(LayerCommand::OpenBand(empty)));
    assert!(wait_for_notice(&mut window).contains("no pixel of the grid has a value"), "{}", notice(&window));
    assert_eq!(entries(&window), 1);
}

#[test]
fn a_raster_of_risk_goes_through_a_curve_whose_knots_are_typed() {
    let mut window = window_with_terrain();
    choose_in(&mut window, "What the values mean", "Curve");
    let transfer = settings(&window).transfer;
    let [[least, at_least], [greatest, at_greatest]] = knots(&window)[..] else { panic!("two knots") };
    assert!(least < greatest);
    assert_eq!([at_least, at_greatest], [transfer.h_max, transfer.h_risk], "fine where the risk was great");
    let before = triangles(&window);
    type_into(&mut window, "Knot 2 diameter", &transfer.h_max.to_string());
    assert_eq!(knots(&window)[1], [greatest, transfer.h_max]);
    assert!(triangles(&window) < before, "the mesh follows the curve");
    click_button(&mut window, "Add knot");
    assert_eq!(knots(&window).len(), 3);
    assert!((knots(&window)[1][0] - 0.5 * (least + greatest)).abs() < 1e-9);
    type_into(&mut window, "Knot 1 value", &(greatest + 1.0).to_string());
    assert!(knots(&window)[0][0] < knots(&window)[1][0], "knots stay in order");
    assert!(warns(&window, "Knot 1 value was set to that."));
    type_into(&mut window, "Knot 3 diameter", "0");
    assert!(warns(&window, "Knot 3 diameter must be greater than zero."));
    key(&mut window, Modifiers::NONE, Key::Escape);
    let known = knots(&window);
    click_button(&mut window, "Delete knot 2");
    assert_eq!(knots(&window), [known[0], known[2]]);
    assert_eq!(entries(&window), 5, "each is a gesture of its own");
    click_button(&mut window, "Delete knot 1");
    let only = window.get_by_role_and_label(Role::Button, "Delete knot 1");
    assert!(only.accesskit_node().is_disabled(), "a curve keeps a knot");
    choose_in(&mut window, "What the values mean", "Risk");
    assert!(window.query_by_label("Add knot").is_none());
}

#[test]
fn a_grid_of_any_values_opens_through_a_curve() {
    let depths = written("curve", "depths.asc", DEPTHS);
    let mut window = window_of(TALL);
    add_by_button(&mut window, "picture or grid, through a curve…");
    type_into(&mut window, "Path", depths.to_str().unwrap());
    wait_until(&mut window, |window| active(window).name == "depths.asc");
    let transfer = settings(&window).transfer;
    // Fine where the depth is nearest to 0.
    let expected = vec![[-30.0, transfer.h_max], [0.0, transfer.h_min], [60.0, transfer.h_max]];
    assert_eq!(knots(&window), expected);
    for (meaning, rule) in [("Risk", "must lie from 0 to 1"), ("Diameter", "must be positive")] {
        choose_in(&mut window, "What the values mean", meaning);
        assert!(notice(&window).contains(rule), "{}", notice(&window));
        assert_eq!(knots(&window), expected);
    }
    assert_eq!(entries(&window), 1);
}

/// Returns a window with a grid of depths through a curve, which is selected.
fn window_with_curve(test: &str) -> Window {
    let depths = written(test, "depths.asc", DEPTHS);
    let mut window = window_of(TALL);
    send(&mut window, Command::from(LayerCommand::OpenValues(depths)));
    wait_until(&mut window, |window| active(window).name == "depths.asc");
    window
}

#[test]
fn knots_of_a_curve_are_dragged_added_and_removed_in_its_plot() {
    let mut window = window_with_curve("plot");
    let plot = |window: &Window| window.get_by_role_and_label(Role::Image, "Curve of the values").rect();
    let knot = |window: &Window, number: usize| {
        window.get_by_role_and_label(Role::Slider, &format!("Curve knot {number}")).rect().center()
    };
    let before = knots(&window);
    let (at, coarse) = (knot(&window, 2), triangles(&window));
    window.drag_at(at);
    window.run();
    for step in 1..=3 {
        window.hover_at(at + vec2(5.0, -15.0) * step as f32);
        window.run();
    }
    window.drop_at(at + vec2(15.0, -45.0));
    window.run();
    let after = knots(&window);
    assert!(after[1][0] > before[1][0] && after[1][1] > 2.0 * before[1][1], "{after:?}");
    assert_eq!((after[0], after[2]), (before[0], before[2]));
    assert_eq!(entries(&window), 2, "a drag is one gesture");
    assert!(triangles(&window) < coarse, "the mesh follows");

    let free = knot(&window, 2).lerp(knot(&window, 3), 0.5) + vec2(0.0, 20.0);
    window.drag_at(free);
    window.drop_at(free);
    window.run();
    assert_eq!((knots(&window).len(), entries(&window)), (4, 3), "a click adds a knot");
    assert!(knot(&window, 3).distance(free) < 2.0, "{:?} {free:?}", knot(&window, 3));
    assert!(plot(&window).contains(free));
    window.get_by_role_and_label(Role::Slider, "Curve knot 3").focus();
    window.run();
    let diameter = knots(&window)[2][1];
    key(&mut window, Modifiers::NONE, Key::ArrowUp);
    assert!(knots(&window)[2][1] > diameter);
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!(knots(&window), after);
    click_button(&mut window, "Fine at high");
    assert_eq!(knots(&window).last().unwrap(), &[60.0, settings(&window).transfer.h_min]);
}

#[test]
fn the_value_of_the_raster_at_the_pointer_is_shown() {
    let mut window = window_with_curve("pointer");
    let value = |window: &Window| value_of(window, Role::Definition, "Value at the pointer");
    for (x, y, expected) in [(0.2, 0.8, "−30"), (0.2, 0.2, "60"), (0.8, 0.2, "none")] {
        move_to(&mut window, dvec2(x, y));
        assert_eq!(value(&window), expected);
    }
    window.hover_at(RESTING_PLACE);
    window.run();
    assert_eq!(value(&window), "–");
}

#[test]
fn a_grid_of_diameters_goes_through_a_curve_and_back() {
    let diameters = DEPTHS.replace("-30 0\n60", "0.5 1\n2");
    let file = written("diameters", "diameters.asc", &diameters);
    let mut window = window_of(TALL);
    send(&mut window, Command::from(LayerCommand::OpenDiameters(file)));
    wait_until(&mut window, |window| active(window).name == "diameters.asc");
    choose_in(&mut window, "What the values mean", "Curve");
    let transfer = settings(&window).transfer;
    // The pixel without a value asks for nothing, and is no end of the curve.
    assert_eq!(knots(&window), [[0.5, transfer.h_min], [2.0, transfer.h_max]]);
    choose_in(&mut window, "What the values mean", "Diameter");
    let Some(RasterLayer { reading, .. }) = active(&window).kind.get() else { panic!("a raster") };
    assert_eq!((reading, entries(&window)), (&RasterReading::Diameter, 3));
}

#[test]
fn distances_are_measured_to_shapes_of_a_file() {
    let road = r#"{"type": "LineString", "coordinates": [[0.1, 0.9], [0.9, 0.9]]}"#;
    let road = written("road", "road.geojson", road);
    let site = written("site", "site.geojson", r#"{"type": "Point", "coordinates": [0.9, 0.1]}"#);
    let mut window = window_of(TALL);
    let (at_road, at_site) = (dvec2(0.55, 0.9), dvec2(0.9, 0.1));
    let coarse = level_at(&window, at_road);
    add_by_button(&mut window, "distance to shapes…");
    type_into(&mut window, "Path", road.to_str().unwrap());
    wait_until(&mut window, |window| active(window).kind.is::<DistanceLayer>());
    assert_eq!(value_of(&window, Role::Definition, "Distance to"), "road.geojson");
    assert!(level_at(&window, at_road) > coarse);
    type_into(&mut window, "At distance 0", "0.01");
    click_button(&mut window, "Open shapes…");
    type_into(&mut window, "Path", site.to_str().unwrap());
    let is_to = |window: &Window, name: &str| value_of(window, Role::Definition, "Distance to") == name;
    wait_until(&mut window, |window| is_to(window, "site.geojson"));
    assert!(
        matches!(active(&window).kind, LayerKind::Distance(DistanceLayer { at_zero: 0.01, .. })),
        "its numbers stay"
    );
    assert_eq!((level_at(&window, at_road), entries(&window)), (coarse, 3));
    assert!(level_at(&window, at_site) > coarse);
    click_button(&mut window, "Use outline");
    assert!(matches!(
        active(&window).kind,
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Outline, .. })
    ));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(is_to(&window, "site.geojson"));
    fs::write(&site, "{").unwrap();
    send(&mut window, Command::from(LayerCommand::ReplaceShapes(site)));
    assert!(wait_for_notice(&mut window).contains("site.geojson"), "{}", notice(&window));
    assert!(is_to(&window, "site.geojson"));
}

#[test]
fn distances_are_measured_to_chosen_pieces_of_the_boundary() {
    let mut window = window_of(TALL);
    let (west, south) = (dvec2(0.001, 0.5), dvec2(0.5, 0.001));
    let coarse = level_at(&window, west);
    add_by_button(&mut window, "distance to the outline");
    let fine = level_at(&window, west);
    assert!(fine > coarse && level_at(&window, south) == fine);
    let toggle = |window: &mut Window, label: &str| {
        wait_until(window, |window| window.query_by_role_and_label(Role::CheckBox, label).is_some());
        window.get_by_role_and_label(Role::CheckBox, label).click();
        window.run();
    };
    toggle(&mut window, "Only some pieces");
    let remark = "No piece of the boundary is chosen";
    wait_until(&mut window, |window| window.query_by_label_contains(remark).is_some());
    assert_eq!(level_at(&window, west), coarse, "a rectangle has no land");
    toggle(&mut window, "open west");
    assert!(level_at(&window, west) == fine && level_at(&window, south) < fine);
    let chosen = |window: &Window| match &active(window).kind {
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Pieces(chosen), .. }) => chosen.names.clone(),
        other => panic!("a distance to pieces: {other:?}"),
    };
    toggle(&mut window, "open south");
    assert_eq!(chosen(&window), ["open west", "open south"]);
    toggle(&mut window, "open west");
    assert_eq!(chosen(&window), ["open south"]);
    toggle(&mut window, "open west");
    toggle(&mut window, "open south");
    assert_eq!(chosen(&window), ["open west"]);
    // A type that is set later counts.
    let pieces = window.state().session.boundary_pieces().unwrap();
    let marks = pieces.retyped(&BoundaryMarks::default(), 0, Some(BoundaryType::Land));
    assert_eq!(pieces.list()[0].name, "open south");
    send(&mut window, Command::from(EditCommand::Set(Setting::BoundaryMarks(marks))));
    assert_eq!(level_at(&window, south), fine);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(level_at(&window, south) < fine);
    toggle(&mut window, "All of the type open");
    assert_eq!(level_at(&window, south), fine);
}

#[test]
fn a_formula_of_the_depth_needs_a_layer_of_depths() {
    let file = written("formula", "depths.asc", DEPTHS);
    let mut window = window_of(TALL);
    select(&mut window, "Base");
    type_into(&mut window, "Target diameter h̄(x, y)", "0.02 + 0.01*abs(depth)");
    assert!(wait_for_notice(&mut window).contains("there are no depths"), "{}", notice(&window));
    send(&mut window, Command::from(LayerCommand::OpenDepth(file)));
    wait_until(&mut window, |window| active(window).name == "depths.asc");
    select(&mut window, "Base");
    type_into(&mut window, "Target diameter h̄(x, y)", "0.02 + 0.01*abs(depth)");
    let Some(FormulaLayer { formula, .. }) = active(&window).kind.get() else { panic!("a formula") };
    assert!(formula.uses_depth());
    // 30 m deep, at the shore, 60 m high, and unknown.
    let session = window.state().session();
    let (field, paint) = (session.follower().field(), session.document().paint());
    for (x, y, expected) in
        [(0.2, 0.8, Some(0.32)), (0.8, 0.8, Some(0.02)), (0.2, 0.2, Some(0.62)), (0.8, 0.2, None)]
    {
        let asked = field.decision_at(paint, dvec2(x, y)).asked;
        let of_base = asked.into_iter().find(|(id, _)| *id == LayerId(0)).and_then(|(_, asked)| asked);
        assert_eq!(of_base, expected, "at {x}, {y}");
    }
}

#[test]
fn undo_says_what_was_done_to_the_layers() {
    let mut window = window_of(TALL);
    let base = LayerId(0);
    for (command, undo) in [
        (LayerCommand::Show(base, false), "Undo hide layer Ctrl+Z"),
        (LayerCommand::Rename(base, "Sea".into()), "Undo rename layer Ctrl+Z"),
        (LayerCommand::Move(base, 1), "Undo move layer Ctrl+Z"),
        (LayerCommand::Add(Box::new(LayerKind::constant(0.1))), "Undo add layer Ctrl+Z"),
        (LayerCommand::Delete(base), "Undo delete layer Ctrl+Z"),
        (LayerCommand::LimitGradation(true), "Undo gradation Ctrl+Z"),
    ] {
        send(&mut window, Command::from(command));
        open_menu(&mut window, "Edit");
        assert!(window.query_by_role_and_label(Role::Button, undo).is_some(), "{undo}");
        key(&mut window, Modifiers::NONE, Key::Escape);
    }
}
