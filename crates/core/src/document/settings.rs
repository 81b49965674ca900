use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec2;

use super::{Background, PathPlan, layers};
use crate::build::MeshSpec;
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain, Line, LineWeirError, Region};
use crate::field::{RefinementRule, Transfer, TransferError, checked_target};
use crate::geometry::{GridError, Lattice, Rect};
use crate::layers::{
    Depths, FormulaLayer, Layer, LayerKind, Quantity, Shapes, SizeFieldSpec, SurfaceGoalError,
};
use crate::mesh::{Cleaning, KeptParts, Limits, MemoryLimit, bisection_edge_length};
use crate::path::PathError;
use crate::text::{Bytes, Grouped, LengthUnit, Number, short_name};

/// Everything about a document that is not paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The name of the document.
    pub name: String,
    /// The unit of coordinates and lengths. It does not change the mesh.
    pub unit: LengthUnit,
    /// The picture behind the mesh. It does not change the mesh.
    pub background: Option<Background>,
    /// Ω.
    pub domain: Domain,
    /// How the mesh meets the boundary of a domain of polygons.
    pub boundary: BoundaryTreatment,
    /// Which triangles of a domain of polygons stay in the derived mesh.
    pub cleaning: Cleaning,
    /// Names, types and splits of the boundary. The mesh depends on them through layers that follow pieces.
    pub boundary_marks: Arc<BoundaryMarks>,
    /// Lines along which the derived mesh has edges. The mesh depends on them through layers.
    pub lines: Arc<Vec<Line>>,
    /// Points whose triangles and values are followed, in world units. They do not change the mesh.
    pub pins: Arc<Vec<DVec2>>,
    /// The waypoints and the cost of paths. They do not change the mesh.
    pub paths: Arc<PathPlan>,
    /// Largest side δ̄ of a coarse cell, in world units.
    pub spacing: f64,
    /// The limits of h̄, and the curve from risk to diameter.
    pub transfer: Transfer,
    /// The layers that decide h̄, from the bottom to the top; their identifiers differ.
    pub layers: Vec<Layer>,
    /// Largest change of h̄ per unit of length, or `None` for any.
    pub gradation: Option<f64>,
    /// Which points of a triangle count.
    pub rule: RefinementRule,
    /// Most triangles.
    pub max_triangles: usize,
    /// Most memory for the mesh and the next one made beside it, in bytes.
    pub max_memory: usize,
    /// The deepest level of a triangle, or `None` for any. Triangles of this level stay as they are, also
    /// where they are larger than their target.
    pub max_level: Option<u32>,
}

