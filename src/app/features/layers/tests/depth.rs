//! Layers of depths and straits.

use std::fs;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

use glam::{DVec2, dvec2};

use crate::app::tests::pictures::{drawn_window, picture, pixel};
use crate::app::tests::{
    RESTING_PLACE, TALL, Window, active, click_button, entries, folder, notice, on_screen, send, settings,
    step_until, triangles, type_into, value_of, wait_for_jobs, wait_for_notice, wait_until, window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::layers::{DepthRule, DepthSizes, Depths, LayerKind, PositiveDepth, Straits};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, LayerCommand, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Heights that fall from 10 m in the west to -190 m in the east, over 20 km.
fn heights() -> String {
    let row: Vec<String> = (0..20).map(|column| (5 - 10 * column).to_string()).collect();
    let header = "ncols 20\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 1000\n";
    header.to_owned() + &format!("{}\n", row.join(" ")).repeat(20)
}

fn sizes(window: &Window) -> DepthSizes {
    let Some(depths) = active(window).kind.get::<Depths>() else { panic!("depths: {:?}", active(window)) };
    *depths.sizes()
}

#[test]
fn a_grid_of_heights_gives_sizes_and_the_depths_in_files() {
    let folder = folder("app-depth", "sizes");
    let file = folder.join("heights.asc");
    fs::write(&file, heights()).unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(LayerCommand::OpenDepth(file)));
    wait_until(&mut window, |window| active(window).kind.is::<Depths>());
    assert_eq!(
        (sizes(&window).positive, sizes(&window).rule),
        (PositiveDepth::Up, DepthRule::DEFAULT_WAVELENGTH)
    );
    assert_eq!(settings(&window).domain.bounds.max.x, 20_000.0, "an empty document takes the extent");
    click_on(&mut window, Role::RadioButton, "Bottom slope");
    wait_until(&mut window, |window| matches!(sizes(window).rule, DepthRule::Slope { .. }));
    let before = triangles(&window);
    type_into(&mut window, "Triangles", "60");
    assert!(triangles(&window) > before, "the mesh follows: {} after {before}", triangles(&window));
    // Deeper water and land ask for nothing.
    let before = triangles(&window);
    click_on(&mut window, Role::CheckBox, "Only between two depths");
    type_into(&mut window, "To depth", "50");
    assert!(sizes(&window).between == [0.0, 50.0] && triangles(&window) < before);
    let exported = folder.join("mesh.14");
    send(&mut window, Command::from(FileCommand::Export(exported.clone())));
    let notice = wait_for_notice(&mut window);
    assert!(notice.contains("mesh.14"), "{notice}");
    let text = fs::read_to_string(exported).unwrap();
    let nodes: usize = text.lines().nth(1).unwrap().split_whitespace().nth(1).unwrap().parse().unwrap();
    for line in text.lines().skip(2).take(nodes) {
        let [_, x, _, depth] = line.split_whitespace().collect::<Vec<_>>()[..] else { panic!("{line}") };
        let [x, depth] = [x, depth].map(|number| number.parse::<f64>().unwrap());
        // The pixels at both ends are flat as far as their middle.
        let expected = (x.clamp(500.0, 19_500.0) - 1000.0) * 0.01;
        assert!((depth - expected).abs() < 6.0, "{line}: {expected} m");
    }
}

#[test]
fn sizes_need_a_document_in_metres() {
    let file = folder("app-depth", "unit").join("heights.asc");
    fs::write(&file, heights()).unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::from(EditCommand::Set(Setting::LengthUnit(LengthUnit::Kilometre))));
    send(&mut window, Command::from(LayerCommand::OpenDepth(file)));
    wait_until(&mut window, |window| active(window).kind.is::<Depths>());
    assert_eq!(sizes(&window).rule, DepthRule::Nothing);
    click_on(&mut window, Role::RadioButton, "Wavelength");
    assert_eq!(sizes(&window).rule, DepthRule::Nothing);
    let remarks = window.query_all_by_label_contains("Sizes from depths need a document in metres").count();
    assert_eq!(remarks, 1);
}

/// Clicks the button that makes the contour the domain, for one frame: while the mesh follows, news fades.
pub fn begin_contour(window: &mut Window) {
    window.get_by_role_and_label(Role::Button, "Use the contour as the domain").click();
    window.step();
}

