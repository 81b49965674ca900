//! Turns tables into the settings of a document, and reads the data that they name.

use std::path::Path;
use std::sync::Arc;

use super::{SavedDomain, SavedSettings, SavedTreatment, marks_of};
use crate::io::KeyFault;
use crate::io::layers::{SavedLayer, TextError};
use glam::DVec2;
use meshbrush_core::document::{PathPlan, Settings};
use meshbrush_core::domain::{
    BoundaryMarks, BoundaryPieces, BoundaryTreatment, Crest, DepthContour, Domain, DomainShape, Line, Polygon,
};
use meshbrush_core::earth::{Coordinates, ProjectionChoice};
use meshbrush_core::field::{RefinementRule, Transfer};
use meshbrush_core::layers::{Layer, LayerId, PositiveDepth, ShapeList, Surface};
use meshbrush_core::surface::domain_on_samples;
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Cleaning, CoarseError, bisection_edge_length};
use meshbrush_mesh::text::LengthUnit;

/// Coarse cells along the longer side of the domain unless the spacing is given (N_e of the report's
/// example).
const DEFAULT_CELLS: f64 = 20.0;

/// The limits of a mesh where the text has none.
#[derive(Clone, Copy, Debug)]
pub struct LoadingDefaults {
    /// Most coarse triangles; no text says it.
    pub most_coarse: usize,
    /// Most triangles.
    pub max_triangles: usize,
    /// Most memory, in bytes.
    pub max_memory: usize,
}

impl LoadingDefaults {
    /// That of a document.
    pub const DOCUMENT: Self = Self {
        most_coarse: meshbrush_core::document::MAX_COARSE_TRIANGLES,
        max_triangles: Settings::MAX_TRIANGLES,
        max_memory: Settings::MAX_MEMORY,
    };
}

/// Polygons of a domain, with what their file says beside them.
#[derive(Debug)]
pub struct ReadRegion {
    /// The domain.
    pub domain: Domain,
    /// Names of its boundary.
    pub marks: BoundaryMarks,
    /// The unit of coordinates and lengths.
    pub unit: LengthUnit,
}

/// What the coordinates of the domain's polygons are, and the plane where they are meshed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionCoordinates {
    /// The contour of a grid that is the region.
    pub contour: DepthContour,
    /// Whether its values are heights or depths; `None` for what its file says, or else heights.
    pub positive: Option<PositiveDepth>,
    /// Whether the domain is where the grid has values, in place of a contour.
    pub outside_nodata: bool,
    /// Whether the file has land, and the domain is the rectangle less it.
    pub is_land: bool,
    /// A place in the sea beside the land, in the coordinates of the file.
    pub sea_at: Option<DVec2>,
    /// Whether the east of the bounds was less than their west, as longitudes across 180° are.
    pub east_is_less: bool,
    /// What coordinates of files are that do not name a known system.
    pub assumed: Option<Coordinates>,
    /// How the plane is chosen; `None` for that of the polygons' own coordinates.
    pub projection: Option<ProjectionChoice>,
}

/// Where the data are that tables and layers name.
pub trait Storage {
    /// A layer, with what says where its data are.
    type Layer;
    /// Why data could not be read, or a value cannot be used.
    type Error: From<KeyFault> + From<TextError> + From<CoarseError>;

    /// Returns the layer as the text has it.
    fn saved(layer: &Self::Layer) -> &SavedLayer;

    /// Returns the polygons of the domain, in `bounds` where these are given, in the plane of a projection
    /// where one is chosen. The bounds are in the coordinates of the file.
    ///
    /// # Errors
    /// Fails when they cannot be read or used.
    fn region(
        &mut self,
        file: &Path,
        bounds: Option<Rect>,
        coordinates: &RegionCoordinates,
    ) -> Result<ReadRegion, Self::Error>;

    /// Returns the rectangle of the rasters of layers, in world units, and the unit that they state: the
    /// domain where no key says it.
    ///
    /// # Errors
    /// Fails when they cannot be read.
    fn extent(&mut self, layers: &[Self::Layer]) -> Result<Option<(Rect, LengthUnit)>, Self::Error>;

    /// Returns the layer with its data, or `None` where it is left out. `number` counts the layers from 0.
    ///
    /// # Errors
    /// Fails when a value cannot be used, or the data not read.
    fn layer(
        &mut self,
        layer: &Self::Layer,
        number: LayerId,
        domain: Rect,
        transfer: &Transfer,
    ) -> Result<Option<Layer>, Self::Error>;

