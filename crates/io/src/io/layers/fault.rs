use std::fmt;

/// A step from a table or a list to a value in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The value of a key.
    Key(&'static str),
    /// An entry of a list, counted from 0.
    Index(usize),
}

/// What to point at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// The key alone.
    Key,
    /// The value alone.
    Value,
    /// From the key to the end of its value.
    Entry,
}

/// A value that cannot be used: which one, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{sentence}", KeyPath(path))]
pub struct KeyFault {
    /// From the root of the text to the value.
    pub path: Vec<Step>,
    /// What to point at.
    pub mark: Mark,
    /// What is wrong, and what would help.
    pub sentence: String,
    /// Two lines that point into the value itself, as those of a formula do.
    pub pointer: Option<String>,
}

impl KeyFault {
    /// A value that cannot be used, in the table that holds it.
    pub fn value(key: &'static str, sentence: impl Into<String>) -> Self {
        Self { path: vec![Step::Key(key)], mark: Mark::Value, sentence: sentence.into(), pointer: None }
    }

    /// A key that should not be there.
    pub fn key(key: &'static str, sentence: impl Into<String>) -> Self {
        Self { mark: Mark::Key, ..Self::value(key, sentence) }
    }

    /// A key whose value names something that is not there.
    pub fn entry(key: &'static str, sentence: impl Into<String>) -> Self {
        Self { mark: Mark::Entry, ..Self::value(key, sentence) }
    }

    /// The fault as one in a larger table or list: `step` leads from there to the former root.
    pub fn within(mut self, step: Step) -> Self {
        self.path.insert(0, step);
        self
    }

    /// The fault as one in an entry of the list that it was found in.
    pub fn at(mut self, step: Step) -> Self {
        self.path.push(step);
        self
    }
}

/// A path for a person: `layer 3, curve: `. Entries are counted from 1.
struct KeyPath<'a>(&'a [Step]);

impl fmt::Display for KeyPath<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(key) if position > 0 => write!(f, ", {key}")?,
                Step::Key(key) => f.write_str(key)?,
                Step::Index(index) => write!(f, " {}", index + 1)?,
            }
        }
        if self.0.is_empty() { Ok(()) } else { f.write_str(": ") }
    }
}
