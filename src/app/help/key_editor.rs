//! Changing keys in the list of keys.

use eframe::egui::{Context, Event, Id, Key, KeyboardShortcut, Modifiers, RichText, Ui};

use crate::app::file_kinds::{EXPORT_KEYS, IMPORT_KEYS};
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::{CatalogItem, Keymap, conflicts, owners, same_keys, shortcut_text};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{ActionButton, key_row_button};

/// What the next key that is pressed is for.
#[derive(Clone, Debug, PartialEq)]
enum Capture {
    /// The list shows what it does.
    Search,
    /// It becomes a key of the entry with this id.
    Entry(String),
}

/// The state of the list that is being edited, in egui's memory.
#[derive(Clone, Debug, Default)]
pub struct KeyEditor {
    /// The id of the entry whose keys are shown for editing.
    open: Option<String>,
    capture: Option<Capture>,
    /// A key that was pressed for the open entry and belongs to others.
    taken: Option<KeyboardShortcut>,
    /// The key whose entries are shown alone.
    sought: Option<KeyboardShortcut>,
}

fn id() -> Id {
    Id::unique("editor of keys")
}

/// Returns whether the list of keys waits for a key, which then runs no command.
pub fn takes_next_key(ctx: &Context) -> bool {
    ctx.data(|data| data.get_temp::<KeyEditor>(id())).is_some_and(|editor| editor.capture.is_some())
}

/// Forgets what was being edited: the list is closed.
pub fn stop(ctx: &Context) {
    ctx.data_mut(|data| data.remove::<KeyEditor>(id()));
}

impl KeyEditor {
    /// Returns the state of the last frame.
    pub fn load(ui: &Ui) -> Self {
        ui.data(|data| data.get_temp(id())).unwrap_or_default()
    }

    /// Keeps the state for the next frame.
    pub fn store(self, ui: &Ui) {
        ui.data_mut(|data| data.insert_temp(id(), self));
    }

    /// Shows what concerns all keys: searching by a key, files, the way back, and keys of two entries.
    pub fn bar(
        &mut self,
        ui: &mut Ui,
        catalog: &[CatalogItem],
        keymap: &Keymap,
        commands: &mut Vec<Command>,
    ) {
        if self.capture == Some(Capture::Search) {
            self.sought = self.captured(ui);
        }
        ui.add_space(4.0);
        ui.horizontal_wrapped(|ui| {
            self.search_button(ui);
            let file = |kind| Command::from(FileCommand::Ask(kind));
            if ui.add(ActionButton::new("Import keys…")).clicked() {
                commands.push(file(&IMPORT_KEYS));
            }
            let can = !keymap.is_empty();
            if ui.add_enabled_ui(can, |ui| ui.add(ActionButton::new("Export keys…"))).inner.clicked() {
                commands.push(file(&EXPORT_KEYS));
            }
            if ui.add_enabled_ui(can, |ui| ui.add(ActionButton::new("Reset all keys"))).inner.clicked() {
                commands.push(set(Keymap::default()));
            }
        });
        for sentence in conflicts(catalog) {
            ui.label(RichText::new(sentence).color(tokens(ui).danger));
        }
    }

    /// Shows the button that waits for a key to search by, and the way back to all entries.
    fn search_button(&mut self, ui: &mut Ui) {
        let waits = self.capture == Some(Capture::Search);
        let search = if waits { "Press a key…" } else { "Search by pressing a key" };
        if ui.add(ActionButton::new(search)).clicked() {
            self.begin(ui, Capture::Search);
        }
        if let Some(sought) = self.sought {
            let text = format!("Show all, not only {}", shortcut_text(&sought));
            if ui.add(ActionButton::new(&text)).clicked() {
                self.sought = None;
            }
        }
    }

    /// Returns whether the list shows an entry, or with `None` a gesture: a key can be sought.
    pub fn shows(&self, item: Option<&CatalogItem>) -> bool {
        let has = |sought| item.is_some_and(|item| item.shortcuts.iter().any(|own| same_keys(own, &sought)));
        self.sought.is_none_or(has)
    }

    /// Shows an entry with its keys. A click opens them for editing.
    pub fn row(
        &mut self,
        ui: &mut Ui,
        item: &CatalogItem,
        catalog: &[CatalogItem],
        keymap: &Keymap,
        commands: &mut Vec<Command>,
    ) {
        let keys: Vec<String> = item.shortcuts.iter().map(shortcut_text).collect();
        let is_open = self.open.as_deref() == Some(&item.id);
        if key_row_button(ui, &item.title_with_situation(), &keys, keymap.changes(&item.id), is_open)
            .clicked()
        {
            self.open = (!is_open).then(|| item.id.clone());
            (self.capture, self.taken) = (None, None);
        }
        if is_open {
            ui.indent(("keys of", &item.id), |ui| self.edit(ui, item, catalog, keymap, commands));
        }
    }

