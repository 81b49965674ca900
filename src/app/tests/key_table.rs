//! The table of keys: no key runs two entries, every default can be typed, and a person can change all of it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;

use eframe::App as _;
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::{FREE, Kept, Window, choose, folder, key, notice, send, wait_until, window};
use crate::app::catalog::catalog;
use crate::app::features::ROWS;
use crate::app::features::domain::{DomainCommand, DomainToolMode};
use crate::app::features::inspection::InspectCommand;
use crate::app::features::lines::{LineEnd, LineToolMode, LinesCommand};
use crate::app::features::painting::{BRUSH, ERASER};
use crate::app::features::paths::PathCommand;
use crate::app::features::pins::PinsCommand;
use crate::app::features::stepping::StepCommand;
use crate::app::features::threats::{THREATS, ThreatsCommand};
use meshbrush_core::layers::{LayerId, LayerKind, Threats};
use meshbrush_kit::kit::command::{
    Command, FileCommand, LayerCommand, ShellCommand, SpaceCommand, ViewCommand,
};
use meshbrush_kit::kit::{CatalogItem, all_tools, conflicts, same_keys, shortcut_text};

pub fn entries(window: &Window) -> Vec<CatalogItem> {
    catalog(&window.state().state(None))
}

/// The entries in a state of the window.
pub struct State {
    pub name: String,
    pub entries: Vec<CatalogItem>,
}

/// Returns the entries in all states of tool, mode and selection, which are looked at once for all tests.
pub fn states() -> &'static [State] {
    static STATES: OnceLock<Vec<State>> = OnceLock::new();
    STATES.get_or_init(|| {
        let mut states = Vec::new();
        in_every_state(&mut |window, name| {
            states.push(State { name: name.to_owned(), entries: entries(window) });
        });
        states
    })
}

/// Brings the window into each combination of tool, mode and selection, and calls `look` in each.
pub fn in_every_state(look: &mut dyn FnMut(&mut Window, &str)) {
    let mut window = window();
    send(&mut window, Command::from(LayerCommand::Add(Box::new(LayerKind::Threats(Threats::default())))));
    let select = [
        // A triangle with a parent, and a layer between others: most entries are enabled.
        Command::from(LayerCommand::Select(LayerId(1))),
        Command::from(InspectCommand::Query(dvec2(0.245, 0.765))),
        Command::from(PinsCommand::Add(FREE)),
        Command::from(PinsCommand::Select(0)),
        Command::from(ThreatsCommand::Place(FREE)),
        Command::from(PathCommand::StartAt(dvec2(0.1, 0.1))),
        Command::from(PathCommand::GoalAt(dvec2(0.9, 0.9))),
    ];
    for (number, tool) in all_tools(ROWS).into_iter().enumerate() {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        look(&mut window, tool.name);
        for command in select.iter().take(if number == 0 { 7 } else { 5 }) {
            send(&mut window, command.clone());
            send(&mut window, Command::from(ShellCommand::Use(tool)));
            look(&mut window, tool.name);
        }
    }
    // Modes of tools, which select their tool.
    for item in entries(&window).into_iter().filter(|item| item.is_above && item.enabled) {
        if item.command.get::<FileCommand>().is_none() && item.command.get::<PathCommand>().is_none() {
            send(&mut window, item.command);
            look(&mut window, &item.title);
        }
    }
    for corner in [dvec2(0.1, 0.1), dvec2(0.3, 0.1), dvec2(0.2, 0.3)] {
        send(&mut window, Command::from(DomainCommand::Mode(DomainToolMode::Polygon)));
        send(&mut window, Command::from(DomainCommand::AddCorner(corner)));
        look(&mut window, "a polygon");
    }
    send(&mut window, Command::from(ShellCommand::Escape));
    for corner in [dvec2(0.1, 0.1), dvec2(0.3, 0.1)] {
        send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::Corners)));
        send(&mut window, Command::from(LinesCommand::AddCorner(corner)));
        look(&mut window, "a line");
    }
    send(&mut window, Command::from(LinesCommand::AddCorner(dvec2(0.3, 0.3))));
    send(&mut window, Command::from(LinesCommand::End(LineEnd::Open)));
    for mode in [LineToolMode::Corners, LineToolMode::Edit] {
        send(&mut window, Command::from(LinesCommand::Mode(mode)));
        send(&mut window, Command::from(LinesCommand::TakeCorner(Some(0))));
        look(&mut window, "a selected line");
    }
    send(&mut window, Command::from(StepCommand::Begin(None)));
    wait_until(&mut window, |window| {
        entries(window).iter().any(|item| item.title == "Next step" && item.enabled)
    });
    look(&mut window, "steps");
    send(&mut window, Command::from(ShellCommand::Escape));
    for (name, command) in [
        ("presentation", Command::from(ViewCommand::TogglePresentation)),
        ("presentation with a panel", Command::from(ViewCommand::TogglePanels)),
        ("in space", Command::from(ViewCommand::Space(SpaceCommand::Toggle))),
        ("a new document", Command::from(FileCommand::New)),
        ("the help", Command::from(ShellCommand::ShowHelp(meshbrush_kit::kit::command::HelpTopic::Keys))),
    ] {
        send(&mut window, command);
        look(&mut window, name);
    }
}

