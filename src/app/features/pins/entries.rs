//! The pins in menus and in the palette.

use eframe::egui::{Key, Modifiers};
use glam::DVec2;

use super::PinsCommand;
use super::files::EXPORT_PINS;
use crate::app::features::pins::Pins;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu, QUERYING};

/// Entries of the menu of the canvas, with the tool that moves pins.
pub fn entries_at(state: &FrameState<'_>, point: DVec2) -> Vec<(&'static str, Command)> {
    if !state.tools.tool.queries {
        return Vec::new();
    }
    let pins = &state.session.document().settings().pins;
    let selected = state.feature::<Pins>().selected_of(pins);
    let delete = selected.map(|_| ("Delete the selected pin", Command::from(PinsCommand::Delete)));
    [Some(("Pin here", Command::from(PinsCommand::Add(point)))), delete].into_iter().flatten().collect()
}

/// The key deletes a pin only with the tool that moves pins.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, command);
    let pins = &state.session.document().settings().pins;
    let has_pins = !pins.is_empty();
    let delete = item("Delete the selected pin", Command::from(PinsCommand::Delete));
    let is_tool = state.tools.tool.queries;
    let delete = delete.key(Key::Delete).only(QUERYING, is_tool);
    let items = vec![
        item("Pin the queried point", Command::from(PinsCommand::Pin))
            .keys(Modifiers::SHIFT, Key::P)
            .enabled(state.session.queried().is_some())
            .group(),
        delete.enabled(state.feature::<Pins>().selected_of(pins).is_some()),
        item("Delete all pins", Command::from(PinsCommand::DeleteAll)).enabled(has_pins),
        item("Copy the table of pins", Command::from(PinsCommand::Copy)).enabled(has_pins),
        item("Export the table of pins…", Command::from(FileCommand::Ask(&EXPORT_PINS))).enabled(has_pins),
    ];
    // The menu has what the selected tool does.
    items.into_iter().map(|item| item.in_menu(is_tool)).collect()
}
