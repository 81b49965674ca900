use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::super::layers::{KindSpec, LayerSpec};
use super::{PathsSpec, SavedTreatment};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryMarks, BoundaryTreatment};
use meshbrush_core::field::{Formula, RefinementRule, Transfer, TransferError};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, KeptParts, Limits, MemoryLimit};
use meshbrush_mesh::text::LengthUnit;

/// What to mesh, as a recipe or the options of the command line say it: every value is checked on its own,
/// and no file was read.
///
/// What is `None` has its usual value, or that of the project or recipe that the options go with.
#[derive(Clone, Debug, Default)]
pub struct MeshDescription {
    /// The rectangle that the coarse grid covers, in world units.
    pub bounds: Option<Rect>,
    /// The domain is where this is not 0.
    pub inside: Option<Formula>,
    /// The domain is what the polygons of this file cover.
    pub region: Option<PathBuf>,
    /// The unit of coordinates and lengths, in place of that of the region's file.
    pub unit: Option<LengthUnit>,
    /// How the mesh meets the outline of a region.
    pub boundary: Option<SavedTreatment>,
    /// Largest diameter of a triangle on the outline, in world units.
    pub boundary_diameter: Option<f64>,
    /// The parts of the mesh that stay.
    pub parts: Option<KeptParts>,
    /// Whether pinches stay in any case.
    pub keeps_pinches: bool,
    /// Names of the boundary, in place of those of the region's file.
    pub marks: Option<Arc<BoundaryMarks>>,
    /// Longest side of a coarse cell, in world units.
    pub spacing: Option<f64>,
    /// Which points of a triangle count.
    pub rule: Option<RefinementRule>,
    /// Most triangles.
    pub max_triangles: Option<usize>,
    /// Deepest level.
    pub max_level: Option<u32>,
    /// Most memory, in bytes.
    pub max_memory: Option<usize>,
    /// Smallest target diameter, in world units.
    pub h_min: Option<f64>,
    /// Largest target diameter, in world units.
    pub h_max: Option<f64>,
    /// Exponent of the curve from risk to diameter, dimensionless.
    pub shape: Option<f64>,
    /// Bound of the change of h̄ by unit of length, dimensionless.
    pub gradation: Option<f64>,
    /// The size field, from the bottom layer to the top one.
    pub layers: Vec<LayerSpec>,
    /// Between which places paths are sought, what they cost, and where they do not go.
    pub paths: PathsSpec,
    /// Points that the window follows, in world units.
    pub pins: Vec<DVec2>,
}

impl MeshDescription {
    /// The description with the values of `options` in place of its own. Domain, layers, paths and pins are
    /// its own: no option goes with them.
    pub fn overridden_by(self, options: &Self) -> Self {
        let Self { bounds, inside, region, unit, marks, layers, paths, pins, .. } = self;
        Self {
            bounds,
            inside,
            region,
            unit,
            marks,
            layers,
            paths,
            pins,
            boundary: options.boundary.or(self.boundary),
            boundary_diameter: options.boundary_diameter.or(self.boundary_diameter),
            parts: options.parts.or(self.parts),
            keeps_pinches: options.keeps_pinches || self.keeps_pinches,
            spacing: options.spacing.or(self.spacing),
            rule: options.rule.or(self.rule),
            max_triangles: options.max_triangles.or(self.max_triangles),
            max_level: options.max_level.or(self.max_level),
            max_memory: options.max_memory.or(self.max_memory),
            h_min: options.h_min.or(self.h_min),
            h_max: options.h_max.or(self.h_max),
            shape: options.shape.or(self.shape),
            gradation: options.gradation.or(self.gradation),
        }
    }