/// Returns what two enabled entries share.
fn shared(items: &[CatalogItem]) -> BTreeSet<String> {
    let active: Vec<_> = items.iter().filter(|item| item.enabled && item.keys_work).collect();
    let mut found = BTreeSet::new();
    for (number, item) in active.iter().enumerate() {
        for other in &active[number + 1..] {
            for keys in
                item.shortcuts.iter().filter(|keys| other.shortcuts.iter().any(|own| same_keys(own, keys)))
            {
                found.insert(format!("{}: {} and {}", shortcut_text(keys), item.title, other.title));
            }
        }
    }
    found
}

#[test]
fn no_key_runs_two_entries_with_any_tool_mode_and_selection() {
    for State { name, entries } in states() {
        assert_eq!(shared(entries), BTreeSet::new(), "{name}");
        // Entries that never meet may share a key; the list of keys must not call that a conflict.
        assert_eq!(conflicts(entries), [""; 0], "{name}");
    }
    assert!(states().len() > 60, "{} states", states().len());
}

/// The file that lists the ids of all entries.
const IDS: &str = "docs/commands.txt";

#[test]
fn ids_are_unique_and_never_change() {
    let mut titles = BTreeMap::new();
    for State { name, entries } in states() {
        let ids: BTreeSet<_> = entries.iter().map(|item| &item.id).collect();
        assert_eq!(ids.len(), entries.len(), "two entries have one id: {name}");
        titles.extend(entries.iter().map(|item| (item.id.clone(), item.title.clone())));
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(IDS);
    let known = std::fs::read_to_string(&path).unwrap_or_default();
    let gone: Vec<&str> = known.lines().filter(|id| !titles.contains_key(*id)).collect();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        let lines: Vec<String> = titles.keys().map(|id| format!("{id}\n")).collect();
        std::fs::write(&path, lines.concat()).unwrap();
        return;
    }
    let new: Vec<_> = titles.keys().filter(|id| !known.lines().any(|line| line == *id)).collect();
    assert!(
        gone.is_empty(),
        "people have keys for these entries: give them back their ids with `.id(…)`: {gone:?}"
    );
    assert!(new.is_empty(), "{IDS} lacks {new:?}: UPDATE_DOCS=1 cargo test --lib key_table");
}

/// The characters that a keyboard types without AltGr, besides letters and digits: without Shift, and with
/// it.
const LAYOUTS: [(&str, &str, &str); 6] = [
    ("US", "`-=[]\\;',./", "~_+{}|:\"<>?!@#$%^&*()"),
    ("German", "^ß´ü+öä#,.-<", "°?`Ü*ÖÄ';:_>!\"§$%&/()="),
    ("French", "²&é\"'(-è_çà)=^$ù*,;:!<", "°+¨£%µ?./§>"),
    ("Swedish", "§+´å¨öä',.-<", "½?`Å^ÖÄ*;:_>!\"#¤%&/()="),
    ("Danish", "½+´å¨æø',.-<", "§?`Å^ÆØ*;:_>!\"#¤%&/()="),
    ("Norwegian", "|+\\å¨øæ',.-<", "§?`Å^ØÆ*;:_>!\"#¤%&/()="),
];

/// Returns whether a shortcut can be typed on a keyboard without AltGr, and with no other Shift than its own.
fn can_be_typed(shortcut: &KeyboardShortcut, plain: &str, with_shift: &str) -> bool {
    let key = shortcut.logical_key;
    let symbol = match key {
        Key::Minus => "-",
        _ => key.symbol_or_name(),
    };
    let is_punctuation =
        symbol.chars().count() == 1 && symbol.is_ascii() && !symbol.chars().all(char::is_alphanumeric);
    let shift = shortcut.modifiers.shift;
    // Letters, digits by their place, and keys with names.
    !is_punctuation || (!shift && plain.contains(symbol)) || with_shift.contains(symbol)
}

