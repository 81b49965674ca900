//! The files that a recipe or options name, as the data of the settings of a document.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use super::super::geojson::{self, Outline};
use super::super::layers::{
    GridKeys, LayerData, LayerKeys, LayerOrigin, LoadedRaster, PaintKeys, RasterError, RasterFrame,
    RasterLoader, SavedLayer, Stored, TextError,
};
use super::super::settings::{
    LoadingDefaults, ReadRegion, RegionCoordinates, SavedOpen, SavedSettings, Storage,
};
use super::super::shapes::ShapeFile;
use super::super::{
    DocumentPlane, Given, KeyFault, Meter, RasterFormat, ReadError, project, shape_format, shapes, threats,
};
use super::LoadedLayer;
use super::file_frame::{OutlineSource, check_east, part_in_bounds, sea_notes, sea_of_land};
use super::grid_region::contour_of_grid;
use super::line_files::check_lines;
use super::notes::{
    cut_at_antimeridian, far_places, idle_cleaning, in_the_plane, mark_notes, no_open_boundary, notes,
    places_in_degrees,
};
use super::opening::{self, OpenData};
use meshbrush_core::document::{Document, Settings, SettingsError, check_layer_count};
use meshbrush_core::domain::{BoundaryMarks, Crest, Domain, Line, OutlineOnEarth, Polygon};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Layer, LayerId, Mask, PaintLayers, ShapeList, Shapes, Threats};
use meshbrush_core::raster::{RasterValues, Resampling};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::CoarseError;
use meshbrush_mesh::text::{LengthUnit, abridged};

/// Why settings cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// A file is of no use.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The data of a layer or a region are of no use.
    #[error(transparent)]
    Data(#[from] TextError),
    /// A value cannot be used.
    #[error(transparent)]
    Value(#[from] KeyFault),
    /// There is no coarse grid.
    #[error(transparent)]
    Coarse(#[from] CoarseError),
    /// The parts do not suit each other; the sentence says which.
    #[error("{}", abridged(_0))]
    Unsuited(String),
}

/// How files are read.
pub struct Loading<'a> {
    /// The limits of a mesh where the text has none.
    pub defaults: LoadingDefaults,
    /// Whether hidden layers, which ask for nothing, are read too.
    pub with_hidden: bool,
    /// Reads the polygons of the domain.
    pub read_outline: fn(&Path, &Meter) -> Result<Outline, ReadError>,
    /// Reads the land beside the domain, or only what can meet a rectangle.
    pub read_land: fn(&Path, Option<Rect>, &Meter) -> Result<ShapeFile, ReadError>,
    /// Data in memory, in place of files of their names.
    pub given: Given,
    /// Counts the bytes of each file.
    pub meter: &'a Meter,
}

impl<'a> Loading<'a> {
    /// Returns all layers, for a document.
    pub fn for_document(meter: &'a Meter) -> Self {
        Self {
            defaults: LoadingDefaults::DOCUMENT,
            with_hidden: true,
            read_outline: shape_format::read_outline,
            read_land: shape_format::read_own_shapes,
            given: Given::default(),
            meter,
        }
    }

    /// Returns the polygons of a file, or of data in memory of this name.
    fn outline(&self, file: &Path) -> Result<Outline, ReadError> {
        match self.given.shapes(file) {
            Some(text) => geojson::read_outline_from(text, file).map(Outline::in_degrees),
            None => (self.read_outline)(file, self.meter).map(Outline::in_degrees),
        }
    }

    /// Returns the shapes of data in memory of this name, or else of a file, which `read` reads.
    fn shapes(
        &self,
        file: &Path,
        read: impl FnOnce() -> Result<ShapeFile, ReadError>,
    ) -> Result<ShapeFile, ReadError> {
        let given = self.given.shapes(file).map(|text| shapes::read_from(text, file));
        given.unwrap_or_else(read).map(ShapeFile::in_degrees)
    }
}

/// Settings with the data of their files.
pub struct Loaded {
    /// The settings of a document.
    pub settings: Settings,
    /// The paint of its layers.
    pub paint: PaintLayers,
    /// The coordinates in the file of the domain, where that is meshed in the plane of a projection.
    pub coordinates: Option<Coordinates>,
    /// Notes for a person, a sentence each.
    pub notes: Vec<String>,
    /// Those of them on what has no effect.
    pub without_effect: Vec<String>,
}

impl SavedSettings {
    /// Reads the files. `name` is what the document is called.
    ///
    /// # Errors
    /// Fails when a file cannot be read or used, there is no coarse grid, or a layer asks for the distance to
    /// the outline of a domain that has none.
    pub fn load_files(&self, name: &str, loading: &Loading) -> Result<Loaded, LoadError> {
        let unsuited = |error: SettingsError| LoadError::Unsuited(error.to_string());
        check_layer_count(self.layer.len()).map_err(unsuited)?;
        let mut files = Files::new(loading);
        let mut settings = self.load(name, &loading.defaults, &mut files)?;
        let idle = mark_notes(&self.domain, &settings);
        let opened = self.open_boundary(&mut settings, &mut files)?;
        check_outline(&settings)?;
        settings.check_depth_unit().map_err(unsuited)?;
        // Without a domain of its own, the mesh covers all rasters.
        let has_frame = self.domain.bounds.is_some() || self.domain.outline_file().is_some();
        let of_layers = notes(&settings, &files.paint, has_frame).into_iter();
        let of_places = far_places(&settings).chain(idle_cleaning(&self.domain, &settings));
        let all = of_layers.chain(of_places).chain(idle.without_effect).chain(opened);
        let without_effect: Vec<String> = all.map(|note| abridged(&note)).collect();
        let in_degrees = places_in_degrees(self, &settings);
        let facts = [files.note, idle.assumed, in_degrees, no_open_boundary(&settings)];
        let facts = facts.into_iter().flatten().chain(files.notes).map(|note| abridged(&note));
        let notes = facts.chain(without_effect.iter().cloned()).collect();
        let Files { paint, coordinates, .. } = files;
        Ok(Loaded { settings, paint, coordinates, notes, without_effect })
    }

    /// Opens the boundary of a document where `open` says. Returns notes for a person.
    ///
    /// # Errors
    /// Fails when a file cannot be read, or the document has no depths and they are needed.
    pub fn open_boundary_of(
        &self,
        settings: &mut Settings,
        loading: &Loading,
    ) -> Result<Vec<String>, LoadError> {
        let mut files = Files::for_document(settings, None, loading);
        files.file_coordinates = settings.coordinates_of_outlines();
        self.open_boundary(settings, &mut files)
    }

    /// Opens the boundary where `open` says. Returns notes for a person.
    fn open_boundary(&self, settings: &mut Settings, files: &mut Files) -> Result<Vec<String>, LoadError> {
        let entries = &self.domain.open.0;
        let named = entries.iter().filter_map(|entry| match entry {
            SavedOpen::Polygons(file) => Some(Storage::polygons(files, file)),
            _ => None,
        });
        let polygons = named.collect::<Result<_, _>>()?;
        opening::open(settings, entries, OpenData { file: files.file_coordinates, polygons })
    }
}

/// Reads the files that tables and layers name, each once.
pub(super) struct Files<'a> {
    loading: &'a Loading<'a>,
    pub(super) rasters: RasterLoader,
    projects: BTreeMap<PathBuf, Document>,
    pub(super) frame: RasterFrame,
    paint: PaintLayers,
    /// The plane of the domain, if it has one.
    pub(super) plane: Option<DocumentPlane>,
    /// See [`Loaded::coordinates`].
    coordinates: Option<Coordinates>,
    /// What the coordinates of the domain's file are, if that is known.
    file_coordinates: Option<Coordinates>,
    /// A sentence for a person about the polygons.
    note: Option<String>,
    /// Sentences for a person about the data of files.
    pub(super) notes: Vec<String>,
}

