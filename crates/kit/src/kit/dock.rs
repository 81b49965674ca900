//! Which tab of the lower dock is shown.

use super::Tab;

/// A tool by its name, with its tab.
type ToolOfDock = (&'static str, Option<Tab>);

/// The tab of the lower dock, and why it is shown.
#[derive(Clone, Copy, Debug)]
pub struct Dock {
    tab: Tab,
    /// The tool that was selected when the tab was last looked at.
    tool: Option<ToolOfDock>,
    /// Whether a person has chosen the tab since that tool was selected.
    is_chosen: bool,
}

impl Default for Dock {
    fn default() -> Self {
        Self { tab: Tab::Size, tool: None, is_chosen: false }
    }
}

impl Dock {
    /// Returns the tab that is shown.
    pub fn tab(&self) -> Tab {
        self.tab
    }

    /// Shows a tab that a person has chosen, or whose panel a command has opened. It stays until another tool
    /// is selected.
    pub fn choose(&mut self, tab: Tab) {
        if tab != Tab::Layers {
            (self.tab, self.is_chosen) = (tab, true);
        }
    }

    /// Shows the tab of a tool that was selected, unless that tool was selected already and a person has
    /// chosen another tab since then.
    pub fn follow_tool(&mut self, name: &'static str, tab: Option<Tab>) {
        if self.tool.replace((name, tab)) != Some((name, tab)) {
            self.is_chosen = false;
        }
        if let Some(tab) = tab.filter(|_| !self.is_chosen) {
            self.tab = tab;
        }
    }

    /// Leaves a tab that has nothing to show any more for that of the selected tool.
    pub fn leave(&mut self, tab: Tab) {
        if self.tab == tab {
            let of_tool = self.tool.and_then(|(_, tab)| tab);
            (self.tab, self.is_chosen) = (of_tool.unwrap_or(Tab::Size), false);
        }
    }
}
