//! The changes that the shown mesh does not have yet, or that a stroke would make, as far as knowing them
//! makes tests of triangles cheaper.

use std::sync::{Arc, Weak};

use crate::layers::{LayerId, LevelCachePool, PaintChange, PaintLayers, SizeField};
use crate::mesh::{ChangedArea, TargetChange};

/// The changes since the shown mesh was up to date, and the answers of the fields that decide about them.
#[derive(Clone, Debug, Default)]
pub(super) struct Pending {
    /// `Some` if nothing has changed but that these layers ask for smaller diameters in places. Without
    /// doubles.
    finer: Option<Vec<LayerId>>,
    /// [`SizeField::of_layers_alone`] of the layers that asked for less the last time.
    alone: Option<Alone>,
    /// What the field of all layers has answered.
    known: LevelCachePool,
}

/// A field of some layers of another one.
#[derive(Clone, Debug)]
struct Alone {
    layers: Vec<LayerId>,
    /// Not kept longer than its document.
    whole: Weak<SizeField>,
    field: SizeField,
    known: LevelCachePool,
}

impl Pending {
    /// Forgets what fields have answered where pixels have changed.
    pub(super) fn forget(&mut self, changes: &[PaintChange], field: &SizeField) {
        let areas = || changes.iter().map(|change| change.area);
        self.known.all_mut().iter_mut().for_each(|squares| field.forget(squares, areas()));
        if let Some(Alone { field, known, .. }) = &mut self.alone {
            known.all_mut().iter_mut().for_each(|squares| field.forget(squares, areas()));
        }
    }

    /// Notes that paint has changed; `was_in_step` says whether the mesh was in step before.
    pub(super) fn paint(&mut self, was_in_step: bool, changes: &[PaintChange], field: &Arc<SizeField>) {
        self.forget(changes, field);
        let is_finer = changes.iter().all(|change| change.change == TargetChange::Finer);
        let layers = is_finer.then(|| changes.iter().map(|change| change.layer).collect());
        self.finer(was_in_step, layers, field);
    }

    /// Notes that the mesh follows another field, in which only these layers ask for other diameters, all of
    /// them smaller; `None` where that is not so.
    pub(super) fn field_changed(
        &mut self,
        was_in_step: bool,
        layers: Option<Vec<LayerId>>,
        field: &Arc<SizeField>,
    ) {
        (self.alone, self.known) = (None, LevelCachePool::default());
        self.finer(was_in_step, layers, field);
    }

    /// Notes that something besides paint has changed.
    pub(super) fn anything(&mut self) {
        *self = Self::default();
    }

    fn finer(&mut self, was_in_step: bool, more: Option<Vec<LayerId>>, whole: &Arc<SizeField>) {
        let earlier = if was_in_step { Some(Vec::new()) } else { self.finer.take() };
        self.finer = None;
        let (Some(mut layers), Some(more)) = (earlier, more) else { return };
        for layer in more {
            if !layers.contains(&layer) {
                layers.push(layer);
            }
        }
        let is_known = |alone: &Alone| alone.layers == layers && alone.whole.ptr_eq(&Arc::downgrade(whole));
        if !self.alone.as_ref().is_some_and(is_known) {
            let field = whole.of_layers_alone(&layers);
            let (whole, layers) = (Arc::downgrade(whole), layers.clone());
            self.alone = field.map(|field| Alone { layers, whole, field, known: LevelCachePool::default() });
        }
        self.finer = self.alone.is_some().then_some(layers);
    }

    /// Returns where and how h̄ of the field of all layers can have changed after changes of pixels.
    /// [`Self::paint`] must have noted them.
    pub(super) fn changed_areas(
        &self,
        changes: &[PaintChange],
        field: &SizeField,
        paint: &PaintLayers,
    ) -> Vec<ChangedArea> {
        let mut squares = self.known.take();
        let areas = field.changes_by_paint(&mut squares, changes, paint);
        self.known.put_back(squares);
        areas
    }

    /// Returns the field that says which triangles of the shown mesh exceed their targets, and what it has
    /// answered; `whole` is the field of all layers.
    pub(super) fn field<'a>(&'a self, whole: &'a SizeField) -> (&'a SizeField, &'a LevelCachePool) {
        match (&self.finer, &self.alone) {
            (Some(_), Some(Alone { field, known, .. })) => (field, known),
            _ => (whole, &self.known),
        }
    }
}
