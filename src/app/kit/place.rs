//! Places in the panels: sections and settings that can be put in sight.

/// A section of a panel, or a control in it.
#[derive(Debug, PartialEq, Eq)]
pub struct Place {
    /// The name of the panel.
    pub panel: &'static str,
    /// The title or the name of the section.
    pub section: &'static str,
    /// The name of the control; empty for the section itself.
    pub control: &'static str,
    /// Other words by which it is found.
    pub words: &'static str,
    /// Whether the panel is shown only with a tool that lists it.
    pub needs_tool: bool,
}

impl Place {
    /// Creates a place in a panel that is always shown.
    pub const fn new(panel: &'static str, section: &'static str, control: &'static str) -> Self {
        Self { panel, section, control, words: "", needs_tool: false }
    }

    /// Adds other words by which it is found.
    pub const fn words(self, words: &'static str) -> Self {
        Self { words, ..self }
    }

    /// Marks a panel that is shown only with a tool that lists it.
    pub const fn with_tool(self) -> Self {
        Self { needs_tool: true, ..self }
    }

    /// Returns the title in the palette.
    pub fn title(&self) -> String {
        match self.control {
            "" => format!("Panel {}", self.section),
            control => format!("{} › {control}", self.section),
        }
    }
}
