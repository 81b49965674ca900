//! The docks at the right, the strip above the canvas, and menus that stay short.

use std::collections::BTreeSet;

use eframe::App as _;
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Rect, Vec2, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{
    Kept, Window, button_event, canvas, click_button, key, open_popup, open_section, open_tab, section, send,
    window, window_of,
};
use crate::app::catalog::{PLACES, catalog};
use crate::app::features::ROWS;
use crate::app::features::inspection::InspectCommand;
use crate::app::features::plots::{PlotKind, PlotsCommand};
use crate::app::features::stepping::StepCommand;
use crate::app::kept::load_tab;
use crate::app::panels;
use glam::dvec2;
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_kit::kit::dock::Dock;
use meshbrush_kit::kit::{Menu, Tab, all_tools};

/// The most entries of a menu.
const LONGEST_MENU: usize = 21;

fn tab(window: &Window) -> Tab {
    window.state().view().dock.tab()
}

fn bar(window: &Window) -> Rect {
    window.get_by_role_and_label(Role::Tab, "Size").rect()
}

fn drag(window: &mut Window, from: eframe::egui::Pos2, by: Vec2) {
    window.event(Event::PointerMoved(from));
    window.run();
    window.event(button_event(from, PointerButton::Primary, true, Modifiers::NONE));
    window.run();
    window.event(Event::PointerMoved(from + by));
    window.run();
    window.event(button_event(from + by, PointerButton::Primary, false, Modifiers::NONE));
    window.run();
}

#[test]
fn a_tool_selects_its_tab_unless_another_was_chosen_since() {
    let mut window = window();
    assert_eq!(tab(&window), Tab::Size);
    key(&mut window, Modifiers::NONE, Key::Q);
    assert_eq!(tab(&window), Tab::Inspect);
    open_tab(&mut window, Tab::Mesh);
    key(&mut window, Modifiers::NONE, Key::Q);
    assert_eq!(tab(&window), Tab::Mesh, "the tool was selected already");
    key(&mut window, Modifiers::NONE, Key::H);
    assert_eq!(tab(&window), Tab::Mesh, "the pan tool has no tab");
    key(&mut window, Modifiers::NONE, Key::P);
    assert_eq!(tab(&window), Tab::Paths);
    // With the keyboard, from tab to tab.
    window.get_by_role_and_label(Role::Tab, "Inspect").focus();
    window.run();
    key(&mut window, Modifiers::NONE, Key::ArrowRight);
    assert_eq!(tab(&window), Tab::Paths);
}

#[test]
fn a_panel_that_is_asked_for_comes_with_its_tab() {
    let mut window = window();
    send(&mut window, Command::from(PlotsCommand::Show(PlotKind::Triangles)));
    assert_eq!(tab(&window), Tab::Mesh);
    let export = window.get_by_role_and_label(Role::Button, "Export plot…").rect();
    assert!(export.bottom() <= canvas(&window).bottom() && export.top() > bar(&window).bottom(), "{export}");
    send(&mut window, Command::from(InspectCommand::Query(super::FREE)));
    assert_eq!(tab(&window), Tab::Inspect);
}

#[test]
fn sections_stay_in_their_places_whatever_the_tool() {
    let mut window = window();
    let order = |window: &mut Window| {
        let mut titles = Vec::new();
        for tab in Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method) {
            open_tab(window, tab);
            let nodes = window.query_all_by_role(Role::Button);
            let headers = nodes.filter(|node| node.accesskit_node().data().is_expanded().is_some());
            titles.push(headers.filter_map(|node| node.accesskit_node().label()).collect::<Vec<_>>());
        }
        titles
    };
    let before = order(&mut window);
    assert!(before.iter().all(|titles| titles.len() > 2), "{before:?}");
    for tool in all_tools(ROWS) {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        assert_eq!(order(&mut window), before, "{tool:?}");
    }
}

#[test]
fn the_layers_and_the_selected_layer_are_in_sight_with_every_tool_and_tab() {
    for size in [vec2(1280.0, 720.0), vec2(1440.0, 900.0), vec2(2560.0, 1440.0)] {
        let mut window = window_of(size);
        for tool in all_tools(ROWS) {
            send(&mut window, Command::from(ShellCommand::Use(tool)));
            for title in ["Layers", "Selected layer"] {
                let header = section(&window, title).expect("the section").rect();
                assert!(header.bottom() < bar(&window).top(), "{title} at {header} with {tool:?}");
            }
        }
        let lower = canvas(&window).bottom() - bar(&window).top();
        assert!(lower >= 200.0, "{lower} at {size}");
    }
}

