//! Places in the docks: sections and settings that can be put in sight.

/// A section of a panel, or a control in it.
#[derive(Debug, PartialEq, Eq)]
pub struct DockPlace {
    /// The name of the panel.
    pub panel: &'static str,
    /// The title or the name of the section.
    pub section: &'static str,
    /// The name of the control; empty for the section itself.
    pub control: &'static str,
    /// Other words by which it is found.
    pub words: &'static str,
}

impl DockPlace {
    /// Creates a place in a panel.
    pub const fn new(panel: &'static str, section: &'static str, control: &'static str) -> Self {
        Self { panel, section, control, words: "" }
    }

    /// Adds other words by which it is found.
    pub const fn words(self, words: &'static str) -> Self {
        Self { words, ..self }
    }

    /// Returns the title in the palette.
    pub fn title(&self) -> String {
        match self.control {
            "" => format!("Panel {}", self.section),
            control => format!("{} › {control}", self.section),
        }
    }
}