    fn edit(
        &mut self,
        ui: &mut Ui,
        item: &CatalogItem,
        catalog: &[CatalogItem],
        keymap: &Keymap,
        commands: &mut Vec<Command>,
    ) {
        let own = Capture::Entry(item.id.clone());
        if self.capture.as_ref() == Some(&own)
            && let Some(shortcut) = self.captured(ui)
            && !item.shortcuts.iter().any(|known| same_keys(known, &shortcut))
        {
            if owners(item, &shortcut, catalog).is_empty() {
                commands.push(changed(keymap, |keymap| keymap.assign(item, shortcut, catalog)));
            } else {
                self.taken = Some(shortcut);
            }
        }
        ui.horizontal_wrapped(|ui| {
            for shortcut in &item.shortcuts {
                let text = format!("Remove {}", shortcut_text(shortcut));
                if ui.add(ActionButton::new(&text)).clicked() {
                    commands.push(changed(keymap, |keymap| keymap.remove(item, shortcut)));
                }
            }
            let add = if self.capture.as_ref() == Some(&own) { "Press a key…" } else { "Add a key" };
            if ui.add(ActionButton::new(add)).clicked() {
                self.begin(ui, own);
            }
            if keymap.changes(&item.id) && ui.add(ActionButton::new("Reset")).clicked() {
                commands.push(changed(keymap, |keymap| keymap.reset(&item.id)));
            }
        });
        self.ask_about_taken(ui, item, catalog, keymap, commands);
    }

    /// Asks whether to take a key from the entries that have it.
    fn ask_about_taken(
        &mut self,
        ui: &mut Ui,
        item: &CatalogItem,
        catalog: &[CatalogItem],
        keymap: &Keymap,
        commands: &mut Vec<Command>,
    ) {
        let Some(shortcut) = self.taken else { return };
        let titles: Vec<String> =
            owners(item, &shortcut, catalog).iter().map(|owner| format!("“{}”", owner.title)).collect();
        let keys = shortcut_text(&shortcut);
        let text = format!("{keys} belongs to {}.", titles.join(" and "));
        ui.label(RichText::new(text).font(font::caption()).color(tokens(ui).danger));
        ui.horizontal(|ui| {
            if ui.add(ActionButton::new("Move the key here")).clicked() {
                commands.push(changed(keymap, |keymap| keymap.assign(item, shortcut, catalog)));
                self.taken = None;
            }
            if ui.add(ActionButton::new("Leave it there")).clicked() {
                self.taken = None;
            }
        });
    }

    fn begin(&mut self, ui: &Ui, capture: Capture) {
        (self.capture, self.taken) = (Some(capture), None);
        // Space and Enter would press the button again.
        ui.memory_mut(|memory| {
            if let Some(focused) = memory.focused() {
                memory.surrender_focus(focused);
            }
        });
    }

    /// Returns the key that was pressed. Escape ends the waiting; Tab always moves the focus.
    fn captured(&mut self, ui: &Ui) -> Option<KeyboardShortcut> {
        let events = ui.input(|input| input.events.clone());
        let (key, modifiers) = events.iter().find_map(|event| match *event {
            Event::Key { key, pressed: true, modifiers, .. } if !is_modifier(key) => Some((key, modifiers)),
            Event::Copy => Some((Key::C, Modifiers::COMMAND)),
            Event::Cut => Some((Key::X, Modifiers::COMMAND)),
            Event::Paste(_) => Some((Key::V, Modifiers::COMMAND)),
            _ => None,
        })?;
        self.capture = None;
        // Ctrl and Cmd are the same modifier in files.
        let held = [(modifiers.command, Modifiers::COMMAND), (modifiers.shift, Modifiers::SHIFT)];
        let held = held.into_iter().chain([(modifiers.alt, Modifiers::ALT)]);
        let modifiers = held.filter(|(is_held, _)| *is_held).fold(Modifiers::NONE, |all, (_, one)| all | one);
        (!matches!(key, Key::Escape | Key::Tab)).then_some(KeyboardShortcut::new(modifiers, key))
    }
}

fn is_modifier(key: Key) -> bool {
    ["Shift", "Control", "Alt", "Super"].iter().any(|name| key.name().starts_with(name))
}

fn set(keymap: Keymap) -> Command {
    Command::from(ShellCommand::SetKeys(keymap))
}

/// Returns the command that changes keys.
fn changed(keymap: &Keymap, change: impl FnOnce(&mut Keymap)) -> Command {
    let mut keymap = keymap.clone();
    change(&mut keymap);
    set(keymap)
}
