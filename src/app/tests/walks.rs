//! The walk of point location, the trail of neighbours, and hidden levels.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::{
    RESTING_PLACE, TALL, Window, button_event, choose, click, key, selected, send, value_of, wait_until,
    window_of,
};
use crate::app::command::{Command, ShellCommand};
use crate::app::tools::QUERY;

#[test]
fn the_inspector_says_how_long_the_walk_is_and_a_toggle_hides_it() {
    let mut window = window_of(TALL);
    send(&mut window, Command::Shell(ShellCommand::Use(&QUERY)));
    let point = dvec2(0.71, 0.735);
    click(&mut window, point, Modifiers::NONE);
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
    choose(&mut window, "View", "Walk of point location");
    assert!(window.state().view().aids.walk);
}

#[test]
fn with_shift_the_trail_of_neighbours_stays_until_the_next_query() {
    let mut window = window_of(TALL);
    send(&mut window, Command::Shell(ShellCommand::Use(&QUERY)));
    click(&mut window, dvec2(0.5, 0.45), Modifiers::NONE);
    let start = selected(&window).unwrap();
    let trail = |window: &Window| window.state().tools().trail.len();
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

/// A click on the row of a level in the legend.
fn click_row(window: &mut Window, level: u32, modifiers: Modifiers) {
    let label = format!("Level {level}:");
    let rows = window.query_all_by_role(Role::ListItem);
    let is_row = |name: Option<String>| name.is_some_and(|name| name.starts_with(&label));
    let row = rows.into_iter().find(|node| is_row(node.accesskit_node().label())).unwrap();
    let at = row.rect().center();
    window.event(Event::ModifiersChanged(modifiers));
    window.event(Event::PointerMoved(at));
    // In one frame: held for longer it would be no click.
    for pressed in [true, false] {
        window.event(button_event(at, PointerButton::Primary, pressed, modifiers));
    }
    window.run();
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    window.hover_at(RESTING_PLACE);
    window.run();
}

#[test]
fn a_row_of_the_legend_hides_its_level_and_alt_shows_it_alone() {
    let mut window = window_of(TALL);
    let shown = |window: &Window| {
        let view = window.state().view();
        view.style(super::settings(window), 1.0).shown_levels
    };
    assert_eq!(shown(&window), u64::MAX);
    click_row(&mut window, 2, Modifiers::NONE);
    assert_eq!(shown(&window), !(1 << 2));
    click_row(&mut window, 5, Modifiers::NONE);
    assert_eq!(shown(&window), !(1 << 2 | 1 << 5));
    click_row(&mut window, 2, Modifiers::NONE);
    assert_eq!(shown(&window), !(1 << 5));
    click_row(&mut window, 3, Modifiers::ALT);
    assert_eq!(shown(&window), 1 << 3);
    window.get_by_role_and_label(Role::Button, "Show all levels").click();
    window.run();
    window.hover_at(RESTING_PLACE);
    window.run();
    assert_eq!(shown(&window), u64::MAX);
}
