//! h̄ under a pointer.

use std::sync::Arc;

use glam::DVec2;

use super::{Document, Follower};
use crate::layers::{Decision, LevelCache, SizeField};

/// Reads h̄ of the shown mesh point by point. What it finds out about squares serves the next points, until
/// the field or the paint changes.
#[derive(Debug, Default)]
pub struct Readings {
    squares: LevelCache,
    /// The field and the document's revision that the squares are of.
    of: Option<(Arc<SizeField>, u64)>,
}

impl Readings {
    /// Returns h̄ at a point in world units and the layer that decides it, by
    /// [`SizeField::quick_decision_at`].
    pub fn decision_at(&mut self, document: &Document, follower: &Follower, point: DVec2) -> Decision {
        let now = (follower.shared_field(), document.revision());
        let is_same = self.of.as_ref().is_some_and(|of| Arc::ptr_eq(&of.0, &now.0) && of.1 == now.1);
        if !is_same {
            self.squares = LevelCache::default();
        }
        let decision = now.0.quick_decision_at(&mut self.squares, document.paint(), point);
        self.of = Some(now);
        decision
    }
}
