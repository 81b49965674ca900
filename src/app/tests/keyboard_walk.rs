//! A walk through all controls without a pointer: each has a role and a name for screen readers, and Tab
//! leads to it. `MESHBRUSH_LONG=1` lets Tab go through every state.

use std::collections::BTreeSet;

use eframe::egui::accesskit::{Action, Role};
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{AccessKitNode, By, NodeT as _, Queryable as _};
use glam::dvec2;

use super::{TALL, Window, click, open_tab, send, wait_for_jobs, window_of};
use crate::app::features::report::FigureCommand;
use crate::app::features::stepping::StepCommand;
use meshbrush_core::document::Example;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::{Tab, ToolSpec};
use meshbrush_study::report::ReportFigure;

/// More than the controls of any state.
const MOST_STOPS: usize = 500;

/// A control as a screen reader presents it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Control {
    id: String,
    role: Role,
    name: String,
    is_enabled: bool,
}

fn identity(node: &AccessKitNode<'_>) -> String {
    format!("{:?}", node.id())
}

fn control(node: &AccessKitNode<'_>) -> Control {
    let name = node.label().unwrap_or_default();
    Control { id: identity(node), role: node.role(), name, is_enabled: !node.is_disabled() }
}

/// Returns what acts on a click, except the canvas.
fn controls(window: &Window) -> Vec<Control> {
    let nodes = window.query_all(By::new());
    let acts = |node: &AccessKitNode<'_>| node.data().supports_action(Action::Click);
    nodes
        .filter(|node| acts(&node.accesskit_node()))
        .map(|node| control(&node.accesskit_node()))
        .filter(|control| control.role != Role::Image)
        .collect()
}

fn focused(window: &Window) -> Option<String> {
    let node = window.query_all(By::new()).find(|node| node.accesskit_node().is_focused())?;
    Some(identity(&node.accesskit_node()))
}

/// Returns what Tab leads to, until it is back at the first.
fn reached_by_tab(window: &mut Window) -> BTreeSet<String> {
    let mut reached = BTreeSet::new();
    for _ in 0..MOST_STOPS {
        window.key_press(Key::Tab);
        window.step();
        if let Some(focused) = focused(window)
            && !reached.insert(focused)
        {
            break;
        }
        reached.extend(rows_reached_by_arrows(window));
    }
    reached
}

/// Returns the rows that the key Down leads to, from a row of the legend of levels. Tab stops there once.
fn rows_reached_by_arrows(window: &mut Window) -> BTreeSet<String> {
    let is_row = |window: &Window| {
        let mut rows = window.query_all_by_role(Role::ListItem);
        rows.any(|node| node.accesskit_node().is_focused())
    };
    let mut rows = BTreeSet::new();
    while is_row(window) && focused(window).is_some_and(|row| rows.insert(row)) {
        window.key_press(Key::ArrowDown);
        window.step();
    }
    rows
}

/// Checks the role and the name of each control of the window as it is.
fn check_names(window: &Window, what: &str) {
    let controls = controls(window);
    assert!(controls.len() > 20, "{what}: {} controls", controls.len());
    for control in controls {
        assert!(!control.name.trim().is_empty(), "{what}: a {:?} has no name", control.role);
        let has_role = ![Role::Unknown, Role::GenericContainer].contains(&control.role);
        assert!(has_role, "{what}: {:?} has no role", control.name);
    }
}

/// Checks that Tab leads to each enabled control of the window as it is.
fn check_tab(window: &mut Window, what: &str) {
    let reached = reached_by_tab(window);
    let missed: Vec<_> = controls(window)
        .into_iter()
        .filter(|control| control.is_enabled && !reached.contains(&control.id))
        .map(|control| (control.role, control.name))
        .collect();
    assert!(
        missed.is_empty(),
        "{what}: Tab does not lead to {missed:?}; it leads to {} others",
        reached.len()
    );
}

/// Returns whether Tab goes through each state, and not only through some.
fn is_long() -> bool {
    std::env::var_os("MESHBRUSH_LONG").is_some()
}

fn tools() -> Vec<&'static ToolSpec> {
    use crate::app::features as f;
    vec![
        &f::painting::BRUSH,
        &f::painting::ERASER,
        &f::inspection::QUERY,
        &f::threats::THREATS,
        &f::paths::PATH,
        &f::domain::DOMAIN,
        &f::boundary::BOUNDARY,
    ]
}

#[test]
fn every_control_has_a_role_and_a_name_and_is_reached_by_tab() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Path)));
    wait_for_jobs(&mut window);
    for tool in tools() {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        if tool.name == "Query" {
            click(&mut window, dvec2(0.4, 0.4), Modifiers::NONE);
        }
        wait_for_jobs(&mut window);
        check_names(&window, tool.name);
        if is_long() || tool.name == "Path" {
            check_tab(&mut window, tool.name);
        }
    }
}

#[test]
fn every_control_of_every_tab_is_reached_by_tab() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Layers)));
    wait_for_jobs(&mut window);
    for tab in Tab::LOWER {
        if window.query_by_role_and_label(Role::Tab, tab.name()).is_some() {
            open_tab(&mut window, tab);
            wait_for_jobs(&mut window);
            check_names(&window, tab.name());
            if is_long() || tab == Tab::Mesh {
                check_tab(&mut window, tab.name());
            }
        }
    }
}

#[test]
fn every_control_of_the_steps_and_of_a_figure_is_reached_by_tab() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FigureCommand::Open(ReportFigure::Descendants)));
    wait_for_jobs(&mut window);
    check_names(&window, "a figure");
    send(&mut window, Command::from(StepCommand::Begin(None)));
    wait_for_jobs(&mut window);
    check_names(&window, "the steps");
    check_tab(&mut window, "the steps");
}
