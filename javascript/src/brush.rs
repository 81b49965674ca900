//! Strokes of a brush.

use meshbrush_core::layers::LayerId;
use meshbrush_core::paint::{Brush, Medium, Mirror};
use wasm_bindgen::prelude::*;

use crate::document::Core;
use crate::errors::{error, refused};
use crate::values::points_of;

#[wasm_bindgen]
impl Core {
    /// Paints a line through points, x and y in turn, as one edit. `quantity` is "diameter", "risk", "error"
    /// or "eraser". `mirror` has the x and the y of mirrors, NaN for none. `layer` is the layer to paint on;
    /// without it, it is chosen as the window does.
    ///
    /// # Errors
    /// Fails for a brush that is impossible, points that are not finite, and where there is no layer to paint
    /// on.
    #[expect(clippy::too_many_arguments, reason = "a brush, and where it goes")]
    pub fn paint(
        &mut self,
        points: &[f64],
        quantity: &str,
        value: f64,
        change: &str,
        radius: f64,
        hardness: f64,
        strength: f64,
        mirror: &[f64],
        layer: Option<u32>,
    ) -> Result<(), JsError> {
        let points = points_of(points, "Points of a stroke")?;
        let Some(&first) = points.first() else {
            return Err(error("A stroke needs a point at least, and this one has none."));
        };
        if let Some(point) = points.iter().find(|point| !point.is_finite()) {
            return Err(error(format_args!("A stroke through {}, {} is impossible.", point.x, point.y)));
        }
        let settings = self.settings();
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(refused("radius", radius, "a radius is positive and finite"));
        }
        for (key, share) in [("hardness", hardness), ("strength", strength)] {
            if !(0.0..=1.0).contains(&share) {
                return Err(refused(key, share, "it lies from 0 to 1"));
            }
        }
        let radius = settings.domain.in_plane(radius, first);
        let medium = Medium::named(quantity, value, change).map_err(error)?;
        let brush = Brush { medium, radius, hardness, strength };
        if matches!(brush.medium, Medium::Risk(_)) && !self.has_smallest {
            return Err(error("Risk needs hMin: the smallest target diameter, where the risk is 1."));
        }
        let [x, y] = [0, 1].map(|axis| mirror.get(axis).copied().filter(|place| !place.is_nan()));
        self.begin(brush, Mirror { x, y }, layer.map(LayerId))?;
        points.into_iter().for_each(|point| self.document.draw_to(point));
        self.document.end_stroke();
        Ok(())
    }
}

impl Core {
    /// Begins a stroke, on a new paint layer if there is none for it.
    fn begin(&mut self, brush: Brush, mirror: Mirror, layer: Option<LayerId>) -> Result<(), JsError> {
        if let Some(layer) = layer {
            self.document.activate_layer(layer);
        }
        let found = self.document.layer_for_or_new(&brush.medium).map_err(error)?;
        if layer.is_some_and(|layer| layer != found) {
            return Err(error(
                "This layer cannot be painted on with this brush: it is no paint layer of its quantity.",
            ));
        }
        self.document.begin_mirrored_stroke(brush, mirror);
        Ok(())
    }
}
