//! Drawing masks, keep-out regions and shapes.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::inspection::InspectCommand;
use crate::app::features::regions::RegionTool;
use crate::app::features::regions::{REGION, RegionCommand, RegionShape, RegionTarget};
use crate::app::tests::{
    TALL, Window, active, click, click_button, entries, fingerprint, key, level_at, move_to, notice,
    open_tab, press, release, send, settings, stroke, triangles, wait_until, window_of,
};
use meshbrush_core::document::DrawnShape;
use meshbrush_core::domain::{CutShape, corners};
use meshbrush_core::layers::{DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, ShapeList};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, LayerCommand};
use meshbrush_mesh::geometry::Rect;

const SQUARE: [DVec2; 4] = [dvec2(0.2, 0.2), dvec2(0.5, 0.2), dvec2(0.5, 0.5), dvec2(0.2, 0.5)];

/// Returns a new document in which the base layer, with a fine diameter, is selected.
fn with_fine_base() -> Window {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    let id = settings(&window).layers[0].id;
    send(&mut window, Command::from(LayerCommand::Select(id)));
    let kind = Box::new(LayerKind::constant(0.02));
    send(&mut window, Command::from(LayerCommand::SetKind(id, kind)));
    send(&mut window, Command::from(EditCommand::EndGesture));
    settle(&mut window);
    window
}

/// Waits until what was drawn is in the document, and the mesh follows it.
fn settle(window: &mut Window) {
    wait_until(window, |window| {
        let session = window.state().session();
        !session.is_cutting() && session.follower().is_in_step(session.document())
    });
}

fn choose(window: &mut Window, choice: &str) {
    window.get_by_role_and_label(Role::RadioButton, choice).click();
    window.run();
}

/// Chooses a shape in the list of the strip.
fn draw_with(window: &mut Window, shape: &str) {
    window.get_by_role_and_label(Role::ComboBox, "Draw with").click();
    window.run();
    window.get_all_by_role_and_label(Role::Button, shape).last().unwrap().click();
    window.run();
}

#[test]
fn rectangle_circle_and_lasso_are_drawn_in_one_drag_and_holes_are_filled() {
    let mut window = with_fine_base();
    let at_first = entries(&window);
    send(&mut window, Command::from(RegionCommand::Target(RegionTarget::Mask)));
    let near = |window: &Window, area: f64| {
        assert!((mask_area(window) - area).abs() < 3e-3, "{} for {area}", mask_area(window));
    };
    draw_with(&mut window, "Rectangle");
    stroke(&mut window, dvec2(0.1, 0.1), dvec2(0.5, 0.4));
    settle(&mut window);
    near(&window, 0.12);
    press(&mut window, dvec2(0.6, 0.1), Modifiers::SHIFT);
    move_to(&mut window, dvec2(0.8, 0.15));
    release(&mut window, dvec2(0.8, 0.15));
    settle(&mut window);
    near(&window, 0.16);
    draw_with(&mut window, "Circle");
    press(&mut window, dvec2(0.3, 0.25), Modifiers::ALT);
    move_to(&mut window, dvec2(0.4, 0.25));
    release(&mut window, dvec2(0.4, 0.25));
    settle(&mut window);
    let disc = std::f64::consts::PI * 0.01;
    near(&window, 0.16 - disc);
    assert_eq!(entries(&window), at_first + 3, "each is one entry");
    draw_with(&mut window, "Fill");
    click(&mut window, dvec2(0.3, 0.25), Modifiers::NONE);
    settle(&mut window);
    near(&window, 0.16);
    click(&mut window, dvec2(0.7, 0.2), Modifiers::ALT);
    settle(&mut window);
    near(&window, 0.12);
    click(&mut window, dvec2(0.9, 0.9), Modifiers::NONE);
    assert!(notice(&window).contains("no outline of the region encloses this place"), "{}", notice(&window));
    assert_eq!(entries(&window), at_first + 5);
    draw_with(&mut window, "Lasso");
    press(&mut window, dvec2(0.6, 0.6), Modifiers::NONE);
    for corner in [dvec2(0.8, 0.6), dvec2(0.8, 0.8), dvec2(0.6, 0.8)] {
        move_to(&mut window, corner);
    }
    release(&mut window, dvec2(0.6, 0.8));
    settle(&mut window);
    near(&window, 0.16);
    press(&mut window, dvec2(0.1, 0.6), Modifiers::NONE);
    move_to(&mut window, dvec2(0.3, 0.9));
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, dvec2(0.3, 0.9));
    assert_eq!(entries(&window), at_first + 6, "Escape gives a lasso up");
}

