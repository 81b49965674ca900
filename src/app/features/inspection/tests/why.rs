//! Why the queried triangle is in the mesh, in the panel and by keys.

use eframe::egui::accesskit::Role;
use eframe::egui::{Color32, Key, Modifiers, Shape};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::inspection::Inspector;
use crate::app::features::inspection::QUERY;
use crate::app::tests::{TALL, Window, click, key, painted_shapes, send, stroke, window_of};
use meshbrush_core::explain::Explanation;
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_mesh::mesh::{Cause, TriangleId};

fn explanation(window: &Window) -> &Explanation {
    window.state().features().get::<Inspector>().explore.explanation().unwrap()
}

/// Queries a triangle of the shown mesh that was bisected for compatibility, or for its own rule.
fn query_one(window: &mut Window, compatibility: bool) {
    key(window, Modifiers::NONE, Key::Q);
    assert_eq!(window.state().tools().tool, &QUERY);
    let count = window.state().session().mesh().raw_triangle_count();
    for index in (0..count).step_by(7) {
        let corners = window.state().session().mesh().view().world_corners(TriangleId::from_index(index));
        click(window, corners.iter().sum::<glam::DVec2>() / 3.0, Modifiers::NONE);
        match explanation(window).cause {
            Cause::Compatibility { ref chain } if compatibility && chain.len() > 2 => return,
            Cause::OwnRule { .. } if !compatibility => return,
            _ => {}
        }
    }
    panic!("no such triangle");
}

fn says(window: &Window, text: &str) -> bool {
    window.query_by_label_contains(text).is_some()
}

fn row(window: &Window, name: &str) -> Option<String> {
    window.query_by_role_and_label(Role::Definition, name).and_then(|row| row.value())
}

fn press_button(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::Button, name).click();
    window.run();
}

fn choose_node(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::RadioButton, name).click();
    window.run();
}

#[test]
fn the_panel_names_the_layer_that_asked_for_a_triangle() {
    let mut window = window_of(TALL);
    query_one(&mut window, false);
    assert!(says(&window, "exceeds its target."), "the parent's own rule");
    assert!(says(&window, "where the layer “"), "the layer that decides");
    assert!(window.state().features().get::<Inspector>().explore.chain().is_empty());
}

#[test]
fn the_chain_is_walked_by_chips_and_by_keys() {
    let mut window = window_of(TALL);
    query_one(&mut window, true);
    assert!(says(&window, "to keep the mesh compatible"));
    let chain = window.state().features().get::<Inspector>().explore.chain().to_vec();
    press_button(&mut window, "Triangle 1 of the chain");
    assert_eq!(window.state().features().get::<Inspector>().explore.shown(), chain.first());
    key(&mut window, Modifiers::NONE, Key::Period);
    assert_eq!(window.state().features().get::<Inspector>().explore.shown(), chain.get(1));
    key(&mut window, Modifiers::NONE, Key::Comma);
    assert_eq!(window.state().features().get::<Inspector>().explore.link(), Some(0));
    key(&mut window, Modifiers::COMMAND, Key::PageDown);
    assert!(!window.state().features().get::<Inspector>().explore.is_away(), "back to the queried triangle");
}

