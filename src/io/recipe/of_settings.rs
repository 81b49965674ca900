use super::super::words::{SavedUnit, saved_marks};
use super::saved::{SavedDomain, SavedLimits, SavedMesh, SavedRecipe, SavedTreatment};
use crate::document::Settings;
use crate::domain::{BoundaryTreatment, DomainShape};
use crate::geometry::Rect;
use crate::io::layers::SavedLayer;
use crate::text::LengthUnit;

impl SavedRecipe {
    /// The recipe that makes the mesh of a document, without outputs.
    ///
    /// `region_file` is the name of the file with the polygons of the domain, if it has some: the caller
    /// writes it beside the recipe. `layers` are from the bottom of the stack to its top.
    pub fn of_settings(settings: &Settings, region_file: &str, layers: Vec<SavedLayer>) -> Self {
        let mesh = SavedMesh {
            spacing: Some(settings.spacing),
            rule: Some(settings.rule.into()),
            max_triangles: Some(settings.max_triangles),
            ..SavedMesh::default()
        };
        let limits = SavedLimits {
            h_min: Some(settings.transfer.h_min),
            h_max: Some(settings.transfer.h_max),
            shape: (settings.transfer.shape != 1.0).then_some(settings.transfer.shape),
            gradation: settings.gradation,
        };
        Self { domain: domain(settings, region_file), mesh, limits, layer: layers, output: Vec::new() }
    }
}

fn domain(settings: &Settings, region_file: &str) -> SavedDomain {
    let Rect { min, max } = settings.domain.bounds;
    let (splits, names) = saved_marks(&settings.boundary_marks);
    let rectangle = SavedDomain {
        unit: (settings.unit != LengthUnit::None).then(|| settings.unit.into()),
        splits,
        names,
        ..SavedDomain::default()
    };
    match &settings.domain.shape {
        DomainShape::Whole => SavedDomain { bounds: Some([min.x, min.y, max.x, max.y]), ..rectangle },
        DomainShape::Formula(formula) => SavedDomain {
            bounds: Some([min.x, min.y, max.x, max.y]),
            inside: Some(formula.source().to_owned()),
            ..rectangle
        },
        DomainShape::Region(_) => SavedDomain {
            region: Some(region_file.to_owned()),
            bounds: Some([min.x, min.y, max.x, max.y]),
            unit: Some(rectangle.unit.unwrap_or(SavedUnit::None)),
            boundary: Some(match settings.boundary {
                BoundaryTreatment::Report => SavedTreatment::Report,
                BoundaryTreatment::Fitted { .. } => SavedTreatment::Fitted,
                BoundaryTreatment::OnOutline { .. } => SavedTreatment::Outline,
            }),
            boundary_diameter: settings.boundary.diameter(),
            parts: Some(settings.cleaning.parts.into()),
            keep_pinches: settings.cleaning.keeps_pinches,
            ..rectangle
        },
    }
}
