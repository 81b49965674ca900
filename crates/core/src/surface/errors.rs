//! The largest errors that layers of errors allow in place of those of surfaces.

use glam::DVec2;

use crate::layers::{Layer, PaintLayers};

/// The visible layers of a stack that say how large errors may be, with their pixels.
#[derive(Clone, Debug, Default)]
pub(super) struct ErrorLayers {
    /// From the top to the bottom.
    layers: Vec<Layer>,
    paint: PaintLayers,
}

impl ErrorLayers {
    /// Returns the layers of errors of a stack. They share its pixels.
    pub(super) fn new(stack: &[Layer], paint: &PaintLayers) -> Self {
        let of_errors = stack.iter().rev().filter(|layer| layer.visible && layer.is_of_errors());
        let layers: Vec<Layer> = of_errors.cloned().collect();
        let paint = paint.of_layers(layers.iter().map(|layer| layer.id));
        Self { layers, paint }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.layers.is_empty()
    }

    /// Returns the largest error at a point in world units: that of the topmost layer that says one.
    pub(super) fn at(&self, point: DVec2) -> Option<f64> {
        self.layers.iter().find_map(|layer| layer.error_at(&self.paint, point))
    }
}