/// Why settings cannot be met.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The coarse grid is impossible.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The transfer curve is impossible.
    #[error(transparent)]
    Transfer(#[from] TransferError),
    /// The diameter at the boundary is not a length.
    #[error("A diameter of {} at the boundary cannot be met: it must be positive and finite.", Number(*.0))]
    BoundaryDiameter(f64),
    /// The share of the area is not between 0 and 1.
    #[error("Parts with a share of {} of the area cannot be kept: a share is between 0 and 1.", Number(*.0))]
    PartShare(f64),
    /// The background picture would have no extent.
    #[error(
        "The background picture cannot be placed there: its right side is right of the left one, and its top is \
         above the bottom."
    )]
    BackgroundBounds,
    /// A pin is nowhere.
    #[error("A pin at x = {}, y = {} cannot be kept: both must be finite numbers.", Number(_0.x), Number(_0.y))]
    Pin(DVec2),
    /// A path is impossible.
    #[error(transparent)]
    Path(#[from] PathError),
    /// Too many layers.
    #[error("The document has {} layers, and the limit is {}.", Grouped(*_0), Grouped(layers::MOST_LAYERS))]
    Layers(usize),
    /// A weir is of no use.
    #[error(transparent)]
    Weir(#[from] LineWeirError),
    /// The domain is empty.
    #[error("Nothing would be left of the domain: keep some of it.")]
    EmptyDomain,
    /// The gradation is not a slope.
    #[error("A gradation of {} cannot be met: it must be positive. Without a limit, h̄ may change abruptly.", Number(*.0))]
    Gradation(f64),
    /// Two layers have the same identifier.
    #[error("There are two layers with the identifier {0}: each layer needs its own.")]
    SameLayer(u32),
    /// A constant layer asks for a diameter that no mesh can meet.
    #[error("A target diameter of {} cannot be met: it must be positive; write inf to ask for nothing.", Number(*.0))]
    Constant(f64),
    /// Sizes from depths, which are in metres, in a document that is not.
    #[error(
        "The layer “{}”: sizes from depths are in metres, and lengths of the domain are in {}. {}",
        short_name(layer), unit.name(), layers::way_to_metres(*unit)
    )]
    DepthUnit {
        /// The name of the layer.
        layer: String,
        /// The unit of the document.
        unit: LengthUnit,
    },
    /// A formula uses the depth, and nothing gives it.
    #[error(
        "The layer “{}”: its formula uses the depth, and there are no depths. Add a layer of depths, or change the \
         formula first.",
        short_name(layer)
    )]
    NoDepths {
        /// The name of the layer.
        layer: String,
    },
    /// A formula of risk uses the depth.
    #[error(
        "The layer “{}”: a formula of risk cannot use the depth, only one of a target diameter can.",
        short_name(layer)
    )]
    RiskOfDepth {
        /// The name of the layer.
        layer: String,
    },
    /// A paint layer has pixels of the other quantity.
    #[error(
        "The pixels of the layer “{}” are {is}, and cannot be read as {read_as}. Add another paint layer.",
        short_name(layer)
    )]
    PaintedOther {
        /// The name of the layer.
        layer: String,
        /// The quantity of the layer's pixels.
        is: &'static str,
        /// The quantity that they would be read as.
        read_as: &'static str,
    },
    /// No mesh is as close to a surface.
    #[error("The layer “{}”: {error}", short_name(layer))]
    Surface {
        /// The name of the layer.
        layer: String,
        /// The rule that it breaks.
        error: SurfaceGoalError,
    },
    /// The rasters of all layers are too large together.
    #[error(
        "The rasters of all layers have {} pixels, and {} are possible in a document. Remove a layer with a raster, or \
         make the rasters coarser.",
        Grouped(*pixels as usize), Grouped(MOST_RASTER_PIXELS as usize)
    )]
    RasterPixels {
        /// The pixels of all rasters, each counted once.
        pixels: u64,
    },
    /// The memory budget is too small for any mesh.
    #[error("A memory budget of {} cannot be kept: choose {} at least.", Bytes(*bytes), Bytes(LEAST_MEMORY))]
    Memory {
        /// The number of bytes as given.
        bytes: usize,
    },
}

/// Most coarse triangles of a document: the coarse grid is made in one go, and must not delay a frame.
pub const MAX_COARSE_TRIANGLES: usize = 130_000;

/// Most pixels of the rasters of all layers, each raster counted once. A project with more is not read:
/// pixels without a value pack to a thousandth, so that a small file could fill the memory.
pub const MOST_RASTER_PIXELS: u64 = 500_000_000;

/// Least memory budget, in bytes: the program without a mesh takes a hundred times as much.
pub const LEAST_MEMORY: usize = 1_000_000;

impl Settings {
    /// Checks every number, and returns the settings when all can be met.
    ///
    /// # Errors
    /// Fails for the first number that cannot be met. A formula is not evaluated here: a value that is not a
    /// positive length is found when the field is sampled.
    pub fn checked(mut self) -> Result<Self, SettingsError> {
        self.lattice()?;
        self.transfer.checked()?;
        if let Some(Background { bounds, .. }) = self.background
            && !bounds.is_proper()
        {
            return Err(SettingsError::BackgroundBounds);
        }
        if let Some(diameter) = self.boundary.diameter() {
            checked_target(diameter, self.domain.bounds.center())
                .map_err(|e| SettingsError::BoundaryDiameter(e.value))?;
        }
        if self.domain.region().is_some_and(|region| region.is_empty()) {
            return Err(SettingsError::EmptyDomain);
        }
        if let KeptParts::Share(share) = self.cleaning.parts
            && !(0.0..=1.0).contains(&share)
        {
            return Err(SettingsError::PartShare(share));
        }
        self.paths.check()?;
        if let Some(&pin) = self.pins.iter().find(|pin| !pin.is_finite()) {
            return Err(SettingsError::Pin(pin));
        }
        Line::check_all(&self.lines)?;
        self.check_layers()?;
        if let Some(slope) = self.gradation
            && !(slope > 0.0 && slope.is_finite())
        {
            return Err(SettingsError::Gradation(slope));
        }
        if self.max_memory < LEAST_MEMORY {
            return Err(SettingsError::Memory { bytes: self.max_memory });
        }
        self.find_straits();
        Ok(self)
    }

