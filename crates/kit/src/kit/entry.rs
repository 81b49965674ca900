//! An entry of a menu, which the palette and the list of keys offer too.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::shortcut::shortcut_text;
use crate::kit::command::Command;

/// The keys of digits, from 1.
pub const DIGITS: [Key; 10] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
    Key::Num0,
];

/// The situation of keys that work with the query tool.
pub const QUERYING: &str = "with the query tool";
/// The situation of keys that work with any other tool.
pub const NOT_QUERYING: &str = "with any other tool";

/// The menu that a command is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Menu {
    /// Documents and files.
    File,
    /// History and paint.
    Edit,
    /// Tools and the brush.
    Tool,
    /// The layers of the size field.
    Layer,
    /// The menu of the view.
    View,
    /// Documents that come with the program.
    Examples,
    /// The method of the report: steps, figures, walks.
    Method,
    /// Manual, keys and gestures, About.
    Help,
}

impl Menu {
    /// All menus, from left to right, with their names.
    pub const ALL: [(Self, &'static str); 8] = [
        (Self::File, "File"),
        (Self::Edit, "Edit"),
        (Self::Tool, "Tool"),
        (Self::Layer, "Layer"),
        (Self::View, "View"),
        (Self::Examples, "Examples"),
        (Self::Method, "Method"),
        (Self::Help, "Help"),
    ];
}

/// A menu within a menu, for entries of one sort. It keeps the menu around it short.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Submenu {
    /// Each way to add a layer.
    AddLayer,
    /// How the selected layer combines with those below it.
    Combine,
    /// What colours the triangles on the canvas.
    Overlay,
    /// The colours of values.
    Colours,
    /// How places are written.
    Places,
    /// Light or dark.
    Theme,
    /// The size of text and controls.
    InterfaceSize,
    /// Brushes that a person keeps under a name.
    BrushPresets,
}

impl Submenu {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::AddLayer,
        Self::Combine,
        Self::Overlay,
        Self::Colours,
        Self::Places,
        Self::Theme,
        Self::InterfaceSize,
        Self::BrushPresets,
    ];

    /// Returns the title, as the menu around it shows it.
    pub fn title(self) -> &'static str {
        match self {
            Self::AddLayer => "Add layer",
            Self::Combine => "Combine",
            Self::Overlay => "Overlay",
            Self::Colours => "Colours",
            Self::Places => "Places",
            Self::Theme => "Theme",
            Self::InterfaceSize => "Interface size",
            Self::BrushPresets => "Brush presets",
        }
    }

    /// Returns the title of an entry within this menu: without the words that the menu says already.
    pub fn title_within(self, title: &str) -> &str {
        let rest = title.strip_prefix(self.title());
        rest.and_then(|rest| rest.strip_prefix(": ").or(rest.strip_prefix(' '))).unwrap_or(title)
    }
}

/// A command with its title, its menu and its key.
#[derive(Clone, Debug)]
pub struct CatalogItem {
    /// Names the entry in files of keys. It never changes: an entry whose title varies, or was changed, sets
    /// it.
    pub id: String,
    /// The menu of the entry.
    pub menu: Menu,
    /// The menu within that menu, if it is in one.
    pub submenu: Option<Submenu>,
    /// The title in menus and in the palette.
    pub title: String,
    /// The keys that run it; the first one is shown.
    pub shortcuts: Vec<KeyboardShortcut>,
    /// The keys that it has where nobody changed them.
    pub default_shortcuts: Vec<KeyboardShortcut>,
    /// The situation in which its keys work, such as a tool; entries of different ones can share a key.
    pub situation: Option<&'static str>,
    /// Whether its keys work now.
    pub keys_work: bool,
    /// The pointer gesture that does the same, as shown beside the title.
    pub gesture: &'static str,
    /// The command that it sends.
    pub command: Command,
    /// Whether it can be run now.
    pub enabled: bool,
    /// Whether it is the current choice of several.
    pub checked: bool,
    /// Whether a separator is above it.
    pub begins_group: bool,
    /// Whether it stands above the other entries of its menu, as those that set how a tool works.
    pub is_above: bool,
    /// Whether it is in its menu, and not only in the palette and the list of keys.
    pub is_in_menu: bool,
}

