//! The background picture in `settings.json`; its pixels are in the part `background.png`.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::super::Flaw;
use super::super::error::PlacedFlaw;
use super::settings::{corners, rect};
use crate::document::{Background, Picture};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedBackground {
    name: String,
    bounds: [f64; 4],
    opacity: f64,
}

impl SavedBackground {
    pub fn of(background: &Background) -> Self {
        let Background { name, bounds, opacity, .. } = background;
        Self { name: name.clone(), bounds: corners(*bounds), opacity: *opacity }
    }

    pub fn with(self, picture: Picture) -> Result<Background, PlacedFlaw> {
        if !(0.0..=1.0).contains(&self.opacity) {
            let problem =
                format!("the opacity of \"background\" is {}, and it is from 0 to 1.", self.opacity);
            return Err(Flaw::Syntax(problem).into());
        }
        let (bounds, picture) = (rect("background", self.bounds)?, Arc::new(picture));
        Ok(Background { name: self.name, picture, bounds, opacity: self.opacity })
    }
}