impl<'a> Files<'a> {
    fn new(loading: &'a Loading<'a>) -> Self {
        let transfer = Settings::default().transfer;
        Self {
            loading,
            rasters: RasterLoader::with_given(loading.given.clone(), loading.meter),
            projects: BTreeMap::new(),
            frame: RasterFrame {
                domain: Rect::UNIT,
                wanted: None,
                plane: None,
                transfer,
                resampling: Resampling::Linear,
            },
            paint: PaintLayers::default(),
            plane: None,
            coordinates: None,
            file_coordinates: None,
            note: None,
            notes: Vec::new(),
        }
    }

    /// Returns what reads files for a document that is there. `assumed` is what coordinates of files are that
    /// do not name a known system.
    pub(super) fn for_document(
        settings: &Settings,
        assumed: Option<Coordinates>,
        loading: &'a Loading<'a>,
    ) -> Self {
        let Domain { bounds, projection, .. } = settings.domain;
        let plane = projection.map(|projection| DocumentPlane { projection, assumed });
        let new = Self::new(loading);
        let (wanted, transfer) = (Some(bounds), settings.transfer);
        Self { plane, frame: RasterFrame { domain: bounds, wanted, plane, transfer, ..new.frame }, ..new }
    }

    /// Returns one layer with its data.
    pub(super) fn one_layer(mut self, layer: &SavedLayer, id: LayerId) -> Result<LoadedLayer, LoadError> {
        let loaded = layer.load(id, &mut self)?;
        self.add_paint(layer, id)?;
        Ok(LoadedLayer { layer: loaded, paint: self.paint.get(id).cloned(), notes: self.notes })
    }

