//! The background picture in `settings.json`; its pixels are in a part, `background.png` in a project.

use serde::{Deserialize, Serialize};

use super::super::Flaw;
use super::super::error::PlacedFlaw;
use super::BACKGROUND;
use super::part_names::{PartData, PartNames};
use super::part_reader::PartReader;
use super::settings::{corners, rect};
use meshbrush_core::document::Background;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedBackground {
    name: String,
    /// The part with the pixels.
    #[serde(default = "default_part", skip_serializing_if = "is_default_part")]
    part: String,
    bounds: [f64; 4],
    opacity: f64,
}

impl SavedBackground {
    pub fn of(background: &Background, names: &PartNames) -> Self {
        let Background { name, bounds, opacity, picture } = background;
        let part = names.of(&PartData::Picture(picture.clone())).unwrap_or_default().to_owned();
        Self { name: name.clone(), part, bounds: corners(*bounds), opacity: *opacity }
    }

    pub fn load(self, parts: &mut PartReader) -> Result<Background, PlacedFlaw> {
        let picture = parts.background(&self.part)?;
        if !(0.0..=1.0).contains(&self.opacity) {
            let problem =
                format!("the opacity of \"background\" is {}, and it is from 0 to 1.", self.opacity);
            return Err(Flaw::Syntax(problem).into());
        }
        let bounds = rect("background", self.bounds)?;
        Ok(Background { name: self.name, picture, bounds, opacity: self.opacity })
    }
}

fn default_part() -> String {
    BACKGROUND.to_owned()
}

fn is_default_part(part: &str) -> bool {
    part == BACKGROUND
}
