//! Ways to other triangles in menus and in the palette.

use eframe::egui::{Key, Modifiers};

use super::{ExploreCommand, InspectCommand, TreeStep};
use crate::app::features::inspection::Inspector;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CatalogItem, DIGITS, FrameState, Menu, QUERYING};

/// To neighbours, and through the bisection tree. The menu has what the selected tool does.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let is_tool = state.tools.tool.queries;
    let trail = trail(state).map(CatalogItem::palette_only);
    let in_menu = move |item: CatalogItem| item.in_menu(is_tool);
    neighbours(state).map(in_menu).chain(trail).chain(tree_steps(state)).collect()
}

/// The neighbours of the queried triangle. With the query tool they have the numbers on the canvas as keys.
fn neighbours(state: &FrameState<'_>) -> impl Iterator<Item = CatalogItem> + use<> {
    let titles = ["Go to the bisection neighbour", "Go to the second neighbour", "Go to the third neighbour"];
    let has_keys = state.tools.tool.queries;
    let is_queried = state.session.queried_triangle().is_some();
    titles.into_iter().enumerate().map(move |(place, title)| {
        let item = CatalogItem::new(Menu::Tool, title, Command::from(InspectCommand::QueryNeighbour(place)))
            .enabled(is_queried);
        let item = item.key(DIGITS[place]).only(QUERYING, has_keys);
        if place == 0 { item.group() } else { item }
    })
}

/// Returns the entries that go to a neighbour and keep the triangles on the way highlighted.
fn trail(state: &FrameState<'_>) -> impl Iterator<Item = CatalogItem> + use<> {
    let names = ["bisection", "second", "third"];
    let has_keys = state.tools.tool.queries;
    let is_queried = state.session.queried_triangle().is_some();
    names.into_iter().enumerate().map(move |(place, name)| {
        let title = format!("Follow the {name} neighbour and keep the trail");
        let item = CatalogItem::new(Menu::Tool, title, Command::from(InspectCommand::FollowNeighbour(place)))
            .enabled(is_queried);
        item.keys(Modifiers::SHIFT, DIGITS[place]).only(QUERYING, has_keys)
    })
}

/// Steps in the bisection tree that are in the menu: to the parent and the sibling.
const STEPS_IN_MENU: usize = 2;

/// Steps in the bisection tree from the queried triangle. They have keys with the tool that explains it.
fn tree_steps(state: &FrameState<'_>) -> impl Iterator<Item = CatalogItem> + use<> {
    let steps = [
        ("Go to the parent triangle", TreeStep::Parent, Modifiers::NONE, Key::PageUp),
        ("Go to the sibling", TreeStep::Sibling, Modifiers::SHIFT, Key::PageUp),
        ("Go to the first half", TreeStep::Child(0), Modifiers::NONE, Key::PageDown),
        ("Go to the second half", TreeStep::Child(1), Modifiers::SHIFT, Key::PageDown),
        ("Go to the coarse triangle", TreeStep::Coarse, Modifiers::COMMAND, Key::PageUp),
        ("Go back to the queried triangle", TreeStep::Queried, Modifiers::COMMAND, Key::PageDown),
        ("Go towards the triangle that required it", TreeStep::PreviousLink, Modifiers::NONE, Key::Comma),
        ("Go back along the chain", TreeStep::NextLink, Modifiers::NONE, Key::Period),
    ];
    let has_keys = state.tools.tool.queries;
    let leads = steps.map(|(_, step, ..)| {
        state.feature::<Inspector>().explore.target(step, state.session.mesh()).is_some()
    });
    steps.into_iter().zip(leads).enumerate().map(move |(place, ((title, step, modifiers, key), leads))| {
        let command = Command::from(InspectCommand::Explore(ExploreCommand::Step(step)));
        let item = CatalogItem::new(Menu::Tool, title, command).enabled(leads);
        // The others have buttons in the tab Inspect.
        let item = item.in_menu(has_keys && place < STEPS_IN_MENU);
        let item = item.keys(modifiers, key).only(QUERYING, has_keys);
        if place == 0 { item.group() } else { item }
    })
}
