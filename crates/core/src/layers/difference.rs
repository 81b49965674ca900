//! What an edit changes: of a size field, and of the risk that paths follow. This is the one place that
//! decides it.
//!
//! h̄ before gradation is a function of what each layer asks for at the same point, and a monotone one: where
//! a layer asks for a smaller diameter than before, h̄ does not grow. In a layer in which the finest counts,
//! a request for nothing is an infinite diameter. For a floor and a replacement it is not, and a direction
//! is claimed only where they ask in the same places as before. So an edit is taken apart into steps, each
//! of which changes one layer or the limits:
//!
//! ```text
//!   old stack ─▶ layers leave ─▶ others change places ─▶ layers change ─▶ layers join ─▶ limits ─▶ new stack
//! ```
//!
//! Each step has an area, outside of which h̄ before gradation stays as it is, and a direction. Both
//! specifications are taken apart completely, without `..`: a new field does not compile until somebody has
//! decided what it changes.

use std::sync::Arc;

use super::extent::{Extent, ExtentContext};
use super::kinds::areas_that_differ;
use super::risk::{RiskField, RiskLayer};
use super::risk_source::RiskSource;
use super::value_change::{LayerEdit, ValueChange, direction};
use super::{Combine, Layer, LayerId, PaintLayers, SizeFieldSpec, hidden_differently, surface_changes};
use crate::field::Transfer;
use crate::geometry::Rect;
use crate::mesh::TargetChange::{self, Any, Coarser, Finer};

/// One step from a specification of a size field to another.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpecChange {
    /// The area in which h̄ before gradation can differ.
    pub area: Extent,
    /// The direction of the change.
    pub change: TargetChange,
    /// The layer that changes, if it is one in which the finest counts: h̄ changes only where that is what it
    /// asks for before or after.
    pub layer: Option<LayerId>,
}

/// The common settings of both specifications of an edit, and the difference of their outlines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circumstances<'a> {
    /// The painted pixels.
    pub paint: &'a PaintLayers,
    /// The diameter of a coarse triangle in world units: nothing coarser than this matters to a mesh.
    pub longest: f64,
    /// How many times longer than on the Earth a length counts in the plane; 1 without a projection.
    pub greatest_scale: f64,
    /// Rectangles in world units that hold every edge that only one of the two outlines has, if they are
    /// known.
    pub outline_areas: Option<&'a [Rect]>,
}

impl SizeFieldSpec {
    /// Returns the steps from an earlier specification to this one; none where the mesh is the same.
    pub(crate) fn difference(&self, old: &Self, circumstances: &Circumstances) -> Vec<SpecChange> {
        let new = self;
        let Self { layers, transfer, unasked, outline, gradation, projection } = new;
        let now = limits(transfer, *unasked, circumstances.longest);
        let (layers_now, outline_now, slope_now) = (layers, outline, slope(*gradation));
        let plane_now = projection;
        let Self { layers, transfer, unasked, outline, gradation, projection } = old;
        let before = limits(transfer, *unasked, circumstances.longest);

        let mut steps = Steps {
            new: circumstances.extents(new),
            old: circumstances.extents(old),
            outline_areas: circumstances.outline_areas,
            has_new_curve: !new.transfer.has_curve_of(transfer),
            has_new_outline: outline_now != outline,
            is_ordered: [new, old].iter().all(|spec| spec.is_ordered(circumstances.longest)),
            changes: Vec::new(),
        };
        steps.add_layers(layers_now, layers);
        steps.add_everywhere(direction(now.numbers(), before.numbers()));
        steps.add_everywhere(direction([slope_now], [slope(*gradation)]));
        // Every length means another one.
        steps.add_everywhere((plane_now != projection).then_some(Any));
        steps.changes
    }
}

impl SizeFieldSpec {
    /// Returns whether h̄ is nowhere larger than where no layer asks for anything, as far as it matters to a
    /// mesh with coarse triangles of the diameter `longest`, in world units. Otherwise a layer that asks for
    /// more can let h̄ grow.
    pub(super) fn is_ordered(&self, longest: f64) -> bool {
        self.unasked >= self.transfer.h_max.min(longest)
    }
}

impl SizeFieldSpec {
    /// Returns where a layer of the stack can ask for something that matters to a mesh, in world units.
    pub(crate) fn extent_of(&self, layer: &Layer, circumstances: &Circumstances) -> Extent {
        circumstances.extents(self).of(layer)
    }
}

