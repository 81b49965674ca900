use std::collections::VecDeque;

use super::Settings;
use crate::paint::{PaintRasters, Patch};

/// What is kept of one gesture: the other side of it, to be exchanged with the document's own.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// Old pixels.
    Paint(Patch),
    /// Old settings, where the layers kept their size.
    Settings(Box<Settings>),
    /// Everything, where the domain or the resolution changed.
    Everything(Box<(Settings, PaintRasters)>),
}

impl Change {
    fn bytes(&self) -> usize {
        match self {
            Self::Paint(patch) => patch.bytes(),
            Self::Settings(_) => size_of::<Settings>(),
            Self::Everything(both) => 8 * both.1.risk.values().len(),
        }
    }
}

/// One gesture, done or undone.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) title: &'static str,
    pub(super) change: Change,
    /// The document's version on the other side.
    pub(super) version: u64,
}

/// Gestures that can be undone and redone. Neither mesh nor field is kept: they are derived.
///
/// Limits: [`Self::MAX_BYTES`] of old pixels; the oldest gestures are forgotten first.
#[derive(Clone, Debug, Default)]
pub struct History {
    done: VecDeque<Entry>,
    undone: Vec<Entry>,
}

impl History {
    /// Most memory for old pixels.
    pub const MAX_BYTES: usize = 256 << 20;

    /// Notes a gesture. Whatever was undone can no longer be redone.
    pub(super) fn push(&mut self, entry: Entry) {
        self.undone.clear();
        self.done.push_back(entry);
        let mut bytes: usize = self.done.iter().map(|entry| entry.change.bytes()).sum();
        while bytes > Self::MAX_BYTES && self.done.len() > 1 {
            bytes -= self.done.pop_front().map_or(0, |entry| entry.change.bytes());
        }
    }

    pub(super) fn last_done(&self) -> Option<&Entry> {
        self.done.back()
    }

    /// Moves the last gesture to the undone ones, after `exchange` has turned it round.
    pub(super) fn undo(&mut self, exchange: impl FnOnce(&mut Entry)) -> bool {
        let Some(mut entry) = self.done.pop_back() else { return false };
        exchange(&mut entry);
        self.undone.push(entry);
        true
    }

    /// The opposite of [`Self::undo`].
    pub(super) fn redo(&mut self, exchange: impl FnOnce(&mut Entry)) -> bool {
        let Some(mut entry) = self.undone.pop() else { return false };
        exchange(&mut entry);
        self.done.push_back(entry);
        true
    }

    /// Forgets the last undone gesture.
    pub(super) fn forget_undone(&mut self) {
        self.undone.pop();
    }

    /// What undo would take back, in a word or two.
    pub fn undo_title(&self) -> Option<&'static str> {
        self.done.back().map(|entry| entry.title)
    }

    /// What redo would do again.
    pub fn redo_title(&self) -> Option<&'static str> {
        self.undone.last().map(|entry| entry.title)
    }

    /// How many gestures can be undone.
    pub fn len(&self) -> usize {
        self.done.len()
    }

    /// Whether nothing can be undone.
    pub fn is_empty(&self) -> bool {
        self.done.is_empty()
    }
}