#[test]
fn every_default_can_be_typed_on_german_french_and_nordic_keyboards() {
    let mut lacking = BTreeSet::new();
    let with_keys = |item: &&CatalogItem| !item.default_shortcuts.is_empty();
    for item in states().iter().flat_map(|state| &state.entries).filter(with_keys) {
        for (layout, plain, with_shift) in LAYOUTS {
            if !item.default_shortcuts.iter().any(|keys| can_be_typed(keys, plain, with_shift)) {
                lacking.insert(format!("{} on a {layout} keyboard", item.title));
            }
        }
    }
    assert_eq!(lacking, BTreeSet::new());
    let bracket = KeyboardShortcut::new(Modifiers::NONE, Key::CloseBracket);
    let types = |(_, plain, with_shift): &(_, &str, &str)| can_be_typed(&bracket, plain, with_shift);
    assert_eq!(LAYOUTS.iter().filter(|layout| types(layout)).count(), 1, "the table knows what needs AltGr");
}

#[test]
fn brush_and_layers_follow_their_keys_without_brackets() {
    let mut window = window();
    let radius = |window: &Window| window.state().tools().radius;
    let before = (radius(&window), window.state().tools().hardness);
    key(&mut window, Modifiers::NONE, Key::I);
    assert!(radius(&window) > before.0);
    key(&mut window, Modifiers::NONE, Key::J);
    assert!((radius(&window) - before.0).abs() < 1e-12);
    key(&mut window, Modifiers::SHIFT, Key::I);
    assert!(window.state().tools().hardness > before.1);
    key(&mut window, Modifiers::SHIFT, Key::J);
    assert!((window.state().tools().hardness - before.1).abs() < 1e-12);
    let order =
        |window: &Window| -> Vec<_> { super::settings(window).layers.iter().map(|layer| layer.id).collect() };
    let layers = order(&window);
    send(&mut window, Command::from(LayerCommand::Select(layers[0])));
    key(&mut window, Modifiers::COMMAND, Key::ArrowUp);
    assert_eq!(order(&window)[1], layers[0]);
    key(&mut window, Modifiers::COMMAND, Key::ArrowDown);
    assert_eq!(order(&window), layers);
}

fn press(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    window.run();
}

/// Opens the list of keys, and in it the keys of an entry.
fn open_keys_of(window: &mut Window, row: &str) {
    send(window, Command::from(ShellCommand::ShowHelp(meshbrush_kit::kit::command::HelpTopic::Keys)));
    let search = window.get_by_role_and_label(Role::TextInput, "Search for a key");
    search.focus();
    window.run();
    key(window, Modifiers::COMMAND, Key::A);
    let title = row.rsplit_once(' ').map_or(row, |(title, _)| title);
    window.get_by_role_and_label(Role::TextInput, "Search for a key").type_text(title);
    window.run();
    window.get_by_role_and_label(Role::ListItem, row).click();
    window.run();
}

fn has_button(window: &Window, name: &str) -> bool {
    window.query_by_role_and_label(Role::Button, name).is_some()
}

#[test]
fn a_key_is_added_taken_from_another_entry_and_shown_everywhere() {
    let mut window = window();
    open_keys_of(&mut window, "Eraser E");
    press(&mut window, "Add a key");
    key(&mut window, Modifiers::NONE, Key::Q);
    assert_eq!(window.state().tools().tool, &BRUSH, "the key is for the list");
    assert!(window.query_by_label("Q belongs to “Query”.").is_some());
    press(&mut window, "Move the key here");
    press(&mut window, "Remove E");
    send(&mut window, Command::from(ShellCommand::CloseHelp));
    key(&mut window, Modifiers::NONE, Key::E);
    assert_eq!(window.state().tools().tool, &BRUSH);
    key(&mut window, Modifiers::NONE, Key::Q);
    assert_eq!(window.state().tools().tool, &ERASER);
    super::open_menu(&mut window, "Tool");
    assert!(
        has_button(&window, "Eraser Q") && !has_button(&window, "Query Q"),
        "the menu shows the new keys"
    );
    key(&mut window, Modifiers::NONE, Key::Escape);
    open_keys_of(&mut window, "Eraser Q");
    press(&mut window, "Reset all keys");
    send(&mut window, Command::from(ShellCommand::CloseHelp));
    key(&mut window, Modifiers::NONE, Key::Q);
    assert_ne!(window.state().tools().tool, &ERASER);
}

#[test]
fn tips_show_the_key_that_works() {
    let mut window = window();
    let tip = |window: &Window| {
        let button = window.get_by_role_and_label(Role::RadioButton, "Build up");
        button.accesskit_node().description().unwrap_or_default()
    };
    assert!(tip(&window).ends_with("diameter is painted; U."), "{}", tip(&window));
    open_keys_of(&mut window, "Build up U");
    press(&mut window, "Add a key");
    key(&mut window, Modifiers::COMMAND, Key::U);
    press(&mut window, "Remove U");
    assert!(tip(&window).ends_with("; Ctrl+U."), "{}", tip(&window));
    press(&mut window, "Remove Ctrl+U");
    assert!(tip(&window).ends_with("diameter is painted."), "{}", tip(&window));
}

