//! Adding data of any kind: what a file is to be, an empty document, and the page of a new document.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::project::Dropped;
use super::{
    Window, active, click_button, document, entries, key, notice, open_menu, open_tab, paint, send, set,
    settings, value_of, wait_for_notice, wait_until, window,
};
use crate::app::features::picture::PictureCommand;
use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::earth::Projection;
use meshbrush_core::layers::{DistanceLayer, DistanceTo, LayerKind, RasterLayer, RasterReading, Threats};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Depths over a part of the earth, in metres, far from the domain of a new document.
const DEPTHS: &str = "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 4000000\ncellsize 1000\n\
                      NODATA_value -9999\n-30 -20 -10\n-5 -9999 60\n";
const COAST: &str =
    "{\"type\": \"Polygon\", \"coordinates\": [[[20, 30], [24, 30], [24, 33], [20, 33], [20, 30]]]}";
const LINE: &str = "{\"type\": \"LineString\", \"coordinates\": [[0.2, 0.2], [0.8, 0.7]]}";
const THREATS: &str = "x,y,range,peak,law\n0.3,0.4,0.1,0.8,radar\n0.6,0.6,0.2,0.5,disc\n";
const POINTS: &str = "x,y\n0.3,0.4\n0.6,0.6\n0.3,0.4\n";

fn written(test: &str, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let file = super::folder("app-add-data", test).join(name);
    fs::write(&file, text).unwrap();
    file
}

fn drop_file(window: &mut Window, file: &Path) {
    window.input_mut().dropped_files.push(Arc::new(Dropped(file.to_owned())));
    window.run();
}

fn is_asked(window: &Window) -> bool {
    window.query_by_label("What is the file to be?").is_some()
}

/// Drops a file on the window, and waits for the question about it.
fn drop_and_wait(window: &mut Window, file: &Path) {
    drop_file(window, file);
    wait_until(window, is_asked);
}

/// Returns the roles that can be chosen, and the chosen one.
fn roles(window: &Window) -> (Vec<String>, Option<String>) {
    let canvas = super::canvas(window);
    let radios = window.query_all_by_role(Role::RadioButton);
    // The panels beside the dialog have choices, too.
    let of_dialog = radios.filter(|node| canvas.contains(node.rect().center()));
    let mut found = (Vec::new(), None);
    for data in of_dialog.map(|node| node.accesskit_node().data().clone()) {
        let title = data.label().unwrap_or_default().to_owned();
        if data.is_disabled() {
            continue;
        }
        if data.toggled() == Some(Toggled::True) {
            found.1 = Some(title.clone());
        }
        found.0.push(title);
    }
    found
}

fn choose_role(window: &mut Window, title: &str) {
    window.get_by_role_and_label(Role::RadioButton, title).click();
    window.run();
    click_button(window, "Add");
}

fn new_document(window: &mut Window) {
    send(window, Command::from(FileCommand::New));
}

#[test]
fn a_dropped_grid_of_depths_is_asked_about_and_gives_an_empty_document_its_extent() {
    let file = written("depths", "depths.asc", DEPTHS);
    let mut window = window();
    new_document(&mut window);
    drop_and_wait(&mut window, &file);
    assert_eq!(value_of(&window, Role::Definition, "Contents"), "grid, 3 × 2");
    assert_eq!(value_of(&window, Role::Definition, "Values"), "−30 … 60");
    assert_eq!(value_of(&window, Role::Definition, "Without a value"), "17 %");
    assert!(window.query_by_role_and_label(Role::Image, "Picture of depths.asc").is_some());
    assert!(window.query_by_label_contains("takes the extent of the file").is_some());
    let (possible, chosen) = roles(&window);
    let uses = ["Values through a curve", "Band of values", "Depth of water", "Surface"];
    assert_eq!(possible, uses, "neither risks nor diameters");
    assert_eq!(chosen.as_deref(), Some("Values through a curve"));
    click_button(&mut window, "Add");
    wait_until(&mut window, |window| settings(window).layers.len() == 4);
    let bounds = Rect::new(dvec2(500_000.0, 4_000_000.0), dvec2(503_000.0, 4_002_000.0));
    assert_eq!(settings(&window).domain.bounds, bounds);
    assert!(
        notice(&window).contains("was empty, so it takes the extent of depths.asc"),
        "{}",
        notice(&window)
    );
    let Some(RasterLayer { reading: RasterReading::Curve(curve), .. }) = active(&window).kind.get() else {
        panic!("the new layer is selected: {:?}", active(&window));
    };
    assert!(curve.knots().iter().all(|knot| knot[1] > 1.0), "diameters of the new extent: {curve:?}");
    assert!(!is_asked(&window));
}