#[test]
fn the_docks_are_resized_within_limits_and_shrink_with_the_window() {
    let mut window = window();
    let before = canvas(&window);
    let edge = pos2(before.right() + 2.0, 600.0);
    drag(&mut window, edge, vec2(-60.0, 0.0));
    let wide = canvas(&window);
    assert!((before.width() - wide.width() - 60.0).abs() < 4.0, "{before} to {wide}");
    drag(&mut window, pos2(wide.right() + 2.0, 600.0), vec2(-600.0, 0.0));
    assert!((canvas(&window).right() - (1440.0 - 520.0)).abs() < 2.0, "{}", canvas(&window));
    let edge = pos2(canvas(&window).right() + 2.0, 600.0);
    drag(&mut window, edge, vec2(800.0, 0.0));
    assert!((canvas(&window).right() - (1440.0 - 280.0)).abs() < 2.0, "{}", canvas(&window));
    let divider = bar(&window).top();
    drag(&mut window, pos2(1400.0, divider), vec2(0.0, -2000.0));
    let upper = bar(&window).top() - 36.0;
    assert!((120.0..124.0).contains(&upper), "{upper}");
    let divider = bar(&window).top();
    drag(&mut window, pos2(1400.0, divider), vec2(0.0, 2000.0));
    let lower = |window: &Window| canvas(window).bottom() - bar(window).top();
    assert!((199.0..203.0).contains(&lower(&window)), "{}", lower(&window));
    window.set_size(vec2(900.0, 600.0));
    window.run();
    window.run();
    assert!(lower(&window) >= 199.0 && canvas(&window).width() > 400.0, "{}", lower(&window));
}

#[test]
fn the_docks_keep_their_split_through_small_windows_presentations_and_restarts() {
    let mut window = window();
    let divider = bar(&window).top();
    drag(&mut window, pos2(1400.0, divider), vec2(0.0, 70.0));
    let edge = pos2(canvas(&window).right() + 2.0, 600.0);
    drag(&mut window, edge, vec2(-80.0, 0.0));
    let chosen = (bar(&window).top(), canvas(&window).right());
    let is_as_chosen = |window: &Window, what: &str| {
        let now = (bar(window).top(), canvas(window).right());
        assert!(
            (now.0 - chosen.0).abs() < 2.0 && (now.1 - chosen.1).abs() < 2.0,
            "{what}: {now:?}, {chosen:?}"
        );
    };
    window.set_size(vec2(640.0, 360.0));
    window.run();
    window.set_size(vec2(1440.0, 900.0));
    window.run();
    is_as_chosen(&window, "after a small window");
    key(&mut window, Modifiers::NONE, Key::F5);
    key(&mut window, Modifiers::NONE, Key::F5);
    is_as_chosen(&window, "after a presentation");
    assert!(section(&window, "Selected layer").is_some());
    // What egui's memory keeps is what the next run begins with.
    let memory = window.ctx.memory(Clone::clone);
    let mut next = super::window();
    next.ctx.memory_mut(|empty| *empty = memory);
    next.run();
    is_as_chosen(&next, "in the next run");
}

#[test]
fn options_without_room_are_in_a_popup() {
    let mut window = window_of(vec2(900.0, 600.0));
    assert!(window.query_by_role_and_label(Role::Slider, "Hardness").is_none());
    open_popup(&mut window, "More options");
    window.get_by_role_and_label(Role::Slider, "Hardness");
    window.get_by_role_and_label(Role::Slider, "Smoothing");
    let strip = canvas(&window).top() - 40.0..=canvas(&window).top();
    let radius = window.get_by_role_and_label(Role::Slider, "Radius").rect();
    assert!(strip.contains(&radius.top()) && strip.contains(&radius.bottom()), "{radius}");
    // A control of the popup leaves it open, a press beside it closes it and paints nothing.
    window.get_by_role_and_label(Role::CheckBox, "Mirror x").click();
    window.run();
    assert!(window.state().tools().mirrored[0]);
    window.get_by_role_and_label(Role::CheckBox, "Mirror y");
    super::click(&mut window, dvec2(0.05, 0.05), Modifiers::NONE);
    assert!(window.query_by_role_and_label(Role::CheckBox, "Mirror y").is_none());
    assert_eq!(super::entries(&window), 0);
}

