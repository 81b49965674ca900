//! Regions that paths stay out of: read from files, or taken from the mask of a layer.

use std::path::{Path, PathBuf};

use super::background::{Aim, Background, Outcome, name_of};
use super::command::Command;
use super::paths::PathCommand;
use super::session::Session;
use crate::document::KeepOut;
use crate::io;
use crate::layers::Mask;

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
    /// The mask of the selected layer, unless it is a region already.
    pub fn mask_to_add(session: &Session) -> Option<KeepOut> {
        let document = session.document();
        let layer = document.active_layer()?;
        let mask = layer.mask.clone()?;
        let is_known = document.settings().paths.keep_out.iter().any(|region| region.mask == mask);
        (!is_known).then(|| KeepOut { name: layer.name.clone(), mask })
    }
}

/// Reads polygons, and adds them as one region.
pub fn load(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let named = match io::geojson::read_named_metered(&file, meter) {
            Ok(named) => named,
            Err(error) => return Outcome::not_read(error),
        };
        let polygons: Vec<_> = named.into_iter().map(|named| named.polygon).collect();
        match Mask::new(&polygons) {
            Ok(mask) => {
                let region = KeepOut { name: name_of(&file), mask };
                let add = PathCommand::KeepOut(KeepOutCommand::Add(region));
                Outcome::PartRead(vec![Command::Path(add)])
            }
            Err(error) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}
