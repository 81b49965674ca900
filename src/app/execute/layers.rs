//! Commands about layers.

use eframe::egui::Context;

use crate::app::App;
use crate::app::command::{Command, FileCommand, LayerCommand};
use crate::app::features::layers::OPEN_BAND;
use crate::app::layer_files;
use crate::app::notices::Offer;
use crate::app::panels::{LAYER_KINDS, ask_layer_name, kind_of};
use crate::app::tools::PaintKind;
use meshbrush_core::document::{NoPaintLayer, Setting, Settings};
use meshbrush_core::layers::{DistanceTo, Layer, LayerId, LayerKind, Quantity};

impl App {
    pub(in crate::app) fn execute_on_layers(&mut self, command: LayerCommand, ctx: &Context) {
        let (session, background) = (&self.session, &mut self.background);
        match command {
            LayerCommand::OpenImage(path) => layer_files::load_image(session, background, &path),
            LayerCommand::OpenDiameters(path) => layer_files::load_diameters(session, background, &path),
            LayerCommand::OpenBand(path) => layer_files::load_band(session, background, &path),
            LayerCommand::OpenValues(path) => layer_files::load_values(session, background, &path),
            LayerCommand::OpenShapes(path) => layer_files::load_shapes(session, background, &path),
            LayerCommand::ReplaceShapes(path) => layer_files::replace_shapes(session, background, &path),
            LayerCommand::OpenMask(path) => layer_files::load_mask(session, background, &path),
            LayerCommand::Select(id) => self.select_layer(id),
            LayerCommand::Add(kind) => self.add_layer(*kind),
            LayerCommand::AddBand => self.add_band(),
            LayerCommand::AddCorridor => self.add_corridor(),
            LayerCommand::TakePaths(id) => self.take_paths(id),
            LayerCommand::Duplicate(id) => self.duplicate_layer(id),
            LayerCommand::Delete(id) => self.delete_layer(id),
            LayerCommand::Move(id, place) => {
                self.session.edit_layers_once(|layers| move_layer(layers, id, place))
            }
            LayerCommand::Rename(id, name) => self.edit_layer_once(id, |layer| layer.name = name),
            LayerCommand::Show(id, visible) => self.edit_layer_once(id, |layer| layer.visible = visible),
            LayerCommand::Lock(id, locked) => self.edit_layer_once(id, |layer| layer.locked = locked),
            LayerCommand::Combine(id, combine) => self.edit_layer_once(id, |layer| layer.combine = combine),
            LayerCommand::SetKind(id, kind) => self.session.set_layer_kind(id, *kind),
            LayerCommand::MeasureTo(id, to) => self.edit_layer_once(id, |layer| measure_to(layer, to)),
            LayerCommand::Mask(id, mask) => self.edit_layer_once(id, |layer| layer.mask = mask),
            LayerCommand::Clear(id) => self.session.document_mut().clear_layer(id),
            LayerCommand::AskName(id) => self.ask_layer_name(id, ctx),
            LayerCommand::LimitGradation(limits) => {
                self.session.end_gesture();
                self.session.set(Setting::Gradation(limits.then_some(Settings::USUAL_GRADATION)));
                self.session.end_gesture();
            }
        }
    }

    /// Selects a layer. Where it can be painted on, the brush paints its quantity from now on. A tool that
    /// cannot edit the layer gives way to the one that can.
    fn select_layer(&mut self, id: LayerId) {
        let document = self.session.document_mut();
        document.activate_layer(id);
        match document.settings().layer(id).and_then(Layer::paints) {
            Some(Quantity::Risk) => self.tools.kind = PaintKind::Risk,
            Some(Quantity::Diameter) => self.tools.kind = PaintKind::Diameter,
            None => {}
        }
        let layer = document.settings().layer(id);
        let Some(kind) = layer.map(|layer| &layer.kind) else { return };
        let chosen = self.tools.chosen();
        let edits_a_kind = LAYER_KINDS.iter().any(|kind| kind.tool == Some(chosen));
        match kind_of(kind).tool {
            Some(tool) if chosen.brush.is_some() => self.tools.select(tool),
            None if edits_a_kind && matches!(kind, LayerKind::Paint(_)) => self.tools.select_brush(),
            _ => {}
        }
    }

    /// Selects a layer that the brush can paint a quantity on, if there is one and none is selected: rather
    /// one that is visible and not locked, the highest of several.
    pub(super) fn select_layer_painted_with(&mut self, kind: PaintKind) {
        let document = self.session.document_mut();
        let quantity = quantity_of(kind);
        let takes = |layer: &&Layer| layer.paints() == Some(quantity);
        if document.active_layer().filter(takes).is_some() {
            return;
        }
        let fitting = || document.settings().layers.iter().rev().filter(takes);
        let usable = fitting().find(|layer| layer.visible && !layer.locked);
        if let Some(id) = usable.or_else(|| fitting().next()).map(|layer| layer.id) {
            document.activate_layer(id);
        }
    }

