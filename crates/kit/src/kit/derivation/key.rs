use std::sync::Arc;

use meshbrush_core::document::Follower;
use meshbrush_core::domain::{Line, Region};
use meshbrush_mesh::mesh::Cleaning;

/// The data that a derived mesh depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivationKey {
    pub(super) revision: u64,
    pub(super) on_outline: bool,
    pub(super) cleaning: Cleaning,
    /// The outline that the mesh meets, if there is one.
    pub(super) region: Option<Arc<Region>>,
    pub(super) lines: Arc<Vec<Line>>,
}

impl DerivationKey {
    /// Returns the data that the derived mesh of the follower depends on; `None` if the mesh itself is
    /// exported.
    pub(super) fn of(follower: &Follower) -> Option<Self> {
        let settings = follower.settings();
        settings.is_derived().then(|| Self {
            revision: follower.revision(),
            on_outline: follower.domain().region_on_outline().is_some(),
            cleaning: settings.derived_cleaning(),
            region: settings.outline(),
            lines: settings.lines.clone(),
        })
    }
}
