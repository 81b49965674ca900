use std::mem::Discriminant;
use std::sync::Arc;

use glam::DVec2;

use super::layer_titles::layers_title;
use super::{Background, PathPlan, Settings};
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain, Line};
use crate::field::RefinementRule;
use crate::geometry::Rect;
use crate::layers::Layer;
use crate::mesh::Cleaning;
use crate::text::LengthUnit;

/// One change of one setting, as a menu, a slider, a test or a script sends it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Setting {
    /// Largest side δ̄ of a coarse cell, in world units.
    Spacing(f64),
    /// The smallest target diameter, in world units. Raises the diameter at risk 1 and the largest diameter
    /// where they would be below it.
    SmallestDiameter(f64),
    /// Target diameter at risk 1, in world units. Lowers the smallest diameter where that would be above it,
    /// and raises the largest diameter where that would be below it.
    DiameterAtRiskOne(f64),
    /// The largest target diameter, also that at risk 0, in world units. Lowers the smallest diameter and the
    /// diameter at risk 1 where they would be above it.
    LargestDiameter(f64),
    /// Exponent of the transfer curve.
    TransferShape(f64),
    /// The layers, from the bottom to the top.
    Layers(Vec<Layer>),
    /// Largest change of h̄ per unit of length, or none.
    Gradation(Option<f64>),
    /// Which points of a triangle count.
    RefinementRule(RefinementRule),
    /// Most triangles.
    MaxTriangles(usize),
    /// Most memory for meshes, in bytes.
    MaxMemory(usize),
    /// The deepest level of a triangle, or none.
    MaxLevel(Option<u32>),
    /// The rectangle that the coarse grid covers, in world units.
    Bounds(Rect),
    /// The whole domain.
    Domain(Domain),
    /// Another outline, with what depends on it: see [`Settings::with_outline`].
    Outline {
        /// The domain.
        domain: Domain,
        /// The names of its boundary.
        boundary_marks: Arc<BoundaryMarks>,
    },
    /// How the mesh meets the boundary of the domain.
    Boundary(BoundaryTreatment),
    /// Which triangles of the domain stay in the derived mesh.
    Cleaning(Cleaning),
    /// Names and types of pieces of the boundary, and where it is split.
    BoundaryMarks(BoundaryMarks),
    /// Lines along which the derived mesh has edges.
    Lines(Arc<Vec<Line>>),
    /// Points whose triangles and values are followed, in world units.
    Pins(Arc<Vec<DVec2>>),
    /// The waypoints and the cost of paths.
    Paths(Arc<PathPlan>),
    /// The unit of coordinates and lengths.
    LengthUnit(LengthUnit),
    /// The picture behind the mesh, or none.
    Background(Option<Background>),
}

/// Which setting a [`Setting`] changes, at any value: changes of one kind can be one gesture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SettingKind(Discriminant<Setting>);

impl Setting {
    /// Which setting this changes.
    pub fn kind(&self) -> SettingKind {
        SettingKind(std::mem::discriminant(self))
    }

    /// Returns the name of the change in the history, for display only. `before` are the settings without it.
    pub fn title(&self, before: &Settings) -> &'static str {
        match self {
            Self::Spacing(_) => "coarse spacing",
            Self::SmallestDiameter(_) => "smallest diameter",
            Self::DiameterAtRiskOne(_) => "diameter at risk 1",
            Self::LargestDiameter(_) => "largest diameter",
            Self::TransferShape(_) => "transfer curve",
            Self::Layers(layers) => layers_title(&before.layers, layers),
            Self::Gradation(_) => "gradation",
            Self::RefinementRule(_) => "refinement rule",
            Self::MaxTriangles(_) => "triangle budget",
            Self::MaxMemory(_) => "memory budget",
            Self::MaxLevel(_) => "deepest level",
            Self::Bounds(_) => "domain",
            Self::Domain(_) => "domain shape",
            Self::Outline { .. } => "outline",
            Self::Boundary(_) => "boundary",
            Self::Cleaning(_) => "cleaning",
            Self::BoundaryMarks(_) => "boundary pieces",
            Self::Lines(_) => "lines",
            Self::Pins(_) => "pins",
            Self::Paths(_) => "path",
            Self::LengthUnit(_) => "unit",
            Self::Background(_) => "background",
        }
    }

    /// Returns whether the setting is one of the size: a limit of the diameter, the risk curve, the gradation
    /// or the layers.
    pub fn is_of_size(&self) -> bool {
        matches!(
            self,
            Self::SmallestDiameter(_)
                | Self::DiameterAtRiskOne(_)
                | Self::LargestDiameter(_)
                | Self::TransferShape(_)
                | Self::Gradation(_)
                | Self::Layers(_)
        )
    }

    /// Returns settings with this change, unchecked.
    pub fn applied_to(self, settings: &Settings) -> Settings {
        let mut settings = settings.clone();
        self.apply(&mut settings);
        settings
    }

    pub(super) fn apply(self, settings: &mut Settings) {
        let transfer = &mut settings.transfer;
        match self {
            Self::Spacing(spacing) => settings.spacing = spacing,
            Self::SmallestDiameter(h_min) => *transfer = transfer.with_smallest(h_min),
            Self::DiameterAtRiskOne(h_risk) => {
                transfer.h_risk = h_risk;
                transfer.h_min = transfer.h_min.min(h_risk);
                transfer.h_max = transfer.h_max.max(h_risk);
            }
            Self::LargestDiameter(h_max) => {
                transfer.h_max = h_max;
                transfer.h_min = transfer.h_min.min(h_max);
                transfer.h_risk = transfer.h_risk.min(h_max);
            }
            Self::TransferShape(shape) => transfer.shape = shape,
            Self::Layers(layers) => settings.layers = layers,
            Self::Gradation(gradation) => settings.gradation = gradation,
            Self::RefinementRule(rule) => settings.rule = rule,
            Self::MaxTriangles(max_triangles) => settings.max_triangles = max_triangles,
            Self::MaxMemory(max_memory) => settings.max_memory = max_memory,
            Self::MaxLevel(max_level) => settings.max_level = max_level,
            Self::Bounds(bounds) => settings.domain = settings.domain.with_bounds(bounds),
            Self::Domain(domain) => settings.domain = domain,
            Self::Outline { domain, boundary_marks } => {
                (settings.domain, settings.boundary_marks) = (domain, boundary_marks);
            }
            Self::Boundary(boundary) => settings.boundary = boundary,
            Self::Cleaning(cleaning) => settings.cleaning = cleaning,
            Self::BoundaryMarks(marks) => settings.boundary_marks = Arc::new(marks),
            Self::Lines(lines) => settings.lines = lines,
            Self::Pins(pins) => settings.pins = pins,
            Self::Paths(paths) => settings.paths = paths,
            Self::LengthUnit(unit) => settings.unit = unit,
            Self::Background(background) => settings.background = background,
        }
        settings.find_straits();
    }
}
