//! Keyboard and mouse: every command with a key, and every gesture.

use eframe::egui::{Id, Role, Sense, Ui, WidgetInfo, vec2};

use crate::app::catalog::gestures;
use crate::app::kit::{CatalogItem, Menu};
use crate::app::theme::{font, tokens};
use crate::app::widgets::{SearchField, key_row, matches};

/// A line of the list.
struct Entry<'a> {
    group: &'a str,
    title: &'a str,
    keys: String,
}

/// A search field, and below it the keys and gestures that match.
pub fn show(ui: &mut Ui, catalog: &[CatalogItem]) {
    let id = Id::unique("search in the list of keys");
    let mut query: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    SearchField::new("Search for a key", "Search: a key, or what it does").show(ui, &mut query);
    let entries = entries(catalog);
    let found: Vec<&Entry<'_>> = entries.iter().filter(|entry| entry.matches(&query)).collect();
    if found.is_empty() {
        ui.label("No key or gesture matches.");
    }
    let mut group = "";
    for entry in found {
        if entry.group != group {
            group = entry.group;
            heading(ui, group);
        }
        key_row(ui, entry.title, &entry.keys);
    }
    ui.data_mut(|data| data.insert_temp(id, query));
}

/// Returns the list as a page of the documentation.
#[cfg(test)]
pub fn page(catalog: &[CatalogItem]) -> String {
    let mut page = "# Keys and gestures\n\nThe list of Shift+`F1` in the window. On a Mac, Ctrl is Cmd. \
                    Written by a test.\n"
        .to_owned();
    let mut group = "";
    for entry in entries(catalog) {
        if entry.group != group {
            group = entry.group;
            page += &format!("\n## {group}\n\n| | |\n|---|---|\n");
        }
        page += &format!("| {} | {} |\n", entry.title, entry.keys);
    }
    page
}

/// Gestures first: they are the hardest to guess.
fn entries(catalog: &[CatalogItem]) -> Vec<Entry<'_>> {
    let gestures = gestures().into_iter().map(|gesture| Entry {
        group: gesture.place.name(),
        title: gesture.title,
        keys: gesture.keys.to_owned(),
    });
    let keys = Menu::ALL.iter().flat_map(|(menu, group)| {
        let items = catalog.iter().filter(move |item| item.menu == *menu && item.shortcut.is_some());
        items.map(move |item| Entry { group, title: &item.title, keys: item.keys_text() })
    });
    gestures.chain(keys).collect()
}

impl Entry<'_> {
    fn matches(&self, query: &str) -> bool {
        matches(query, self.title) || matches(query, &self.keys) || matches(query, self.group)
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