    /// Returns the polygons of a keep-out region.
    ///
    /// # Errors
    /// Fails when they cannot be read.
    fn polygons(&mut self, file: &Path) -> Result<Vec<Polygon>, Self::Error>;

    /// Returns the lines and polygons of a file of lines.
    ///
    /// # Errors
    /// Fails when they cannot be read, and when there is none.
    fn lines(&mut self, file: &Path) -> Result<ShapeList, Self::Error>;

    /// Returns the crest of a line from a file with a grid of heights; `bounds` are those of the domain.
    ///
    /// # Errors
    /// Fails when it cannot be read, and when the line is far from it.
    fn crest(&mut self, file: &Path, line: &Line, bounds: Rect) -> Result<Crest, Self::Error>;
}

impl<L> SavedSettings<L> {
    /// Returns the settings of a document that is called `name`; `storage` reads the data.
    ///
    /// Limits of the target diameter that are not given do not restrict it: they are the smallest and the
    /// largest number.
    ///
    /// # Errors
    /// Fails when a value cannot be used, data cannot be read, or there is no coarse grid.
    pub fn load<S: Storage<Layer = L>>(
        &self,
        name: &str,
        defaults: &LoadingDefaults,
        storage: &mut S,
    ) -> Result<Settings, S::Error> {
        self.check_tables()?;
        let ReadRegion { domain, marks, unit } = self.read_domain(storage)?;
        let domain = self.domain.cut(domain).map_err(|fault| fault.within("domain"))?;
        let unit = self.domain.unit.map_or(unit, Into::into);
        self.lengths.check(unit)?;
        let bounds = domain.bounds;
        let marks = self.domain.marks_on(&domain).before(marks);
        let spacing = self.mesh.spacing.map_or(bounds.size().max_element() / DEFAULT_CELLS, Into::into);
        let lattice = Lattice::covering(bounds, spacing, defaults.most_coarse).map_err(CoarseError::from)?;
        let coarse_diameter = domain.longest_on_earth(bisection_edge_length(lattice.spacing(), 0));
        let transfer = self.transfer::<S>(coarse_diameter);
        let numbered = self.layer.iter().zip((0..).map(LayerId));
        let layers = numbered.map(|(layer, number)| storage.layer(layer, number, bounds, &transfer));
        let layers: Vec<Layer> = layers.filter_map(Result::transpose).collect::<Result<_, _>>()?;
        let (domain, spacing) = match self.on_samples(&layers) {
            Some((bounds, spacing)) => (Domain { bounds, ..domain }, spacing),
            None => (domain, spacing),
        };
        let lines = self.read_lines(storage, domain.bounds)?;
        let keep_out = self.keep_out.iter().map(|region| region.load(|file| storage.polygons(file)));
        let places = |typed: Vec<DVec2>| typed.into_iter().map(|at| domain.place_of(at)).collect::<Vec<_>>();
        let pins = places(self.pins.points()?);
        let paths = PathPlan {
            keep_out: keep_out.collect::<Result<_, _>>()?,
            routes: self.paths.routes()?.into_iter().map(places).collect(),
            names: Vec::new(),
            cost: self.paths.checked_cost()?,
            clearance: self.paths.checked_clearance()?,
        };
        let paths = paths.with_names(self.paths.names.iter().cloned());
        // The values of the text take the place of these.
        let settings = Settings {
            name: name.to_owned(),
            unit,
            boundary: BoundaryTreatment::default_for(domain.longest_on_earth(spacing)),
            domain,
            boundary_marks: Arc::new(marks),
            lines: Arc::new(lines),
            pins: Arc::new(pins),
            paths: Arc::new(paths),
            spacing,
            transfer,
            layers,
            rule: RefinementRule::Area,
            max_triangles: defaults.max_triangles,
            max_memory: defaults.max_memory,
            ..Settings::default()
        };
        Ok(self.override_settings(settings)?)
    }

    /// Reads the lines along which the mesh has edges; `bounds` are those of the domain.
    ///
    /// # Errors
    /// Fails when they cannot be read, or a value cannot be used.
    pub(in crate::io) fn read_lines<S: Storage>(
        &self,
        storage: &mut S,
        bounds: Rect,
    ) -> Result<Vec<Line>, S::Error> {
        let mut lines = Vec::new();
        for (index, line) in self.line.iter().enumerate() {
            line.check().map_err(|fault| fault.within(index).within("line"))?;
            let mut read = line.load(|file| storage.lines(file))?;
            line.give_kind(&mut read, |file, line| storage.crest(file, line, bounds))?;
            lines.extend(read);
        }
        Ok(lines)
    }