impl<'a> Circumstances<'a> {
    fn extents(&self, spec: &'a SizeFieldSpec) -> StackExtents<'a> {
        let Self { paint, longest, greatest_scale, outline_areas: _ } = *self;
        let ceiling = spec.transfer.h_max.min(longest);
        let is_ordered = spec.is_ordered(longest);
        let outline = spec.outline.as_ref();
        let context = ExtentContext { ceiling, is_ordered, outline, paint, greatest_scale };
        StackExtents { layers: &spec.layers, context }
    }
}

/// The limits of h̄, as far as they matter to a mesh, in world units.
#[derive(Clone, Copy, Debug)]
struct Limits {
    h_min: f64,
    h_max: f64,
    unasked: f64,
}

fn limits(transfer: &Transfer, unasked: f64, longest: f64) -> Limits {
    let Transfer { h_min, h_risk: _, h_max, shape: _ } = *transfer;
    Limits { h_min: h_min.min(longest), h_max: h_max.min(longest), unasked: unasked.min(h_max).min(longest) }
}

impl Limits {
    fn numbers(self) -> [f64; 3] {
        [self.h_min, self.h_max, self.unasked]
    }
}

/// Returns a limit of the slope as a number.
fn slope(gradation: Option<f64>) -> f64 {
    gradation.unwrap_or(f64::INFINITY)
}

/// Returns the change of h̄ where a layer no longer has a target.
fn when_lost(combine: Combine) -> TargetChange {
    match combine {
        Combine::Finest => Coarser,
        Combine::Floor => Finer,
        Combine::Replace => Any,
    }
}

/// Returns the change of h̄ where a layer gets a target.
fn when_gained(combine: Combine) -> TargetChange {
    match combine {
        Combine::Finest => Finer,
        Combine::Floor => Coarser,
        Combine::Replace => Any,
    }
}

/// Where the layers of a stack can ask for something.
struct StackExtents<'a> {
    layers: &'a [Layer],
    context: ExtentContext<'a>,
}

impl StackExtents<'_> {
    /// Returns where a layer of the stack, if it is visible, can ask for something that matters to the mesh.
    fn of(&self, layer: &Layer) -> Extent {
        let extent = match &layer.kind {
            kind if kind.is_of_errors() => Extent::NOTHING,
            kind if kind.uses_depth() => Extent::of(surface_changes(self.layers, &[])),
            kind => kind.extent(layer.slot(), &self.context),
        };
        extent.within_mask(layer.mask.as_ref())
    }
}

/// The steps of an edit, as far as they are known.
struct Steps<'a> {
    new: StackExtents<'a>,
    old: StackExtents<'a>,
    outline_areas: Option<&'a [Rect]>,
    has_new_curve: bool,
    has_new_outline: bool,
    /// See [`SizeFieldSpec::is_ordered`].
    is_ordered: bool,
    changes: Vec<SpecChange>,
}

