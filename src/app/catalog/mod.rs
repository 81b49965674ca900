//! The commands that have a title: what menus, keys and the palette offer.

mod edit;
mod file;
mod gestures;
mod help;
mod layer;
mod steps;
mod tool;
mod view;

use eframe::egui::{Key, KeyboardShortcut, Modifiers};

use super::command::Command;
use super::features::plots;
use super::frame::FrameState;
pub use gestures::{GESTURES, GestureHelp};

/// Every command with a title, in menu order, with its present state.
pub fn catalog(state: &FrameState<'_>) -> Vec<CatalogItem> {
    [
        file::file(state),
        edit::edit(state),
        tool::tool(state),
        layer::layer(state),
        view::view(state),
        plots::entries(state),
        steps::steps(state),
        help::examples(),
        help::help(),
    ]
    .concat()
}

/// The menu that a command is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Documents and files.
    File,
    /// History and paint.
    Edit,
    /// Tools and the brush.
    Tool,
    /// The layers of the size field.
    Layer,
    /// What is shown.
    View,
    /// Documents that come with the program.
    Examples,
    /// Manual, keys and gestures, About.
    Help,
}

impl Menu {
    /// All menus, from left to right, with their names.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::File, "File"),
        (Self::Edit, "Edit"),
        (Self::Tool, "Tool"),
        (Self::Layer, "Layer"),
        (Self::View, "View"),
        (Self::Examples, "Examples"),
        (Self::Help, "Help"),
    ];
}

/// A command with its title, its menu and its key.
#[derive(Clone, Debug)]
pub struct CatalogItem {
    /// Its menu.
    pub menu: Menu,
    /// Its title in menus and in the palette.
    pub title: String,
    /// Its shortcut.
    pub shortcut: Option<KeyboardShortcut>,
    /// The pointer gesture that does the same, as shown beside the title.
    pub gesture: &'static str,
    /// What it does.
    pub command: Command,
    /// Whether it can be run now.
    pub enabled: bool,
    /// Whether it is the current choice of several.
    pub checked: bool,
    /// Whether a separator is above it.
    pub begins_group: bool,
}

impl CatalogItem {
    /// A command that is enabled, without a key.
    pub fn new(menu: Menu, title: impl Into<String>, command: Command) -> Self {
        Self {
            menu,
            title: title.into(),
            shortcut: None,
            gesture: "",
            command,
            enabled: true,
            checked: false,
            begins_group: false,
        }
    }

    /// With a plain key.
    pub fn key(self, key: Key) -> Self {
        self.keys(Modifiers::NONE, key)
    }

    /// With a key and Ctrl (Cmd on a Mac).
    pub fn ctrl(self, key: Key) -> Self {
        self.keys(Modifiers::COMMAND, key)
    }

    /// With a key and modifiers.
    pub fn keys(mut self, modifiers: Modifiers, key: Key) -> Self {
        self.shortcut = Some(KeyboardShortcut::new(modifiers, key));
        self
    }

    /// Done by a pointer gesture.
    pub fn gesture(mut self, gesture: &'static str) -> Self {
        self.gesture = gesture;
        self
    }

    /// The shortcut or the gesture, as menus and the palette show it; empty if there is none.
    pub fn keys_text(&self) -> String {
        self.shortcut.as_ref().map_or_else(|| self.gesture.to_owned(), shortcut_text)
    }

    /// Only where `enabled`.
    pub fn enabled(mut self, enabled: bool) -> Self {
        self.enabled = enabled;
        self
    }

    /// Marked where `checked`.
    pub fn checked(mut self, checked: bool) -> Self {
        self.checked = checked;
        self
    }

    /// With a separator above it.
    pub fn group(mut self) -> Self {
        self.begins_group = true;
        self
    }
}

/// A shortcut in words.
fn shortcut_text(shortcut: &KeyboardShortcut) -> String {
    let mut text = String::new();
    if shortcut.modifiers.command {
        text += "Ctrl+";
    }
    if shortcut.modifiers.shift {
        text += "Shift+";
    }
    text + match shortcut.logical_key {
        Key::OpenCurlyBracket => "[",
        Key::CloseCurlyBracket => "]",
        Key::Escape => "Esc",
        key => key.symbol_or_name(),
    }
}
