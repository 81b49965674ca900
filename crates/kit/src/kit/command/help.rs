//! The topics of the help.

/// The contents of the help window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HelpTopic {
    /// Keys and gestures.
    Keys,
    /// A page of the manual, by its file.
    Page(&'static str),
    /// A heading of a page: the file of the page, and the number of the block of the heading.
    Heading(&'static str, usize),
}

impl HelpTopic {
    /// The first page.
    pub const MANUAL: Self = Self::Page("first-steps.md");
    /// The page that explains the steps from risk to mesh in one picture.
    pub const HOW_IT_WORKS: Self = Self::Page("how-it-works.md");
    /// The words of the field and of the program.
    pub const GLOSSARY: Self = Self::Page("glossary.md");

    /// Returns the entry of the list that is marked.
    pub fn in_list(self) -> Self {
        if let Self::Heading(file, _) = self { Self::Page(file) } else { self }
    }
}