#[test]
fn the_facts_of_a_file_are_its_own_size_and_an_extent_without_idle_digits() {
    let netcdf = include_bytes!("../../../crates/io/src/io/netcdf/tests/packed.nc");
    let file = written("facts", "packed.nc", netcdf);
    let mut window = window();
    new_document(&mut window);
    drop_and_wait(&mut window, &file);
    let size = meshbrush_ui::widgets::format::file_size(netcdf.len() as u64);
    assert_eq!(value_of(&window, Role::Definition, "File size"), size);
    key(&mut window, Modifiers::NONE, Key::Escape);
    let grid =
        "ncols 2\nnrows 2\nxllcorner -84.06666666680549\nyllcorner 36.5\ncellsize 0.1666666666\n1 2\n3 4\n";
    drop_and_wait(&mut window, &written("facts", "heights.asc", grid));
    // The status bar has x and y, too.
    let canvas = super::canvas(&window);
    let extent = ["x", "y"].map(|name| {
        let mut rows = window.query_all_by_role_and_label(Role::Definition, name);
        let row = rows.find(|row| canvas.contains(row.rect().center())).unwrap();
        row.value().unwrap_or_default()
    });
    assert_eq!(extent, ["−84.066667 … −83.733333", "36.5 … 36.833333"]);
}

#[test]
fn a_document_with_paint_keeps_its_extent() {
    let file = written("painted", "depths.asc", DEPTHS);
    let mut window = window();
    new_document(&mut window);
    paint(&mut window, 0.5);
    drop_and_wait(&mut window, &file);
    assert!(window.query_by_label_contains("takes the extent of the file").is_none());
    click_button(&mut window, "Add");
    let problem = wait_for_notice(&mut window);
    assert!(problem.contains("outside this document") && problem.contains("empty document"), "{problem}");
    assert_eq!(settings(&window).domain.bounds, Rect::UNIT);
}

#[test]
fn shapes_give_an_empty_document_their_extent_and_unit() {
    let file = written("shapes", "coast.geojson", COAST);
    let mut window = window();
    new_document(&mut window);
    drop_and_wait(&mut window, &file);
    let (possible, chosen) = roles(&window);
    assert_eq!(chosen.as_deref(), Some("Domain in metres"));
    assert!(possible.iter().any(|role| role == "Domain of a new document"), "{possible:?}");
    assert!(possible.iter().any(|role| role == "Keep-out region of paths"), "{possible:?}");
    choose_role(&mut window, "Shapes to measure the distance to");
    wait_until(&mut window, |window| settings(window).layers.len() == 4);
    assert!(matches!(
        &active(&window).kind,
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Shapes { .. }, .. })
    ));
    let bounds = settings(&window).domain.bounds;
    assert!(bounds.min.x < 20.0 && bounds.max.y > 33.0 && bounds.size().x < 5.0, "{bounds:?}");
    assert_eq!(settings(&window).unit, LengthUnit::Degree);
}

#[test]
fn polygons_become_a_domain_an_outline_a_mask_or_a_region() {
    let file = written("polygons", "coast.geojson", COAST);
    let mut window = window();
    drop_and_wait(&mut window, &file);
    click_button(&mut window, "Add");
    wait_until(&mut window, |window| settings(window).name == "coast");
    assert_ne!(settings(&window).boundary, BoundaryTreatment::Report);
    let Domain { projection, bounds, .. } = settings(&window).domain.clone();
    let plane = projection.expect("longitudes and latitudes are projected");
    open_tab(&mut window, Tab::Domain);
    assert_eq!(
        (settings(&window).unit, value_of(&window, Role::Definition, "Plane").as_str()),
        (LengthUnit::Metre, plane.kind().name())
    );
    assert!(bounds.size().min_element() > 3e5, "{bounds:?}");
    drop_and_wait(&mut window, &file);
    choose_role(&mut window, "Domain of a new document");
    wait_until(&mut window, |window| settings(window).unit == LengthUnit::Degree);
    drop_and_wait(&mut window, &file);
    choose_role(&mut window, "Mask of the selected layer");
    wait_until(&mut window, |window| active(window).mask.is_some());
    drop_and_wait(&mut window, &file);
    choose_role(&mut window, "Keep-out region of paths");
    wait_until(&mut window, |window| settings(window).paths.keep_out.len() == 1);
}

