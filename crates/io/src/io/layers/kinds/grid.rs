//! The place of a raster: keys of several kinds.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::super::checks::rect_of;
use super::super::{RasterFile, Stored};
use crate::io::{KeyFault, RasterFormat};

/// Which raster a layer reads, and where it lies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridKeys {
    /// The file that holds the raster.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Where it lies, in place of what its file says: x₀, y₀, x₁, y₁.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 4]>,
}

impl GridKeys {
    /// Checks them for a layer; `missing` is the fault of its kind where it lacks something.
    pub(super) fn check(
        &self,
        missing: impl FnOnce(&str) -> KeyFault,
        stored: Stored,
    ) -> Result<(), KeyFault> {
        if self.file.is_none() {
            return Err(missing("needs `file`"));
        }
        if stored == Stored::InFiles { self.raster_file().map(|_| ()) } else { Ok(()) }
    }

    /// Returns the file with the pixels.
    ///
    /// # Errors
    /// Fails when it is no raster.
    pub fn raster_file(&self) -> Result<RasterFile, KeyFault> {
        let path = self.file.clone().unwrap_or_default();
        let bounds = self.bounds.map(rect_of).transpose().map_err(|fault| fault.within("bounds"))?;
        match RasterFormat::from_path(&path) {
            Ok(format) => Ok(RasterFile { path, format, bounds }),
            Err(rule) => Err(KeyFault { given: Some(String::new()), ..KeyFault::value("file", rule) }),
        }
    }
}