    /// The settings of a document with the values that are given here in place of its own.
    pub fn override_settings(&self, settings: Settings) -> Settings {
        let Transfer { h_min, h_max, shape } = settings.transfer;
        let transfer = Transfer {
            h_min: self.h_min.unwrap_or(h_min),
            h_max: self.h_max.unwrap_or(h_max),
            shape: self.shape.unwrap_or(shape),
        };
        let spacing = self.spacing.unwrap_or(settings.spacing);
        let diameter = self.boundary_diameter.or(settings.boundary.diameter());
        let diameter = diameter.unwrap_or(BoundaryTreatment::usual_diameter(spacing));
        let treatment = self.boundary.unwrap_or(SavedTreatment::of(settings.boundary));
        Settings {
            spacing,
            transfer,
            boundary: treatment.with_diameter(diameter),
            cleaning: self.cleaning(settings.cleaning),
            gradation: self.gradation.or(settings.gradation),
            rule: self.rule.unwrap_or(settings.rule),
            max_triangles: self.max_triangles.unwrap_or(settings.max_triangles),
            max_memory: self.max_memory.unwrap_or(settings.max_memory),
            ..settings
        }
    }

    /// Whether some layer needs both ends of the scale from the smallest to the largest target diameter.
    pub fn uses_scale(&self) -> bool {
        self.layers.iter().any(LayerSpec::uses_scale)
    }

    /// Checks the curve from risk to diameter.
    ///
    /// # Errors
    /// When its ends or its exponent are impossible.
    pub fn check_transfer(&self) -> Result<(), TransferError> {
        // Where one end is not given, the other takes its place: only the rest is checked then.
        let h_min = self.h_min.or(self.h_max).unwrap_or(1.0);
        let h_max = self.h_max.unwrap_or(h_min);
        Transfer { h_min, h_max, shape: self.exponent() }.checked().map(|_| ())
    }

    /// Exponent of the curve from risk to diameter.
    pub fn exponent(&self) -> f64 {
        self.shape.unwrap_or(1.0)
    }

    /// Which triangles stay: the usual ones, unless the description says otherwise.
    pub fn cleaning(&self, usual: Cleaning) -> Cleaning {
        Cleaning {
            parts: self.parts.unwrap_or(usual.parts),
            keeps_pinches: self.keeps_pinches || usual.keeps_pinches,
        }
    }

    /// Which points of a triangle count. Where that is not given, it suits the layers: the area rule misses
    /// no pixel.
    pub fn rule(&self) -> RefinementRule {
        let is_formula = |layer: &LayerSpec| matches!(layer.kind, KindSpec::Formula { .. });
        self.rule.unwrap_or(match self.layers.iter().all(is_formula) {
            true => RefinementRule::Vertex,
            false => RefinementRule::Area,
        })
    }

    /// What a mesh that is made once may cost; `usual` is the triangle budget where none is given.
    pub fn limits(&self, usual: usize) -> Limits {
        Limits {
            max_triangles: self.max_triangles.unwrap_or(usual),
            max_level: self.max_level,
            max_memory: self.max_memory.map(MemoryLimit::for_one_mesh),
        }
    }

    /// The files that it names.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let of_paths = self.paths.files().map(PathBuf::as_path);
        self.layers.iter().flat_map(LayerSpec::files).chain(self.region.as_deref()).chain(of_paths)
    }
}

impl SavedTreatment {
    /// The kind of a treatment.
    pub fn of(treatment: BoundaryTreatment) -> Self {
        match treatment {
            BoundaryTreatment::Report => Self::Report,
            BoundaryTreatment::Fitted { .. } => Self::Fitted,
            BoundaryTreatment::OnOutline { .. } => Self::Outline,
        }
    }

    /// The treatment of this kind with a diameter at the outline, in world units.
    pub fn with_diameter(self, diameter: f64) -> BoundaryTreatment {
        match self {
            Self::Report => BoundaryTreatment::Report,
            Self::Fitted => BoundaryTreatment::Fitted { diameter },
            Self::Outline => BoundaryTreatment::OnOutline { diameter },
        }
    }
}