#[test]
fn every_option_of_a_usual_window_is_on_the_strip() {
    let mut window = window_of(vec2(1440.0, 900.0));
    for tool in all_tools(ROWS) {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        let state = window.state().state(None);
        let shown = tool.options.iter().filter(|item| item.rank.is_some() && (item.is_shown)(&state));
        let width: f32 = shown.map(|item| item.width + 8.0).sum();
        assert!(width + 88.0 <= canvas(&window).width(), "{tool:?} needs {width}");
    }
}

#[test]
fn the_tab_method_is_there_only_while_it_is_asked_for() {
    let mut window = window();
    let has_tab = |window: &Window| window.query_by_role_and_label(Role::Tab, "Method").is_some();
    assert!(!has_tab(&window));
    super::choose(&mut window, "Method", "The report, Figure 1: a mesh");
    assert!(has_tab(&window) && tab(&window) == Tab::Method);
    open_tab(&mut window, Tab::Size);
    assert!(has_tab(&window), "the figure is still shown");
    open_tab(&mut window, Tab::Method);
    click_button(&mut window, "Close the figure");
    assert!(!has_tab(&window) && tab(&window) == Tab::Size);
    super::choose(&mut window, "Method", "Show the tab Method");
    assert!(section(&window, "Point location").is_some());
    open_tab(&mut window, Tab::Mesh);
    assert!(!has_tab(&window));
}

#[test]
fn a_section_that_is_opened_comes_into_view() {
    let mut window = window_of(vec2(1280.0, 720.0));
    open_section(&mut window, "Statistics");
    super::wait_for_jobs(&mut window);
    let title = section(&window, "Statistics").expect("the section").rect();
    let last = window.get_by_label("Fingerprint").rect();
    let (top, bottom) = (bar(&window).bottom(), super::canvas(&window).bottom());
    assert!(top <= title.top() && last.bottom() <= bottom, "{title} to {last}, in {top} to {bottom}");
}

#[test]
fn menus_are_short_and_the_palette_has_everything() {
    let mut window = window();
    let check = |window: &mut Window, what: &str| {
        let items = catalog(&window.state().state(None));
        for (menu, name) in Menu::ALL {
            let shown: Vec<_> = items.iter().filter(|item| item.menu == menu && item.is_in_menu).collect();
            // A menu within it is one line.
            let count = shown.chunk_by(|a, b| a.submenu.is_some() && a.submenu == b.submenu).count();
            assert!((1..=LONGEST_MENU).contains(&count), "{name} has {count} entries, {what}");
        }
        key(window, Modifiers::COMMAND, Key::P);
        let rows = window.get_all_by_role(Role::MenuItem);
        let palette: BTreeSet<String> = rows.filter_map(|node| node.accesskit_node().label()).collect();
        key(window, Modifiers::NONE, Key::Escape);
        let titles: BTreeSet<String> = items.into_iter().map(|item| item.title).collect();
        let places: BTreeSet<String> = PLACES.iter().map(|place| place.title()).collect();
        assert_eq!(palette, &titles | &places, "{what}");
    };
    for tool in all_tools(ROWS) {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        check(&mut window, tool.name);
    }
    send(&mut window, Command::from(StepCommand::Begin(None)));
    check(&mut window, "steps");
}

#[test]
fn every_panel_has_a_name_of_its_own_and_every_tab_a_panel() {
    let names: BTreeSet<_> = panels::all().map(|panel| panel.name).collect();
    assert_eq!(names.len(), panels::all().count());
    for tab in Tab::LOWER {
        assert!(panels::all().any(|panel| panel.tab == tab), "{tab:?}");
        assert_eq!(Tab::named(tab.name()), Some(tab));
    }
}

#[test]
fn the_tab_is_remembered_from_run_to_run() {
    let mut first = window();
    open_tab(&mut first, Tab::Domain);
    let mut kept = Kept::default();
    first.state_mut().save(&mut kept);
    let mut dock = Dock::default();
    load_tab(&mut dock, &kept);
    assert_eq!(dock.tab(), Tab::Domain);
    load_tab(&mut dock, &Kept::default());
    assert_eq!(dock.tab(), Tab::Domain, "nothing was kept");
}