#[test]
fn a_hole_of_a_keep_out_region_is_filled_without_choosing_the_region() {
    let mut window = with_fine_base();
    send(&mut window, Command::from(RegionCommand::Target(RegionTarget::KeepOut)));
    let area = |window: &Window| {
        let regions = &settings(window).paths.keep_out;
        regions.iter().map(|region| region.mask.area()).sum::<f64>()
    };
    draw_with(&mut window, "Rectangle");
    stroke(&mut window, dvec2(0.2, 0.2), dvec2(0.6, 0.6));
    settle(&mut window);
    press(&mut window, dvec2(0.3, 0.3), Modifiers::ALT);
    move_to(&mut window, dvec2(0.4, 0.4));
    release(&mut window, dvec2(0.4, 0.4));
    settle(&mut window);
    assert!((area(&window) - 0.15).abs() < 3e-3, "{}", area(&window));
    send(&mut window, Command::from(RegionCommand::KeepOut(None)));
    draw_with(&mut window, "Fill");
    click(&mut window, dvec2(0.35, 0.35), Modifiers::NONE);
    settle(&mut window);
    assert!((area(&window) - 0.16).abs() < 3e-3, "{}", area(&window));
    assert_eq!(settings(&window).paths.keep_out.len(), 1);
}

fn draw_polygon(window: &mut Window, corners: &[DVec2]) {
    for &corner in corners {
        click(window, corner, Modifiers::NONE);
    }
    key(window, Modifiers::NONE, Key::Enter);
    settle(window);
}

fn mask_area(window: &Window) -> f64 {
    active(window).mask.as_ref().map_or(0.0, |mask| mask.area())
}

fn shapes(layer: &Layer) -> Option<&ShapeList> {
    match &layer.kind {
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Shapes { shapes, .. }, .. }) => {
            Some(shapes.list())
        }
        _ => None,
    }
}

#[test]
fn a_mask_is_drawn_as_a_polygon_painted_and_cut_and_each_is_one_entry() {
    let mut window = with_fine_base();
    let (before, at_first) = (fingerprint(&window), entries(&window));
    let (inside, outside) = (dvec2(0.35, 0.35), dvec2(0.8, 0.8));
    let fine = level_at(&window, outside);
    click_button(&mut window, "Draw mask");
    assert_eq!(window.state().tools().tool, &REGION);
    draw_with(&mut window, "Polygon");
    draw_polygon(&mut window, &SQUARE);
    assert!((mask_area(&window) - 0.09).abs() < 2e-3, "{}", mask_area(&window));
    assert_eq!(entries(&window), at_first + 1);
    assert_eq!(level_at(&window, inside), fine);
    assert!(level_at(&window, outside) < fine, "the layer counts inside only");

    draw_with(&mut window, "Brush");
    let radius = window.state().tools().radius;
    stroke(&mut window, dvec2(0.7, 0.8), dvec2(0.9, 0.8));
    settle(&mut window);
    let painted = 0.09 + std::f64::consts::PI * radius * radius + 0.4 * radius;
    assert!((mask_area(&window) - painted).abs() < 3e-3, "{} {painted}", mask_area(&window));
    assert_eq!(entries(&window), at_first + 2, "a stroke is one entry");
    assert_eq!(level_at(&window, outside), fine, "the mesh follows");

    key(&mut window, Modifiers::NONE, Key::X);
    stroke(&mut window, dvec2(0.2, 0.35), dvec2(0.5, 0.35));
    settle(&mut window);
    assert!(mask_area(&window) < painted - 0.02);
    assert_eq!(active(&window).mask.as_ref().unwrap().polygons().len(), 3, "the square is cut in two");
    assert_eq!(entries(&window), at_first + 3);
    for _ in 0..3 {
        key(&mut window, Modifiers::COMMAND, Key::Z);
        settle(&mut window);
    }
    assert_eq!((fingerprint(&window), mask_area(&window)), (before, 0.0));
}