#[test]
fn polygons_in_degrees_lie_in_the_plane_of_the_document() {
    let file = written("plane", "coast.geojson", COAST);
    let mut window = window();
    let projection: Projection = "+proj=merc +lat_ts=30 +lon_0=22".parse().unwrap();
    let [low, high] = [dvec2(20.0, 30.0), dvec2(24.0, 33.0)].map(|at| projection.plane_from_geographic(at));
    let whole = Domain::rectangle(Rect::new(low - 1e5, high + 1e5));
    set(&mut window, Setting::Spacing(1e5));
    set(&mut window, Setting::Domain(Domain { projection: Some(projection), ..whole }));
    drop_and_wait(&mut window, &file);
    choose_role(&mut window, "Mask of the selected layer");
    wait_until(&mut window, |window| active(window).mask.is_some());
    let bounds = active(&window).mask.as_ref().unwrap().bounds();
    assert!(bounds.min.distance(low) < 1e-3 && bounds.max.distance(high) < 1e-3, "{bounds:?}");
    drop_and_wait(&mut window, &file);
    choose_role(&mut window, "Outline of this document");
    wait_until(&mut window, |window| settings(window).domain.region().is_some());
    assert_eq!(settings(&window).domain.projection, Some(projection));
}

#[test]
fn an_array_lies_where_its_world_file_says_or_over_the_document() {
    let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 3), }";
    let array =
        [b"\x93NUMPY\x01\0", &[header.len() as u8, 0][..], header.as_bytes(), &[5, 6, 7, 8, 9, 10]].concat();
    let file = written("array", "lengths.npy", array);
    let extent = |window: &Window| match &active(window).kind {
        LayerKind::Raster(RasterLayer { source, reading: RasterReading::Diameter }) => {
            source.raster.raster().bounds()
        }
        other => panic!("the new layer is selected: {other:?}"),
    };
    let [mut window, mut empty] = [window(), window()];
    let before = settings(&window).layers.len();
    drop_and_wait(&mut window, &file);
    assert!(roles(&window).0.iter().any(|role| role == "Target diameter"), "{:?}", roles(&window));
    choose_role(&mut window, "Target diameter");
    wait_until(&mut window, |window| settings(window).layers.len() > before);
    assert_eq!(extent(&window), settings(&window).domain.bounds);
    fs::write(file.with_extension("nyw"), "2\n0\n0\n-2\n11\n23\n").unwrap();
    new_document(&mut empty);
    drop_and_wait(&mut empty, &file);
    choose_role(&mut empty, "Target diameter");
    wait_until(&mut empty, |window| settings(window).name == "lengths");
    assert_eq!(extent(&empty), Rect::new(dvec2(10.0, 20.0), dvec2(16.0, 24.0)));
}

#[test]
fn a_line_can_be_measured_to_or_be_a_line_of_the_mesh_and_other_reasons_are_told() {
    let file = written("line", "line.geojson", LINE);
    let mut window = window();
    drop_and_wait(&mut window, &file);
    let (possible, chosen) = roles(&window);
    assert_eq!(
        possible,
        ["Sea around this land", "Shapes to measure the distance to", "Lines inside the mesh"]
    );
    assert_eq!(chosen.as_deref(), Some("Shapes to measure the distance to"));
    assert!(window.query_all_by_label_contains("has no polygons").count() > 0);
    key(&mut window, Modifiers::NONE, Key::Enter);
    wait_until(&mut window, |window| active(window).kind.is::<DistanceLayer>());
}

#[test]
fn tables_become_threats_or_pins() {
    let threats = written("threats", "threats.csv", THREATS);
    let points = written("points", "points.csv", POINTS);
    let mut window = window();
    new_document(&mut window);
    drop_and_wait(&mut window, &threats);
    assert_eq!(roles(&window).0, ["Threats"]);
    click_button(&mut window, "Add");
    wait_until(&mut window, |window| active(window).kind.is::<Threats>());
    let Some(threats) = active(&window).kind.get::<Threats>() else { panic!("a layer of threats") };
    assert_eq!(threats.list().len(), 2);
    assert_eq!(settings(&window).layers.len(), 4, "the layer that was selected stays as it is");
    let bounds = settings(&window).domain.bounds;
    let ranges = Rect::new(dvec2(0.2, 0.3), dvec2(0.8, 0.8));
    assert!(bounds.min.distance(ranges.min) + bounds.max.distance(ranges.max) < 1e-12, "{bounds:?}");
    drop_and_wait(&mut window, &points);
    choose_role(&mut window, "Pins");
    wait_until(&mut window, |window| settings(window).pins.len() == 2);
    assert!(notice(&window).contains("2 pins"), "a point that is there twice is one pin");
}

