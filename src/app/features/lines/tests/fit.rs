//! Which parts of lines are on edges.

use eframe::egui::accesskit::Role;
use eframe::egui::{Color32, Shape};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::{draw, lines, tool, wait_for_fits, with_tool};
use crate::app::features::lines::places::reason;
use crate::app::features::lines::{LineEnd, LineToolMode, LinesCommand};
use crate::app::tests::{Window, in_world, move_to, on_screen, painted_shapes, send, value_of};
use meshbrush_core::outline::LineProblem;
use meshbrush_kit::kit::command::Command;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::theme::tokens_of;

/// Returns how many line segments are painted in a colour.
fn segments(window: &Window, color: Color32) -> usize {
    let shapes = painted_shapes(window.output());
    let is_so = |shape: &&&Shape| matches!(shape, Shape::LineSegment { stroke, .. } if stroke.color == color);
    shapes.iter().filter(is_so).count()
}

fn through(window: &mut Window) {
    let points = vec![dvec2(-0.2, 0.51), dvec2(1.3, 0.62)];
    send(window, Command::from(LinesCommand::Draw(points, LineEnd::Open)));
    wait_for_fits(window);
}

#[test]
fn parts_that_are_not_on_edges_are_dashed_and_say_why() {
    let mut window = with_tool(LineToolMode::Corners);
    let danger = tokens_of(&window.ctx).danger;
    draw(&mut window, &[dvec2(0.2, 0.2), dvec2(0.8, 0.31)]);
    wait_for_fits(&mut window);
    assert_eq!(segments(&window, danger), 0, "all of it is on edges");
    through(&mut window);
    assert!(segments(&window, danger) > 3, "{}", segments(&window, danger));
    let fit = window.state().session().derived().unwrap().line_fits[1].clone();
    assert_eq!(fit.unresolved.len(), 2);
    send(&mut window, Command::from(meshbrush_kit::kit::command::ViewCommand::Zoom(0.5)));
    let place = fit.unresolved[0].place;
    let beside = in_world(&window, on_screen(&window, place) + eframe::egui::vec2(3.0, 2.0));
    move_to(&mut window, beside);
    let said = reason(&fit.unresolved[0], LengthUnit::None);
    assert!(said.starts_with("Outside the domain: 0.2"), "{said}");
    let labels = window.query_all_by_role_and_label(Role::Label, &said).count();
    assert_eq!(labels, 2, "the mark says so, and the list");
}

#[test]
fn the_list_walks_through_the_places() {
    let mut window = with_tool(LineToolMode::Corners);
    through(&mut window);
    assert_eq!(value_of(&window, Role::Button, "Not on edges"), "2 places");
    let fit = window.state().session().derived().unwrap().line_fits[0].clone();
    for (value, place) in [("1 of 2", 0), ("2 of 2", 1), ("1 of 2", 0)] {
        window.get_by_role_and_label(Role::Button, "Not on edges").click();
        window.run();
        assert_eq!(value_of(&window, Role::Button, "Not on edges"), value);
        let middle = window.state().view().camera.unwrap().visible_world().center();
        // The middle of the view stays on the domain.
        let place = fit.unresolved[place].place.clamp(DVec2::ZERO, DVec2::ONE);
        assert!(middle.distance(place) < 0.05, "{middle} {value}");
    }
    assert_eq!(tool(&window).selected, Some(0));
}

#[test]
fn a_line_too_close_to_another_names_the_diameter_that_it_needs() {
    let mut window = with_tool(LineToolMode::Corners);
    let pair = |y: f64| vec![dvec2(0.2, y), dvec2(0.8, y)];
    for y in [0.513, 0.5135] {
        send(&mut window, Command::from(LinesCommand::Draw(pair(y), LineEnd::Open)));
    }
    wait_for_fits(&mut window);
    let fits = window.state().session().derived().unwrap().line_fits.clone();
    let coarse = fits.iter().flat_map(|fit| &fit.unresolved).next().expect("a part that is too coarse");
    assert_eq!(coarse.problem, LineProblem::TooCoarse);
    let said = reason(coarse, LengthUnit::Metre);
    assert!(said.starts_with("Too coarse: ") && said.contains("Triangles of about 0.0005 m"), "{said}");
    assert!(lines(&window).iter().all(|line| line.points[0].x == 0.2));
    let far: DVec2 = coarse.place;
    assert!((far.y - 0.513).abs() < 1e-3);
}