#[test]
fn cutting_begins_with_the_whole_domain_and_clearing_removes_the_mask() {
    let mut window = with_fine_base();
    send(&mut window, Command::from(RegionCommand::Target(RegionTarget::Mask)));
    send(&mut window, Command::from(RegionCommand::Shape(RegionShape::Polygon)));
    choose(&mut window, "Cut");
    draw_polygon(&mut window, &SQUARE);
    assert!((mask_area(&window) - 0.91).abs() < 2e-3, "{}", mask_area(&window));
    let before = entries(&window);
    let everything = CutShape::Ring(corners(&Rect::around(DVec2::splat(0.5), 2.0)));
    send(&mut window, Command::from(RegionCommand::Draw(DrawnShape::Area(everything), false)));
    send(&mut window, Command::from(EditCommand::EndGesture));
    settle(&mut window);
    assert!(notice(&window).contains("Nothing would be left of the mask"), "{}", notice(&window));
    assert_eq!(entries(&window), before);
    send(&mut window, Command::from(RegionCommand::Clear));
    assert_eq!((active(&window).mask.clone(), entries(&window)), (None, before + 1));
}

#[test]
fn escape_takes_the_polygon_and_the_stroke_back() {
    let mut window = with_fine_base();
    let before = entries(&window);
    key(&mut window, Modifiers::NONE, Key::M);
    draw_with(&mut window, "Polygon");
    for corner in &SQUARE[..3] {
        click(&mut window, *corner, Modifiers::NONE);
    }
    key(&mut window, Modifiers::NONE, Key::Backspace);
    assert_eq!(window.state().tools().settings::<RegionTool>().corners.len(), 2);
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(notice(&window).contains("three corners"), "{}", notice(&window));
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.state().tools().settings::<RegionTool>().corners.is_empty());
    draw_with(&mut window, "Brush");
    press(&mut window, SQUARE[0], Modifiers::NONE);
    move_to(&mut window, SQUARE[2]);
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, SQUARE[2]);
    settle(&mut window);
    assert_eq!((active(&window).mask.clone(), entries(&window)), (None, before));
}

#[test]
fn a_locked_layer_keeps_its_mask() {
    let mut window = with_fine_base();
    let id = active(&window).id;
    send(&mut window, Command::from(LayerCommand::Lock(id, true)));
    send(&mut window, Command::from(RegionCommand::Target(RegionTarget::Mask)));
    stroke(&mut window, SQUARE[0], SQUARE[2]);
    assert!(notice(&window).contains("is locked"), "{}", notice(&window));
    assert_eq!(active(&window).mask, None);
}

#[test]
fn keep_out_regions_are_drawn_and_paths_are_found_around_them() {
    let mut window = with_fine_base();
    open_tab(&mut window, Tab::Paths);
    click_button(&mut window, "Draw keep-out region");
    draw_with(&mut window, "Polygon");
    draw_polygon(&mut window, &SQUARE);
    let regions = |window: &Window| -> Vec<(String, f64)> {
        let regions = settings(window).paths.keep_out.iter();
        regions.map(|region| (region.name.clone(), region.mask.area())).collect()
    };
    assert_eq!(regions(&window).len(), 1);
    assert!((regions(&window)[0].1 - 0.09).abs() < 2e-3);
    send(&mut window, Command::from(RegionCommand::Rename(0, "Shoals".into())));
    assert_eq!(regions(&window)[0].0, "Shoals");
    // The next polygon joins the region, and with *new region* it is another one.
    let apart = SQUARE.map(|corner| corner + 0.4);
    draw_polygon(&mut window, &apart);
    assert_eq!(regions(&window).len(), 1);
    send(&mut window, Command::from(RegionCommand::KeepOut(None)));
    draw_polygon(&mut window, &SQUARE.map(|corner| 0.4 * corner));
    assert_eq!(regions(&window)[1].0, "drawn region 1");
    key(&mut window, Modifiers::NONE, Key::X);
    send(&mut window, Command::from(RegionCommand::KeepOut(None)));
    draw_polygon(&mut window, &SQUARE);
    assert!((regions(&window)[0].1 - 0.09).abs() < 2e-3, "what is cut goes from the region where it begins");
    draw_polygon(&mut window, &apart);
    assert_eq!(regions(&window).len(), 1, "a region of which nothing is left goes");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(regions(&window).len(), 2);
}

