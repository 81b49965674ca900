//! The keys that a person changed.

use std::collections::BTreeMap;

use egui::KeyboardShortcut;

use super::entry::CatalogItem;
use super::shortcut::{parse_shortcut, same_keys, shortcut_name, shortcut_text};

/// The first words of a file of keys.
const FORMAT: &str = "meshbrush keys";
/// The version of the format that is written, and the newest that can be read.
const VERSION: u64 = 1;

/// Differences from the keys that entries have by themselves: the keys of an entry, by its id. An entry
/// without keys is there with an empty list. Ids that this version does not know are kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keymap(BTreeMap<String, Vec<KeyboardShortcut>>);

impl Keymap {
    /// Gives an entry its keys. Every list of keys in the window is made from entries that went through here.
    pub fn apply(&self, item: &mut CatalogItem) {
        if let Some(keys) = self.0.get(&item.id) {
            item.shortcuts = keys.clone();
        }
    }

    /// Returns whether no key was changed.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns whether the keys of an entry were changed.
    pub fn changes(&self, id: &str) -> bool {
        self.0.contains_key(id)
    }

    /// Adds a key to those of an entry, and takes it from the entries that it would run otherwise.
    pub fn assign(&mut self, item: &CatalogItem, shortcut: KeyboardShortcut, all: &[CatalogItem]) {
        for owner in owners(item, &shortcut, all) {
            self.remove(owner, &shortcut);
        }
        let mut keys = item.shortcuts.clone();
        keys.push(shortcut);
        self.set(item, keys);
    }

    /// Takes a key from an entry.
    pub fn remove(&mut self, item: &CatalogItem, shortcut: &KeyboardShortcut) {
        let keys = item.shortcuts.iter().filter(|own| !same_keys(own, shortcut)).copied().collect();
        self.set(item, keys);
    }

    /// Gives an entry the keys that it has by itself.
    pub fn reset(&mut self, id: &str) {
        self.0.remove(id);
    }

    fn set(&mut self, item: &CatalogItem, keys: Vec<KeyboardShortcut>) {
        if keys == item.default_shortcuts {
            self.0.remove(&item.id);
        } else {
            self.0.insert(item.id.clone(), keys);
        }
    }

    /// Returns the differences as the text of a file.
    pub fn to_text(&self) -> String {
        let keys: BTreeMap<&str, Vec<String>> =
            self.0.iter().map(|(id, keys)| (id.as_str(), keys.iter().map(shortcut_name).collect())).collect();
        let file = serde_json::json!({ "format": FORMAT, "version": VERSION, "keys": keys });
        serde_json::to_string_pretty(&file).unwrap_or_default() + "\n"
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// Fails with a sentence that says what is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        let file: serde_json::Value =
            serde_json::from_str(text).map_err(|error| format!("It is no file of keys: {error}."))?;
        if file["format"] != FORMAT {
            return Err(format!("It is no file of keys: its \"format\" is not \"{FORMAT}\"."));
        }
        if file["version"].as_u64().is_none_or(|version| version > VERSION) {
            let version = &file["version"];
            return Err(format!(
                "It has the version {version}, and this program reads version {VERSION}. Use a newer Meshbrush."
            ));
        }
        let entries = file["keys"].as_object().ok_or("Its \"keys\" are missing.")?;
        let keys = entries.iter().map(|(id, keys)| Ok((id.clone(), parse_keys(id, keys)?)));
        Ok(Self(keys.collect::<Result<_, String>>()?))
    }
}

fn parse_keys(id: &str, keys: &serde_json::Value) -> Result<Vec<KeyboardShortcut>, String> {
    let keys = keys.as_array().ok_or_else(|| format!("The keys of \"{id}\" are not a list."))?;
    let parse = |key: &serde_json::Value| {
        let unknown = || format!("{key}, a key of \"{id}\", is not known. Write it as in Ctrl+Shift+PageUp.");
        key.as_str().and_then(parse_shortcut).ok_or_else(unknown)
    };
    keys.iter().map(parse).collect()
}

/// Returns the other entries that a key of `item` would run. Entries of different situations, such as tools,
/// can share a key.
pub fn owners<'a>(
    item: &CatalogItem,
    shortcut: &KeyboardShortcut,
    all: &'a [CatalogItem],
) -> Vec<&'a CatalogItem> {
    let shares = |other: &&CatalogItem| {
        other.id != item.id
            && other.can_meet(item)
            && other.shortcuts.iter().any(|own| same_keys(own, shortcut))
    };
    all.iter().filter(shares).collect()
}

/// Returns a sentence for each key that two entries share.
pub fn conflicts(all: &[CatalogItem]) -> Vec<String> {
    let mut found = Vec::new();
    for (number, item) in all.iter().enumerate() {
        for shortcut in &item.shortcuts {
            for other in owners(item, shortcut, &all[number + 1..]) {
                let keys = shortcut_text(shortcut);
                found.push(format!("{keys} belongs to “{}” and to “{}”.", item.title, other.title));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use egui::{Key, Modifiers};

    use super::*;
    use crate::kit::Menu;
    use crate::kit::command::{Command, EditCommand};

    fn items(keymap: &Keymap) -> Vec<CatalogItem> {
        let item =
            |title, key| CatalogItem::new(Menu::Edit, title, Command::from(EditCommand::Undo)).key(key);
        let mut items = vec![item("One", Key::A), item("Two", Key::B)];
        items.iter_mut().for_each(|item| keymap.apply(item));
        items
    }

    #[test]
    fn a_key_moves_from_one_entry_to_another_and_back() {
        let mut keymap = Keymap::default();
        let all = items(&keymap);
        let b = KeyboardShortcut::new(Modifiers::NONE, Key::B);
        keymap.assign(&all[0], b, &all);
        let all = items(&keymap);
        assert_eq!((all[0].shortcuts.len(), all[1].shortcuts.len()), (2, 0));
        assert!(conflicts(&all).is_empty());
        assert_eq!(Keymap::parse(&keymap.to_text()), Ok(keymap.clone()), "also an empty list is kept");
        keymap.remove(&all[0], &b);
        assert!(!keymap.changes("one"), "only differences are kept");
        keymap.reset("two");
        assert!(keymap.is_empty());
    }

    #[test]
    fn a_file_that_is_not_of_keys_says_why() {
        for (text, why) in [
            ("keys", "no file of keys"),
            ("{}", "\"format\""),
            (r#"{"format": "meshbrush keys", "version": 9}"#, "newer Meshbrush"),
            (r#"{"format": "meshbrush keys", "version": 1}"#, "missing"),
            (r#"{"format": "meshbrush keys", "version": 1, "keys": {"undo": "Z"}}"#, "not a list"),
            (r#"{"format": "meshbrush keys", "version": 1, "keys": {"undo": ["Hyper+Z"]}}"#, "Hyper+Z"),
        ] {
            let problem = Keymap::parse(text).unwrap_err();
            assert!(problem.contains(why), "{problem}");
        }
    }
}