impl Steps<'_> {
    /// A change of a layer, of which `combine` says how it was and is combined with others.
    fn add(&mut self, layer: &Layer, combine: Combine, area: Extent, change: TargetChange) {
        if area != Extent::Within(Vec::new()) {
            let is_plain = self.is_ordered && combine == Combine::Finest;
            let change = if self.is_ordered { change } else { Any };
            self.changes.push(SpecChange { area, change, layer: is_plain.then_some(layer.id) });
        }
    }

    /// Limits have a direction in any case.
    fn add_everywhere(&mut self, change: Option<TargetChange>) {
        let change = change.map(|change| SpecChange { area: Extent::Everywhere, change, layer: None });
        self.changes.extend(change);
    }

    /// A change wherever one of two states of a layer asks for something.
    fn add_both(&mut self, new: &Layer, old: &Layer, change: TargetChange) {
        let (before, after) = (self.old.of(old), self.new.of(new));
        let combine = if new.combine == Combine::Finest { old.combine } else { new.combine };
        if before != after {
            self.add(old, combine, before, change);
        }
        self.add(new, combine, after, change);
    }

    fn add_layers(&mut self, new: &[Layer], old: &[Layer]) {
        let visible = |layers: &[Layer], of: &Layer| {
            of.visible && layers.iter().any(|layer| layer.id == of.id && layer.visible)
        };
        for layer in old.iter().filter(|layer| layer.visible && !visible(new, layer)) {
            self.add(layer, layer.combine, self.old.of(layer), when_lost(layer.combine));
        }
        let stayed: Vec<&Layer> = old.iter().filter(|layer| visible(new, layer)).collect();
        let kept: Vec<&Layer> = new.iter().filter(|layer| visible(old, layer)).collect();
        self.add_new_order(&kept, &stayed);
        for layer in kept {
            if let Some(before) = stayed.iter().find(|before| before.id == layer.id) {
                self.add_layer(layer, before);
                let hidden = Extent::of(hidden_differently(layer, new, old));
                self.add(layer, Combine::Replace, hidden, Any);
                if layer.kind.uses_depth() {
                    self.add(layer, layer.combine, Extent::of(surface_changes(new, old)), Any);
                }
            }
        }
        for layer in new.iter().filter(|layer| layer.visible && !visible(old, layer)) {
            self.add(layer, layer.combine, self.new.of(layer), when_gained(layer.combine));
        }
    }

    /// Adds the changes by another order of equal layers. Where only the finest layer counts, the order does
    /// not matter.
    fn add_new_order(&mut self, new: &[&Layer], old: &[&Layer]) {
        let is_same = |(new, old): &(&&Layer, &&Layer)| new.id == old.id;
        let first = new.iter().zip(old).take_while(is_same).count();
        let last = new[first..].iter().rev().zip(old[first..].iter().rev()).take_while(is_same).count();
        let moved = &old[first..old.len() - last];
        if moved.iter().any(|layer| layer.combine != Combine::Finest) {
            for layer in moved {
                // Its request can now count for more or for less, whatever it is.
                self.add(layer, Combine::Replace, self.old.of(layer), Any);
            }
        }
    }

    /// Two states of a layer that is visible in both.
    fn add_layer(&mut self, new: &Layer, old: &Layer) {
        let Layer { id: _, name: _, visible: _, locked: _, combine, mask, kind } = new;
        let Layer {
            id: _,
            name: _,
            visible: _,
            locked: _,
            combine: old_combine,
            mask: old_mask,
            kind: old_kind,
        } = old;
        if combine != old_combine {
            return self.add_both(new, old, Any);
        }
        let has_new_values = kind != old_kind
            || (self.has_new_curve && new.is_of_risk())
            || (self.has_new_outline && new.kind.is_of_outline());
        match (mask, old_mask) {
            _ if mask == old_mask => {}
            (Some(_), None) if !has_new_values => {
                self.add(old, *combine, self.old.of(old), when_lost(*combine))
            }
            (None, Some(_)) if !has_new_values => {
                self.add(new, *combine, self.new.of(new), when_gained(*combine))
            }
            _ => return self.add_both(new, old, Any),
        }
        if has_new_values {
            self.add_values(new, old);
        }
    }

    /// Two states of a layer with the same mask and combination, but other values.
    fn add_values(&mut self, new: &Layer, old: &Layer) {
        if self.has_new_curve && (new.is_of_risk() || old.is_of_risk()) {
            return self.add_both(new, old, Any);
        }
        if new.is_of_errors() && old.is_of_errors() {
            return;
        }
        let edit = LayerEdit {
            combine: new.combine,
            new: &self.new.context,
            old: &self.old.context,
            has_new_outline: self.has_new_outline,
            outline_areas: self.outline_areas,
        };
        match new.kind.change_since(&*old.kind, &edit) {
            ValueChange::Nothing => {}
            ValueChange::Anywhere(change) => self.add_both(new, old, change),
            ValueChange::Within(steps) => {
                for (rects, change) in steps {
                    let change = if new.combine == Combine::Finest { change } else { Any };
                    let area = Extent::of(rects).within_mask(new.mask.as_ref());
                    self.add(new, new.combine, area, change);
                }
            }
        }
    }
}

impl RiskField {
    /// Rectangles in world units on the closed union of which the risk can differ from that of another
    /// stack. `None` where it can differ anywhere.
    pub fn areas_that_differ(&self, other: &Self) -> Option<Vec<Rect>> {
        let (Self { layers, inside }, Self { layers: before, inside: inside_before }) = (self, other);
        if layers.len() != before.len() || inside != inside_before {
            return None;
        }
        let areas = layers.iter().zip(before).map(|(layer, before)| risk_areas(layer, before));
        areas.collect::<Option<Vec<_>>>().map(|areas| areas.concat())
    }
}

/// Where two states of a layer of risk can have other risks.
fn risk_areas(new: &RiskLayer, old: &RiskLayer) -> Option<Vec<Rect>> {
    let RiskLayer { combine, mask, source } = new;
    let RiskLayer { combine: old_combine, mask: old_mask, source: old_source } = old;
    if combine != old_combine || mask != old_mask {
        return None;
    }
    let is_same = match (source, old_source) {
        (RiskSource::Paint(new), RiskSource::Paint(old)) => return new.areas_that_differ(old),
        (RiskSource::Threats(new), RiskSource::Threats(old)) => {
            return Some(areas_that_differ(new, old));
        }
        (RiskSource::Raster(new), RiskSource::Raster(old)) => Arc::ptr_eq(new, old),
        (RiskSource::Formula(new), RiskSource::Formula(old)) => new == old,
        (
            RiskSource::Paint(_) | RiskSource::Threats(_) | RiskSource::Raster(_) | RiskSource::Formula(_),
            _,
        ) => false,
    };
    is_same.then(Vec::new)
}

#[cfg(test)]
mod tests;
