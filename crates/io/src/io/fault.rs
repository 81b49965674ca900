//! A value of a text that cannot be used: its key, and why. Checks and serde give errors of the same kind.

use std::borrow::Cow;
use std::fmt::{self, Display};

use serde::de::{Error, Expected, Unexpected};

use meshbrush_core::field::formula::ParseError;
use meshbrush_mesh::text::{Number, excerpt};

/// A step from a table or a list to a value in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyStep {
    /// The value of a key.
    Key(Cow<'static, str>),
    /// An entry of a list, counted from 0.
    Index(usize),
}

impl From<&'static str> for KeyStep {
    fn from(key: &'static str) -> Self {
        Self::Key(key.into())
    }
}

impl From<String> for KeyStep {
    fn from(key: String) -> Self {
        Self::Key(key.into())
    }
}

impl From<usize> for KeyStep {
    fn from(index: usize) -> Self {
        Self::Index(index)
    }
}

/// The part of the text to point at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// The key alone.
    Key,
    /// The value alone.
    Value,
    /// The text from the key to the end of its value.
    Entry,
}

/// The part of a value that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaultPart {
    /// Two lines that point to it.
    pub pointer: String,
    /// Where in the value it begins, in characters.
    pub position: usize,
}

/// A value that cannot be used: which one, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}{sentence}", KeyPath(path), given.as_deref().unwrap_or_default())]
pub struct KeyFault {
    /// The keys and indices from the root of the text to the value.
    pub path: Vec<KeyStep>,
    /// The part of the text to point at.
    pub mark: Mark,
    /// The value and what is wrong with it, as in `0 cannot be used: `, unless the sentence says it: left out
    /// where the value is named otherwise.
    pub given: Option<String>,
    /// A sentence with the mistake and what would help.
    pub sentence: String,
    /// The part of the value that is wrong, as for a mistake in a formula.
    pub part: Option<Box<FaultPart>>,
    /// The key that is missing, where that is the mistake.
    pub missing: Option<&'static str>,
}

impl KeyFault {
    /// Returns a fault of the value whose path is still empty.
    pub(super) fn here(sentence: impl Into<String>) -> Self {
        let sentence = sentence.into();
        Self { path: Vec::new(), mark: Mark::Value, given: None, sentence, part: None, missing: None }
    }

    /// Returns the fault of a number that breaks a rule.
    pub(super) fn refused(value: f64, rule: &str) -> Self {
        let given = Some(format!("{} cannot be used: ", Number(value)));
        Self { given, ..Self::here(format!("{rule}.")) }
    }

    /// Returns the value, if the sentence does not name it, and the sentence.
    pub fn full_sentence(&self) -> String {
        format!("{}{}", self.given.as_deref().unwrap_or_default(), self.sentence)
    }

    /// Returns the fault of a value that cannot be used, in the table that holds it.
    pub fn value(key: impl Into<KeyStep>, sentence: impl Into<String>) -> Self {
        Self::here(sentence).within(key)
    }

    /// Returns the fault of a text whose formula has a mistake. The formula begins after `skipped` bytes.
    pub fn mistake(key: impl Into<KeyStep>, text: &str, skipped: usize, mistake: &ParseError) -> Self {
        let before = &text[..skipped + mistake.span().start];
        let part = FaultPart { pointer: mistake.pointer().to_owned(), position: before.chars().count() };
        Self { part: Some(Box::new(part)), ..Self::value(key, mistake.to_string()) }
    }

    /// Returns the fault of a key that should not be there.
    pub fn key(key: impl Into<KeyStep>, sentence: impl Into<String>) -> Self {
        Self { mark: Mark::Key, ..Self::value(key, sentence) }
    }

    /// Returns a fault of a key whose value names something that does not exist.
    pub fn entry(key: impl Into<KeyStep>, sentence: impl Into<String>) -> Self {
        Self { mark: Mark::Entry, ..Self::value(key, sentence) }
    }

    /// Returns the fault as one in a larger table or list: `step` leads from there to the former root.
    pub fn within(mut self, step: impl Into<KeyStep>) -> Self {
        self.path.insert(0, step.into());
        self
    }

    /// Returns the fault as one in an entry of the list that it was found in.
    pub fn at(mut self, step: impl Into<KeyStep>) -> Self {
        self.path.push(step.into());
        self
    }

