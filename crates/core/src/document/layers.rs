//! The layers of a document: which one a brush paints on, and blank pixels for it.

use std::collections::HashSet;

use glam::DVec2;

use super::{Document, Edit, EditError, Setting, Settings, SettingsError};
use crate::layers::{Layer, LayerId, LayerKind, PaintLayers, Quantity};
use crate::paint::Medium;
use crate::raster::{PixelGrid, TiledRaster};
use crate::text::{LengthUnit, short_name};

/// Pixels of depth 0 along the longer side of the domain. Strokes choose their depth by their radius.
const COARSEST_PIXELS: f64 = 1024.0;

/// Most layers of a document: each question about a size asks all of them.
pub(super) const MOST_LAYERS: usize = 1000;

/// Checks that a document can have this number of layers.
///
/// # Errors
/// Fails beyond 1,000.
pub fn check_layer_count(layers: usize) -> Result<(), SettingsError> {
    if layers > MOST_LAYERS { Err(SettingsError::Layers(layers)) } else { Ok(()) }
}

/// Returns what a person can do to get lengths in metres.
pub(super) fn way_to_metres(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::Degree => {
            "Mesh longitudes and latitudes in metres: with a projection, such as auto, or in the window as “Domain in metres”, \
             or with the grid of depths as the first file of a new document."
        }
        _ => "Give the domain in metres.",
    }
}

/// Why nothing can be painted with a brush.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoPaintLayer {
    /// There is no paint layer for the brush.
    #[error("No layer for painted {}: add a paint layer to paint on.", .0.map_or("risk or diameters", Quantity::noun))]
    Missing(Option<Quantity>),
    /// The layer is locked.
    #[error("The layer “{}” is locked: unlock it to paint on it, or select another layer.", short_name(name))]
    Locked {
        /// The layer.
        id: LayerId,
        /// The name of the layer.
        name: String,
    },
    /// The layer is hidden.
    #[error("The layer “{}” is hidden: show it to paint on it, or select another layer.", short_name(name))]
    Hidden {
        /// The layer.
        id: LayerId,
        /// The name of the layer.
        name: String,
    },
}

