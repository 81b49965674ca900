//! Translates keys to commands.

use eframe::egui::{Context, Event, Key, KeyboardShortcut, Modifiers, RawInput};

use super::command::{Command, ViewCommand};
use crate::app::kit::CatalogItem;

/// Returns the command that a pressed key stands for. While the user is `typing`, keys that edit text stay
/// with the text field.
pub fn command_of(
    key: Key,
    modifiers: Modifiers,
    typing: bool,
    catalog: Vec<CatalogItem>,
) -> Option<Command> {
    let is_pressed = |item: &CatalogItem| {
        item.enabled
            && item.shortcut.is_some_and(|shortcut| {
                shortcut.logical_key == key
                    && key != Key::Tab
                    && modifiers.matches_logically(shortcut.modifiers)
                    && !(typing && edits_text(&shortcut))
            })
    };
    // Ctrl+Shift+Z before Ctrl+Z: a key matches with more modifiers than its shortcut has.
    let item = (catalog.into_iter().filter(is_pressed))
        .max_by_key(|item| item.shortcut.map_or(0, |shortcut| modifier_count(shortcut.modifiers)))?;
    Some(item.command)
}

/// Returns the key that was pressed. With Shift a digit types another character on most keyboards, and not
/// the same on all of them: there the place of the key counts.
pub fn with_digits(key: Key, physical_key: Option<Key>, modifiers: Modifiers) -> Key {
    physical_key.filter(|key| modifiers.shift && ("0"..="9").contains(&key.name())).unwrap_or(key)
}

/// Removes presses of Tab, which egui would move the focus by, and returns the commands that they stand for:
/// while nothing has the focus, Tab hides and shows the panels.
pub fn catch_tab(ctx: &Context, raw_input: &mut RawInput) -> Vec<Command> {
    let mut commands = Vec::new();
    if ctx.memory(|memory| memory.focused().is_some()) {
        return commands;
    }
    raw_input.events.retain(|event| match event {
        Event::Key { key: Key::Tab, pressed, modifiers, .. } if modifiers.is_none() => {
            if *pressed {
                commands.push(Command::View(ViewCommand::TogglePanels));
            }
            false
        }
        _ => true,
    });
    commands
}

/// Returns whether a shortcut belongs to a text field that has the focus.
fn edits_text(shortcut: &KeyboardShortcut) -> bool {
    !shortcut.modifiers.command || matches!(shortcut.logical_key, Key::Z | Key::C | Key::Backspace)
}

fn modifier_count(modifiers: Modifiers) -> u8 {
    u8::from(modifiers.shift) + u8::from(modifiers.alt) + u8::from(modifiers.command)
}
