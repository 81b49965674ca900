use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::super::{LayerData, LayerOrigin, SavedQuantity, Stored};
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use meshbrush_core::layers::{LayerKind, PaintLayer};

/// The keys of paint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PaintKeys {
    /// What is painted.
    pub quantity: SavedQuantity,
    /// The project that holds the paint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The name of the paint layer in `file`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<String>,
}

impl PaintKeys {
    pub(super) fn of(paint: &PaintLayer) -> Self {
        Self { quantity: paint.quantity.into(), file: None, layer: None }
    }
}

impl KindKeys for PaintKeys {
    fn check(&self, _: Stored) -> Result<(), KeyFault> {
        if self.file.is_none() && self.layer.is_some() {
            let sentence = "`layer` names a layer of the project `file`, which is missing.";
            return Err(KeyFault::key("layer", sentence));
        }
        Ok(())
    }

    fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    fn file_key(&mut self) -> Option<&mut Option<PathBuf>> {
        Some(&mut self.file)
    }

    fn is_risk(&self) -> bool {
        self.quantity == SavedQuantity::Risk
    }
}

impl LoadKind for PaintKeys {
    const WORD: &str = "paint";
    const NAME: &str = "Paint";

    fn load<D: LayerData>(&self, _: &LayerOrigin, _: &mut D) -> Result<LayerKind, D::Error> {
        Ok(LayerKind::paint(self.quantity.into()))
    }
}
