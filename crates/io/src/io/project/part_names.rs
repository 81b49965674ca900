//! The data that projects hold as parts of their own, and the names of these parts.

use std::collections::{BTreeMap, HashMap};
use std::io::{self, Write};
use std::mem::{Discriminant, discriminant};
use std::sync::Arc;

use glam::DVec2;

use super::super::layers::MOST_IN_PLACE;
use super::super::{png, shapes};
use super::lists::{self, ShapeSlices};
use super::{BACKGROUND, pixels};
use meshbrush_core::document::{Background, Picture, Settings};
use meshbrush_core::domain::{Domain, Polygon, Region};
use meshbrush_core::layers::{DistanceLayer, Layer, Mask, Shapes, Threats};
use meshbrush_core::raster::RasterPyramid;

/// Data with a part of its own. Documents share it, and it never changes.
#[derive(Clone, Debug)]
pub(super) enum PartData {
    Raster(Arc<RasterPyramid>),
    Picture(Arc<Picture>),
    Shapes(Shapes),
    Mask(Mask),
    Region(Arc<Region>),
    Pins(Arc<Vec<DVec2>>),
    Threats(Threats),
}

impl PartData {
    /// Returns the raster of a layer, if it reads one.
    pub fn raster_of(layer: &Layer) -> Option<Self> {
        layer.kind.raster_source().map(|source| Self::Raster(source.raster.clone()))
    }

    /// Returns the shapes of a layer, if they are too many for the settings.
    pub fn shapes_of(layer: &Layer) -> Option<Self> {
        let DistanceLayer { to, .. } = layer.kind.get()?;
        let shapes = to.shapes()?;
        let is_long = shapes::places(shapes.list()).nth(MOST_IN_PLACE).is_some();
        is_long.then(|| Self::Shapes(shapes.clone()))
    }

    /// Returns the threats of a layer, if they are too many for the settings.
    pub fn threats_of(layer: &Layer) -> Option<Self> {
        let threats = layer.kind.get::<Threats>()?;
        (threats.list().len() > MOST_IN_PLACE).then(|| Self::Threats(threats.clone()))
    }

    /// Returns a mask, if it has too many points for the settings.
    pub fn of_mask(mask: &Mask) -> Option<Self> {
        let is_long = mask.polygons().iter().flatten().flatten().nth(MOST_IN_PLACE).is_some();
        is_long.then(|| Self::Mask(mask.clone()))
    }

    /// Returns the pins, if they are too many for the settings.
    pub fn of_pins(pins: &Arc<Vec<DVec2>>) -> Option<Self> {
        (pins.len() > MOST_IN_PLACE).then(|| Self::Pins(pins.clone()))
    }

    /// Returns all such data of a document, in the order of its parts.
    fn all_of(settings: &Settings) -> impl Iterator<Item = Self> {
        let region = settings.domain.region().cloned().map(Self::Region);
        let of_layer = |layer: &Layer| {
            let mask = layer.mask.as_ref().and_then(Self::of_mask);
            [Self::raster_of(layer), Self::shapes_of(layer), Self::threats_of(layer), mask]
        };
        let of_layers = settings.layers.iter().flat_map(of_layer).flatten();
        let keep_out = settings.paths.keep_out.iter().filter_map(|region| Self::of_mask(&region.mask));
        let picture = settings.background.as_ref();
        let picture = picture.map(|Background { picture, .. }| Self::Picture(picture.clone()));
        region
            .into_iter()
            .chain(of_layers)
            .chain(keep_out)
            .chain(Self::of_pins(&settings.pins))
            .chain(picture)
    }

    /// Returns the address of the data that clones share.
    fn address(&self) -> usize {
        match self {
            Self::Raster(raster) => Arc::as_ptr(raster).addr(),
            Self::Picture(picture) => Arc::as_ptr(picture).addr(),
            Self::Shapes(shapes) => shapes.shared_data().0,
            Self::Mask(mask) => mask.shared_data().0,
            Self::Region(region) => Arc::as_ptr(region).addr(),
            Self::Pins(pins) => Arc::as_ptr(pins).addr(),
            Self::Threats(threats) => threats.shared_data().0,
        }
    }

