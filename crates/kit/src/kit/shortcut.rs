//! Keys in words, for people and for files.

use egui::{Key, KeyboardShortcut, Modifiers};

/// Modifiers in the order in which they are written, with their names.
const MODIFIERS: [(Modifiers, &str); 3] =
    [(Modifiers::COMMAND, "Ctrl"), (Modifiers::SHIFT, "Shift"), (Modifiers::ALT, "Alt")];

/// Returns a shortcut as menus and the palette show it: `Ctrl+Shift+Z`.
pub fn shortcut_text(shortcut: &KeyboardShortcut) -> String {
    let key = match shortcut.logical_key {
        Key::OpenCurlyBracket => "[",
        Key::CloseCurlyBracket => "]",
        Key::Escape => "Esc",
        // egui names them by triangles, which fonts for text lack.
        Key::ArrowUp => "↑",
        Key::ArrowDown => "↓",
        Key::ArrowLeft => "←",
        Key::ArrowRight => "→",
        key => key.symbol_or_name(),
    };
    with_modifiers(shortcut.modifiers, key)
}

/// Returns a shortcut as files have it: names of keys are those of the characters on a US keyboard, such as
/// `Ctrl+PageUp` and `CloseBracket`.
pub fn shortcut_name(shortcut: &KeyboardShortcut) -> String {
    with_modifiers(shortcut.modifiers, shortcut.logical_key.name())
}

/// Returns the shortcut that [`shortcut_name`] wrote, or `None` for any other text.
pub fn parse_shortcut(text: &str) -> Option<KeyboardShortcut> {
    let mut rest = text.trim();
    let mut modifiers = Modifiers::NONE;
    while let Some((modifier, after)) = MODIFIERS.iter().find_map(|(modifier, name)| {
        let after = rest.strip_prefix(name)?.strip_prefix('+')?;
        (!after.is_empty()).then_some((*modifier, after))
    }) {
        modifiers |= modifier;
        rest = after;
    }
    Key::from_name(rest).map(|key| KeyboardShortcut::new(modifiers, key))
}

/// Returns whether two shortcuts are the same keys, also on a Mac, where Ctrl is Cmd.
pub fn same_keys(a: &KeyboardShortcut, b: &KeyboardShortcut) -> bool {
    let parts = |modifiers: Modifiers| (modifiers.command, modifiers.shift, modifiers.alt);
    a.logical_key == b.logical_key && parts(a.modifiers) == parts(b.modifiers)
}

fn with_modifiers(modifiers: Modifiers, key: &str) -> String {
    let held = [modifiers.command, modifiers.shift, modifiers.alt];
    let names = MODIFIERS.iter().zip(held).filter(|(_, held)| *held).map(|((_, name), _)| *name);
    names.chain([key]).collect::<Vec<_>>().join("+")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shortcut_is_read_as_it_was_written() {
        for key in [Key::Plus, Key::A, Key::PageUp, Key::OpenCurlyBracket, Key::F6, Key::Num1, Key::Minus] {
            for modifiers in [Modifiers::NONE, Modifiers::COMMAND, Modifiers::COMMAND | Modifiers::SHIFT] {
                let shortcut = KeyboardShortcut::new(modifiers, key);
                let read = parse_shortcut(&shortcut_name(&shortcut)).expect("a shortcut");
                assert!(same_keys(&read, &shortcut), "{}", shortcut_name(&shortcut));
            }
        }
        assert_eq!(shortcut_text(&parse_shortcut("Ctrl++").unwrap()), "Ctrl++");
        assert!(parse_shortcut("Ctrl+").is_none() && parse_shortcut("Meta+Q").is_none());
    }
}
