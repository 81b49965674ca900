//! The walk of point location, and the trail of neighbours.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use crate::app::features::inspection::QUERY;
use crate::app::tests::{TALL, Window, choose, click, key, selected, send, value_of, wait_until, window_of};
use meshbrush_kit::kit::command::{Command, ShellCommand};

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