    fn check_layers(&self) -> Result<(), SettingsError> {
        layers::check_layer_count(self.layers.len())?;
        let mut ids = BTreeSet::new();
        for layer in &self.layers {
            if !ids.insert(layer.id) {
                return Err(SettingsError::SameLayer(layer.id.0));
            }
            if let Some(FormulaLayer { quantity: Quantity::Diameter, formula }) = layer.kind.get()
                && let Some(value) = formula.constant()
                && (value.is_nan() || value <= 0.0)
            {
                // Infinity asks for nothing, as it does where a formula has it in some places only.
                return Err(SettingsError::Constant(value));
            }
        }
        self.check_depth_formulas()?;
        self.check_depth_unit()?;
        self.check_surfaces()?;
        let pixels = self.raster_pixels();
        if pixels > MOST_RASTER_PIXELS { Err(SettingsError::RasterPixels { pixels }) } else { Ok(()) }
    }

    /// Checks that formulas that use the depth have one. A hidden layer of depths is enough: without depths
    /// in sight they ask for nothing.
    fn check_depth_formulas(&self) -> Result<(), SettingsError> {
        let has_depths = self.layers.iter().any(|layer| layer.kind.is::<Depths>());
        for layer in self.layers.iter().filter(|layer| layer.kind.uses_depth()) {
            let name = layer.name.clone();
            if layer.is_of_risk() {
                return Err(SettingsError::RiskOfDepth { layer: name });
            }
            if !has_depths {
                return Err(SettingsError::NoDepths { layer: name });
            }
        }
        Ok(())
    }

    /// Checks that lengths are in metres where sizes from depths are asked for.
    ///
    /// # Errors
    /// Fails with the first visible layer that asks for them in another unit.
    pub fn check_depth_unit(&self) -> Result<(), SettingsError> {
        let asks = |layer: &&Layer| layer.visible && layer.kind.needs_metres();
        match self.layers.iter().find(asks) {
            Some(layer) if !self.unit.may_be_metres() => {
                Err(SettingsError::DepthUnit { layer: layer.name.clone(), unit: self.unit })
            }
            _ => Ok(()),
        }
    }

    /// Returns the pixels of the rasters of all layers. A raster that two layers read counts once.
    fn raster_pixels(&self) -> u64 {
        let rasters = self.layers.iter().filter_map(|layer| layer.kind.raster_source());
        let sizes: BTreeMap<usize, u64> = rasters
            .map(|source| (Arc::as_ptr(&source.raster).addr(), source.raster.raster().values().len() as u64))
            .collect();
        sizes.values().sum()
    }

    /// Returns the coarse grid and its lattice.
    ///
    /// # Errors
    /// Fails when the grid is impossible or too fine.
    pub fn lattice(&self) -> Result<Lattice, GridError> {
        Lattice::covering(self.domain.bounds, self.spacing, MAX_COARSE_TRIANGLES)
    }

    /// The gradation of meshes for most solvers: neighbouring triangles differ little in size.
    pub const DEFAULT_GRADATION: f64 = 0.3;

    /// Returns the description of the size field, without the paint.
    pub fn field_spec(&self) -> SizeFieldSpec {
        let Self { layers, transfer, gradation, .. } = self;
        SizeFieldSpec {
            layers: layers.iter().map(|layer| self.field_layer(layer)).collect(),
            transfer: *transfer,
            unasked: transfer.h_max,
            outline: self.outline_shapes(),
            gradation: *gradation,
            projection: self.domain.projection,
        }
    }

    /// Returns a layer as the size field has it: shapes take the place of coasts and pieces of the boundary.
    pub fn field_layer(&self, layer: &Layer) -> Layer {
        let mut layer = layer.clone();
        layer.kind.enter_field(&self.domain, &self.boundary_marks);
        layer.kind.follow_domain(&self.domain, &self.boundary_marks);
        layer.kind.follow_lines(&self.lines, &self.domain);
        layer
    }

    /// Finds straits, the middle of the water, gaps between lines and slopes for layers that ask for them.
    pub(super) fn find_straits(&mut self) {
        for layer in &mut self.layers {
            layer.kind.follow_domain(&self.domain, &self.boundary_marks);
            layer.kind.follow_lines(&self.lines, &self.domain);
        }
    }

    /// Returns the boundary of the domain, if a layer asks for the distance to it.
    fn outline_shapes(&self) -> Option<Shapes> {
        let is_asked = self.layers.iter().any(|layer| layer.visible && layer.kind.is_of_outline());
        let region = if is_asked { self.domain.as_region()? } else { return None };
        Shapes::outline(&region).ok()
    }

