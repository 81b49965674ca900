//! The keys of the sizes that lines need.

use serde::{Deserialize, Serialize};

use super::super::checks::number_where;
use super::super::{LayerData, LayerOrigin, Stored};
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use meshbrush_core::layers::{LayerKind, LineGaps, LineSizes};

/// The keys of the sizes that lines need.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineSizeKeys {
    /// Triangles across the gap between two parts of lines.
    #[serde(default = "enough_across")]
    pub across: f64,
}

fn enough_across() -> f64 {
    LineSizes::ENOUGH_ACROSS
}

impl LineSizeKeys {
    pub(super) fn of(sizes: &LineSizes) -> Self {
        Self { across: sizes.across }
    }
}

impl KindKeys for LineSizeKeys {
    fn check(&self, _: Stored) -> Result<(), KeyFault> {
        let rule = "a number of triangles must be above 0, and finite";
        let checked = number_where(self.across, self.across > 0.0, rule);
        checked.map(|_| ()).map_err(|fault| fault.within("across"))
    }
}

impl LoadKind for LineSizeKeys {
    const WORD: &str = "lines";
    const NAME: &str = "Lines";

    fn load<D: LayerData>(&self, _: &LayerOrigin, _: &mut D) -> Result<LayerKind, D::Error> {
        Ok(LayerKind::Lines(LineSizes { across: self.across, gaps: LineGaps::unknown() }))
    }
}
