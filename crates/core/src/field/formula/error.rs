//! A mistake in a formula: a sentence, its place, and the text with carets under the place.

use std::ops::Range;

use super::pointer::{draw_pointer, printable};

/// A mistake in a formula.
///
/// Its text is a sentence for a person: what was found, what was expected, and what would help.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ParseError {
    message: String,
    span: Range<usize>,
    pointer: String,
}

impl ParseError {
    /// `span` must lie on character boundaries of `source`.
    pub(super) fn new(source: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let pointer = draw_pointer(source, &span);
        Self { message: message.into(), span, pointer }
    }

    /// Returns the place of the mistake, in bytes of the formula's text; empty at its end.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Returns two lines for a fixed-width font: the formula, or about 70 columns of it around the mistake,
    /// and carets under the mistake.
    ///
    /// ```
    /// # use meshbrush_core::field::Formula;
    /// let mistake = Formula::parse("θ + größe").unwrap_err();
    /// assert_eq!(mistake.pointer(), "θ + größe\n    ^^^^^");
    /// ```
    pub fn pointer(&self) -> &str {
        &self.pointer
    }
}

/// Returns at most 24 characters of a text found in a formula, between backquotes.
pub(super) fn quote(text: &str) -> String {
    let mut shown: String = text.chars().take(24).map(printable).collect();
    if text.chars().nth(24).is_some() {
        shown.push('…');
    }
    format!("`{shown}`")
}
