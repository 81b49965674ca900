//! Documents from settings as values, and layers for documents that are there: for programs that have no
//! text.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::super::layers::{DepthKeys, GridKeys, LayerKeys, PaintKeys, SavedLayer};
use super::super::lengths::{SavedLength, TextContext};
use super::super::settings::{SavedOutput, SavedSettings};
use super::super::values::TextReader;
use super::super::{Given, KeyFault, TextValue};
use super::files::Files;
use super::notes::notes_on;
use super::{LoadError, Loaded, Loading, Recipe, found_in};
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::{Depths, Layer, LayerId, PaintLayers};
use meshbrush_core::raster::TiledRaster;
use meshbrush_mesh::text::{LengthUnit, abridged};

/// A document that was made from settings.
#[derive(Debug)]
pub struct LoadedDocument {
    /// The document.
    pub document: Document,
    /// The coordinates in the file of the domain, where that is meshed in the plane of a projection.
    pub coordinates: Option<Coordinates>,
    /// Notes for a person, a sentence each.
    pub notes: Vec<String>,
    /// Those of them on what has no effect.
    pub without_effect: Vec<String>,
}

/// A layer for a document that is there.
#[derive(Debug)]
pub struct LoadedLayer {
    /// The layer.
    pub layer: Layer,
    /// What a project has painted on it, if it is a paint layer.
    pub paint: Option<TiledRaster>,
    /// Notes for a person, a sentence each.
    pub notes: Vec<String>,
}

/// What a document has beside a layer that is added, as far as layers need it.
#[derive(Clone, Copy, Debug, Default)]
pub struct BesideLayer {
    /// A smallest diameter that somebody gave.
    pub smallest: bool,
    /// A layer of depths.
    pub depths: bool,
    /// The unit of lengths.
    pub unit: LengthUnit,
}

impl SavedSettings {
    /// Returns the settings that tables state, with the keys of a recipe. Files are named from the working
    /// folder, or are data in memory of these names.
    ///
    /// # Errors
    /// Fails for the first key or value that no recipe has, and for files that are not there.
    pub fn of_value(tables: &TextValue, given: &Given) -> Result<Self, KeyFault> {
        Self::of_tables(tables, None)?.checked(given)
    }

    /// Returns the settings that tables state for a document that is there, whose lengths are in `unit`.
    ///
    /// # Errors
    /// Fails as [`Self::of_value`] does, and for lengths in another unit.
    pub fn of_value_for(tables: &TextValue, unit: LengthUnit) -> Result<Self, KeyFault> {
        let settings = Self::of_tables(tables, Some(unit))?;
        settings.lengths.check(unit)?;
        settings.checked(&Given::default())
    }

    /// Returns the settings that tables state, with numbers in the place of lengths with units.
    pub(super) fn of_tables(tables: &TextValue, unit: Option<LengthUnit>) -> Result<Self, KeyFault> {
        let context = TextContext::new(unit.or_else(|| stated_unit(tables)).unwrap_or_default());
        let tables = SavedSettings::<TextValue>::deserialize(TextReader::new(tables, &context))?;
        let layer_of = |(index, table): (usize, TextValue)| {
            let read = || context.within(index.into(), || SavedLayer::of_table(table, &context));
            let layer = context.within("layer".into(), read);
            layer.map_err(|fault| fault.within(index).within("layer"))
        };
        let settings = tables.with_layers(|layers| layers.into_iter().enumerate().map(layer_of).collect())?;
        Ok(settings.with_lengths(context.into_written()))
    }

    fn checked(mut self, given: &Given) -> Result<Self, KeyFault> {
        let checked = self.place_files(&|name| found(given, name)).and_then(|()| self.check());
        checked.and_then(|()| self.check_recipe()).map_err(|fault| self.lengths.as_written(fault))?;
        Ok(self)
    }

    /// Reads the files, and returns a document with the mesh that they make.
    ///
    /// # Errors
    /// Fails as [`Self::load_files`] does, and when no document can have these settings.
    pub fn into_document(&self, name: &str, loading: &Loading) -> Result<LoadedDocument, LoadError> {
        let Loaded { settings, paint, notes, without_effect, coordinates } =
            self.load_files(name, loading)?;
        let document = Document::new(settings.with_limits_of_the_grid()?, Some(paint));
        let document = document.map_err(|error| LoadError::Unsuited(error.to_string()))?;
        Ok(LoadedDocument { document, coordinates, notes, without_effect })
    }
}

