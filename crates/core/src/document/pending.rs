//! What the shown mesh waits for, as far as it makes questions about triangles cheaper.

use std::sync::Arc;

use crate::layers::{LayerId, PaintChange, SizeField};
use crate::mesh::TargetChange;

/// What has changed since the shown mesh was in step.
#[derive(Clone, Debug, Default)]
pub(super) enum Pending {
    /// These layers ask for smaller diameters in places, and nothing else has changed.
    Finer {
        /// Without doubles.
        layers: Vec<LayerId>,
        /// [`SizeField::of_layers_alone`].
        field: Arc<SizeField>,
    },
    /// Anything.
    #[default]
    Any,
}

impl Pending {
    /// Notes that paint has changed; `was_in_step` says whether the mesh was in step before.
    pub(super) fn paint(&mut self, was_in_step: bool, changes: &[PaintChange], field: &SizeField) {
        let is_finer = changes.iter().all(|change| change.change == TargetChange::Finer);
        let layers = is_finer.then(|| changes.iter().map(|change| change.layer).collect());
        let known = match self {
            Self::Finer { layers, field } if !was_in_step => Some((layers.len(), field.clone())),
            _ => None,
        };
        self.finer(was_in_step, layers, |layers| match known {
            Some((count, field)) if count == layers.len() => Some(field),
            _ => field.of_layers_alone(layers).map(Arc::new),
        });
    }

    /// Notes that the mesh follows another field, in which only these layers ask for other diameters, all of
    /// them smaller; `None` where that is not so.
    pub(super) fn field_changed(
        &mut self,
        was_in_step: bool,
        layers: Option<Vec<LayerId>>,
        field: &SizeField,
    ) {
        self.finer(was_in_step, layers, |layers| field.of_layers_alone(layers).map(Arc::new));
    }

    /// Notes that something besides the size field has changed.
    pub(super) fn anything(&mut self) {
        *self = Self::Any;
    }

    fn finer(
        &mut self,
        was_in_step: bool,
        more: Option<Vec<LayerId>>,
        field: impl FnOnce(&[LayerId]) -> Option<Arc<SizeField>>,
    ) {
        let earlier = match std::mem::take(self) {
            _ if was_in_step => Some(Vec::new()),
            Self::Finer { layers, .. } => Some(layers),
            Self::Any => None,
        };
        let (Some(mut layers), Some(more)) = (earlier, more) else { return };
        for layer in more {
            if !layers.contains(&layer) {
                layers.push(layer);
            }
        }
        if let Some(field) = field(&layers) {
            *self = Self::Finer { layers, field };
        }
    }

    /// The field that says which triangles of the shown mesh exceed their targets; `whole` is the field of
    /// all layers.
    pub(super) fn field<'a>(&'a self, whole: &'a SizeField) -> &'a SizeField {
        match self {
            Self::Finer { field, .. } => field,
            Self::Any => whole,
        }
    }
}
