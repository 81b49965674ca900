//! Layers that change nothing.

use super::Settings;
use crate::geometry::Lattice;
use crate::layers::{LayerId, PaintLayers, SizeField};

impl Settings {
    /// Returns the visible layers that change nothing in the rectangle of the domain; see
    /// [`SizeField::idle_layers`].
    pub fn idle_layers(&self, paint: &PaintLayers) -> Vec<LayerId> {
        let lattice = Lattice::covering(self.domain.bounds, self.spacing, self.max_triangles);
        let field = lattice.ok().map(|lattice| SizeField::new(self.field_spec(), &lattice));
        field.map_or_else(Vec::new, |field| field.idle_layers(paint))
    }
}
