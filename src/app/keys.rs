//! Translates keys to commands.

use eframe::egui::{Context, Id, Key, KeyboardShortcut, Modifiers};

use crate::app::kit::CatalogItem;
use crate::app::widgets::key_menu::MENU_KEYS;

/// The part of the window that a key goes to first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Receiver {
    /// The canvas, or nothing.
    Canvas,
    /// A control, such as a button or a text field. It keeps all keys but those with Ctrl and function keys.
    Control,
}

impl Receiver {
    /// Returns the receiver of keys; `canvas` is the widget of the canvas.
    pub fn of(ctx: &Context, canvas: Option<Id>) -> Self {
        let focused = ctx.memory(|memory| memory.focused());
        if focused.is_none() || focused == canvas { Self::Canvas } else { Self::Control }
    }

    /// Returns whether a shortcut belongs to what has the focus.
    fn keeps(self, shortcut: &KeyboardShortcut) -> bool {
        self == Self::Control && !is_function_key(shortcut.logical_key) && edits(shortcut)
    }
}

/// Returns the entry that a pressed key runs, if there is one.
///
/// A digit is found by the place of its key, too: with Shift it is another character on most keyboards, and
/// without on French ones.
pub fn entry_of(
    key: Key,
    physical_key: Option<Key>,
    modifiers: Modifiers,
    receiver: Receiver,
    catalog: &[CatalogItem],
) -> Option<&CatalogItem> {
    if receiver == Receiver::Control && MENU_KEYS == KeyboardShortcut::new(modifiers, key) {
        return None; // the control shows its own menu
    }
    let digit = physical_key.filter(|key| ("0"..="9").contains(&key.name()));
    let with = |key| best(key, modifiers, receiver, catalog);
    match digit.filter(|_| modifiers.shift) {
        Some(digit) => with(digit),
        None => with(key).or_else(|| with(digit?)),
    }
}

/// Returns the entry whose shortcut has the most modifiers: Ctrl+Shift+Z before Ctrl+Z, as Shift may also be
/// needed to type the key itself.
fn best(key: Key, modifiers: Modifiers, receiver: Receiver, catalog: &[CatalogItem]) -> Option<&CatalogItem> {
    let is_pressed = |shortcut: &&KeyboardShortcut| {
        // AltGr reaches the window as Alt, with or without Ctrl: it types a character and runs no command.
        shortcut.logical_key == key
            && modifiers.matches_logically(shortcut.modifiers)
            && modifiers.alt == shortcut.modifiers.alt
            && !receiver.keeps(shortcut)
    };
    let items = catalog.iter().filter(|item| item.enabled && item.keys_work);
    let pressed =
        items.flat_map(|item| item.shortcuts.iter().filter(is_pressed).map(move |keys| (item, keys)));
    pressed.max_by_key(|(_, keys)| modifier_count(keys.modifiers)).map(|(item, _)| item)
}

fn is_function_key(key: Key) -> bool {
    let number = key.name().strip_prefix('F').and_then(|number| number.parse::<u8>().ok());
    number.is_some()
}

/// Returns whether a shortcut changes a text, or moves in a text or in a control.
fn edits(shortcut: &KeyboardShortcut) -> bool {
    const KEPT_WITH_CTRL: [Key; 13] = [
        Key::A,
        Key::C,
        Key::V,
        Key::X,
        Key::Y,
        Key::Z,
        Key::Backspace,
        Key::Delete,
        Key::ArrowUp,
        Key::ArrowDown,
        Key::ArrowLeft,
        Key::ArrowRight,
        Key::Enter,
    ];
    !shortcut.modifiers.command || KEPT_WITH_CTRL.contains(&shortcut.logical_key)
}

fn modifier_count(modifiers: Modifiers) -> u8 {
    u8::from(modifiers.shift) + u8::from(modifiers.alt) + u8::from(modifiers.command)
}
