//! From keys to commands.

use std::cmp::Reverse;

use eframe::egui::{Context, Event, Key, KeyboardShortcut, Modifiers, RawInput};

use super::catalog::CatalogItem;
use super::command::Command;

/// The commands whose keys were pressed. Keys that edit text stay with a text field that has the focus.
pub fn pressed(ctx: &Context, mut catalog: Vec<CatalogItem>) -> Vec<Command> {
    let typing = ctx.egui_wants_keyboard_input();
    // Ctrl+Shift+Z before Ctrl+Z: egui ignores extra modifiers.
    catalog
        .sort_by_key(|item| Reverse(item.shortcut.map_or(0, |shortcut| modifier_count(shortcut.modifiers))));
    let mut commands = Vec::new();
    for item in catalog {
        let Some(shortcut) = item.shortcut else { continue };
        let for_text = typing && edits_text(&shortcut);
        if for_text || !item.enabled || shortcut.logical_key == Key::Tab {
            continue;
        }
        let count =
            ctx.input_mut(|input| input.count_and_consume_key(shortcut.modifiers, shortcut.logical_key));
        commands.extend(std::iter::repeat_n(item.command, count));
    }
    commands
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
                commands.push(Command::TogglePanels);
            }
            false
        }
        _ => true,
    });
    commands
}

/// Whether a shortcut belongs to a text field that has the focus.
fn edits_text(shortcut: &KeyboardShortcut) -> bool {
    !shortcut.modifiers.command || matches!(shortcut.logical_key, Key::Z | Key::Backspace)
}

fn modifier_count(modifiers: Modifiers) -> u8 {
    u8::from(modifiers.shift) + u8::from(modifiers.alt) + u8::from(modifiers.command)
}
