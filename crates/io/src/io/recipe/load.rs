//! From a [`MeshDescription`] to the settings of a document: polygons and the data of layers are read here.

use std::path::Path;
use std::sync::Arc;

use super::super::geojson::{self, Outline};
use super::super::layers::{GridFiles, LayerError, LayerFiles};
use super::super::{Meter, ReadError};
use super::{MeshDescription, SavedTreatment};
use meshbrush_core::build::MeshSpec;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{
    BoundaryMarks, BoundaryTreatment, Domain, DomainShape, NamedPolygon, RegionError,
};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Layer, LayerId, LayerKind, PaintLayers, RasterSource, Shapes};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Cleaning, CoarseError, Limits, bisection_edge_length};
use meshbrush_mesh::text::{LengthUnit, abridged};

/// Coarse cells along the longer side of the domain unless the spacing is given (N_e of the report's
/// example).
const USUAL_CELLS: f64 = 20.0;

/// The share of a rectangle that a raster covers which covers all of it, but for rounding.
const WHOLE: f64 = 1.0 - 1e-6;

/// Why what is described cannot be meshed.
#[derive(Debug, thiserror::Error)]
pub enum DescriptionError {
    /// A file is of no use.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The data of a layer are of no use.
    #[error(transparent)]
    Layer(#[from] LayerError),
    /// There is no coarse grid.
    #[error(transparent)]
    Coarse(#[from] CoarseError),
    /// The parts do not suit each other; the sentence says which.
    #[error("{}", abridged(_0))]
    Unsuited(String),
}

/// How the files of a description are read.
pub struct Loading<'a> {
    /// Most coarse triangles.
    pub most_coarse: usize,
    /// Whether hidden layers, which ask for nothing, are read too.
    pub with_hidden: bool,
    /// Reads the polygons of the domain.
    pub read_outline: fn(&Path, &Meter) -> Result<Outline, ReadError>,
    /// Counts the bytes of each file.
    pub meter: &'a Meter,
}

impl<'a> Loading<'a> {
    /// All layers, polygons from files.
    pub fn all(most_coarse: usize, meter: &'a Meter) -> Self {
        Self { most_coarse, with_hidden: true, read_outline: geojson::read_outline, meter }
    }
}

/// A description with the data of its files.
pub struct Described {
    /// The settings of a document that has the described mesh.
    pub settings: Settings,
    /// What is painted on its layers.
    pub paint: PaintLayers,
    /// The lattice of the coarse grid.
    pub lattice: Lattice,
    /// Notes for a person, a sentence each.
    pub notes: Vec<String>,
}

impl MeshDescription {
    /// Reads the files. `name` is what the document is called.
    ///
    /// Limits of the target diameter that are not given do not restrict it: they are the smallest and the
    /// largest number. See [`Described::with_limits_of_the_grid`].
    ///
    /// # Errors
    /// When a file cannot be read or used, there is no coarse grid, or a layer asks for the distance to the
    /// outline of a domain that has none.
    pub fn load(&self, name: &str, loading: &Loading) -> Result<Described, DescriptionError> {
        let read = || self.layers.iter().filter(|layer| layer.visible || loading.with_hidden);
        let visible = self.layers.iter().filter(|layer| layer.visible);
        let grids = GridFiles::read(read(), loading.meter)?;
        let ReadDomain { domain, marks, unit, note } = self.domain(grids.extent(visible), loading)?;
        let bounds = domain.bounds;
        let spacing = self.spacing.unwrap_or(bounds.size().max_element() / USUAL_CELLS);
        let lattice = Lattice::covering(bounds, spacing, loading.most_coarse).map_err(CoarseError::from)?;
        let transfer = self.transfer(bisection_edge_length(lattice.spacing(), 0));
        let mut files = LayerFiles::new(grids, bounds, transfer, loading.meter);
        let (mut layers, mut paint) = (Vec::new(), PaintLayers::default());
        for (spec, id) in read().zip((0..).map(LayerId)) {
            layers.push(spec.load(id, &mut files)?);
            files.add_paint(spec, id, &mut paint)?;
        }
        check_outline(&layers, &domain)?;
        let notes = note.into_iter().chain(self.notes(&layers, bounds)).map(|note| abridged(&note)).collect();
        let treatment = self.boundary.unwrap_or(SavedTreatment::Outline);
        let usual = BoundaryTreatment::usual_diameter(spacing);
        let settings = Settings {
            name: name.to_owned(),
            unit: self.unit.unwrap_or(unit),
            domain,
            boundary: treatment.with_diameter(self.boundary_diameter.unwrap_or(usual)),
            cleaning: self.cleaning(Cleaning::FOR_SOLVERS),
            boundary_marks: self.marks.clone().unwrap_or(Arc::new(marks)),
            spacing,
            transfer,
            layers,
            gradation: self.gradation,
            rule: self.rule(),
            max_triangles: self.max_triangles.unwrap_or(Settings::MAX_TRIANGLES),
            max_memory: self.max_memory.unwrap_or(Settings::MAX_MEMORY),
            pins: Arc::new(self.pins.clone()),
            paths: Arc::new(self.paths.load(loading.meter)?),
            ..Settings::default()
        };
        Ok(Described { settings, paint, lattice, notes })
    }