#[test]
fn the_contour_of_a_layer_becomes_the_domain() {
    let file = folder("app-layer-contour", "contour").join("bay.asc");
    // A bay that is open in the south, with an island of one pixel.
    let rows = ["9 9 9 9 9 9", "9 -5 -5 -5 -5 9", "9 -5 -5 2 -5 9", "9 -5 -5 -5 -5 9", "9 -5 -5 -5 -5 9"];
    let head = "ncols 6\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 0.2\n";
    fs::write(&file, head.to_owned() + &rows.join("\n")).unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::from(LayerCommand::OpenDepth(file)));
    wait_until(&mut window, |window| active(window).name == "bay.asc");
    let domain = |window: &Window| settings(window).domain.clone();
    let before = domain(&window);
    begin_contour(&mut window);
    step_until(&mut window, |window| domain(window) != before);
    let found = domain(&window);
    let rings: Vec<_> = found.region().unwrap().rings().collect();
    assert_eq!((rings.len(), found.bounds), (2, Rect::new(DVec2::ZERO, DVec2::ONE)));
    assert_eq!(notice(&window), "The domain was replaced: it is the contour of bay.asc.");
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(domain(&window), before);
    type_into(&mut window, "Smallest island", "0.05");
    click_button(&mut window, "Use the contour as the domain");
    wait_until(&mut window, |window| domain(window) != before);
    assert_eq!(domain(&window).region().unwrap().rings().count(), 1);
    type_into(&mut window, "Contour", "50");
    click_button(&mut window, "Use the contour as the domain");
    assert!(wait_for_notice(&mut window).contains("no pixel is deeper than 50 m"), "{}", notice(&window));
}

#[test]
fn pixels_without_a_value_that_become_land_are_told() {
    let file = folder("app-layer-contour", "unknown").join("bay.asc");
    let rows = ["9 9 9 9 9 9", "9 -5 -5 -5 -5 9", "9 -5 -1 -1 -5 9", "9 -5 -5 -5 -5 9", "9 -5 -5 -5 -5 9"];
    let head = "ncols 6\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 0.2\nNODATA_value -1\n";
    fs::write(&file, head.to_owned() + &rows.join("\n")).unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::from(LayerCommand::OpenDepth(file)));
    wait_until(&mut window, |window| active(window).name == "bay.asc");
    begin_contour(&mut window);
    step_until(&mut window, |window| notice(window).contains("was replaced"));
    assert!(
        notice(&window).ends_with("2 pixels without a value in it count as land."),
        "{}",
        notice(&window)
    );
    assert_eq!(settings(&window).domain.region().unwrap().rings().count(), 2, "an island");
}

#[test]
fn straits_are_found_again_when_the_outline_changes() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    let before = triangles(&window);
    click_button(&mut window, "Add layer");
    click_button(&mut window, "straits of the domain");
    wait_until(&mut window, |window| triangles(window) > before);
    assert_ne!(value_of(&window, Role::Button, "Narrowest strait"), "none");
    let found = |window: &Window| match &active(window).kind {
        LayerKind::Straits(Straits { found, .. }) => found.clone(),
        other => panic!("straits: {other:?}"),
    };
    let first = found(&window);
    type_into(&mut window, "Triangles across", "1");
    assert!(found(&window) == first, "another number needs no other straits");
    let Some(Straits { across, .. }) = active(&window).kind.get() else { panic!("straits") };
    assert_eq!(*across, 1.0);
    let mut domain = settings(&window).domain.clone();
    let rings = domain.region().unwrap().polygons()[0][0].clone();
    domain = meshbrush_core::domain::Domain::of_polygons(&[vec![rings]]).unwrap();
    let count = entries(&window);
    send(&mut window, Command::from(EditCommand::Set(Setting::Domain(domain))));
    assert!(found(&window) != first && entries(&window) > count, "without islands there are other straits");
    send(&mut window, Command::from(EditCommand::Undo));
    assert!(found(&window) == first);
}

pub fn click_on(window: &mut Window, role: Role, label: &str) {
    window.get_by_role_and_label(role, label).click();
    window.run();
}

#[test]
fn the_overlays_of_depths_have_the_colours_of_their_legends() {
    let folder = folder("app-depth", "overlay");
    let file = folder.join("heights.asc");
    fs::write(&file, heights()).unwrap();
    let mut window = drawn_window();
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Depth)));
    assert!(window.query_by_label_contains("Legend: no layer of depths").is_some());
    send(&mut window, Command::from(LayerCommand::OpenDepth(file)));
    wait_until(&mut window, |window| active(window).kind.is::<Depths>());
    for overlay in [FieldOverlay::Depth, FieldOverlay::DepthError] {
        send(&mut window, Command::from(ViewCommand::SetOverlay(overlay)));
        window.hover_at(RESTING_PLACE);
        window.run();
        wait_for_jobs(&mut window);
        let image = picture(&mut window);
        let [land, shallow, deep] =
            [700.0, 6_000.0, 19_000.0].map(|x| pixel(&image, on_screen(&window, dvec2(x, 9_400.0))));
        if overlay == FieldOverlay::Depth {
            assert!(window.query_by_label_contains("Legend: depth 0 to 185 m").is_some());
            assert!(land[0] > land[2], "land is brown: {land:?}");
            assert!(shallow[1] > deep[1] + 40 && deep[2] > deep[0] + 30, "{shallow:?} {deep:?}");
        } else {
            assert!(window.query_by_label_contains("Legend: depth error −10 % to 10 %").is_some());
            // A plane, so that the mesh is exact.
            assert_eq!(shallow, deep);
        }
    }
}
