//! Other layers for the shown mesh, followed in place.

use std::sync::Arc;

use super::Settings;
use crate::build::BuildError;
use crate::field::RefinementRule;
use crate::geometry::Lattice;
use crate::layers::{LayerCheck, SizeField};
use crate::mesh::Progress;

/// Checks other layers, limits or gradation in slices. Then the mesh can follow them where h̄ differs.
#[derive(Clone, Debug)]
pub(super) struct LayersUpdate {
    /// The settings with the new layers.
    pub(super) settings: Settings,
    field: Arc<SizeField>,
    check: LayerCheck,
}

impl LayersUpdate {
    /// Whether a mesh can follow in place from some settings to others: only where nothing else differs that
    /// changes the mesh. Under the vertex rule it cannot, as coarsening would leave triangles behind.
    pub(super) fn is_possible(shown: &Settings, wanted: &Settings) -> bool {
        let Settings { layers, transfer, gradation, .. } = wanted.clone();
        wanted.rule == RefinementRule::Area
            && Settings { layers, transfer, gradation, ..shown.clone() }.share_mesh_with(wanted)
    }

    /// The work from the shown to the wanted settings, on the lattice of the shown mesh.
    pub(super) fn new(shown: &Settings, wanted: &Settings, lattice: &Lattice) -> Self {
        let field = SizeField::new(wanted.field_spec(), lattice);
        let check = LayerCheck::of_changed(&field, &shown.layers);
        Self { settings: wanted.clone(), field: Arc::new(field), check }
    }

    /// One slice of work: about `budget` evaluations.
    ///
    /// # Errors
    /// When a layer has a value that no mesh can meet.
    pub(super) fn advance(&mut self, budget: usize) -> Result<Progress, BuildError> {
        Ok(self.check.advance(&self.field, budget)?)
    }

    /// Once done: the settings and their field.
    pub(super) fn finish(self) -> (Settings, Arc<SizeField>) {
        (self.settings, self.field)
    }
}
