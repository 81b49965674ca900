//! Where a layer of a document asks for something.

use super::Document;
use crate::geometry::Rect;
use crate::layers::{Circumstances, LayerId};

impl Document {
    /// Returns the smallest rectangle of the domain, in world units, that has all that a layer asks for; the
    /// whole domain where the layer can ask for something everywhere. `None` where it asks for nothing, and
    /// without such a layer.
    pub fn layer_extent(&self, id: LayerId) -> Option<Rect> {
        let settings = self.settings();
        let bounds = settings.domain.bounds;
        let circumstances = Circumstances {
            paint: self.paint(),
            longest: settings.spacing * std::f64::consts::SQRT_2,
            greatest_scale: 1.0,
            outline_areas: None,
        };
        let spec = settings.field_spec();
        let layer = spec.layers.iter().find(|layer| layer.id == id)?;
        let rects = spec.extent_of(layer, &circumstances).rects_within(bounds);
        rects.iter().filter_map(|rect| rect.intersection(&bounds)).reduce(|a, b| a.union(&b))
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::document::{Example, Setting, Settings};
    use crate::layers::Mask;

    /// Returns the extent of the first layer that has paint.
    fn painted_extent(document: &Document) -> Option<Rect> {
        let painted = document.settings().layers.iter().filter(|layer| layer.paints().is_some());
        painted.map(|layer| layer.id).find_map(|id| document.layer_extent(id))
    }

    #[test]
    fn a_layer_ends_where_its_mask_does_and_paint_where_it_was_painted() {
        let mut threats = Example::Threats.without_data();
        let bounds = threats.settings().domain.bounds;
        let painted = painted_extent(&threats).expect("paint");
        assert!(bounds.size().cmpgt(painted.size()).any() && painted.size().min_element() > 0.0);
        // A corner of the domain as the mask of the painted layer.
        let corner = Rect::new(bounds.min, bounds.min + 0.5 * bounds.size());
        let [min, max] = [corner.min, corner.max];
        let polygon = vec![vec![min, dvec2(max.x, min.y), max, dvec2(min.x, max.y)]];
        let mut layers = threats.settings().layers.clone();
        for layer in &mut layers {
            layer.mask = Some(Mask::new(std::slice::from_ref(&polygon)).unwrap());
        }
        threats.set(Setting::Layers(layers)).unwrap();
        let masked = painted_extent(&threats);
        assert_eq!(masked, corner.intersection(&painted));
    }

    #[test]
    fn a_layer_without_paint_asks_for_nothing_anywhere() {
        let blank = Document::new(Settings::default(), None).unwrap();
        assert_eq!(painted_extent(&blank), None);
        assert_eq!(blank.layer_extent(LayerId(1_000)), None);
    }
}