    /// The domain, with the names and the unit that its file has; where none is given, the `extent` of the
    /// rasters, or the unit square.
    fn domain(&self, extent: Option<Rect>, loading: &Loading) -> Result<ReadDomain, DescriptionError> {
        if let Some(path) = &self.region {
            let outline = (loading.read_outline)(path, loading.meter)?;
            let note = cut_at_antimeridian(path, &outline);
            return domain_of(&outline.polygons, self.bounds)
                .map(|(domain, marks)| ReadDomain { domain, marks, unit: outline.unit, note })
                .map_err(|error| DescriptionError::Unsuited(format!("{}: {error}", path.display())));
        }
        let bounds = self.bounds.or(extent).unwrap_or(Rect::UNIT);
        let shape = self.inside.clone().map_or(DomainShape::Whole, DomainShape::Formula);
        let domain = Domain { bounds, shape };
        Ok(ReadDomain { domain, marks: BoundaryMarks::default(), unit: LengthUnit::None, note: None })
    }

    /// The curve from risk to diameter; its ends bound h̄. Where the ends are not given, they do not restrict
    /// formulas and lengths.
    fn transfer(&self, coarse_diameter: f64) -> Transfer {
        let h_min = self.h_min.unwrap_or(f64::MIN_POSITIVE);
        let widest = if self.uses_scale() { coarse_diameter.max(h_min) } else { f64::MAX };
        Transfer { h_min, h_max: self.h_max.unwrap_or(widest), shape: self.exponent() }
    }

    /// Layers that ask for nothing, or only in a part of the domain.
    fn notes(&self, layers: &[Layer], domain: Rect) -> Vec<String> {
        let of_raster = |layer: &Layer, source: &RasterSource| {
            let (bounds, file) = (source.raster.raster().bounds(), &source.name);
            let common = bounds.intersection(&domain).map_or(0.0, |common| common.size().element_product());
            if common == 0.0 {
                let Rect { min, max } = bounds;
                let place = format!("{}, {} to {}, {}", min.x, min.y, max.x, max.y);
                return Some(format!("{file} covers {place} and does not meet the domain."));
            }
            let share = common / domain.size().element_product();
            // Without a domain of its own, the mesh covers all rasters.
            let is_partial = share < WHOLE && (self.bounds.is_some() || self.region.is_some());
            is_partial.then(|| {
                let percent = (100.0 * share).max(1.0).floor();
                let name = &layer.name;
                format!("{file} covers {percent} % of the domain's rectangle; beyond it the layer “{name}” asks for nothing.")
            })
        };
        let note = |layer: &Layer| match (&layer.kind, &layer.mask) {
            (_, Some(mask)) if mask.bounds().intersection(&domain).is_none() => Some(format!(
                "The mask of the layer “{}” does not meet the domain: it asks for nothing.",
                layer.name
            )),
            (LayerKind::Raster { source, .. } | LayerKind::Band { source, .. }, _) => {
                of_raster(layer, source)
            }
            _ => None,
        };
        layers.iter().filter(|layer| layer.visible).filter_map(note).collect()
    }
}

impl Described {
    /// What to mesh, but for the paint.
    pub fn mesh_spec(&self, limits: Limits) -> MeshSpec {
        let mut spec = self.settings.mesh_spec_on(self.lattice, limits);
        if self.settings.transfer.h_max == f64::MAX {
            spec.field.unasked = self.diameter_at(0);
        }
        spec
    }

    /// The settings with limits that a person can read where the description has none: the diameters of the
    /// smallest and the largest triangles of the lattice. The mesh is the same.
    pub fn with_limits_of_the_grid(mut self) -> Self {
        let (smallest, largest) = (self.diameter_at(self.lattice.deepest_level()), self.diameter_at(0));
        let transfer = &mut self.settings.transfer;
        if transfer.h_max == f64::MAX {
            transfer.h_max = largest.max(transfer.h_min);
        }
        if transfer.h_min == f64::MIN_POSITIVE {
            transfer.h_min = smallest.min(transfer.h_max);
        }
        self
    }

    /// The diameter of triangles of a level, in world units.
    fn diameter_at(&self, level: u32) -> f64 {
        bisection_edge_length(self.lattice.spacing(), level)
    }
}

/// The domain of a description, with what its file holds beside the polygons.
struct ReadDomain {
    domain: Domain,
    marks: BoundaryMarks,
    unit: LengthUnit,
    /// A sentence for a person.
    note: Option<String>,
}

/// The note on polygons that are cut at the antimeridian.
fn cut_at_antimeridian(path: &Path, outline: &Outline) -> Option<String> {
    outline.is_cut_at_antimeridian().then(|| {
        format!(
            "{} is cut at the antimeridian (longitude 180°): the halves on its sides are separate parts of the mesh, and \
             without --parts all only the largest part stays. Add 360 to the negative longitudes to mesh them as one.",
            path.display()
        )
    })
}

/// The domain that polygons cover, in `bounds` where these are given, and the names that they bring.
fn domain_of(
    polygons: &[NamedPolygon],
    bounds: Option<Rect>,
) -> Result<(Domain, BoundaryMarks), RegionError> {
    let Some(bounds) = bounds else { return BoundaryMarks::domain_of(polygons) };
    let plain = polygons.iter().map(|named| named.polygon.clone()).collect();
    let domain = Domain::of_stored_polygons(plain, bounds)?;
    let marks = BoundaryMarks::of_polygons(polygons, &domain);
    Ok((domain, marks))
}

/// Refuses a distance to the outline of a domain that has none.
fn check_outline(layers: &[Layer], domain: &Domain) -> Result<(), DescriptionError> {
    let Some(layer) = layers.iter().find(|layer| layer.visible && layer.is_of_outline()) else {
        return Ok(());
    };
    let Some(region) = domain.as_region() else {
        let problem = "there is no distance to the outline of a domain that is given by a formula";
        return Err(DescriptionError::Unsuited(format!(
            "The layer “{}”: {problem}. Give the domain by polygons, or the distance to shapes.",
            layer.name
        )));
    };
    Shapes::outline(&region).map(|_| ()).map_err(|error| DescriptionError::Unsuited(error.to_string()))
}