    /// Returns the bounds of a domain and a spacing that suit the samples of a surface, where the text leaves
    /// the domain to the layers.
    fn on_samples(&self, layers: &[Layer]) -> Option<(Rect, f64)> {
        let SavedDomain { bounds, inside, cut_off, .. } = &self.domain;
        let is_free = bounds.is_none()
            && inside.is_none()
            && cut_off.is_empty()
            && self.domain.outline_file().is_none();
        let mut rasters = layers.iter().filter_map(|layer| layer.kind.get::<Surface>()?.source.raster());
        let source = rasters.next_back().filter(|_| is_free)?;
        domain_on_samples(source.raster.raster(), self.mesh.spacing.map(Into::into))
    }

    fn read_domain<S: Storage<Layer = L>>(&self, storage: &mut S) -> Result<ReadRegion, S::Error> {
        let bounds = self.domain.rect()?;
        if let Some(file) = self.domain.outline_file() {
            return storage.region(file, bounds, &self.domain.coordinates()?);
        }
        let (bounds, unit) = match bounds {
            Some(bounds) => (bounds, LengthUnit::None),
            None => storage.extent(&self.layer)?.unwrap_or((Rect::UNIT, LengthUnit::None)),
        };
        let shape = self.domain.formula()?.map_or(DomainShape::Whole, DomainShape::from);
        let marks = BoundaryMarks::default();
        Ok(ReadRegion { domain: Domain { bounds, shape, projection: None }, marks, unit })
    }

    /// Returns the limits of h̄ and the curve from risk to diameter.
    fn transfer<S: Storage<Layer = L>>(&self, coarse_diameter: f64) -> Transfer {
        let h_min = self.limits.h_min.map_or(f64::MIN_POSITIVE, Into::into);
        let uses_scale = self.layer.iter().any(|layer| S::saved(layer).keys.uses_scale());
        let h_risk = self.limits.h_risk.map_or(h_min, Into::into);
        let widest = if uses_scale { coarse_diameter.max(h_risk) } else { f64::MAX };
        let h_max = self.limits.h_max.map_or(widest, Into::into);
        Transfer { h_min, h_risk, h_max, shape: self.limits.shape.unwrap_or(1.0) }
    }

    /// Returns which triangles stay: the default ones, unless the text says otherwise.
    pub fn cleaning(&self, default: Cleaning) -> Cleaning {
        Cleaning {
            parts: self.domain.parts.map_or(default.parts, Into::into),
            keeps_pinches: self.domain.keep_pinches.unwrap_or(default.keeps_pinches),
            improves_boundary: self.domain.improve_boundary.unwrap_or(default.improves_boundary),
        }
    }
}

impl super::SavedDomain {
    /// Returns whether it has splits, names or types of the boundary.
    pub fn has_marks(&self) -> bool {
        !(self.splits.is_empty() && self.names.is_empty() && self.types.is_empty())
    }

    /// Returns the marks of the text, in world units. In the plane of a projection, a place that is not on
    /// the boundary is a longitude and a latitude if that is on it.
    pub fn marks_on(&self, domain: &Domain) -> BoundaryMarks {
        let marks = marks_of(&self.splits, &self.names, &self.types);
        let Some(projection) = domain.projection.filter(|_| !marks.is_empty()) else { return marks };
        let Some(pieces) = BoundaryPieces::of_domain(domain, &BoundaryMarks::default()) else { return marks };
        let is_on = |at: DVec2| at.is_finite() && pieces.nearest(at, pieces.tolerance()).is_some();
        marks.moved(|at| match (is_on(at), at.y.abs() <= 90.0 && at.x.abs() <= 360.0) {
            (false, true) => Some(projection.plane_from_geographic(at)).filter(|&at| is_on(at)).unwrap_or(at),
            _ => at,
        })
    }
}

impl SavedTreatment {
    /// Returns the kind of a treatment.
    pub fn of(treatment: BoundaryTreatment) -> Self {
        match treatment {
            BoundaryTreatment::Report => Self::Report,
            BoundaryTreatment::Fitted { .. } => Self::Fitted,
            BoundaryTreatment::OnOutline { .. } => Self::Outline,
        }
    }

    /// Returns the treatment of this kind with a diameter at the outline, in world units.
    pub fn with_diameter(self, diameter: f64) -> BoundaryTreatment {
        match self {
            Self::Report => BoundaryTreatment::Report,
            Self::Fitted => BoundaryTreatment::Fitted { diameter },
            Self::Outline => BoundaryTreatment::OnOutline { diameter },
        }
    }
}
