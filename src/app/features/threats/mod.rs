//! The threats of the selected layer: places with a risk around them.

mod command;
mod entries;
mod execute;
mod files;
mod layer_kind;
mod options;
mod table;
#[cfg(test)]
mod tests;
mod tool;

pub use command::ThreatsCommand;
use files::{OPEN_THREATS, ROLES, SAVE_THREATS};
use glam::DVec2;
use layer_kind::THREATS_KIND;
pub use tool::THREATS;

use meshbrush_core::document::Document;
use meshbrush_core::layers::{Layer, LayerId, Threats};

/// What the window keeps of threats; they are in their layers.
#[derive(Default)]
pub struct ThreatEditor {
    /// The layer of the selected threat, and its number there.
    selected: Option<(LayerId, usize)>,
    /// What a drag changes.
    grip: Option<ThreatGrip>,
}

/// What of a threat is dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ThreatGrip {
    /// The threat itself. Its middle lies at this offset from the pointer, in world units.
    Middle(DVec2),
    /// The ring of its range.
    Ring,
}

impl ThreatEditor {
    /// The number of the selected threat in the selected layer. An undo can have removed it.
    fn selected_in(&self, document: &Document) -> Option<usize> {
        let (layer, threats) = threats_layer(document)?;
        let (_, number) = self.selected.filter(|(id, _)| *id == layer.id)?;
        (number < threats.list().len()).then_some(number)
    }
}

/// The selected layer and its threats, if it is a layer of threats.
fn threats_layer(document: &Document) -> Option<(&Layer, &Threats)> {
    let layer = document.active_layer()?;
    if let Some(threats) = layer.kind.get::<Threats>() { Some((layer, threats)) } else { None }
}
