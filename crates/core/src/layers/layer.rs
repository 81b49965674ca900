use glam::DVec2;

use super::{Combine, LayerId, LayerKind, LayerSlot, Mask, PaintLayer, PaintLayers, Quantity};
use crate::field::f32_not_below;

/// One layer of the size field.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Which layer it is.
    pub id: LayerId,
    /// The name that a person gave the layer.
    pub name: String,
    /// A hidden layer asks for nothing.
    pub visible: bool,
    /// A locked layer cannot be edited.
    pub locked: bool,
    /// How it is combined with the layers below.
    pub combine: Combine,
    /// The area in which the layer counts; everywhere without a mask.
    pub mask: Option<Mask>,
    /// The kind of the layer, with its settings.
    pub kind: LayerKind,
}

impl Layer {
    /// Returns the layers of a new document: `base`, and paint of both kinds over it.
    pub fn default_stack(base: LayerKind) -> Vec<Self> {
        let paint = [Quantity::Diameter, Quantity::Risk].map(LayerKind::paint);
        let mut layers = Self::stack([base].into_iter().chain(paint));
        layers[0].name = "Base".into();
        layers
    }

    /// Creates a visible layer in which the finest counts.
    pub fn new(id: LayerId, name: impl Into<String>, kind: impl Into<LayerKind>) -> Self {
        let (combine, kind) = (Combine::Finest, kind.into());
        Self { id, name: name.into(), visible: true, locked: false, combine, mask: None, kind }
    }

    /// Returns a stack of layers, from the bottom to the top, named after their kinds and numbered from 0.
    pub fn stack(kinds: impl IntoIterator<Item: Into<LayerKind>>) -> Vec<Self> {
        let layer = |(id, kind): (u32, LayerKind)| Self::new(LayerId(id), kind.label(), kind);
        (0..).zip(kinds.into_iter().map(Into::into)).map(layer).collect()
    }

    /// Returns which layer it is, and how it is combined.
    pub(super) fn slot(&self) -> LayerSlot {
        LayerSlot { id: self.id, combine: self.combine }
    }

    /// Returns the risk that the layer has at a point in world units, if it is one of risk with a value
    /// there.
    pub fn risk_at(&self, paint: &PaintLayers, point: DVec2) -> Option<f64> {
        if self.mask.as_ref().is_some_and(|mask| !mask.contains(point)) {
            return None;
        }
        self.kind.risk_at(point, paint.get(self.id))
    }

    /// Returns whether its values are risks, so that the transfer curve matters.
    pub fn is_of_risk(&self) -> bool {
        self.kind.is_of_risk()
    }

    /// Returns whether it changes with the boundary of the domain.
    pub fn follows_outline(&self) -> bool {
        self.kind.follows_outline()
    }

    /// Returns whether the layer says how large errors from surfaces may be.
    pub fn is_of_errors(&self) -> bool {
        self.kind.is_of_errors()
    }

    /// Returns the largest error from surfaces that the layer allows at a point in world units; `None` where
    /// it says nothing: it is of something else, its mask ends, nothing is painted, or its number is not
    /// positive and finite.
    pub fn error_at(&self, paint: &PaintLayers, point: DVec2) -> Option<f64> {
        if self.mask.as_ref().is_some_and(|mask| !mask.contains(point)) {
            return None;
        }
        let error = self.kind.error_at(point, paint.get(self.id))?;
        // As paint has it, so that all layers agree.
        (error > 0.0 && error.is_finite()).then(|| f64::from(f32_not_below(error)))
    }

    /// Returns the data that other layers may share, its mask among them: the address of each and its size in
    /// bytes.
    pub(crate) fn shared_data(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        self.mask.as_ref().map(Mask::shared_data).into_iter().chain(self.kind.shared_data())
    }

    /// Returns the quantity that is painted on the layer, if it is a paint layer.
    pub fn paints(&self) -> Option<Quantity> {
        self.kind.get::<PaintLayer>().map(|paint| paint.quantity)
    }
}