    /// Adds what a project has painted on a layer, if that is a paint layer.
    fn add_paint(&mut self, layer: &SavedLayer, id: LayerId) -> Result<(), LoadError> {
        let LayerKeys::Paint(PaintKeys { quantity, file: Some(path), layer: there }) = &layer.keys else {
            return Ok(());
        };
        if !self.projects.contains_key(path) {
            self.projects.insert(path.clone(), project::read_metered(path, self.loading.meter)?);
        }
        let document = &self.projects[path];
        let (name, file) = (there.as_deref().unwrap_or(layer.shown_name()), path.display());
        let painted = || document.settings().layers.iter().filter(|layer| layer.paints().is_some());
        let Some(stored) = painted().find(|other| other.name == name) else {
            let known: Vec<String> = painted().map(|layer| format!("“{}”", layer.name)).collect();
            let there = match known.is_empty() {
                true => "has none".to_owned(),
                false => format!("has {}", known.join(", ")),
            };
            return Err(layer
                .origin()
                .error(format_args!("{file} has no paint layer “{name}”; it {there}."))
                .into());
        };
        if stored.paints() != Some((*quantity).into()) {
            let problem = format_args!("what is painted on “{name}” in {file} is not of this `quantity`.");
            return Err(layer.origin().error(problem).into());
        }
        document.paint().get(stored.id).into_iter().for_each(|raster| self.paint.insert(id, raster.clone()));
        Ok(())
    }
}

impl Files<'_> {
    /// Reads the polygons of the domain, in the coordinates of their file.
    fn outline_source(
        &mut self,
        file: &Path,
        bounds: Option<Rect>,
        coordinates: &RegionCoordinates,
    ) -> Result<OutlineSource, LoadError> {
        if coordinates.is_land {
            let Loading { read_land, meter, .. } = self.loading;
            let shapes = self.loading.shapes(file, || read_land(file, bounds, meter))?;
            let RegionCoordinates { sea_at, assumed, .. } = *coordinates;
            let sea = sea_of_land(file, &shapes, bounds, sea_at, assumed)?;
            let notes = sea_notes(file, &sea, bounds.is_some());
            notes.into_iter().for_each(|note| LayerData::note(self, note));
            return Ok(sea.source);
        }
        let outline = match RasterFormat::from_path(file) {
            Ok(format) => {
                let (outline, notes) =
                    contour_of_grid(file, format, bounds, coordinates, self.loading.meter)?;
                notes.into_iter().for_each(|note| LayerData::note(self, note));
                outline
            }
            Err(_) => self.loading.outline(file)?,
        };
        part_in_bounds(file, outline, bounds, coordinates)
    }
}

