//! From keys to commands.

use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers, Popup, RawInput};

use super::App;
use super::catalog::catalog;

impl App {
    /// Sends the commands whose shortcuts were pressed, unless somebody is typing.
    pub(super) fn follow_keys(&mut self, ctx: &Context) {
        // A menu or a dialog takes Escape and Enter itself.
        if self.asks_something() || Popup::is_any_open(ctx) {
            return;
        }
        let typing = ctx.egui_wants_keyboard_input();
        let mut entries = catalog(self);
        // Ctrl+Shift+Z before Ctrl+Z: egui lets extra modifiers pass.
        entries.sort_by_key(|entry| {
            std::cmp::Reverse(entry.shortcut.map_or(0, |shortcut| modifier_count(shortcut.modifiers)))
        });
        for entry in entries {
            let Some(shortcut) = entry.shortcut else { continue };
            let for_typing = typing && edits_text(&shortcut);
            if !for_typing && entry.enabled && shortcut.logical_key != Key::Tab {
                for _ in 0..ctx
                    .input_mut(|input| input.count_and_consume_key(shortcut.modifiers, shortcut.logical_key))
                {
                    self.commands.push(entry.command.clone());
                }
            }
        }
    }

    /// Tab hides the panels while nothing has the keyboard's focus; egui would move the focus instead.
    pub(super) fn catch_tab(&mut self, ctx: &Context, raw_input: &mut RawInput) {
        let focused = ctx.memory(|memory| memory.focused().is_some());
        if focused || self.asks_something() {
            return;
        }
        raw_input.events.retain(|event| match event {
            eframe::egui::Event::Key { key: Key::Tab, pressed, modifiers, .. } if modifiers.is_none() => {
                if *pressed {
                    self.commands.push(super::command::Command::TogglePanels);
                }
                false
            }
            _ => true,
        });
    }
}

/// Whether a shortcut belongs to the text field while somebody types in one.
fn edits_text(shortcut: &KeyboardShortcut) -> bool {
    !shortcut.modifiers.command || matches!(shortcut.logical_key, Key::Z | Key::Backspace)
}

fn modifier_count(modifiers: Modifiers) -> u8 {
    u8::from(modifiers.shift) + u8::from(modifiers.alt) + u8::from(modifiers.command)
}

/// A shortcut as menus and the palette show it.
pub fn shortcut_text(shortcut: &KeyboardShortcut) -> String {
    let mut text = String::new();
    if shortcut.modifiers.command {
        text += "Ctrl+";
    }
    if shortcut.modifiers.shift {
        text += "Shift+";
    }
    text + match shortcut.logical_key {
        Key::OpenCurlyBracket => "[",
        Key::CloseCurlyBracket => "]",
        Key::Escape => "Esc",
        key => key.symbol_or_name(),
    }
}
