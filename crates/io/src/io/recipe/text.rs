//! The text of a recipe, and sentences that point into it.

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::super::error::PlacedFlaw;
use super::super::settings::SavedSettings;
use super::super::values::TextValue;
use super::super::{Flaw, KeyFault, KeyStep, Mark, PlaceInFile, ReadError};
use meshbrush_core::field::formula::draw_pointer;
use meshbrush_mesh::text::excerpt;

/// The text of a recipe.
#[derive(Clone, Debug)]
pub struct RecipeText {
    file: PathBuf,
    text: String,
}

impl RecipeText {
    /// Returns the text of a file.
    pub fn new(file: &Path, text: String) -> Self {
        Self { file: file.to_owned(), text }
    }

    /// Returns the file as it was named.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Returns the tables.
    ///
    /// # Errors
    /// Fails with line and column, when the text is not valid TOML, has a key that no recipe has, or a value
    /// of another type.
    pub fn parse(&self) -> Result<SavedSettings, ReadError> {
        let tables = DeTable::parse(&self.text).map_err(|error| {
            let sentence = format!("this is not valid TOML: {}.", excerpt(300, error.message().trim()));
            self.pointing(error.span().unwrap_or(0..0), &sentence, None)
        })?;
        SavedSettings::of_tables(&TextValue::from_toml(tables.get_ref()), None)
            .map_err(|fault| self.error(&fault))
    }

    /// Returns the error for a value that cannot be used.
    pub fn error(&self, fault: &KeyFault) -> ReadError {
        let span = self.span_of(fault).unwrap_or(0..0);
        self.pointing(span, &fault.full_sentence(), fault.part.as_ref().map(|part| &*part.pointer))
    }

    /// Returns an error at a place: the sentence, and two lines that point there, or `own_pointer`.
    fn pointing(&self, span: Range<usize>, sentence: &str, own_pointer: Option<&str>) -> ReadError {
        let text = &self.text;
        let start = text.floor_char_boundary(span.start.min(text.len()));
        let line_start = text[..start].rfind('\n').map_or(0, |end| end + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |end| start + end);
        let line = text[line_start..line_end].trim_end_matches('\r');
        let start_in_line = (start - line_start).min(line.len());
        let end_in_line = text.floor_char_boundary(span.end.min(text.len())).saturating_sub(line_start);
        let marked = start_in_line..end_in_line.clamp(start_in_line, line.len());
        let drawn;
        let pointer = match own_pointer {
            Some(pointer) => pointer,
            None => {
                drawn = draw_pointer(line, &marked);
                &drawn
            }
        };
        let place = PlaceInFile::Column {
            line: text[..line_start].matches('\n').count() + 1,
            column: line[..start_in_line].chars().count() + 1,
        };
        let flaw = Flaw::Syntax(format!("{sentence}\n    {}", pointer.replace('\n', "\n    ")));
        PlacedFlaw { place, flaw }.in_file(&self.file)
    }

    /// Returns the place of a value in the text; where the path ends early, that of what encloses it.
    fn span_of(&self, fault: &KeyFault) -> Option<Range<usize>> {
        let tables = DeTable::parse(&self.text).ok()?;
        let (mut key, mut value): (Option<Range<usize>>, Range<usize>) = (None, tables.span());
        let root = Spanned::new(value.clone(), DeValue::Table(tables.into_inner()));
        let mut inner = &root;
        for step in &fault.path {
            let next = match step {
                KeyStep::Key(name) => {
                    let found = inner.get_ref().as_table().and_then(|table| table.get_key_value(&**name));
                    found.map(|(found, value)| (Some(found.span()), value))
                }
                KeyStep::Index(index) => inner.get_ref().get(*index).map(|value| (None, value)),
            };
            let Some((next_key, next_value)) = next else { break };
            (key, value, inner) = (next_key, next_value.span(), next_value);
        }
        Some(match (fault.mark, key) {
            (Mark::Value, _) | (_, None) => value,
            (Mark::Key, Some(key)) => key,
            (Mark::Entry, Some(key)) => key.start..value.end,
        })
    }
}