#[test]
fn points_and_background_pictures_give_an_empty_document_their_extent() {
    let points = written("extents", "stations.csv", "x,y\n100,10\n300,50\n");
    let mut window = window();
    new_document(&mut window);
    drop_and_wait(&mut window, &points);
    assert!(window.query_by_label_contains("takes the extent of the file").is_some());
    choose_role(&mut window, "Pins");
    wait_until(&mut window, |window| settings(window).pins.len() == 2);
    assert_eq!(settings(&window).domain.bounds, Rect::new(dvec2(80.0, -10.0), dvec2(320.0, 70.0)));
    assert!(notice(&window).contains("takes the extent of stations.csv"), "{}", notice(&window));

    let picture = written("extents", "map.png", "");
    fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/jacksboro_slope.png"), &picture).unwrap();
    for (world_file, width) in [(None, 1.0), (Some("2\n0\n0\n-2\n101\n899\n"), 806.0)] {
        if let Some(text) = world_file {
            fs::write(picture.with_extension("pgw"), text).unwrap();
        }
        new_document(&mut window);
        send(&mut window, Command::from(PictureCommand::Open(picture.clone())));
        wait_until(&mut window, |window| settings(window).background.is_some());
        let Settings { domain, background, .. } = settings(&window);
        let background = background.as_ref().unwrap();
        let [columns, rows] = background.picture.size.map(f64::from);
        assert_eq!(domain.bounds, background.bounds, "the picture is not distorted");
        assert_eq!((domain.bounds.size().x, domain.bounds.size().y), (width, width * rows / columns));
    }
    fs::remove_file(picture.with_extension("pgw")).unwrap();
}

#[test]
fn two_dropped_files_are_asked_about_one_after_the_other() {
    let [a, b] = ["a.geojson", "b.geojson"].map(|name| written(name, name, LINE));
    let mut window = window();
    drop_file(&mut window, &a);
    drop_and_wait(&mut window, &b);
    let is_about = |window: &Window, name: &str| window.query_by_label(&format!("Add {name}")).is_some();
    wait_until(&mut window, |window| is_about(window, "a.geojson") || is_about(window, "b.geojson"));
    let first_is_a = is_about(&window, "a.geojson");
    let before = entries(&window);
    key(&mut window, Modifiers::NONE, Key::Escape);
    let other = if first_is_a { "b.geojson" } else { "a.geojson" };
    wait_until(&mut window, |window| is_about(window, other));
    click_button(&mut window, "Cancel");
    assert!(!is_asked(&window));
    assert_eq!(entries(&window), before, "nothing was added");
}

#[test]
fn add_data_asks_for_a_file_and_tells_what_is_wrong_with_it() {
    let bad = written("bad", "bad.csv", "a,b\n1,2\n");
    let mut window = window();
    open_menu(&mut window, "File");
    window.get_by_label_contains("Add data…").click();
    window.run();
    super::type_into(&mut window, "Path", &bad.display().to_string());
    wait_until(&mut window, |window| window.query_by_label_contains("needs a header with x and y").is_some());
    assert!(window.query_by_label("Add data").is_some(), "another file can be given");
}

#[test]
fn a_new_document_starts_from_a_page() {
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::N);
    assert!(document(&window).paint().is_blank() && settings(&window).domain.bounds == Rect::UNIT);
    assert!(window.query_by_label("New document").is_some());
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(window.query_by_label("New document").is_none(), "the rectangle has the focus");
    key(&mut window, Modifiers::COMMAND, Key::N);
    click_button(&mut window, "Coast…");
    assert!(window.query_by_label("Open domain").is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    key(&mut window, Modifiers::COMMAND, Key::N);
    click_button(&mut window, "Aegean Sea");
    assert_eq!(settings(&window).name, "Aegean Sea");
}

#[test]
fn a_picture_lies_where_its_world_file_says() {
    let file = written("placed", "map.png", "");
    fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/jacksboro_slope.png"), &file).unwrap();
    fs::write(file.with_extension("pgw"), "2\n0\n0\n-2\n101\n899\n").unwrap();
    let mut window = window();
    new_document(&mut window);
    send(&mut window, Command::from(LayerCommand::OpenImage(file)));
    wait_until(&mut window, |window| settings(window).layers.len() == 4);
    let bounds = settings(&window).domain.bounds;
    assert_eq!((bounds.min.x, bounds.max.y), (100.0, 900.0));
    assert_eq!(bounds.size().x, 2.0 * 403.0);
}