impl Storage for Files<'_> {
    type Layer = SavedLayer;
    type Error = LoadError;

    fn saved(layer: &SavedLayer) -> &SavedLayer {
        layer
    }

    fn region(
        &mut self,
        file: &Path,
        bounds: Option<Rect>,
        coordinates: &RegionCoordinates,
    ) -> Result<ReadRegion, LoadError> {
        let OutlineSource { outline, frame } = self.outline_source(file, bounds, coordinates)?;
        check_east(file, &outline, bounds, coordinates)?;
        let unsuited = |problem: &dyn Display| LoadError::Unsuited(format!("{}: {problem}", file.display()));
        let uncertain = outline.coordinates.note().map(|note| format!("{}: {note}", file.display()));
        uncertain.into_iter().for_each(|note| LayerData::note(self, note));
        let RegionCoordinates { assumed, projection, is_land, .. } = *coordinates;
        self.file_coordinates = outline.coordinates.on_earth(assumed);
        let frame = frame.map(|frame| frame.rect);
        let bounds = frame.or(bounds);
        let Some(choice) = projection else {
            self.note = cut_at_antimeridian(file, &outline);
            let frame = frame.filter(|_| is_land);
            let on_earth = OutlineOnEarth { file: self.file_coordinates, projection: None, frame };
            let domain = BoundaryMarks::domain_of(&outline.polygons, bounds, &on_earth);
            let (domain, marks) = domain.map_err(|error| unsuited(&error))?;
            return Ok(ReadRegion { domain, marks, unit: outline.coordinates.assuming(assumed).unit() });
        };
        self.coordinates = self.file_coordinates;
        let (outline, projection) = outline.projected(choice, assumed).map_err(|error| unsuited(&error))?;
        self.note = Some(in_the_plane(&outline, &projection));
        self.plane = Some(DocumentPlane { projection, assumed });
        let on_earth = OutlineOnEarth { file: self.coordinates, projection: Some(projection), frame };
        let bounds = bounds.filter(|_| frame.is_none());
        let domain = BoundaryMarks::domain_of(&outline.polygons, bounds, &on_earth);
        let (domain, marks) = domain.map_err(|error| unsuited(&error))?;
        Ok(ReadRegion { domain, marks, unit: LengthUnit::Metre })
    }

    fn extent(&mut self, layers: &[SavedLayer]) -> Result<Option<(Rect, LengthUnit)>, LoadError> {
        let mut extent: Option<(Rect, LengthUnit)> = None;
        for grid in layers.iter().filter(|layer| layer.shared.visible).filter_map(|layer| layer.keys.grid()) {
            let place = self.rasters.own_place(&grid.raster_file()?)?;
            let place = place.map(|place| (place.rect, place.unit()));
            let both = |(a, of_a): (Rect, LengthUnit), (b, of_b)| {
                (a.union(&b), if of_a == of_b { of_a } else { LengthUnit::None })
            };
            extent = place.into_iter().chain(extent).reduce(both);
        }
        Ok(extent)
    }

    fn layer(
        &mut self,
        layer: &SavedLayer,
        number: LayerId,
        domain: Rect,
        transfer: &Transfer,
    ) -> Result<Option<Layer>, LoadError> {
        if !(layer.shared.visible || self.loading.with_hidden) {
            return Ok(None);
        }
        let (wanted, plane) = (Some(domain), self.plane);
        self.frame = RasterFrame { domain, wanted, plane, transfer: *transfer, ..self.frame };
        let loaded = layer.load(number, self)?;
        self.add_paint(layer, number)?;
        Ok(Some(loaded))
    }

    fn polygons(&mut self, file: &Path) -> Result<Vec<Polygon>, LoadError> {
        let Self { loading, plane, .. } = self;
        let polygons = match loading.given.has(file) {
            true => shape_format::placed_polygons(loading.outline(file)?, plane.as_ref(), file)?,
            false => shape_format::read_polygons(file, plane.as_ref(), loading.meter)?,
        };
        Ok(geojson::without_names(polygons))
    }

    fn lines(&mut self, file: &Path) -> Result<ShapeList, LoadError> {
        let Self { loading, plane, .. } = self;
        let shapes = loading.shapes(file, || shape_format::read_own_shapes(file, None, loading.meter))?;
        let shapes = shape_format::placed_shapes(shapes, plane.as_ref(), file)?.shapes;
        let note = check_lines(file, &shapes)?;
        note.into_iter().for_each(|note| LayerData::note(self, note));
        Ok(shapes)
    }

    fn crest(&mut self, file: &Path, line: &Line, bounds: Rect) -> Result<Crest, LoadError> {
        self.crest_of(file, line, bounds)
    }
}

impl LayerData for Files<'_> {
    type Error = LoadError;

    const STORED: Stored = Stored::InFiles;

    fn raster(
        &mut self,
        origin: &LayerOrigin,
        grid: &GridKeys,
        values: RasterValues,
    ) -> Result<LoadedRaster, LoadError> {
        self.rasters.load(&grid.raster_file()?, values, &self.frame).map_err(|error| match error {
            RasterError::Read(error) => error.into(),
            RasterError::Value(problem) => origin.error(problem).into(),
        })
    }

    fn note(&mut self, sentence: String) {
        // Several layers may read one file.
        if !self.notes.contains(&sentence) {
            self.notes.push(sentence);
        }
    }

    fn threats(&mut self, origin: &LayerOrigin) -> Result<Threats, LoadError> {
        let projection = self.plane.map(|plane| plane.projection);
        Ok(origin.indexed_threats(threats::read(origin.file, projection, self.loading.meter)?)?)
    }

    fn shapes(&mut self, origin: &LayerOrigin) -> Result<Shapes, LoadError> {
        let (Self { loading, plane, .. }, file) = (self, origin.file);
        let shapes = loading.shapes(file, || shape_format::read_own_shapes(file, None, loading.meter))?;
        let read = shape_format::placed_shapes(shapes, plane.as_ref(), file)?;
        Ok(origin.indexed_shapes(read.shapes)?)
    }

    fn mask(&mut self, origin: &LayerOrigin, file: &Path) -> Result<Mask, LoadError> {
        Ok(origin.mask_of_polygons(&self.polygons(file)?)?)
    }
}

/// Refuses a distance to the outline or to the coasts of a domain that has none.
fn check_outline(Settings { layers, domain, .. }: &Settings) -> Result<(), LoadError> {
    let Some(layer) = layers.iter().find(|layer| layer.visible && layer.follows_outline()) else {
        return Ok(());
    };
    let Some(region) = domain.as_region() else {
        let problem = "there is no distance to the outline of a domain that is given by a formula";
        return Err(LoadError::Unsuited(format!(
            "The layer “{}”: {problem}. Give the domain by polygons, or the distance to shapes.",
            layer.name
        )));
    };
    Shapes::outline(&region).map(|_| ()).map_err(|error| LoadError::Unsuited(error.to_string()))
}
