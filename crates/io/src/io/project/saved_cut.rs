//! The rectangles that cut a domain off from its surroundings, in `settings.json`.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::super::error::PlacedFlaw;
use super::settings::{corners, rect, sentence};
use meshbrush_core::domain::CutFrame;
use meshbrush_core::earth::Coordinates;

/// A rectangle in the coordinates in which its sides are straight.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedCut {
    /// x and y of the lower left corner, then of the upper right one.
    rect: [f64; 4],
    /// What world coordinates are, and what those of the rectangle are, where they differ: `lonlat`, or a
    /// projection as PROJ writes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    coordinates: Option<[String; 2]>,
    /// The direction of the southern side of a rectangle that is turned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    eastward: Option<[f64; 2]>,
}

impl SavedCut {
    pub(super) fn of(cut: &CutFrame) -> Self {
        Self {
            rect: corners(cut.rect),
            coordinates: cut.coordinates.map(|both| both.map(|one| one.to_string())),
            eastward: (cut.eastward != DVec2::X).then(|| cut.eastward.to_array()),
        }
    }

    pub(super) fn load(&self) -> Result<CutFrame, PlacedFlaw> {
        let known = |text: &String| text.parse::<Coordinates>().map_err(sentence);
        let coordinates = match &self.coordinates {
            Some([of_world, own]) => Some([known(of_world)?, known(own)?]),
            None => None,
        };
        let eastward = self.eastward.map_or(DVec2::X, DVec2::from);
        if !eastward.is_normalized() {
            return Err(sentence("the settings are not valid: a direction in \"cuts\" is not of length 1."));
        }
        Ok(CutFrame { coordinates, eastward, rect: rect("cuts", self.rect)? })
    }
}