    /// Returns the fault of a key itself, in the table that has it.
    pub(super) fn of_key(self, key: &str) -> Self {
        Self { mark: Mark::Key, ..self.within(key.to_owned()) }
    }

    /// Returns the fault of a value that is none of the words of its key.
    pub(super) fn only_a_word() -> Self {
        Self::here("this must be one of the words of this key, in quotation marks.")
    }

    /// Returns the fault of a key that is none of those of its table.
    pub(super) fn unknown_key(key: &str, known: &[&str]) -> Self {
        let advice = match nearest_word(key, known) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the keys here are {}.", known.join(", ")),
        };
        Self::here(format!("there is no key `{}` here; {advice}", excerpt(40, key)))
    }

    /// Returns the fault of a value of another type than `expected`, a noun phrase.
    pub(super) fn not_a(expected: impl Display, given: Unexpected) -> Self {
        Self::here(format!("this must be {expected}, not {}.", UnexpectedValue(given)))
    }
}

/// The faults that serde finds: keys and words that no table has, missing keys, and other types.
impl Error for KeyFault {
    fn custom<T: Display>(message: T) -> Self {
        Self::here(format!("this cannot be used: {}.", excerpt(300, &message.to_string())))
    }

    fn invalid_type(given: Unexpected, expected: &dyn Expected) -> Self {
        Self::not_a(expected, given)
    }

    fn invalid_value(given: Unexpected, expected: &dyn Expected) -> Self {
        Self::not_a(expected, given)
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::here(format!("this must be {expected}, not {length} values."))
    }

    fn unknown_variant(word: &str, known: &'static [&'static str]) -> Self {
        let advice = match nearest_word(word, known) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("write one of {}.", known.join(", ")),
        };
        Self::here(format!("\"{}\" is not possible here; {advice}", excerpt(40, word)))
    }

    fn unknown_field(key: &str, known: &'static [&'static str]) -> Self {
        Self::unknown_key(key, known)
    }

    fn missing_field(key: &'static str) -> Self {
        Self { missing: Some(key), ..Self::here(format!("the key `{key}` is missing here.")) }
    }

    fn duplicate_field(key: &'static str) -> Self {
        Self::here(format!("the key `{key}` is here twice."))
    }
}

/// A path for a person: `layer 3, curve: `. Entries are counted from 1.
struct KeyPath<'a>(&'a [KeyStep]);

impl Display for KeyPath<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, step) in self.0.iter().enumerate() {
            match step {
                KeyStep::Key(key) if position > 0 => write!(f, ", {}", excerpt(40, key))?,
                KeyStep::Key(key) => f.write_str(&excerpt(40, key))?,
                KeyStep::Index(index) => write!(f, " {}", index + 1)?,
            }
        }
        if self.0.is_empty() { Ok(()) } else { f.write_str(": ") }
    }
}

/// A value that was found in place of another, for a person.
struct UnexpectedValue<'a>(Unexpected<'a>);

impl Display for UnexpectedValue<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Unexpected::Bool(value) => write!(f, "{value}"),
            Unexpected::Unsigned(number) => write!(f, "{number}"),
            Unexpected::Signed(number) => write!(f, "{number}"),
            Unexpected::Float(number) => write!(f, "{}", Number(number)),
            Unexpected::Str(text) => write!(f, "the text \"{}\"", excerpt(40, text)),
            Unexpected::Map => f.write_str("a table"),
            Unexpected::Seq => f.write_str("a list"),
            other => write!(f, "{other}"),
        }
    }
}

/// Returns the known word that is nearest to a given one, if one is near.
pub fn nearest_word<'k>(given: &str, known: &[&'k str]) -> Option<&'k str> {
    // Long words are not compared: the file decides how long they are.
    let given: String = given.chars().take(40).collect();
    let edits = |word: &&str| strsim::levenshtein(&given, word);
    known.iter().copied().filter(|word| edits(word) <= 1 + word.len() / 4).min_by_key(edits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_key_is_proposed_only_where_one_is_near() {
        let known = ["spacing", "rule", "max_triangles"];
        assert_eq!(nearest_word("spcaing", &known), Some("spacing"));
        assert_eq!(nearest_word("max_triangle", &known), Some("max_triangles"));
        assert_eq!(nearest_word("colour", &known), None);
    }
}