    /// Says why nothing can be painted, and offers what would help.
    pub(super) fn offer_paint_layer(&mut self, problem: &NoPaintLayer) {
        let (label, command) = match problem {
            NoPaintLayer::Locked { id, .. } => ("Unlock the layer", LayerCommand::Lock(*id, false)),
            NoPaintLayer::Hidden { id, .. } => ("Show the layer", LayerCommand::Show(*id, true)),
            NoPaintLayer::Missing(quantity) => {
                let quantity = quantity.unwrap_or(quantity_of(self.tools.kind));
                ("Add a paint layer", LayerCommand::Add(Box::new(LayerKind::Paint(quantity))))
            }
        };
        let offer = Offer { label, command: Command::Layer(command) };
        self.session.notices_mut().report_with_offer(problem, offer);
    }

    /// Adds a layer above the selected one, and selects it.
    fn add_layer(&mut self, kind: LayerKind) {
        let document = self.session.document();
        let id = document.unused_layer_id();
        let name = unused_name(&document.settings().layers, &kind.name());
        let place = self.place_above_selected();
        if let Some(tool) = kind_of(&kind).tool {
            self.tools.select(tool);
        }
        self.session.edit_layers_once(|layers| layers.insert(place, Layer::new(id, name, kind)));
        self.select_layer(id);
    }

    /// Adds a band of the selected layer's raster, or else of the highest raster; asks for a file where there
    /// is none.
    fn add_band(&mut self) {
        let document = self.session.document();
        let Settings { layers, transfer, .. } = document.settings();
        let all = document.active_layer().into_iter().chain(layers.iter().rev());
        let Some(source) = all.map(|layer| &layer.kind).find_map(LayerKind::raster_source) else {
            return self.send(Command::File(FileCommand::Ask(&OPEN_BAND)));
        };
        match LayerKind::band_of(source.clone(), transfer) {
            Some(band) => self.add_layer(band),
            None => {
                let name = &source.name;
                let problem = format!(
                    "No pixel of {name} has a value, so a band of its values would be empty. Select a layer of \
                     another raster first."
                );
                self.session.report(problem);
            }
        }
    }

    fn duplicate_layer(&mut self, id: LayerId) {
        let document = self.session.document();
        let layers = &document.settings().layers;
        let Some(place) = layers.iter().position(|layer| layer.id == id) else { return };
        let copy_id = document.unused_layer_id();
        let name = unused_name(layers, &layers[place].name);
        let copy = Layer { id: copy_id, name, ..layers[place].clone() };
        self.session.document_mut().copy_paint(id, copy_id);
        self.session.edit_layers_once(|layers| layers.insert(place + 1, copy));
        self.select_layer(copy_id);
    }

    /// Deletes a layer, and selects the one that was below it, or else the one above. The brush keeps what it
    /// paints.
    fn delete_layer(&mut self, id: LayerId) {
        let layers = &self.session.document().settings().layers;
        let Some(place) = layers.iter().position(|layer| layer.id == id) else { return };
        let next = place.checked_sub(1).or(Some(place + 1)).and_then(|next| layers.get(next));
        let next = next.map(|layer| layer.id);
        let was_selected = self.session.document().active_layer().is_some_and(|layer| layer.id == id);
        self.session.edit_layers_once(|layers| layers.retain(|layer| layer.id != id));
        if let Some(next) = next.filter(|_| was_selected) {
            self.session.document_mut().activate_layer(next);
        }
    }

    /// Shows the panel, and the field for the name in it.
    fn ask_layer_name(&mut self, id: LayerId, ctx: &Context) {
        if let Some(layer) = self.session.document().settings().layer(id) {
            ask_layer_name(ctx, layer);
            self.view.panels = true;
        }
    }

    /// Returns the place above the selected layer; the top without one.
    fn place_above_selected(&self) -> usize {
        let document = self.session.document();
        let selected = document.active_layer().map(|layer| layer.id);
        let layers = &document.settings().layers;
        layers.iter().position(|layer| Some(layer.id) == selected).map_or(layers.len(), |place| place + 1)
    }

    fn edit_layer_once(&mut self, id: LayerId, edit: impl FnOnce(&mut Layer)) {
        self.session.edit_layers_once(|layers| edit_layer(layers, id, edit));
    }
}

fn quantity_of(kind: PaintKind) -> Quantity {
    match kind {
        PaintKind::Risk => Quantity::Risk,
        PaintKind::Diameter => Quantity::Diameter,
    }
}

fn edit_layer(layers: &mut [Layer], id: LayerId, edit: impl FnOnce(&mut Layer)) {
    if let Some(layer) = layers.iter_mut().find(|layer| layer.id == id) {
        edit(layer);
    }
}

/// Changes what the distance of a layer is measured to. Other kinds of layers stay as they are.
fn measure_to(layer: &mut Layer, target: DistanceTo) {
    if let LayerKind::Distance { to, .. } = &mut layer.kind {
        *to = target;
    }
}

/// Moves a layer to a place, counted from the bottom without that layer.
fn move_layer(layers: &mut Vec<Layer>, id: LayerId, place: usize) {
    if let Some(from) = layers.iter().position(|layer| layer.id == id) {
        let layer = layers.remove(from);
        layers.insert(place.min(layers.len()), layer);
    }
}

/// Returns the name, or with a number where a layer has that name.
fn unused_name(layers: &[Layer], name: &str) -> String {
    let is_used = |name: &str| layers.iter().any(|layer| layer.name == name);
    let numbered = (2..).map(|n| format!("{name} {n}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| !is_used(name)).unwrap_or_default()
}
