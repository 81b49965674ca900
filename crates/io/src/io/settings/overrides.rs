//! Values in place of others: options beside a recipe or a project.

use super::{SavedDomain, SavedLimits, SavedLine, SavedMesh, SavedSettings, SavedTreatment};
use crate::io::KeyFault;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::BoundaryTreatment;
use meshbrush_core::field::Transfer;

impl<L> SavedSettings<L> {
    /// Returns the settings with the values of `options` in place of their own, and with their lines besides
    /// their own. Domain, layers, paths and pins are their own: no option goes with them.
    pub fn overridden_by<O>(self, options: &SavedSettings<O>) -> Self {
        let SavedDomain { open, boundary, boundary_diameter, parts, keep_pinches, improve_boundary, .. } =
            &options.domain;
        let SavedMesh { spacing, rule, max_triangles, max_level, max_memory } = &options.mesh;
        let SavedLimits { h_min, h_risk, h_max, shape, gradation } = options.limits;
        let line: Vec<SavedLine> = self.line.into_iter().chain(options.line.iter().cloned()).collect();
        Self {
            line,
            domain: SavedDomain {
                open: if open.is_empty() { self.domain.open } else { open.clone() },
                boundary: boundary.or(self.domain.boundary),
                boundary_diameter: boundary_diameter.or(self.domain.boundary_diameter),
                parts: parts.or(self.domain.parts),
                keep_pinches: keep_pinches.or(self.domain.keep_pinches),
                improve_boundary: improve_boundary.or(self.domain.improve_boundary),
                ..self.domain
            },
            mesh: SavedMesh {
                spacing: spacing.or(self.mesh.spacing),
                rule: rule.or(self.mesh.rule),
                max_triangles: max_triangles.or(self.mesh.max_triangles),
                max_level: max_level.or(self.mesh.max_level),
                max_memory: max_memory.clone().or(self.mesh.max_memory),
            },
            limits: SavedLimits {
                h_min: h_min.or(self.limits.h_min),
                h_risk: h_risk.or(self.limits.h_risk),
                h_max: h_max.or(self.limits.h_max),
                shape: shape.or(self.limits.shape),
                gradation: gradation.or(self.limits.gradation),
            },
            ..self
        }
    }

    /// Returns the settings of a document with the values that are given here in place of its own.
    ///
    /// # Errors
    /// Fails when a value cannot be used.
    pub fn override_settings(&self, settings: Settings) -> Result<Settings, KeyFault> {
        // Taken apart without `..`: a key that is read and then forgotten would be lost in silence.
        let SavedMesh { spacing, rule, max_triangles, max_level, max_memory: _ } = self.mesh;
        let SavedLimits { h_min, h_risk, h_max, shape, gradation } = self.limits;
        let own = settings.transfer;
        // As in a recipe: the curve ends at the smallest diameter, unless another end is given.
        let own_risk = (own.h_risk != own.h_min).then_some(own.h_risk);
        let h_min = h_min.map_or(own.h_min, Into::into);
        let transfer = Transfer {
            h_min,
            h_risk: h_risk.map(Into::into).or(own_risk).unwrap_or(h_min),
            h_max: h_max.map_or(own.h_max, Into::into),
            shape: shape.unwrap_or(own.shape),
        };
        let spacing = spacing.map_or(settings.spacing, Into::into);
        let diameter = self.domain.boundary_diameter.map(Into::into).or(settings.boundary.diameter());
        let diameter = diameter.unwrap_or_else(|| {
            BoundaryTreatment::default_diameter(settings.domain.longest_on_earth(spacing))
        });
        let treatment = self.domain.boundary.unwrap_or(SavedTreatment::of(settings.boundary));
        Ok(Settings {
            spacing,
            transfer,
            boundary: treatment.with_diameter(diameter),
            cleaning: self.cleaning(settings.cleaning),
            gradation: gradation.or(settings.gradation),
            rule: rule.map_or(settings.rule, Into::into),
            max_triangles: max_triangles.unwrap_or(settings.max_triangles),
            max_memory: self.mesh.memory()?.unwrap_or(settings.max_memory),
            max_level: max_level.or(settings.max_level),
            ..settings
        })
    }
}