#[test]
fn shapes_are_drawn_with_a_layer_of_their_own() {
    let mut window = with_fine_base();
    let before = entries(&window);
    send(&mut window, Command::from(RegionCommand::Target(RegionTarget::Shapes)));
    draw_with(&mut window, "Line");
    for corner in &SQUARE[..2] {
        click(&mut window, *corner, Modifiers::NONE);
    }
    let coarse = triangles(&window);
    key(&mut window, Modifiers::NONE, Key::Enter);
    settle(&mut window);
    assert_eq!(shapes(active(&window)).map(|list| list.lines.len()), Some(1));
    assert_eq!((settings(&window).layers.len(), entries(&window)), (4, before + 1));
    assert!(triangles(&window) > coarse, "the mesh follows");
    draw_with(&mut window, "Point");
    click(&mut window, dvec2(0.8, 0.8), Modifiers::NONE);
    settle(&mut window);
    draw_with(&mut window, "Polygon");
    draw_polygon(&mut window, &SQUARE.map(|corner| corner + 0.3));
    let list = shapes(active(&window)).unwrap().clone();
    assert_eq!((list.points.len(), list.lines.len(), list.polygons.len()), (1, 1, 1));
    assert_eq!((settings(&window).layers.len(), entries(&window)), (4, before + 3));
    choose(&mut window, "Cut");
    draw_with(&mut window, "Brush");
    stroke(&mut window, dvec2(0.35, 0.1), dvec2(0.35, 0.3));
    settle(&mut window);
    assert_eq!(shapes(active(&window)).map(|list| list.lines.len()), Some(2), "the line is cut in two");
    assert_eq!(entries(&window), before + 4);
    // A layer without shapes is not touched.
    send(&mut window, Command::from(LayerCommand::Select(LayerId(0))));
    send(&mut window, Command::from(RegionCommand::Cuts(true)));
    stroke(&mut window, SQUARE[0], SQUARE[2]);
    assert!(notice(&window).contains("Nothing can be cut"), "{}", notice(&window));
    assert_eq!(entries(&window), before + 4);
}

#[test]
fn a_polygon_that_was_begun_is_dropped_with_another_target_or_shape() {
    let mut window = with_fine_base();
    for command in [
        RegionCommand::Target(RegionTarget::KeepOut),
        RegionCommand::Target(RegionTarget::Mask),
        RegionCommand::Shape(RegionShape::Brush),
        RegionCommand::Shape(RegionShape::Polygon),
    ] {
        send(&mut window, Command::from(RegionCommand::Shape(RegionShape::Polygon)));
        SQUARE[..2].iter().for_each(|&corner| click(&mut window, corner, Modifiers::NONE));
        assert_eq!(window.state().tools().settings::<RegionTool>().corners.len(), 2, "{command:?}");
        send(&mut window, Command::from(command));
        assert!(window.state().tools().settings::<RegionTool>().corners.is_empty());
    }
}

#[test]
fn escape_drops_a_polygon_before_the_query() {
    let mut window = with_fine_base();
    send(&mut window, Command::from(InspectCommand::Query(dvec2(0.7, 0.7))));
    send(&mut window, Command::from(RegionCommand::Shape(RegionShape::Polygon)));
    click(&mut window, SQUARE[0], Modifiers::NONE);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.state().tools().settings::<RegionTool>().corners.is_empty());
    assert!(window.state().session().queried().is_some(), "one thing at a time");
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.state().session().queried().is_none());
}
