//! Finds the entry of a key.

use eframe::egui::{Context, Id, Key, KeyboardShortcut, Modifiers};

use meshbrush_kit::kit::CatalogItem;
use meshbrush_ui::widgets::key_menu::MENU_KEYS;

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

/// A key that was pressed, with the modifiers that were held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyPress {
    /// The key by its character, or else by its place.
    pub key: Key,
    /// The place of the key, by its character on a US keyboard, where it is known.
    pub physical_key: Option<Key>,
    /// The modifiers that were held.
    pub modifiers: Modifiers,
}

/// Returns the entry that a press belongs to, if there is one. It runs if it is enabled; a press that belongs
/// to a disabled entry runs no other one.
///
/// The modifiers must be those of the entry. Shift may be held besides only where it was needed to type the
/// character, as for `+` on a US keyboard. With Shift, the digit at the place of a key comes first: with
/// Shift its character is another one on most keyboards. Without, the place of a digit comes last: on French
/// keyboards it types another character.
pub fn entry_of(press: KeyPress, receiver: Receiver, catalog: &[CatalogItem]) -> Option<&CatalogItem> {
    let KeyPress { key, physical_key, modifiers } = press;
    if receiver == Receiver::Control && MENU_KEYS == KeyboardShortcut::new(modifiers, key) {
        return None; // the control shows its own menu
    }
    let digit = physical_key.filter(|key| is_digit(*key)).map(|key| KeyboardShortcut::new(modifiers, key));
    let typed = KeyboardShortcut::new(modifiers, key);
    let needs_shift = modifiers.shift && may_need_shift(key) && physical_key != Some(key);
    let without_shift = Modifiers { shift: false, ..modifiers };
    let typed_by_shift = needs_shift.then_some(KeyboardShortcut::new(without_shift, key));
    let meanings = match modifiers.shift {
        true => [digit, Some(typed), typed_by_shift],
        false => [Some(typed), digit, None],
    };
    meanings.into_iter().flatten().find_map(|pressed| owner(pressed, receiver, catalog))
}

/// Returns the entry with exactly these keys: of several, the one that is enabled.
fn owner(pressed: KeyboardShortcut, receiver: Receiver, catalog: &[CatalogItem]) -> Option<&CatalogItem> {
    let is_pressed = |shortcut: &KeyboardShortcut| {
        // AltGr reaches the window as Alt, with or without Ctrl: it types a character and runs no command.
        shortcut.logical_key == pressed.logical_key
            && pressed.modifiers.matches_exact(shortcut.modifiers)
            && !receiver.keeps(shortcut)
    };
    let has_it = |item: &&CatalogItem| item.keys_work && item.shortcuts.iter().any(is_pressed);
    let mut owners = catalog.iter().filter(has_it);
    let first = owners.next()?;
    if first.enabled { Some(first) } else { owners.find(|item| item.enabled).or(Some(first)) }
}

fn is_digit(key: Key) -> bool {
    ("0"..="9").contains(&key.name())
}

/// Returns whether there are keyboards that type the character of a key with Shift only: all but letters,
/// digits and keys without a character.
fn may_need_shift(key: Key) -> bool {
    let symbol = key.symbol_or_name();
    symbol.chars().count() == 1 && symbol.is_ascii() && !symbol.chars().all(char::is_alphanumeric)
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