    /// Returns the name of the part with this number, from 0, among those of its kind.
    fn name(&self, number: usize) -> String {
        let kind = match self {
            Self::Raster(_) => "raster",
            Self::Picture(_) if number == 0 => return BACKGROUND.to_owned(),
            Self::Picture(_) => return format!("background.{number}.png"),
            Self::Shapes(_) => "shapes",
            Self::Mask(_) => "polygons",
            Self::Region(_) => "domain",
            Self::Pins(_) => "points",
            Self::Threats(_) => "threats",
        };
        format!("{kind}.{number}")
    }

    /// Writes the bytes of the part.
    ///
    /// # Errors
    /// Fails with the errors of `out`, and when the polygons of the domain are too complex to be read.
    pub fn write(&self, mut out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Raster(raster) => pixels::write_raster(out, raster.raster()),
            Self::Picture(picture) => png::write(&mut out, picture.size, &picture.rgba),
            Self::Shapes(shapes) => lists::write_shapes(out, shapes.list().into()),
            Self::Mask(mask) => write_polygons(out, mask.polygons()),
            Self::Region(region) => {
                // An edit can make polygons more complex than those that were read.
                let checked = Domain::check_stored_polygons(region.polygons(), region.frame());
                checked
                    .map_err(|error| io::Error::other(error.to_string().trim_end_matches('.').to_owned()))?;
                write_polygons(out, region.polygons())
            }
            Self::Pins(points) => lists::write_shapes(out, ShapeSlices { points, ..ShapeSlices::default() }),
            Self::Threats(threats) => lists::write_threats(out, threats.list()),
        }
    }
}

fn write_polygons(out: &mut dyn Write, polygons: &[Polygon]) -> io::Result<()> {
    lists::write_shapes(out, ShapeSlices { polygons, ..ShapeSlices::default() })
}

/// The names of parts. The same data has one part, however often it is used, and a journal writes it once.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct PartNames {
    parts: BTreeMap<String, PartData>,
    /// By the addresses of the data, which stay where they are as long as `parts` holds them.
    names: HashMap<usize, String>,
    /// How many data of each kind were named.
    counts: HashMap<Discriminant<PartData>, usize>,
}

impl PartNames {
    /// Names everything in the settings that has no name, and returns it in the order of its parts.
    pub(super) fn add(&mut self, settings: &Settings) -> Vec<(String, PartData)> {
        let mut new = Vec::new();
        for data in PartData::all_of(settings) {
            if self.of(&data).is_some() {
                continue;
            }
            let count = self.counts.entry(discriminant(&data)).or_default();
            while self.parts.contains_key(&data.name(*count)) {
                *count += 1;
            }
            let name = data.name(*count);
            self.insert(&name, data.clone());
            new.push((name, data));
        }
        new
    }

    /// Forgets all data that the settings no longer have. Returns those that they have, all of which must
    /// have names, in the order of their parts.
    pub(super) fn keep_only(&mut self, settings: &Settings) -> Vec<(String, PartData)> {
        let mut kept = Self { counts: std::mem::take(&mut self.counts), ..Self::default() };
        let mut parts = Vec::new();
        for data in PartData::all_of(settings) {
            if let (Some(name), None) = (self.of(&data), kept.of(&data)) {
                kept.insert(name, data.clone());
                parts.push((name.to_owned(), data));
            }
        }
        *self = kept;
        parts
    }

    /// Returns the name of the part with this data, if it has one.
    pub(super) fn of(&self, data: &PartData) -> Option<&str> {
        self.names.get(&data.address()).map(String::as_str)
    }

    /// Returns the data that was read or written under a name.
    pub(super) fn get(&self, name: &str) -> Option<&PartData> {
        self.parts.get(name)
    }

    /// Names data that was read.
    pub(super) fn insert(&mut self, name: &str, data: PartData) {
        let address = data.address();
        if let Some(before) = self.parts.insert(name.to_owned(), data) {
            self.names.remove(&before.address());
        }
        self.names.insert(address, name.to_owned());
    }
}
