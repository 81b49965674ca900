use std::sync::Arc;

use super::Background;
use crate::build::{FieldSampling, MeshSpec};
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain};
use crate::field::{
    Formula, RefinementRule, Source, TargetFieldSpec, Transfer, TransferError, checked_target,
};
use crate::geometry::{GridError, Lattice, Rect};
use crate::mesh::{Cleaning, KeptParts, Limits, MemoryLimit};
use crate::raster::{MAX_SIDE, Raster};
use crate::text::{Bytes, Grouped, LengthUnit, Number};

/// Everything about a document that is not paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What the document is called.
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
    /// Names of pieces of the boundary, and where it is split. They do not change the mesh.
    pub boundary_marks: Arc<BoundaryMarks>,
    /// Largest side δ̄ of a coarse cell, in world units.
    pub spacing: f64,
    /// From risk to diameter; its ends bound h̄ everywhere.
    pub transfer: Transfer,
    /// The field under the paint.
    pub base: Base,
    /// Which points of a triangle count.
    pub rule: RefinementRule,
    /// Pixels of the field along the longer side of the domain.
    pub resolution: u32,
    /// Most triangles.
    pub max_triangles: usize,
    /// Most memory for the mesh and the next one made beside it, in bytes.
    pub max_memory: usize,
}

/// The base field under the paint.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Base {
    /// The same target diameter everywhere, in world units.
    Constant(f64),
    /// A formula in x and y for the target diameter, in world units.
    Formula(Formula),
    /// A greyscale picture as risk: black 0, white 1.
    RiskImage {
        /// Name of the file, for a person.
        name: String,
        /// Risks over the domain's rectangle, or with a placement of its own.
        raster: Arc<Raster>,
    },
    /// A grid of target diameters, in world units.
    DiameterGrid {
        /// Name of the file, for a person.
        name: String,
        /// Diameters at their own place; infinite where the grid has no value.
        raster: Arc<Raster>,
    },
}

impl PartialEq for Base {
    /// Pictures that share their memory are not compared pixel by pixel.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Constant(a), Self::Constant(b)) => a == b,
            (Self::Formula(a), Self::Formula(b)) => a == b,
            (Self::RiskImage { name: a, raster: x }, Self::RiskImage { name: b, raster: y })
            | (Self::DiameterGrid { name: a, raster: x }, Self::DiameterGrid { name: b, raster: y }) => {
                a == b && (Arc::ptr_eq(x, y) || x == y)
            }
            _ => false,
        }
    }
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
    /// The share of the area is none.
    #[error("Parts with a share of {} of the area cannot be kept: a share is between 0 and 1.", Number(*.0))]
    PartShare(f64),
    /// The background picture would have no extent.
    #[error(
        "The background picture cannot be placed there: its right side is right of the left one, and its top is \
         above the bottom."
    )]
    BackgroundBounds,
    /// The domain is empty.
    #[error("Nothing would be left of the domain: keep some of it.")]
    EmptyDomain,
    /// The constant is not a length.
    #[error("A target diameter of {} cannot be met: it must be positive and finite.", Number(*.0))]
    Constant(f64),
    /// The memory budget is too small for any mesh.
    #[error("A memory budget of {} cannot be kept: choose {} at least.", Bytes(*bytes), Bytes(LEAST_MEMORY))]
    Memory {
        /// As given.
        bytes: usize,
    },
    /// The raster would be empty or too large.
    #[error(
        "A field of {} pixels cannot be made: choose between {} and {} along the longer side.",
        Grouped(*resolution as usize), Grouped(*least as usize), Grouped(*most as usize)
    )]
    Resolution {
        /// As given.
        resolution: u32,
        /// Fewest allowed.
        least: u32,
        /// Most allowed.
        most: u32,
    },
}

/// Fewest and most pixels along the longer side of a document's field.
pub const RESOLUTIONS: std::ops::RangeInclusive<u32> = 16..=MAX_SIDE / 4;

/// Most coarse triangles of a document: the coarse grid is made in one go, and must not delay a frame.
pub const MAX_COARSE_TRIANGLES: usize = 130_000;

/// Least memory budget, in bytes: the program without a mesh takes a hundred times as much.
pub const LEAST_MEMORY: usize = 1_000_000;

impl Settings {
    /// Checks every number, and returns the settings when all can be met.
    ///
    /// # Errors
    /// For the first number that cannot be met. A formula is not evaluated here: a value that is not a
    /// positive length is found when the field is sampled.
    pub fn checked(self) -> Result<Self, SettingsError> {
        self.lattice()?;
        self.transfer.checked()?;
        if let Some(Background { bounds, .. }) = self.background
            && !(bounds.is_proper() && bounds.size().is_finite())
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
        if let Base::Constant(value) = self.base {
            checked_target(value, self.domain.bounds.center())
                .map_err(|e| SettingsError::Constant(e.value))?;
        }
        if self.max_memory < LEAST_MEMORY {
            return Err(SettingsError::Memory { bytes: self.max_memory });
        }
        if !RESOLUTIONS.contains(&self.resolution) {
            let (least, most) = RESOLUTIONS.into_inner();
            return Err(SettingsError::Resolution { resolution: self.resolution, least, most });
        }
        Ok(self)
    }

