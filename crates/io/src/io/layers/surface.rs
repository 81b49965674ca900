//! The keys of layers of surfaces.

use super::check_layer::{CheckedKind, Stored, compiled};
use super::checks::number_where;
use super::{SavedKind, SavedLayer};
use crate::io::KeyFault;
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{LayerKind, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource};

impl SavedLayer {
    /// Returns a layer of a surface, without a file.
    pub(super) fn of_surface(surface: &Surface) -> Self {
        let layer = Self {
            formula: match &surface.source {
                SurfaceSource::Raster(_) => None,
                SurfaceSource::Formula(formula) => Some(formula.source().to_owned()),
            },
            norm: (surface.norm != SurfaceNorm::default()).then(|| surface.norm.into()),
            ..Self::of_kind(SavedKind::Surface)
        };
        match surface.goal {
            SurfaceGoal::Within(error) => Self { within: Some(error), ..layer },
            SurfaceGoal::AtMost(count) => Self { at_most: Some(count), ..layer },
        }
    }

    /// Returns the surface of a formula, or what is asked of that of a raster.
    pub(super) fn checked_surface(&self, stored: Stored) -> Result<CheckedKind, KeyFault> {
        let (goal, norm) =
            (self.surface_goal()?, self.norm.map_or_else(SurfaceNorm::default, SurfaceNorm::from));
        match (&self.formula, &self.file) {
            (Some(_), Some(_)) => {
                Err(KeyFault::key("formula", "the surface is in `file` or in `formula`, not in both."))
            }
            (Some(text), None) => {
                let source = SurfaceSource::Formula(compiled("formula", text, Formula::parse)?);
                Ok(CheckedKind::Complete(LayerKind::Surface(Surface { source, goal, norm })))
            }
            (None, Some(_)) => {
                self.check_raster_file(stored)?;
                Ok(CheckedKind::Surface(goal, norm))
            }
            (None, None) => Err(self.missing("needs `file`, a raster, or `formula`")),
        }
    }

    fn surface_goal(&self) -> Result<SurfaceGoal, KeyFault> {
        match (self.within, self.at_most) {
            (Some(error), None) => {
                number_where(error, error > 0.0, "an error must be positive and finite")
                    .map_err(|fault| fault.within("within"))?;
                Ok(SurfaceGoal::Within(error))
            }
            (None, Some(count)) => {
                number_where(count as f64, count > 0, "a mesh has one triangle at least")
                    .map_err(|fault| fault.within("at_most"))?;
                Ok(SurfaceGoal::AtMost(count))
            }
            (Some(_), Some(_)) => {
                Err(KeyFault::key("at_most", "a surface has `within` or `at_most`, not both."))
            }
            (None, None) => Err(self
                .missing("needs `within`, the largest error, or `at_most`, the largest number of triangles")),
        }
    }
}
