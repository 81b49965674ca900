//! Keyboard and mouse: every gesture, and every command with its keys, which can be changed.

use std::borrow::Cow;

use eframe::egui::{Id, Role, Sense, Ui, WidgetInfo, vec2};

use super::key_editor::KeyEditor;
use crate::app::catalog::gestures;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CatalogItem, Keymap, Menu, shortcut_text};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{SearchField, key_row, matches};

/// A line of the list.
struct HelpLine<'a> {
    group: &'a str,
    title: Cow<'a, str>,
    keys: String,
    /// The entry of a menu; a gesture has none.
    item: Option<&'a CatalogItem>,
}

/// Shows a search field, and below it the keys and gestures that match. The keys can be changed.
pub fn show(ui: &mut Ui, catalog: &[CatalogItem], keymap: &Keymap, commands: &mut Vec<Command>) {
    let id = Id::unique("search in the list of keys");
    let mut query: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    SearchField::new("Search for a key", "Search: a key, or what it does").show(ui, &mut query);
    let mut editor = KeyEditor::load(ui);
    editor.bar(ui, catalog, keymap, commands);
    let entries = entries(catalog);
    // What is searched for can have no key yet.
    let found =
        entries.iter().filter(|entry| entry.matches(&query) && (entry.has_keys() || !query.is_empty()));
    let found: Vec<&HelpLine<'_>> = found.filter(|entry| editor.shows(entry.item)).collect();
    if found.is_empty() {
        ui.label("No key or gesture matches.");
    }
    let mut group = "";
    for entry in found {
        if entry.group != group {
            group = entry.group;
            heading(ui, group);
        }
        match entry.item {
            Some(item) => editor.row(ui, item, catalog, keymap, commands),
            None => drop(key_row(ui, &entry.title, &entry.keys)),
        }
    }
    editor.store(ui);
    ui.data_mut(|data| data.insert_temp(id, query));
}

/// Returns the list as a page of the documentation.
#[cfg(test)]
pub fn page(catalog: &[CatalogItem]) -> String {
    let mut page = "# Keys and gestures\n\nThe list of Shift+`F1` in the window. On a Mac, Ctrl is Cmd. \
                    Written by a test.\n"
        .to_owned();
    let mut group = "";
    for entry in entries(catalog).into_iter().filter(HelpLine::has_keys) {
        if entry.group != group {
            group = entry.group;
            page += &format!("\n## {group}\n\n| | |\n|---|---|\n");
        }
        page += &format!("| {} | {} |\n", entry.title, entry.keys);
    }
    page
}

/// Gestures first: they are the hardest to guess.
fn entries(catalog: &[CatalogItem]) -> Vec<HelpLine<'_>> {
    let gestures = gestures().into_iter().map(|gesture| HelpLine {
        group: gesture.place.name(),
        title: gesture.title.into(),
        keys: gesture.keys.to_owned(),
        item: None,
    });
    let keys = Menu::ALL.iter().flat_map(|(menu, group)| {
        // Gestures are listed already.
        let items = catalog.iter().filter(move |item| item.menu == *menu && item.gesture.is_empty());
        items.map(move |item| {
            let keys: Vec<String> = item.shortcuts.iter().map(shortcut_text).collect();
            HelpLine {
                group,
                title: item.title_with_situation().into(),
                keys: keys.join(", "),
                item: Some(item),
            }
        })
    });
    gestures.chain(keys).collect()
}

impl HelpLine<'_> {
    fn has_keys(&self) -> bool {
        !self.keys.is_empty()
    }

    fn matches(&self, query: &str) -> bool {
        matches(query, &self.title) || matches(query, &self.keys) || matches(query, self.group)
    }
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(12.0);
    let (_, rect) = ui.allocate_space(vec2(ui.available_width(), 20.0));
    let response = ui.interact(rect, ui.scope_id().with(("keys", text)), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Heading, true, text));
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font::strong(), tokens(ui).value);
    ui.painter().galley(rect.left_top(), galley, tokens(ui).value);
}
