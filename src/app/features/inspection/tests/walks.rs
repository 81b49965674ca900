//! The walk of point location, and the trail of neighbours.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Shape};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::inspection::QUERY;
use crate::app::features::report::FigureCommand;
use crate::app::tests::{
    TALL, Window, choose, click, key, on_screen, painted_shapes, selected, send, value_of, wait_until,
    window_of,
};
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_study::report::ReportFigure;

#[test]
fn the_tab_method_says_how_long_the_walk_is_and_a_toggle_hides_it() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    let point = dvec2(0.71, 0.735);
    click(&mut window, point, Modifiers::NONE);
    choose(&mut window, "Method", "Show the tab Method");
    let walk = |window: &Window| value_of(window, Role::Definition, "Walk");
    wait_until(&mut window, |window| !walk(window).contains('…'));
    let app = window.state();
    let queried = app.session().queried().unwrap();
    let mesh = app.session().mesh();
    let (steps, mean) = (mesh.walk_path(queried).len() - 1, mesh.mean_walk_steps(1000));
    assert!(steps > 1 && mean > 0.0);
    assert_eq!(walk(&window), format!("{steps} steps (mean {mean:.1}, bound {})", mesh.walk_bound()));
    assert!(window.state().view().aids.walk);
    window.get_by_role_and_label(Role::CheckBox, "Show the walk").click();
    window.run();
    assert!(!window.state().view().aids.walk);
    choose(&mut window, "Method", "Walk of point location");
    assert!(window.state().view().aids.walk);
}

#[test]
fn with_shift_the_trail_of_neighbours_stays_until_the_next_query() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    click(&mut window, dvec2(0.5, 0.45), Modifiers::NONE);
    let start = selected(&window).unwrap();
    let trail = |window: &Window| window.state().session().trail().len();
    for (visited, digit) in [(2, Key::Num1), (3, Key::Num2), (4, Key::Num1)] {
        key(&mut window, Modifiers::SHIFT, digit);
        assert_eq!(trail(&window), visited);
    }
    assert_ne!(selected(&window), Some(start));
    key(&mut window, Modifiers::NONE, Key::Num1);
    assert_eq!(trail(&window), 0, "without Shift there is no trail");
    key(&mut window, Modifiers::SHIFT, Key::Num1);
    assert_eq!(trail(&window), 2);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!((trail(&window), selected(&window)), (0, None));
}

#[test]
fn the_walk_passes_below_the_number_of_the_neighbour_that_it_enters_through() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FigureCommand::Open(ReportFigure::Orientation)));
    window.run();
    let session = window.state().session();
    let path = session.mesh().walk_path(session.queried().unwrap());
    let [.., neighbour, last] = path[..] else { panic!("{path:?}") };
    let place = session.view().neighbours(last).iter().position(|one| one.triangle() == Some(neighbour));
    let number = (place.expect("it is a neighbour") + 1).to_string();
    let middle = session.view().world_corners(neighbour).iter().sum::<DVec2>() / 3.0;
    let at = on_screen(&window, middle);
    let shapes = painted_shapes(window.output());
    let of_number = shapes.iter().rposition(|shape| match shape {
        Shape::Text(text) => text.galley.text() == number && shape.visual_bounding_rect().contains(at),
        _ => false,
    });
    let of_number = of_number.expect("the neighbour has its number");
    let is_dot = |shape: &&Shape| match shape {
        Shape::Circle(circle) => circle.radius < 4.0 && circle.center.distance(at) < 6.0,
        _ => false,
    };
    assert!(!shapes[of_number..].iter().any(is_dot), "no dot covers the number");
    assert!(shapes[..of_number].iter().any(is_dot), "the walk is there");
}
