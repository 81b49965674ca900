//! Hidden levels.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::app::tests::{RESTING_PLACE, TALL, Window, button_event, open_tab, window_of};
use meshbrush_kit::kit::Tab;

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
        view.style(crate::app::tests::settings(window), 0, 1.0).shown_levels
    };
    open_tab(&mut window, Tab::Mesh);
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