#[test]
fn the_tree_is_walked_up_and_down() {
    let mut window = window_of(TALL);
    query_one(&mut window, false);
    let queried = explanation(&window).triangle;
    key(&mut window, Modifiers::NONE, Key::PageUp);
    let parent = *window.state().features().get::<Inspector>().explore.shown().unwrap();
    assert_eq!(parent.level() + 1, queried.level());
    assert_eq!(row(&window, "State").unwrap(), "was bisected");
    let halves = parent.children();
    let half = halves.iter().position(|half| half.is_same(&queried)).unwrap();
    press_button(&mut window, ["Second half", "First half"][half]);
    let sibling = *window.state().features().get::<Inspector>().explore.shown().unwrap();
    assert!(halves[1 - half].is_same(&sibling));
    press_button(&mut window, "Sibling");
    assert!(
        !window.state().features().get::<Inspector>().explore.is_away(),
        "the sibling of the sibling is the queried triangle"
    );
    key(&mut window, Modifiers::COMMAND, Key::PageUp);
    assert_eq!(window.state().features().get::<Inspector>().explore.shown().unwrap().level(), 0);
    press_button(&mut window, &format!("Ancestor of level {}", parent.level()));
    assert!(window.state().features().get::<Inspector>().explore.shown().unwrap().is_same(&parent));
    press_button(&mut window, "Ancestor of level 0");
    choose_node(&mut window, "Apex");
    assert_eq!(row(&window, "Parent nodes").unwrap(), "none: a coarse node");
    press_button(&mut window, "Queried triangle");
    choose_node(&mut window, "Apex");
    assert!(row(&window, "First parent node").is_some());
    let dark = Color32::from_black_alpha(220);
    assert!(rims_of_dots(&window, Color32::WHITE).contains(&dark), "the node itself");
    let black = rims_of_dots(&window, Color32::BLACK);
    assert!(black.iter().all(|rim| *rim == Color32::WHITE), "seen on any colour: {black:?}");
    choose_node(&mut window, "No node");
    assert!(row(&window, "First parent node").is_none());
    assert!(!rims_of_dots(&window, Color32::WHITE).contains(&dark));
}

/// Returns the colours around the dots of a colour at nodes.
fn rims_of_dots(window: &Window, fill: Color32) -> Vec<Color32> {
    let dots = painted_shapes(window.output()).into_iter().filter_map(|shape| match shape {
        Shape::Circle(dot) if dot.fill == fill && dot.radius == 3.5 => Some(dot.stroke.color),
        _ => None,
    });
    dots.collect()
}

#[test]
fn an_edit_is_explained_once_the_mesh_is_complete() {
    let mut window = window_of(TALL);
    query_one(&mut window, false);
    let point = window.state().session().queried().unwrap();
    key(&mut window, Modifiers::NONE, Key::PageUp);
    let before = explanation(&window).triangle;
    key(&mut window, Modifiers::NONE, Key::B);
    stroke(&mut window, point, point + dvec2(0.01, 0.0));
    key(&mut window, Modifiers::NONE, Key::Q);
    window.run();
    let after = explanation(&window);
    assert!(after.triangle.level() >= before.level());
    assert!(
        !window.state().features().get::<Inspector>().explore.is_away(),
        "another mesh: the walk starts again"
    );
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.state().features().get::<Inspector>().explore.explanation().is_none());
    assert!(says(&window, "what asked for it appears here"));
}

#[test]
fn overlays_of_slack_forced_triangles_and_ages_have_legends() {
    let mut window = window_of(TALL);
    for (entry, legend) in [
        ("Overlay slack", "Legend: slack 1 to 16"),
        ("Overlay forced triangles", "Legend: triangles that only compatibility asked for"),
        ("Overlay age of triangles", "Legend: edits ago, 0 to 10"),
    ] {
        crate::app::tests::choose_in_palette(&mut window, entry);
        assert!(window.query_by_label(legend).is_some(), "{legend}");
    }
}

#[test]
fn the_age_of_a_triangle_counts_the_edits_since_it_came() {
    let mut window = window_of(TALL);
    let age = |window: &Window, at: DVec2| {
        let id = window.state().session().mesh().locate(at).triangle().unwrap();
        window.state().session().ages().of(id)
    };
    let [first, second, other] = [dvec2(0.2, 0.8), dvec2(0.8, 0.2), dvec2(0.5, 0.02)];
    window.run_steps(5);
    assert_eq!(age(&window, first), None, "nothing was edited yet");
    stroke(&mut window, first, first + dvec2(0.05, 0.0));
    window.run_steps(5);
    assert_eq!([first, second].map(|at| age(&window, at)), [Some(0), None]);
    stroke(&mut window, second, second + dvec2(0.05, 0.0));
    window.run_steps(5);
    assert_eq!([first, second, other].map(|at| age(&window, at)), [Some(1), Some(0), None]);
    send(&mut window, Command::from(EditCommand::Undo));
    window.run_steps(5);
    assert_eq!(age(&window, first), Some(2), "an undo is an edit");
}
