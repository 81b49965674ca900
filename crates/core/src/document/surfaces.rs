//! What settings say about surfaces that the mesh is to be close to.

use super::{Settings, SettingsError};
use crate::domain::BoundaryTreatment;
use crate::field::RefinementRule;
use crate::layers::{Layer, LayerKind, Surface};
use crate::surface::domain_on_samples;

impl Settings {
    pub(super) fn check_surfaces(&self) -> Result<(), SettingsError> {
        for layer in &self.layers {
            if let Some(surface) = layer.kind.get::<Surface>() {
                let refused = |error| SettingsError::Surface { layer: layer.name.clone(), error };
                surface.goal.check().map_err(refused)?;
            }
        }
        Ok(())
    }

    /// Returns whether the mesh is to be close to a surface. Then it is rebuilt after each edit: a triangle
    /// that is close enough may have parts that are not, so that coarsening would leave triangles behind.
    pub fn has_surface(&self) -> bool {
        self.surfaces().next().is_some()
    }

    /// Returns whether edits are followed in place: the mesh is by the area rule, and close to no surface.
    pub fn is_updated_in_place(&self) -> bool {
        self.rule == RefinementRule::Area && !self.has_surface()
    }

    /// Returns the visible layers of surfaces.
    pub fn surfaces(&self) -> impl Iterator<Item = (&Layer, &Surface)> {
        let visible = self.layers.iter().filter(|layer| layer.visible);
        visible.filter_map(|layer| Some((layer, layer.kind.get()?)))
    }

    /// Returns these settings with a domain and a spacing whose nodes are at the samples of a surface;
    /// unchanged for other kinds of layers, and for samples that no nodes can be at.
    pub fn with_nodes_on_samples(self, kind: &LayerKind) -> Self {
        let Some(surface) = kind.get::<Surface>() else { return self };
        let raster = surface.source.raster().map(|source| source.raster.raster());
        match raster.and_then(|raster| domain_on_samples(raster, None)) {
            Some((bounds, spacing)) => {
                let boundary = BoundaryTreatment::default_for(self.domain.longest_on_earth(spacing));
                Self { domain: self.domain.with_bounds(bounds), spacing, boundary, ..self }
            }
            None => self,
        }
    }
}