#[test]
fn remarks_show_the_key_that_works() {
    let mut window = window();
    super::open_tab(&mut window, meshbrush_kit::kit::Tab::Inspect);
    let says = |window: &Window, text| window.query_by_label_contains(text).is_some();
    assert!(says(&window, "with the query tool (Q):"));
    open_keys_of(&mut window, "Query Q");
    press(&mut window, "Remove Q");
    send(&mut window, Command::from(ShellCommand::CloseHelp));
    assert!(says(&window, "with the query tool:"), "an entry without a key");
}

#[test]
fn an_entry_is_found_by_pressing_its_key() {
    let mut window = window();
    choose(&mut window, "Help", "Keyboard and mouse Shift+F1");
    press(&mut window, "Search by pressing a key");
    key(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::O);
    let rows = |window: &Window| -> Vec<String> {
        let rows = window.query_all_by_role(Role::ListItem).filter_map(|node| node.accesskit_node().label());
        rows.filter(|row| !row.starts_with("Level ")).collect()
    };
    assert_eq!(rows(&window), ["Open domain… Ctrl+Shift+O"]);
    press(&mut window, "Show all, not only Ctrl+Shift+O");
    assert!(rows(&window).len() > 60);
}

#[test]
fn changed_keys_are_exported_and_imported_as_differences() {
    let folder = folder("app-keys", "files");
    let file = folder.join("my keys.json");
    let mut window = window();
    open_keys_of(&mut window, "Eraser E");
    press(&mut window, "Remove E");
    for button in ["Import keys…", "Export keys…"] {
        press(&mut window, button);
        let asks = |window: &Window| window.query_by_role_and_label(Role::TextInput, "Path").is_some();
        assert!(asks(&window), "{button} asks for a file");
        key(&mut window, Modifiers::NONE, Key::Escape);
        assert!(!asks(&window));
    }
    let mut kept = Kept::default();
    window.state_mut().save(&mut kept);
    send(&mut window, Command::from(ShellCommand::ExportKeysAs(file.clone())));
    wait_until(&mut window, |window| notice(window).contains("written"));
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(text.contains("\"eraser\": []") && !text.contains("brush\":"), "{text}");
    press(&mut window, "Reset all keys");
    send(&mut window, Command::from(ShellCommand::ImportKeys(file.clone())));
    wait_until(&mut window, |window| window.state().keymap.changes("eraser"));
    std::fs::write(&file, text.replace("[]", "[\"Hyper+Q\"]")).unwrap();
    send(&mut window, Command::from(ShellCommand::ImportKeys(file)));
    wait_until(&mut window, |window| notice(window).contains("Hyper+Q"));
    assert!(window.state().keymap.changes("eraser"), "a file with a mistake changes nothing");
    let mut next = super::window();
    next.state_mut().load_keys(&kept);
    assert!(next.state().keymap.changes("eraser"), "they are those of the next run, too");
}

#[test]
fn an_entry_of_two_owners_is_reported_in_the_list() {
    let mut window = window();
    let text =
        r#"{"format": "meshbrush keys", "version": 1, "keys": {"eraser": ["B"], "unknown-entry": ["A"]}}"#;
    let keymap = meshbrush_kit::kit::Keymap::parse(text).unwrap();
    assert!(keymap.to_text().contains("unknown-entry"), "of another version, and kept");
    send(&mut window, Command::from(ShellCommand::SetKeys(keymap)));
    send(&mut window, Command::from(ShellCommand::ShowHelp(meshbrush_kit::kit::command::HelpTopic::Keys)));
    assert!(window.query_by_label("B belongs to “Brush” and to “Eraser”.").is_some());
}

#[test]
fn the_threats_tool_keeps_its_key_while_a_threat_is_selected() {
    let mut window = window();
    send(&mut window, Command::from(LayerCommand::Add(Box::new(LayerKind::Threats(Threats::default())))));
    send(&mut window, Command::from(ShellCommand::Use(&THREATS)));
    send(&mut window, Command::from(ThreatsCommand::Place(FREE)));
    key(&mut window, Modifiers::NONE, Key::Delete);
    let threats = super::settings(&window).layers.iter().find_map(|layer| match &layer.kind {
        LayerKind::Threats(threats) => Some(threats.list().len()),
        _ => None,
    });
    assert_eq!(threats, Some(0));
}
