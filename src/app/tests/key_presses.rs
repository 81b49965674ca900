//! Every press of a key, with every combination of modifiers and in every state: it runs the entry that it
//! belongs to, or nothing.

use std::collections::BTreeSet;

use eframe::egui::{Event, Key, KeyboardShortcut, Modifiers};

use super::key_table::{in_every_state, states};
use super::{CTRL_SHIFT, FREE, Window, entries, fingerprint, key, stroke, window};
use crate::app::features::painting::BRUSH;
use crate::app::keys::{KeyPress, Receiver, entry_of};
use meshbrush_kit::kit::{CatalogItem, same_keys, shortcut_text};

/// Shift, Ctrl and Alt, held or not.
fn modifiers() -> [Modifiers; 8] {
    std::array::from_fn(|bits| Modifiers {
        shift: bits & 1 > 0,
        ctrl: bits & 2 > 0,
        command: bits & 2 > 0,
        alt: bits & 4 > 0,
        mac_cmd: false,
    })
}

/// Characters that some keyboards type with Shift only, among those that egui has a key for.
const WITH_SHIFT: &str = "+=:;,./\\|?![]{}`";

/// Returns the keys that a press is, by the characters on the keyboard: with Shift also without it, where
/// Shift was needed to type the character.
fn meanings(press: KeyPress) -> Vec<KeyboardShortcut> {
    let KeyPress { key, physical_key, modifiers } = press;
    let typed = KeyboardShortcut::new(modifiers, key);
    let place = physical_key.filter(|key| key.name().parse::<u8>().is_ok());
    let by_place = place.map(|key| KeyboardShortcut::new(modifiers, key));
    let mut all: Vec<_> = [typed].into_iter().chain(by_place).collect();
    let is_character = key.symbol_or_name().len() == 1 && WITH_SHIFT.contains(key.symbol_or_name());
    if modifiers.shift && is_character && physical_key != Some(key) {
        all.push(KeyboardShortcut::new(Modifiers { shift: false, ..modifiers }, key));
    }
    all
}

/// The places of keys that are digits, beside those that their characters name.
const DIGITS: [Key; 2] = [Key::Num1, Key::Num7];

/// Returns the presses of a key: at its place on a US keyboard, at an unknown one, and at that of a digit.
fn presses(key: Key) -> impl Iterator<Item = KeyPress> {
    let places = [None, Some(key), Some(DIGITS[0]), Some(DIGITS[1])];
    places
        .into_iter()
        .flat_map(move |physical_key| modifiers().map(|modifiers| KeyPress { key, physical_key, modifiers }))
}

/// Checks the entry of a press among those that have the key.
fn check(press: KeyPress, candidates: &[CatalogItem], state: &str) {
    let meanings = meanings(press);
    let has = |item: &CatalogItem, meaning| {
        item.keys_work && item.shortcuts.iter().any(|own| same_keys(own, meaning))
    };
    let owns = |item: &CatalogItem| meanings.iter().any(|meaning| has(item, meaning));
    let entry = entry_of(press, Receiver::Canvas, candidates);
    assert_eq!(entry.is_some(), candidates.iter().any(owns), "{press:?}, {state}");
    let Some(entry) = entry else { return };
    assert!(owns(entry), "{press:?} runs {}, {state}", entry.title);
    // The very keys come before those without Shift, also where their entry is disabled.
    let (exact, others): (Vec<_>, Vec<_>) =
        meanings.iter().partition(|meaning| meaning.modifiers == press.modifiers);
    if others.iter().any(|other| has(entry, other)) {
        let owner = candidates.iter().find(|item| exact.iter().any(|exact| has(item, exact)));
        assert!(owner.is_none(), "{press:?} runs {}, {state}", entry.title);
    }
    let is_enabled = |item: &&CatalogItem| item.enabled && item.shortcuts == entry.shortcuts && owns(item);
    assert!(entry.enabled || !candidates.iter().any(|item| is_enabled(&item)), "{press:?}, {state}");
}

#[test]
fn a_press_belongs_to_an_entry_with_exactly_its_keys() {
    let mut seen = BTreeSet::new();
    for state in states() {
        let signature: Vec<_> =
            state.entries.iter().map(|item| (&item.id, item.enabled, item.keys_work)).collect();
        if !seen.insert(signature) {
            continue;
        }
        for key in Key::ALL {
            let concerns =
                |keys: &KeyboardShortcut| keys.logical_key == *key || DIGITS.contains(&keys.logical_key);
            let with_key = state.entries.iter().filter(|item| item.shortcuts.iter().any(concerns));
            let candidates: Vec<_> = with_key.cloned().collect();
            presses(*key).for_each(|press| check(press, &candidates, &state.name));
        }
    }
    assert!(seen.len() > 15, "{} states", seen.len());
}