impl CatalogItem {
    /// Creates a command that is enabled, without a key.
    pub fn new(menu: Menu, title: impl Into<String>, command: Command) -> Self {
        let title = title.into();
        Self {
            id: id_of(&title),
            menu,
            submenu: None,
            title,
            shortcuts: Vec::new(),
            default_shortcuts: Vec::new(),
            situation: None,
            keys_work: true,
            gesture: "",
            command,
            enabled: true,
            checked: false,
            begins_group: false,
            is_above: false,
            is_in_menu: true,
        }
    }

    /// Sets the id, where the title varies or was changed.
    pub fn id(mut self, id: impl Into<String>) -> Self {
        self.id = id.into();
        self
    }

    /// Says that the keys work only in a situation, such as with a tool, and whether that is so now. Entries
    /// of different situations can share a key.
    pub fn only(mut self, situation: &'static str, is_so: bool) -> Self {
        (self.situation, self.keys_work) = (Some(situation), is_so);
        self
    }

    /// Returns the title, with the situation in which its keys work: `Add to the domain (with the domain
    /// tool)`.
    pub fn title_with_situation(&self) -> String {
        self.situation.map_or_else(|| self.title.clone(), |situation| format!("{} ({situation})", self.title))
    }

    /// Returns whether this entry and another one can be meant by one key.
    pub fn can_meet(&self, other: &Self) -> bool {
        match (self.situation, other.situation) {
            (Some(own), Some(others)) => own == others,
            _ => true,
        }
    }

    /// Adds a plain key as shortcut.
    pub fn key(self, key: Key) -> Self {
        self.keys(Modifiers::NONE, key)
    }

    /// Adds a key with Ctrl (Cmd on a Mac) as shortcut.
    pub fn ctrl(self, key: Key) -> Self {
        self.keys(Modifiers::COMMAND, key)
    }

    /// Adds a key with modifiers as shortcut. The first one is shown.
    pub fn keys(mut self, modifiers: Modifiers, key: Key) -> Self {
        let shortcut = KeyboardShortcut::new(modifiers, key);
        self.shortcuts.push(shortcut);
        self.default_shortcuts.push(shortcut);
        self
    }

    /// Done by a pointer gesture.
    pub fn gesture(mut self, gesture: &'static str) -> Self {
        self.gesture = gesture;
        self
    }

    /// Returns the shortcut that works now or the gesture, as menus and the palette show it; empty if there
    /// is none.
    pub fn keys_text(&self) -> String {
        let shown = self.shortcuts.first().filter(|_| self.keys_work);
        shown.map_or_else(|| self.gesture.to_owned(), shortcut_text)
    }

    /// Returns the shortcut in whatever situation it works, or `None` where no key runs the entry.
    pub fn shown_keys(&self) -> Option<String> {
        self.shortcuts.first().map(shortcut_text)
    }

    /// Sets whether the entry is enabled.
    pub fn enabled(mut self, enabled: bool) -> Self {
        self.enabled = enabled;
        self
    }

    /// Marked where `checked`.
    pub fn checked(mut self, checked: bool) -> Self {
        self.checked = checked;
        self
    }

    /// Puts the entry above the others of its menu.
    pub fn above(mut self) -> Self {
        self.is_above = true;
        self
    }

    /// Leaves the entry out of its menu, which stays short: the palette and the list of keys have it.
    pub fn palette_only(self) -> Self {
        self.in_menu(false)
    }

    /// Leaves the entry out of its menu unless `is_in_menu`.
    pub fn in_menu(mut self, is_in_menu: bool) -> Self {
        self.is_in_menu &= is_in_menu;
        self
    }

    /// Puts the entry into a menu within its menu, beside the entries before and after it that are there too.
    pub fn within(mut self, submenu: Submenu) -> Self {
        self.submenu = Some(submenu);
        self
    }

    /// Adds a separator above the entry, or above the menu within the menu that begins with it.
    pub fn group(mut self) -> Self {
        self.begins_group = true;
        self
    }
}

/// Returns a title as an id: `Larger brush` is `larger-brush`.
fn id_of(title: &str) -> String {
    let words = title.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect::<Vec<_>>().join("-")
}
