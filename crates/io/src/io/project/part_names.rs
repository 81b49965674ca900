use std::sync::Arc;

use super::BACKGROUND;
use meshbrush_core::document::{Background, Picture, Settings};
use meshbrush_core::raster::RasterPyramid;

/// The names of the parts that hold rasters and pictures. The same raster has one part, however many layers
/// read it, and a journal writes it once.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct PartNames {
    rasters: Vec<(String, Arc<RasterPyramid>)>,
    pictures: Vec<(String, Arc<Picture>)>,
}

/// Data that have no part yet.
#[derive(Debug, Default)]
pub(super) struct NewParts {
    pub rasters: Vec<(String, Arc<RasterPyramid>)>,
    pub picture: Option<(String, Arc<Picture>)>,
}

impl PartNames {
    /// Names everything in the settings that has no name, and returns it.
    pub(super) fn add(&mut self, settings: &Settings) -> NewParts {
        let mut new = NewParts::default();
        for source in settings.layers.iter().filter_map(|layer| layer.kind.raster_source()) {
            if !self.rasters.iter().any(|(_, raster)| Arc::ptr_eq(raster, &source.raster)) {
                let named = (format!("raster.{}", self.rasters.len()), source.raster.clone());
                self.rasters.push(named.clone());
                new.rasters.push(named);
            }
        }
        if let Some(Background { picture, .. }) = &settings.background
            && !self.pictures.iter().any(|(_, other)| Arc::ptr_eq(other, picture))
        {
            let name = match self.pictures.len() {
                0 => BACKGROUND.to_owned(),
                count => format!("background.{count}.png"),
            };
            self.pictures.push((name.clone(), picture.clone()));
            new.picture = Some((name, picture.clone()));
        }
        new
    }

    /// Returns the name of a raster; empty if it has none.
    pub(super) fn of_raster(&self, raster: &Arc<RasterPyramid>) -> &str {
        let found = self.rasters.iter().find(|(_, other)| Arc::ptr_eq(raster, other));
        found.map_or("", |(name, _)| name)
    }

    /// Returns the name of a picture; empty if it has none.
    pub(super) fn of_picture(&self, picture: &Arc<Picture>) -> &str {
        let found = self.pictures.iter().find(|(_, other)| Arc::ptr_eq(picture, other));
        found.map_or("", |(name, _)| name)
    }

    /// Returns the raster that was read or written under a name.
    pub(super) fn raster(&self, name: &str) -> Option<&Arc<RasterPyramid>> {
        self.rasters.iter().find(|(other, _)| other == name).map(|(_, raster)| raster)
    }

    /// Returns the picture that was read or written under a name.
    pub(super) fn picture(&self, name: &str) -> Option<&Arc<Picture>> {
        self.pictures.iter().find(|(other, _)| other == name).map(|(_, picture)| picture)
    }

    pub(super) fn insert_raster(&mut self, name: &str, raster: Arc<RasterPyramid>) {
        self.rasters.push((name.to_owned(), raster));
    }

    pub(super) fn insert_picture(&mut self, name: &str, picture: Arc<Picture>) {
        self.pictures.push((name.to_owned(), picture));
    }
}