    /// Returns the description of the mesh, without the paint.
    ///
    /// # Errors
    /// Fails as [`Self::lattice`] does.
    pub fn mesh_spec(&self) -> Result<MeshSpec, GridError> {
        Ok(self.mesh_spec_on(self.lattice()?, self.limits()))
    }

    /// Returns the description of the mesh on the lattice of a coarse grid, with limits that may differ from
    /// those of the window.
    pub fn mesh_spec_on(&self, lattice: Lattice, limits: Limits) -> MeshSpec {
        let mut field = self.field_spec();
        // Without an upper limit, h̄ is the diameter of a coarse triangle where no layer asks for anything.
        if self.transfer.h_max == f64::MAX {
            field.unasked = self.domain.longest_on_earth(bisection_edge_length(lattice.spacing(), 0));
        }
        MeshSpec {
            domain: self.domain.clone(),
            boundary: self.boundary,
            lines: self.lines.clone(),
            lattice,
            field,
            rule: self.rule,
            cleaning: self.derived_cleaning(),
            limits,
        }
    }

    /// Which triangles stay in the derived mesh: all, unless the mesh is fitted to an outline.
    pub fn derived_cleaning(&self) -> Cleaning {
        if self.is_fitted() { self.cleaning } else { Cleaning::NONE }
    }

    /// Returns whether the mesh is fitted to an outline, where that can be followed.
    pub fn is_fitted(&self) -> bool {
        !self.domain.is_whole() && self.boundary != BoundaryTreatment::Report
    }

    /// Returns whether files get a derived mesh: fitted to an outline, or with edges along lines.
    pub fn is_derived(&self) -> bool {
        !self.lines.is_empty() || self.outline().is_some()
    }

    /// Returns the polygons that the mesh meets, as [`Domain::outline`] does.
    pub fn outline(&self) -> Option<Arc<Region>> {
        self.domain.outline(self.boundary)
    }

    /// Returns the limits of the size of the mesh.
    pub fn limits(&self) -> Limits {
        let memory = MOST_MEMORY.map_or(self.max_memory, |most| self.max_memory.min(most));
        let max_memory = Some(MemoryLimit::for_two_meshes(memory));
        Limits { max_triangles: self.max_triangles, max_level: self.max_level, max_memory }
    }
}

/// Most memory that meshes get, whatever the document allows, in bytes, where that is limited: a page of a
/// browser has 4 GB for everything.
const MOST_MEMORY: Option<usize> = if cfg!(target_family = "wasm") { Some(1_500_000_000) } else { None };

impl Settings {
    /// Most triangles unless the user says otherwise: 760 MB.
    pub const MAX_TRIANGLES: usize = 20_000_000;
    /// Most memory for meshes unless the user says otherwise, in bytes: enough for some more triangles.
    pub const MAX_MEMORY: usize = 2_600_000_000;

    /// Returns the default settings for a domain: lengths in proportion to its longer side.
    pub fn for_domain(name: String, domain: Domain) -> Self {
        let (default, extent) = (Self::default(), domain.bounds.size().max_element());
        let Transfer { h_min, h_risk, h_max, shape } = default.transfer;
        let spacing = default.spacing * extent;
        Self {
            name,
            spacing,
            boundary: BoundaryTreatment::default_for(domain.longest_on_earth(spacing)),
            domain,
            transfer: Transfer {
                h_min: h_min * extent,
                h_risk: h_risk * extent,
                h_max: h_max * extent,
                shape,
            },
            layers: Layer::default_stack(LayerKind::constant(h_max * extent)),
            ..default
        }
    }
}

impl Default for Settings {
    /// Returns the unit square, 24 coarse cells a side, nothing refined but what is painted.
    fn default() -> Self {
        Self {
            name: "Untitled".into(),
            unit: LengthUnit::None,
            background: None,
            domain: Domain::rectangle(Rect::UNIT),
            spacing: 1.0 / 24.0,
            boundary: BoundaryTreatment::default_for(1.0 / 24.0),
            cleaning: Cleaning::FOR_SOLVERS,
            boundary_marks: Arc::default(),
            lines: Arc::default(),
            pins: Arc::default(),
            paths: Arc::default(),
            transfer: Transfer::between(0.0024, 0.2),
            layers: Layer::default_stack(LayerKind::constant(0.2)),
            gradation: None,
            rule: RefinementRule::Area,
            max_triangles: Self::MAX_TRIANGLES,
            max_memory: Self::MAX_MEMORY,
            max_level: None,
        }
    }
}