fn press_text(press: KeyPress) -> String {
    shortcut_text(&KeyboardShortcut::new(press.modifiers, press.key))
}

/// Returns all that a command can change, as text.
fn contents(window: &Window) -> String {
    let app = window.state();
    let session = app.session();
    let (document, dialogs) = (session.document(), app.asks_something());
    format!(
        "{} {} {:?} {:?} {:?} {:?} {:?} {dialogs} {:?}",
        document.version(),
        document.revision(),
        document.settings(),
        document.active_layer().map(|layer| layer.id),
        app.tools(),
        app.view(),
        session.queried(),
        app.help,
    )
}

#[test]
fn a_press_with_a_disabled_command_changes_nothing() {
    let mut presses_made = 0;
    in_every_state(&mut |window, name| {
        let before = contents(window);
        let all = super::key_table::entries(window);
        let ctx = window.ctx.clone();
        // A dialog takes all keys, the help nearly all.
        let is_covered = window.state().asks_something() || window.state().help.is_some();
        let mut disabled = BTreeSet::new();
        for item in all.iter().filter(|item| item.keys_work) {
            for &KeyboardShortcut { modifiers, logical_key: key } in &item.shortcuts {
                let press = KeyPress { key, physical_key: None, modifiers };
                if entry_of(press, Receiver::Canvas, &all).is_none_or(|entry| entry.enabled) {
                    continue;
                }
                let event = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
                let is_used = window.state_mut().run_key(&event, &ctx);
                assert_eq!(is_used, !is_covered, "{press:?}: a widget must not act on it, {name}");
                disabled.insert(press_text(press));
                presses_made += 1;
            }
        }
        assert_eq!(contents(window), before, "one of {disabled:?}, {name}");
    });
    assert!(presses_made > 500, "{presses_made} presses");
}

#[test]
fn keys_without_their_command_do_not_run_those_without_shift() {
    let mut window = window();
    stroke(&mut window, FREE, FREE);
    let painted = (fingerprint(&window), contents(&window));
    key(&mut window, CTRL_SHIFT, Key::Z);
    assert_eq!((fingerprint(&window), contents(&window)), painted, "there is nothing to redo");
    // A pin for the queried triangle, and the third child of none; the layer's lock is open to all.
    for pressed in [Key::P, Key::Num1, Key::T, Key::B, Key::U] {
        key(&mut window, Modifiers::SHIFT, pressed);
        assert_eq!(contents(&window), painted.1, "Shift+{}", pressed.name());
        assert_eq!(window.state().tools().tool, &BRUSH);
    }
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(entries(&window), 0);
    key(&mut window, Modifiers::COMMAND, Key::Y);
    assert_eq!((entries(&window), fingerprint(&window)), (1, painted.0), "Ctrl+Y redoes");
    key(&mut window, Modifiers::COMMAND, Key::Y);
    assert_eq!(entries(&window), 1);
}

#[test]
fn a_press_that_can_do_nothing_says_so_for_a_moment() {
    let mut window = window();
    window.key_press_modifiers(CTRL_SHIFT, Key::Z);
    window.step();
    window.step();
    let says = "Ctrl+Shift+Z: “Redo” is not possible now";
    let texts = super::painted_texts(window.output());
    assert!(texts.iter().any(|(text, _)| text == says), "{texts:?}");
    window.run();
}

#[test]
fn characters_are_found_on_keyboards_that_type_them_with_shift() {
    let entries = &states()[0].entries;
    let title = |key, physical_key, shift| {
        let modifiers = Modifiers { shift, ..Modifiers::NONE };
        let entry = entry_of(KeyPress { key, physical_key, modifiers }, Receiver::Canvas, entries);
        entry.map(|entry| entry.title.as_str())
    };
    for (keyboard, key, place, shift, found) in [
        ("US", Key::Plus, Key::Equals, true, Some("Zoom in")),
        ("German", Key::Plus, Key::CloseBracket, false, Some("Zoom in")),
        ("German", Key::Equals, Key::Num0, true, Some("Zoom in")),
        ("French", Key::Num1, Key::Num1, false, Some("Strength 10 %")),
        ("French", Key::Num1, Key::Num1, true, None),
        ("French", Key::Minus, Key::Num6, false, Some("Zoom out")),
        ("US", Key::Exclamationmark, Key::Num1, true, None),
        ("US", Key::Minus, Key::Minus, true, None),
        ("US", Key::OpenCurlyBracket, Key::OpenBracket, true, Some("Softer brush")),
        ("US", Key::OpenBracket, Key::OpenBracket, true, None),
    ] {
        assert_eq!(title(key, Some(place), shift), found, "{key:?} on a {keyboard} keyboard, Shift {shift}");
    }
}