impl SavedLayer {
    /// Returns the layer that a table states, with the keys of a recipe, for a document that has `others`.
    /// Files are as for [`SavedSettings::of_value`].
    ///
    /// # Errors
    /// Fails for the first key or value that no layer has, and for files that are not there.
    pub fn of_value(table: &TextValue, others: &BesideLayer, given: &Given) -> Result<Self, KeyFault> {
        let context = TextContext::new(others.unit);
        let layer = Self::of_table(table.clone(), &context)?;
        let lengths = context.into_written();
        lengths.check(others.unit)?;
        let mut alone = SavedSettings { layer: vec![layer], ..SavedSettings::default() };
        alone.limits.h_min = others.smallest.then_some(SavedLength(1.0));
        let checked = alone.place_files(&|name| found(given, name)).and_then(|()| {
            let mut as_recipe = alone.clone();
            // Unlike a recipe, a document has paint layers of its own.
            if let LayerKeys::Paint(PaintKeys { file: file @ None, layer: None, .. }) =
                &mut as_recipe.layer[0].keys
            {
                *file = Some(PathBuf::new());
            }
            if others.depths {
                let grid = GridKeys { file: Some("depths.npy".into()), bounds: None };
                as_recipe.layer.push(DepthKeys { grid, ..DepthKeys::default() }.into());
            }
            as_recipe.check()?;
            as_recipe.check_recipe()
        });
        let in_layer =
            |fault: KeyFault| KeyFault { path: fault.path[2.min(fault.path.len())..].to_vec(), ..fault };
        checked.map_err(|fault| lengths.as_written(in_layer(fault)))?;
        Ok(alone.layer.remove(0))
    }

    /// Reads the data of a layer for a document with these settings. `assumed` is what coordinates of files
    /// are that do not name a known system.
    ///
    /// # Errors
    /// Fails when a file cannot be read or used.
    pub fn load_for(
        &self,
        id: LayerId,
        settings: &Settings,
        assumed: Option<Coordinates>,
        loading: &Loading,
    ) -> Result<LoadedLayer, LoadError> {
        let loaded = Files::for_document(settings, assumed, loading).one_layer(self, id)?;
        // A formula uses the depths of other layers; the rest would be asked again with every layer.
        let gives_depths = |layer: &&Layer| layer.id != id && layer.kind.is::<Depths>();
        let others = settings.layers.iter().filter(gives_depths).cloned();
        let layers = others.chain([loaded.layer.clone()]).collect();
        let with_layer = Settings { layers, ..settings.clone() };
        let notes = notes_on(&with_layer, PaintLayers::blank(), true, |layer| layer.id == id);
        let notes = loaded.notes.into_iter().chain(notes).map(|note| abridged(&note)).collect();
        Ok(LoadedLayer { notes, ..loaded })
    }
}

impl SavedOutput {
    /// Returns the output that a table states, with the keys of a recipe.
    ///
    /// # Errors
    /// Fails for the first key or value that no output has.
    pub fn of_value(table: &TextValue) -> Result<Self, KeyFault> {
        Self::deserialize(TextReader::plain(table))
    }
}

impl Recipe {
    /// Reads the files that the recipe names, and returns a document with its mesh.
    ///
    /// # Errors
    /// Fails when a file cannot be read or used, or no document can have these settings.
    pub fn into_document(&self, loading: &Loading) -> Result<LoadedDocument, LoadError> {
        let name = self.file().file_stem().unwrap_or_default().to_string_lossy();
        self.settings.into_document(&name, loading)
    }
}

fn found(given: &Given, name: &str) -> Result<PathBuf, String> {
    let path = Path::new(name);
    if given.has(path) {
        return Ok(path.to_owned());
    }
    found_in(Path::new(""), name)
        .map_err(|problem| problem.replace("the folder of the recipe", "the working folder"))
}

/// Returns the unit of a document as its tables state it.
fn stated_unit(tables: &TextValue) -> Option<LengthUnit> {
    let value = |tables: &TextValue, key: &str| match tables {
        TextValue::Table(table) => {
            table.iter().find(|(found, _)| found == key).map(|(_, value)| value.clone())
        }
        _ => None,
    };
    match value(&value(tables, "domain")?, "unit")? {
        TextValue::Text(word) => LengthUnit::ALL.into_iter().find(|unit| unit.name() == word),
        _ => None,
    }
}