    /// The coarse grid and its lattice.
    ///
    /// # Errors
    /// When the grid is impossible or too fine.
    pub fn lattice(&self) -> Result<Lattice, GridError> {
        Lattice::covering(self.domain.bounds, self.spacing, MAX_COARSE_TRIANGLES)
    }

    /// Columns and rows of the field: the resolution along the longer side, with pixels as nearly square as
    /// possible.
    pub fn raster_size(&self) -> [u32; 2] {
        let size = self.domain.bounds.size();
        let per_unit = f64::from(self.resolution) / size.max_element();
        [size.x, size.y].map(|side| ((side * per_unit).round() as u32).clamp(1, self.resolution))
    }

    /// What the field is made from.
    pub fn field_spec(&self) -> TargetFieldSpec {
        let source = match &self.base {
            Base::Constant(value) => Source::Constant(*value),
            Base::Formula(formula) => Source::TargetFormula(formula.clone()),
            Base::RiskImage { raster, .. } => Source::RiskRaster(raster.clone()),
            Base::DiameterGrid { raster, .. } => Source::TargetRaster(raster.clone()),
        };
        let (transfer, size) = (self.transfer, self.raster_size());
        TargetFieldSpec { sources: vec![source], transfer, unasked: transfer.h_max, size }
    }

    /// What to mesh, but for the paint.
    ///
    /// # Errors
    /// As [`Self::lattice`].
    pub fn mesh_spec(&self) -> Result<MeshSpec, GridError> {
        Ok(MeshSpec {
            domain: self.domain.clone(),
            boundary: self.boundary,
            lattice: self.lattice()?,
            field: self.field_spec(),
            rule: self.rule,
            sampling: FieldSampling::Always,
            cleaning: self.derived_cleaning(),
            limits: self.limits(),
        })
    }

    /// Which triangles stay in the derived mesh: all, unless the mesh is fitted to polygons.
    pub fn derived_cleaning(&self) -> Cleaning {
        let is_fitted = self.domain.region().is_some() && self.boundary != BoundaryTreatment::Report;
        if is_fitted { self.cleaning } else { Cleaning::NONE }
    }

    /// Whether the mesh of these settings is that of `other`, if neither reaches a budget: the derived mesh
    /// may differ.
    pub fn share_mesh_with(&self, other: &Self) -> bool {
        let boundary = match self.boundary.diameter() == other.boundary.diameter() {
            true => other.boundary,
            false => self.boundary,
        };
        let Self { unit, cleaning, max_triangles, max_memory, .. } = *other;
        let (boundary_marks, background) = (other.boundary_marks.clone(), other.background.clone());
        let derived = Self { boundary, boundary_marks, cleaning, max_triangles, max_memory, ..self.clone() };
        Self { unit, background, ..derived } == *other
    }

    /// What the mesh may cost.
    pub fn limits(&self) -> Limits {
        let max_memory = Some(MemoryLimit::for_two_meshes(self.max_memory));
        Limits { max_triangles: self.max_triangles, max_level: None, max_memory }
    }
}

impl Settings {
    /// Most triangles unless the user says otherwise: 760 MB.
    pub const MAX_TRIANGLES: usize = 20_000_000;
    /// Most memory for meshes unless the user says otherwise, in bytes: enough for a little more than
    /// [`Self::MAX_TRIANGLES`].
    pub const MAX_MEMORY: usize = 2_000_000_000;

    /// The usual settings for a domain: lengths in proportion to its longer side.
    pub fn for_domain(name: String, domain: Domain) -> Self {
        let (usual, extent) = (Self::default(), domain.bounds.size().max_element());
        let Transfer { h_min, h_max, shape } = usual.transfer;
        let spacing = usual.spacing * extent;
        Self {
            name,
            domain,
            spacing,
            boundary: BoundaryTreatment::usual(spacing),
            transfer: Transfer { h_min: h_min * extent, h_max: h_max * extent, shape },
            base: Base::Constant(h_max * extent),
            ..usual
        }
    }
}

impl Default for Settings {
    /// The unit square, 24 coarse cells a side, nothing refined but what is painted.
    fn default() -> Self {
        Self {
            name: "Untitled".into(),
            unit: LengthUnit::None,
            background: None,
            domain: Domain::rectangle(Rect::UNIT),
            spacing: 1.0 / 24.0,
            boundary: BoundaryTreatment::usual(1.0 / 24.0),
            cleaning: Cleaning::FOR_SOLVERS,
            boundary_marks: Arc::default(),
            transfer: Transfer { h_min: 0.0024, h_max: 0.2, shape: 1.0 },
            base: Base::Constant(0.2),
            rule: RefinementRule::Area,
            resolution: 1024,
            max_triangles: Self::MAX_TRIANGLES,
            max_memory: Self::MAX_MEMORY,
        }
    }
}