/// Returns the name, or with a number where a layer has that name.
pub fn unused_name(layers: &[Layer], name: &str) -> String {
    let is_used = |name: &str| layers.iter().any(|layer| layer.name == name);
    let numbered = (2..).map(|n| format!("{name} {n}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| !is_used(name)).unwrap_or_default()
}

impl Settings {
    /// Returns a layer by its identifier.
    pub fn layer(&self, id: LayerId) -> Option<&Layer> {
        self.layers.iter().find(|layer| layer.id == id)
    }

    /// Returns a raster for a paint layer, with nothing painted. Its pixels are square, and lie at the lower
    /// left corner of the domain.
    pub fn blank_raster(&self, id: LayerId) -> TiledRaster {
        let bounds = self.domain.bounds;
        let pixel = DVec2::splat(bounds.size().max_element() / COARSEST_PIXELS);
        let quantity = self.layer(id).and_then(Layer::paints).unwrap_or(Quantity::Diameter);
        TiledRaster::new(PixelGrid { origin: bounds.min, pixel }, quantity.blank())
    }

    /// Checks that each paint layer has pixels of its own quantity: a risk of 0 asks for nothing, and a
    /// diameter of 0 cannot be met.
    pub(super) fn check_paint(&self, paint: &PaintLayers) -> Result<(), SettingsError> {
        for layer in &self.layers {
            if let (Some(quantity), Some(raster)) = (layer.paints(), paint.get(layer.id))
                && raster.blank() != quantity.blank()
            {
                let other = match quantity {
                    _ if raster.blank() == Quantity::Error.blank() => Quantity::Error,
                    Quantity::Risk | Quantity::Error => Quantity::Diameter,
                    Quantity::Diameter => Quantity::Risk,
                };
                let [is, read_as] = [other, quantity].map(Quantity::noun);
                return Err(SettingsError::PaintedOther { layer: layer.name.clone(), is, read_as });
            }
        }
        Ok(())
    }
}

impl Document {
    /// Returns the risk at a point in world units, 0 to 1: the highest of all visible layers of risk; `None`
    /// where none has a value, and beyond the domain's rectangle.
    pub fn risk_at(&self, point: DVec2) -> Option<f64> {
        if !self.settings.domain.bounds.contains(point) {
            return None;
        }
        let visible = self.settings.layers.iter().filter(|layer| layer.visible);
        visible.filter_map(|layer| layer.risk_at(&self.paint, point)).reduce(f64::max)
    }

    /// Removes the paint of a layer, as one gesture.
    pub fn clear_layer(&mut self, id: LayerId) {
        self.clear_layers(&[id], "clear layer");
    }

    /// Returns the layer that brush and eraser were last used on, or that was selected since.
    pub fn active_layer(&self) -> Option<&Layer> {
        self.active.and_then(|id| self.settings.layer(id))
    }

    /// Returns an identifier for a new layer: no layer has it, also none that undo or redo brings back, and
    /// no pixels of a deleted layer are kept under it.
    pub fn unused_layer_id(&self) -> LayerId {
        self.unused_layer_ids().next().expect("there are fewer layers than numbers")
    }

    /// Returns the identifiers of [`Self::unused_layer_id`], for several new layers.
    pub fn unused_layer_ids(&self) -> impl Iterator<Item = LayerId> {
        let settings = self.history.all_settings().chain([&self.settings]);
        let layers = settings.flat_map(|settings| &settings.layers).map(|layer| layer.id);
        let used: HashSet<LayerId> = layers.chain(self.paint.iter().map(|(id, _)| id)).collect();
        (0..=u32::MAX).map(LayerId).filter(move |id| !used.contains(id))
    }

    /// Selects the layer that brush and eraser are used on. This is no edit.
    pub fn activate_layer(&mut self, id: LayerId) {
        self.active = Some(id);
    }

    /// Gives a new layer the pixels of another one. The layer itself is added by a setting.
    pub fn copy_paint(&mut self, from: LayerId, to: LayerId) {
        self.end_gesture();
        if let Some(raster) = self.paint.get(from).cloned() {
            self.paint.insert(to, raster);
            self.edits.layers.insert(to);
            self.note_edit("copy paint", || Edit::CopyPaint { from, to });
        }
    }

    /// Returns the layer that a brush with this medium paints on: the active one if it takes the medium,
    /// otherwise the highest that does.
    ///
    /// # Errors
    /// Fails when there is none, or it is locked or hidden.
    pub fn layer_for(&self, medium: &Medium) -> Result<LayerId, NoPaintLayer> {
        let wanted = match medium {
            Medium::Risk(_) => Some(Quantity::Risk),
            Medium::Diameter(..) => Some(Quantity::Diameter),
            Medium::Error(_) => Some(Quantity::Error),
            Medium::Eraser => None,
        };
        let takes = |layer: &&Layer| match (layer.paints(), wanted) {
            (Some(quantity), Some(wanted)) => quantity == wanted,
            (quantity, None) => quantity.is_some(),
            (None, Some(_)) => false,
        };
        let highest = || self.settings.layers.iter().rev().find(takes);
        let layer = self.active_layer().filter(takes).or_else(highest);
        match layer {
            None => Err(NoPaintLayer::Missing(wanted)),
            Some(Layer { id, locked: true, name, .. }) => {
                Err(NoPaintLayer::Locked { id: *id, name: name.clone() })
            }
            Some(Layer { id, visible: false, name, .. }) => {
                Err(NoPaintLayer::Hidden { id: *id, name: name.clone() })
            }
            Some(layer) => Ok(layer.id),
        }
    }

    /// Returns the layer that a brush with this medium paints on, as [`Self::layer_for`] does, after adding
    /// a paint layer on top where there is none for it.
    ///
    /// # Errors
    /// Fails when the layer is locked or hidden, and when no layer can be added.
    pub fn layer_for_or_new(&mut self, medium: &Medium) -> Result<LayerId, EditError> {
        let quantity = match self.layer_for(medium) {
            Err(NoPaintLayer::Missing(quantity)) => quantity.unwrap_or(Quantity::Diameter),
            found => return Ok(found?),
        };
        let id = self.unused_layer_id();
        let kind = LayerKind::paint(quantity);
        let mut layers = self.settings.layers.clone();
        layers.push(Layer::new(id, kind.label(), kind));
        self.set(Setting::Layers(layers))?;
        Ok(id)
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::Formula;
    use crate::paint::{Brush, DiameterChange};

    /// A diameter layer got the number of a deleted layer of risks. Undo then showed the pixels of one as
    /// those of the other, and the project could not be opened.
    #[test]
    fn a_new_layer_does_not_have_the_identifier_of_one_that_undo_brings_back() {
        let kinds = [Quantity::Diameter, Quantity::Risk].map(LayerKind::paint);
        let layers = Layer::stack(kinds);
        let mut document =
            Document::new(Settings { layers: layers.clone(), ..Settings::default() }, None).unwrap();
        document.set(Setting::Layers(vec![layers[0].clone()])).unwrap();
        document.end_gesture();
        assert_eq!(document.unused_layer_id(), LayerId(2));
        assert!(document.undo() && document.settings().layers == layers);
        assert_eq!(document.unused_layer_id(), LayerId(2));
        assert!(document.redo() && document.unused_layer_id() == LayerId(2));
    }

    #[test]
    fn painted_pixels_are_not_read_as_another_quantity() {
        let stack = |quantity| Layer::stack([LayerKind::paint(quantity)]);
        let [risk, diameter] = [Quantity::Risk, Quantity::Diameter].map(stack);
        let with = |layers: &Vec<Layer>| Settings { layers: layers.clone(), ..Settings::default() };
        let mut document = Document::new(with(&risk), None).unwrap();
        // Nothing is painted yet.
        document.set(Setting::Layers(diameter.clone())).unwrap();
        document.set(Setting::Layers(risk.clone())).unwrap();
        document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 1.0, strength: 1.0 });
        document.draw_to(dvec2(0.5, 0.5));
        document.end_stroke();
        let before = (document.settings().clone(), document.version());
        let error = document.set(Setting::Layers(diameter.clone())).unwrap_err().to_string();
        let said = "The pixels of the layer “Painted diameter” are risk, and cannot be read as diameters.";
        assert_eq!(error, format!("{said} Add another paint layer."));
        assert_eq!((document.settings().clone(), document.version()), before);
        assert_eq!(document.risk_at(dvec2(0.5, 0.5)), Some(1.0));
        // Nor does a document open with them.
        let paint = document.paint().clone();
        assert!(Document::new(with(&diameter), Some(paint.clone())).is_err());
        assert!(Document::new(with(&risk), Some(paint)).is_ok());
    }

    #[test]
    fn a_constant_of_infinity_asks_for_nothing_and_one_below_it_must_be_positive() {
        let with = |text: &str| {
            let layers = Layer::stack([LayerKind::target(Formula::parse(text).unwrap())]);
            Settings { layers, ..Settings::default() }.checked()
        };
        for text in ["1/0", "inf", "1e-9"] {
            assert!(with(text).is_ok(), "{text}");
        }
        for text in ["0", "-1", "-1/0", "0/0"] {
            let error = with(text).unwrap_err().to_string();
            assert!(
                error.ends_with("cannot be met: it must be positive; write inf to ask for nothing."),
                "{error}"
            );
        }
    }

    #[test]
    fn a_brush_without_a_paint_layer_gets_one_on_top() {
        let media = [
            (Medium::Risk(0.5), Quantity::Risk),
            (Medium::Diameter(0.1, DiameterChange::Finer), Quantity::Diameter),
            (Medium::Error(0.1), Quantity::Error),
            (Medium::Eraser, Quantity::Diameter),
        ];
        for (medium, quantity) in media {
            let base = LayerKind::target(Formula::parse("0.1").unwrap());
            let mut document =
                Document::new(Settings { layers: Layer::stack([base]), ..Settings::default() }, None)
                    .unwrap();
            let id = document.layer_for_or_new(&medium).unwrap();
            let layers = document.settings().layers.clone();
            assert_eq!(layers.len(), 2, "{medium:?}");
            assert_eq!((layers[1].id, layers[1].paints()), (id, Some(quantity)), "{medium:?}");
            // The next stroke is on the same layer.
            assert_eq!(document.layer_for_or_new(&medium), Ok(id), "{medium:?}");
            assert_eq!(document.layer_for(&medium), Ok(id), "{medium:?}");
            assert_eq!(document.settings().layers, layers, "{medium:?}");
            let locked = layers.into_iter().map(|layer| Layer { locked: true, ..layer }).collect();
            document.set(Setting::Layers(locked)).unwrap();
            let error = document.layer_for_or_new(&medium).unwrap_err();
            assert!(matches!(error, EditError::NoPaintLayer(NoPaintLayer::Locked { .. })), "{error}");
            assert_eq!(document.settings().layers.len(), 2, "{medium:?}");
        }
    }
}
