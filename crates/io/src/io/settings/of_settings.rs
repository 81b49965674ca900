use glam::DVec2;

use super::{
    SavedDomain, SavedKeepOut, SavedLimits, SavedLine, SavedMesh, SavedPaths, SavedPins, SavedProblem,
    SavedSettings, SavedTreatment, SavedUnit, saved_marks,
};
use crate::io::lengths::WrittenLengths;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryTreatment, DomainShape};
use meshbrush_core::field::Transfer;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Bytes, LengthUnit};

impl<L> SavedSettings<L> {
    /// Returns the tables that make the mesh of a document, without outputs.
    ///
    /// `region_file` is the name of the file with the polygons of the domain, if it has some: the caller
    /// writes it. `layers` are from the bottom of the stack to its top, and `keep_out` are the regions that
    /// paths stay out of: the caller decides which of their data are in files.
    pub fn of(settings: &Settings, region_file: &str, layers: Vec<L>, keep_out: Vec<SavedKeepOut>) -> Self {
        let mesh = SavedMesh {
            spacing: Some(settings.spacing.into()),
            rule: Some(settings.rule.into()),
            max_triangles: Some(settings.max_triangles),
            max_memory: (settings.max_memory != Settings::MAX_MEMORY)
                .then(|| Bytes(settings.max_memory).exactly()),
            max_level: settings.max_level,
        };
        let Transfer { h_min, h_risk, h_max, shape } = settings.transfer;
        let limits = SavedLimits {
            h_min: Some(h_min.into()),
            h_risk: (h_risk != h_min).then_some(h_risk.into()),
            h_max: Some(h_max.into()),
            shape: (shape != 1.0).then_some(shape),
            gradation: settings.gradation,
        };
        Self {
            domain: domain(settings, region_file),
            mesh,
            limits,
            layer: layers,
            paths: SavedPaths::of(&settings.paths),
            keep_out,
            line: settings.lines.iter().map(SavedLine::of).collect(),
            problem: SavedProblem::default(),
            pins: SavedPins { at: settings.pins.iter().map(DVec2::to_array).collect() },
            output: Vec::new(),
            lengths: WrittenLengths::default(),
        }
    }
}

fn domain(settings: &Settings, region_file: &str) -> SavedDomain {
    let Rect { min, max } = settings.domain.bounds;
    let (splits, names, types) = saved_marks(&settings.boundary_marks);
    let rectangle = SavedDomain {
        unit: (settings.unit != LengthUnit::None).then(|| settings.unit.into()),
        splits,
        names,
        types,
        ..SavedDomain::default()
    };
    let rectangle = SavedDomain { bounds: Some([min.x, min.y, max.x, max.y]), ..rectangle };
    // A mesh that is not fitted is not cleaned, whatever the settings say about parts.
    let is_fitted = settings.boundary != BoundaryTreatment::Report;
    let with_outline = |domain: SavedDomain| SavedDomain {
        boundary: Some(SavedTreatment::of(settings.boundary)),
        boundary_diameter: settings.boundary.diameter().map(Into::into),
        parts: is_fitted.then(|| settings.cleaning.parts.into()),
        keep_pinches: (is_fitted && settings.cleaning.keeps_pinches).then_some(true),
        improve_boundary: (is_fitted && settings.cleaning.improves_boundary).then_some(true),
        ..domain
    };
    match &settings.domain.shape {
        DomainShape::Whole => rectangle,
        DomainShape::Formula(shape) => {
            with_outline(SavedDomain { inside: Some(shape.formula().source().to_owned()), ..rectangle })
        }
        DomainShape::Region(_) => with_outline(SavedDomain {
            region: Some(region_file.into()),
            projection: settings.domain.projection.map(|projection| projection.to_string()),
            unit: Some(rectangle.unit.unwrap_or(SavedUnit::None)),
            ..rectangle
        }),
    }
}
