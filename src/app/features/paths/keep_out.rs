//! Regions that paths stay out of: read from files, or taken from the mask of a layer.

use std::path::{Path, PathBuf};

use super::PathCommand;
use meshbrush_core::document::KeepOut;
use meshbrush_kit::kit::background::{Background, name_of};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::with_mask;

/// One thing to do with keep-out regions.
#[derive(Clone, Debug, PartialEq)]
pub enum KeepOutCommand {
    /// Reads polygons, and adds them as one region.
    Open(PathBuf),
    /// Adds a region.
    Add(KeepOut),
    /// Adds the mask of the selected layer.
    AddMask,
    /// Removes a region by its number from 0.
    Remove(usize),
    /// Removes all regions.
    RemoveAll,
}

impl KeepOutCommand {
    /// Returns the mask of the selected layer, unless it is a region already.
    pub fn mask_to_add(session: &Session) -> Option<KeepOut> {
        let document = session.document();
        let layer = document.active_layer()?;
        let mask = layer.mask.clone()?;
        let is_known = document.settings().paths.keep_out.iter().any(|region| region.mask == mask);
        (!is_known).then(|| KeepOut { name: layer.name.clone(), mask })
    }
}

/// Reads polygons, and adds them as one region.
pub fn load(session: &Session, background: &mut Background, path: &Path) {
    let name = name_of(path);
    with_mask(session, background, path, move |mask| {
        Command::from(PathCommand::KeepOut(KeepOutCommand::Add(KeepOut { name, mask })))
    });
}
