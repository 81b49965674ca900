//! The corridor of nearly best paths, as it is shown.

use std::sync::Arc;

use glam::DVec2;

use super::finder::PathsKey;

/// The corridor: whether it is shown, how wide, and its outline.
#[derive(Clone, Debug)]
pub struct ShownCorridor {
    /// Whether it is shown.
    pub is_on: bool,
    /// How much more than the best path the paths in it cost at most, as a share.
    pub share: f64,
    pub(super) lines: Arc<[Vec<DVec2>]>,
    /// The paths and the excess that the lines belong to.
    pub(super) of: Option<(PathsKey, f64)>,
}

impl Default for ShownCorridor {
    fn default() -> Self {
        Self { is_on: false, share: 0.05, lines: Arc::default(), of: None }
    }
}

impl ShownCorridor {
    /// Returns the closed lines around it, in world units: what is within an odd number of them belongs to
    /// it.
    pub fn lines(&self) -> &[Vec<DVec2>] {
        if self.is_on { &self.lines } else { &[] }
    }

    /// Returns whether the lines are still to be found.
    pub(super) fn is_due(&self, key: PathsKey) -> bool {
        self.is_on && self.of != Some((key, self.share))
    }
}
