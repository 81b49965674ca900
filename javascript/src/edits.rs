//! Edits of the options and of the stack of layers.

use js_sys::Array;
use meshbrush_core::document::{Document, Setting};
use meshbrush_core::layers::{DistanceLayer, DistanceTo, Layer, LayerKind};
use wasm_bindgen::prelude::*;

use crate::document::Core;
use crate::errors::error;
use crate::kinds::{COMBINE, layer_of};
use crate::options::{changed, kept};
use crate::values::Table;

#[wasm_bindgen]
impl Core {
    /// Changes the options that an object states.
    ///
    /// # Errors
    /// Fails for options that cannot be met; the document is then as it was.
    pub fn set(&mut self, options: &JsValue) -> Result<(), JsError> {
        let options = Table(options);
        let parts = kept(options)?;
        let wanted = changed(options, self.settings().clone())?;
        self.document.change_numbers(wanted).map_err(error)?;
        self.has_smallest |= options.get("hMin").is_some();
        // What is said about parts counts for every domain.
        self.kept = self.kept.and(parts);
        Ok(())
    }

    /// Adds a layer on top, from an object that states it, and returns its identifier.
    ///
    /// # Errors
    /// Fails for a layer that cannot be added.
    #[wasm_bindgen(js_name = addLayer)]
    pub fn add_layer(&mut self, table: &JsValue) -> Result<u32, JsError> {
        let id = self.document.unused_layer_id();
        let layer = layer_of(Table(table), id, self.settings(), self.has_smallest)?;
        let is_paint = layer.paints().is_some();
        self.change_layers(|layers| layers.push(layer))?;
        if is_paint {
            self.document.activate_layer(id);
        }
        Ok(id.0)
    }

    /// The layers from the bottom to the top: identifier, name, kind, whether it is visible and locked, and
    /// how it is combined.
    pub fn layers(&self) -> Array {
        self.settings().layers.iter().map(row_of).collect()
    }

    /// Removes a layer.
    ///
    /// # Errors
    /// Fails where the layer is not there any more.
    #[wasm_bindgen(js_name = removeLayer)]
    pub fn remove_layer(&mut self, id: u32) -> Result<(), JsError> {
        let place = self.place_of(id)?;
        self.change_layers(|layers| drop(layers.remove(place)))
    }

    /// Moves a layer to a place in the stack, counted from 0 at the bottom.
    ///
    /// # Errors
    /// Fails where the layer is not there any more.
    #[wasm_bindgen(js_name = moveLayer)]
    pub fn move_layer(&mut self, id: u32, to: usize) -> Result<(), JsError> {
        let place = self.place_of(id)?;
        self.change_layers(|layers| {
            let layer = layers.remove(place);
            layers.insert(to.min(layers.len()), layer);
        })
    }

    /// Changes what is stated of a layer: name, whether it is visible and locked, and how it is combined.
    ///
    /// # Errors
    /// Fails where the layer is not there any more, and for another word.
    #[wasm_bindgen(js_name = changeLayer)]
    pub fn change_layer(
        &mut self,
        id: u32,
        name: Option<String>,
        visible: Option<bool>,
        locked: Option<bool>,
        combine: Option<String>,
    ) -> Result<(), JsError> {
        let place = self.place_of(id)?;
        let combine = combine.map(|word| {
            let known = COMBINE.into_iter().find(|(known, _)| *known == word);
            known.map(|(_, combine)| combine).ok_or_else(|| {
                error(format_args!(
                    "combine: \"{word}\" is not possible here; write one of finest, floor, replace."
                ))
            })
        });
        let combine = combine.transpose()?;
        self.change_layers(|layers| {
            let layer = &mut layers[place];
            layer.name = name.unwrap_or_else(|| layer.name.clone());
            layer.visible = visible.unwrap_or(layer.visible);
            layer.locked = locked.unwrap_or(layer.locked);
            layer.combine = combine.unwrap_or(layer.combine);
        })
    }

    /// Undoes the last edit, and returns whether there was one.
    pub fn undo(&mut self) -> bool {
        self.document.undo()
    }

    /// Redoes the edit that was undone last, and returns whether there was one.
    pub fn redo(&mut self) -> bool {
        self.document.redo()
    }

    /// Forgets all edits so far: they make a new document, and nobody undoes them.
    #[wasm_bindgen(js_name = forgetEdits)]
    pub fn forget_edits(&mut self) {
        let (settings, paint) = (self.settings().clone(), self.document.paint().clone());
        if let Ok(document) = Document::new(settings, Some(paint)) {
            self.document = document;
        }
    }
}

impl Core {
    fn place_of(&self, id: u32) -> Result<usize, JsError> {
        let place = self.settings().layers.iter().position(|layer| layer.id.0 == id);
        place.ok_or_else(|| error("The layer is no longer in its mesh."))
    }

    fn change_layers(&mut self, change: impl FnOnce(&mut Vec<Layer>)) -> Result<(), JsError> {
        let mut layers = self.settings().layers.clone();
        change(&mut layers);
        self.document.end_gesture();
        let set = self.document.set(Setting::Layers(layers)).map_err(error);
        self.document.end_gesture();
        set
    }
}

fn row_of(layer: &Layer) -> JsValue {
    let combine = COMBINE.iter().find(|(_, combine)| *combine == layer.combine);
    let row: [JsValue; 6] = [
        layer.id.0.into(),
        layer.name.as_str().into(),
        word_of(&layer.kind).into(),
        layer.visible.into(),
        layer.locked.into(),
        combine.map_or("", |(word, _)| word).into(),
    ];
    row.iter().collect::<Array>().into()
}

/// Returns the word for the kind of a layer.
fn word_of(kind: &LayerKind) -> &'static str {
    match kind {
        LayerKind::Paint(_) => "paint",
        LayerKind::Formula(_) => "formula",
        LayerKind::Raster(_) => "raster",
        LayerKind::Threats(_) => "threats",
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Corridor { .. }, .. }) => "corridor",
        LayerKind::Distance(_) => "distance",
        LayerKind::Band(_) => "band",
        LayerKind::Depth(_) => "depth",
        LayerKind::Straits(_) => "straits",
        LayerKind::FeatureSize(_) => "featureSize",
        LayerKind::Lines(_) => "lines",
        LayerKind::Surface(_) => "surface",
    }
}
