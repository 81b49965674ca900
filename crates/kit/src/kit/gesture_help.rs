//! Gestures of the pointer, as help and menus name them.

use super::{CatalogItem, Menu};
use crate::kit::command::{Command, ShellCommand};

/// The tool or control with which a gesture is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum GesturePlace {
    /// With the brush or the eraser.
    Painting,
    /// With the query tool.
    Querying,
    /// With the threats tool.
    Threats,
    /// With the region tool.
    Regions,
    /// With the line tool.
    Lines,
    /// On the canvas, with any tool.
    Canvas,
    /// On a number or a slider of a panel.
    Panel,
}

impl GesturePlace {
    /// Returns the heading in the list of keys.
    pub fn name(self) -> &'static str {
        match self {
            Self::Painting => "Painting with the pointer",
            Self::Querying => "Inspecting triangles",
            Self::Threats => "Threats",
            Self::Regions => "Drawing regions",
            Self::Lines => "Drawing lines",
            Self::Canvas => "On the canvas, with any tool",
            Self::Panel => "In the panels",
        }
    }
}

/// Something done with the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GestureHelp {
    /// The effect of the gesture.
    pub title: &'static str,
    /// The keys and the movement.
    pub keys: &'static str,
    /// Where.
    pub place: GesturePlace,
    /// The text that its entry in the menu Tool shows; empty for a gesture without an entry.
    pub advice: &'static str,
}

impl GestureHelp {
    /// Creates a gesture without an entry in a menu.
    pub const fn new(place: GesturePlace, title: &'static str, keys: &'static str) -> Self {
        Self { title, keys, place, advice: "" }
    }

    /// Adds an entry to the menu Tool, which gives the advice.
    pub const fn in_menu(self, advice: &'static str) -> Self {
        Self { advice, ..self }
    }

    /// Returns the entry of the menu Tool. Chosen, it says how the gesture is made.
    pub fn entry(&self) -> Option<CatalogItem> {
        let command = Command::from(ShellCommand::Tell(self.advice.to_owned()));
        let item = CatalogItem::new(Menu::Tool, self.title, command).gesture(self.keys);
        (!self.advice.is_empty()).then_some(item)
    }
}
