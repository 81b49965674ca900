//! Edits of the layers of the document.

use super::session::Session;
use meshbrush_core::document::Setting;
use meshbrush_core::layers::{Layer, LayerId, LayerKind};

impl Session {
    /// Edits the layers. Further edits join the gesture.
    pub fn edit_layers(&mut self, edit: impl FnOnce(&mut Vec<Layer>)) {
        let mut layers = self.document().settings().layers.clone();
        edit(&mut layers);
        self.set(Setting::Layers(layers));
    }

    /// Edits the layers as a gesture of its own.
    pub fn edit_layers_once(&mut self, edit: impl FnOnce(&mut Vec<Layer>)) {
        self.end_gesture();
        self.edit_layers(edit);
        self.end_gesture();
    }

    /// Changes what a layer asks for. Further changes join the gesture.
    pub fn set_layer_kind(&mut self, id: LayerId, kind: LayerKind) {
        self.edit_layers(|layers| {
            if let Some(layer) = layers.iter_mut().find(|layer| layer.id == id) {
                layer.kind = kind;
            }
        });
    }
}
