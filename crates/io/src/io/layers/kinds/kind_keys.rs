//! What the keys of every kind of layer can say.

use std::path::{Path, PathBuf};

use super::super::{KeyGroup, LayerData, LayerOrigin, Stored};
use super::GridKeys;
use crate::io::KeyFault;
use crate::io::lengths::TextContext;
use meshbrush_core::layers::LayerKind;

/// What the keys of a kind of layer say.
pub trait KindKeys {
    /// Checks every value. Files are not read.
    ///
    /// # Errors
    /// Fails for the first key that is missing, or has a value that cannot be used.
    fn check(&self, stored: Stored) -> Result<(), KeyFault>;

    /// Returns the place of a raster, for a kind that reads one.
    fn grid(&self) -> Option<&GridKeys> {
        None
    }

    /// Returns the place of a raster, for a kind that reads one.
    fn grid_mut(&mut self) -> Option<&mut GridKeys> {
        None
    }

    /// Returns the file with the data, if one is given.
    fn file(&self) -> Option<&Path> {
        self.grid()?.file.as_deref()
    }

    /// Returns the key for the file with the data, for a kind that has one.
    fn file_key(&mut self) -> Option<&mut Option<PathBuf>> {
        self.grid_mut().map(|grid| &mut grid.file)
    }

    /// Returns whether it asks for risk.
    fn is_risk(&self) -> bool {
        false
    }

    /// Returns whether it needs both ends of the scale from the smallest to the largest target diameter.
    fn uses_scale(&self) -> bool {
        self.is_risk()
    }

    /// Returns whether it needs the depth of the water of another layer.
    fn uses_depth(&self) -> bool {
        false
    }
}

/// Keys that make a layer of a stack.
pub(in super::super) trait LoadKind: KeyGroup {
    /// The word of the kind.
    const WORD: &str;

    /// The name of a layer that is given none.
    const NAME: &str;

    /// Returns the kind, with its data.
    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error>;

    /// Reads lengths in the place of something else.
    fn read_lengths(&mut self, _: &TextContext) -> Result<(), KeyFault> {
        Ok(())
    }

    /// Returns the fault of a layer of this kind that lacks something. `needs` is a verb with its object.
    fn missing(needs: &str) -> KeyFault {
        KeyFault::entry("kind", format!("a layer of the kind \"{}\" {needs}.", Self::WORD))
    }
}
