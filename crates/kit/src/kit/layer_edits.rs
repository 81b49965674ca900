//! Edits of the layers of the document.

use super::session::Session;
use meshbrush_core::document::{Setting, unused_name};
use meshbrush_core::layers::{Layer, LayerId, LayerKind};

impl Session {
    /// Edits the layers. Further edits join the gesture.
    pub fn edit_layers(&mut self, edit: impl FnOnce(&mut Vec<Layer>)) {
        let mut layers = self.document().settings().layers.clone();
        edit(&mut layers);
        self.set(Setting::Layers(layers));
    }

    /// Inserts a layer of a kind above the selected one, or at the top, with a name that no other layer has.
    /// Further edits join the gesture.
    pub fn insert_layer(&mut self, kind: LayerKind) -> LayerId {
        let document = self.document();
        let (id, layers) = (document.unused_layer_id(), &document.settings().layers);
        let name = unused_name(layers, &kind.name());
        let selected = document.active_layer().map(|layer| layer.id);
        let place = layers.iter().position(|layer| Some(layer.id) == selected);
        let place = place.map_or(layers.len(), |place| place + 1);
        self.edit_layers(|layers| layers.insert(place, Layer::new(id, name, kind)));
        id
    }

    /// Edits the layers as a gesture of its own.
    pub fn edit_layers_once(&mut self, edit: impl FnOnce(&mut Vec<Layer>)) {
        self.end_gesture();
        self.edit_layers(edit);
        self.end_gesture();
    }

    /// Changes what a layer asks for. Further changes join the gesture.
    pub fn set_layer_kind(&mut self, id: LayerId, kind: impl Into<LayerKind>) {
        self.edit_layers(|layers| {
            if let Some(layer) = layers.iter_mut().find(|layer| layer.id == id) {
                layer.kind = kind.into();
            }
        });
    }
}
