//! The pins in menus and in the palette.

use eframe::egui::{Key, Modifiers};

use super::PinsCommand;
use super::files::EXPORT_PINS;
use crate::app::catalog::{CatalogItem, Menu};
use crate::app::command::{Command, FileCommand};
use crate::app::frame::FrameState;

/// The key deletes a pin only with the tool that moves pins.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, command);
    let pins = &state.session.document().settings().pins;
    let has_pins = !pins.is_empty();
    let delete = item("Delete the selected pin", Command::Pins(PinsCommand::Delete));
    let delete = if state.tools.tool.moves_pins { delete.key(Key::Delete) } else { delete };
    vec![
        item("Pin the queried point", Command::Pins(PinsCommand::Pin))
            .keys(Modifiers::SHIFT, Key::P)
            .enabled(state.session.queried().is_some())
            .group(),
        delete.enabled(state.pins.selected_of(pins).is_some()),
        item("Delete all pins", Command::Pins(PinsCommand::DeleteAll)).enabled(has_pins),
        item("Copy the table of pins", Command::Pins(PinsCommand::Copy)).enabled(has_pins),
        item("Export the table of pins…", Command::File(FileCommand::Ask(&EXPORT_PINS))).enabled(has_pins),
    ]
}
