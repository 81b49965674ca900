//! Runs the commands about layers.

use super::kinds::kind_of;
use super::{
    GRADATION, KINDS, LAYERS, LayerEditor, OPEN_BAND, OPEN_RISK, ROLES, TRANSFER, entries, grid, list, load,
    marks,
};
use meshbrush_core::document::{Setting, Settings, unused_name};
use meshbrush_core::layers::{DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, PaintLayer};
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand, ViewCommand};
use meshbrush_kit::kit::tools::PaintKind;
use meshbrush_kit::kit::{Ctx, Feature, Row};

impl Feature for LayerEditor {
    type Command = LayerCommand;
    const ROW: Row = Row {
        files: &[&OPEN_RISK],
        roles: &ROLES,
        panels: &[&LAYERS, &TRANSFER, &GRADATION],
        layer_kinds: KINDS,
        marks_below: marks::paint,
        entries: entries::entries,
        ..Row::EMPTY
    };

    fn execute(&mut self, command: LayerCommand, ctx: &mut Ctx<'_>) {
        let (session, background) = (&*ctx.session, &mut *ctx.background);
        match command {
            LayerCommand::OpenImage(path) => load::load_image(session, background, &path),
            LayerCommand::OpenDiameters(path) => load::load_diameters(session, background, &path),
            LayerCommand::OpenBand(path) => load::load_band(session, background, &path),
            LayerCommand::MeasureSurface => self.surface_fit.measure(ctx.session, ctx.jobs),
            LayerCommand::OpenSurface(path) => load::load_surface(session, background, &path),
            LayerCommand::OpenDepth(path) => load::load_depth(session, background, &path),
            LayerCommand::OpenValues(path) => load::load_values(session, background, &path),
            LayerCommand::OpenShapes(path) => load::load_shapes(session, background, &path),
            LayerCommand::ReplaceShapes(path) => load::replace_shapes(session, background, &path),
            LayerCommand::OpenMask(path) => load::load_mask(session, background, &path),
            LayerCommand::Select(id) => select_layer(id, ctx),
            LayerCommand::Add(kind) => add_layer(*kind, ctx),
            LayerCommand::AddBand => add_band(ctx),
            LayerCommand::Duplicate(id) => duplicate_layer(id, ctx),
            LayerCommand::Delete(id) => delete_layer(id, ctx),
            LayerCommand::Move(id, place) => {
                ctx.session.edit_layers_once(|layers| move_layer(layers, id, place))
            }
            LayerCommand::Rename(id, name) => edit_layer_once(id, |layer| layer.name = name, ctx),
            LayerCommand::Show(id, visible) => edit_layer_once(id, |layer| layer.visible = visible, ctx),
            LayerCommand::Solo(id) => ctx.session.edit_layers_once(|layers| show_alone(layers, id)),
            LayerCommand::ZoomTo(id) => zoom_to(id, ctx),
            LayerCommand::ExportGridAs(path) => {
                let path = if path.extension().is_none() { path.with_extension("asc") } else { path };
                let export = |path| Command::from(LayerCommand::ExportGrid(path));
                ctx.commands.extend(ctx.project.save_table_as(path, export));
            }
            LayerCommand::ExportGrid(path) => grid::export(ctx.session, ctx.background, &path),
            LayerCommand::Lock(id, locked) => edit_layer_once(id, |layer| layer.locked = locked, ctx),
            LayerCommand::Combine(id, combine) => edit_layer_once(id, |layer| layer.combine = combine, ctx),
            LayerCommand::SetKind(id, kind) => ctx.session.set_layer_kind(id, *kind),
            LayerCommand::MeasureTo(id, to) => edit_layer_once(id, |layer| measure_to(layer, to), ctx),
            LayerCommand::Mask(id, mask) => edit_layer_once(id, |layer| layer.mask = mask, ctx),
            LayerCommand::Clear(id) => ctx.session.document_mut().clear_layer(id),
            LayerCommand::AskName(id) => ask_name(id, ctx),
            LayerCommand::LimitGradation(limits) => {
                ctx.session.end_gesture();
                ctx.session.set(Setting::Gradation(limits.then_some(Settings::DEFAULT_GRADATION)));
                ctx.session.end_gesture();
            }
        }
    }

    /// The small pictures in the list follow the document while the panels are shown.
    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        if ctx.view.panels {
            self.pictures.advance(ctx.session, ctx.view, ctx.jobs, ctx.egui);
        }
        self.surface_fit.follow(ctx.session, ctx.jobs)
    }
}

/// Selects a layer. Where it can be painted on, the brush paints its quantity from now on. A tool that
/// cannot edit the layer gives way to the one that can.
fn select_layer(id: LayerId, ctx: &mut Ctx<'_>) {
    let document = ctx.session.document_mut();
    document.activate_layer(id);
    // Also where it was selected before, and another kind of paint was chosen since.
    if let Some(quantity) = document.settings().layer(id).and_then(Layer::paints) {
        ctx.tools.kind = PaintKind::of(quantity);
    }
    let layer = document.settings().layer(id);
    let Some(kind) = layer.map(|layer| &layer.kind) else { return };
    let chosen = ctx.tools.chosen();
    let edits_a_kind = ctx.layer_kinds.iter().any(|kind| kind.tool == Some(chosen));
    match kind_of(ctx.layer_kinds, kind).tool {
        Some(tool) if chosen.brush.is_some() => ctx.tools.select(tool),
        None if edits_a_kind && kind.is::<PaintLayer>() => ctx.tools.select_brush(),
        _ => {}
    }
}

/// Adds a layer above the selected one, and selects it.
fn add_layer(kind: LayerKind, ctx: &mut Ctx<'_>) {
    if let Some(tool) = kind_of(ctx.layer_kinds, &kind).tool {
        ctx.tools.select(tool);
    }
    ctx.session.end_gesture();
    let id = ctx.session.insert_layer(kind);
    ctx.session.end_gesture();
    select_layer(id, ctx);
}

/// Adds a band of the selected layer's raster, or else of the highest raster; asks for a file where there
/// is none.
fn add_band(ctx: &mut Ctx<'_>) {
    let document = ctx.session.document();
    let Settings { layers, transfer, .. } = document.settings();
    let all = document.active_layer().into_iter().chain(layers.iter().rev());
    let Some(source) = all.map(|layer| &layer.kind).find_map(|kind| kind.raster_source()) else {
        return ctx.send(Command::from(FileCommand::Ask(&OPEN_BAND)));
    };
    match LayerKind::band_of(source.clone(), transfer) {
        Some(band) => add_layer(band, ctx),
        None => {
            let name = &source.name;
            let problem = format!(
                "No pixel of {name} has a value, so a band of its values would be empty. Select a layer of \
                 another raster first."
            );
            ctx.session.report(problem);
        }
    }
}

fn duplicate_layer(id: LayerId, ctx: &mut Ctx<'_>) {
    let document = ctx.session.document();
    let layers = &document.settings().layers;
    let Some(place) = layers.iter().position(|layer| layer.id == id) else { return };
    let copy_id = document.unused_layer_id();
    let name = unused_name(layers, &layers[place].name);
    let copy = Layer { id: copy_id, name, ..layers[place].clone() };
    ctx.session.document_mut().copy_paint(id, copy_id);
    ctx.session.edit_layers_once(|layers| layers.insert(place + 1, copy));
    select_layer(copy_id, ctx);
}

/// Deletes a layer, and selects the one that was below it, or else the one above.
fn delete_layer(id: LayerId, ctx: &mut Ctx<'_>) {
    let layers = &ctx.session.document().settings().layers;
    let Some(place) = layers.iter().position(|layer| layer.id == id) else { return };
    let next = place.checked_sub(1).or(Some(place + 1)).and_then(|next| layers.get(next));
    let next = next.map(|layer| layer.id);
    let was_selected = ctx.session.document().active_layer().is_some_and(|layer| layer.id == id);
    ctx.session.edit_layers_once(|layers| layers.retain(|layer| layer.id != id));
    if let Some(next) = next.filter(|_| was_selected) {
        ctx.session.document_mut().activate_layer(next);
    }
}

/// Shows the panel, and the field for the name in it.
fn ask_name(id: LayerId, ctx: &mut Ctx<'_>) {
    if let Some(layer) = ctx.session.document().settings().layer(id) {
        list::ask_name(ctx.egui, layer);
        ctx.view.panels = true;
    }
}

fn edit_layer_once(id: LayerId, edit: impl FnOnce(&mut Layer), ctx: &mut Ctx<'_>) {
    ctx.session.edit_layers_once(|layers| edit_layer(layers, id, edit));
}

fn edit_layer(layers: &mut [Layer], id: LayerId, edit: impl FnOnce(&mut Layer)) {
    if let Some(layer) = layers.iter_mut().find(|layer| layer.id == id) {
        edit(layer);
    }
}

/// Shows one layer alone, or all where it is alone already.
fn show_alone(layers: &mut [Layer], id: LayerId) {
    let is_alone = layers.iter().all(|layer| layer.visible == (layer.id == id));
    for layer in layers {
        layer.visible = is_alone || layer.id == id;
    }
}

/// Shows where a layer asks for something, or says that it does so nowhere.
fn zoom_to(id: LayerId, ctx: &mut Ctx<'_>) {
    let document = ctx.session.document();
    let Some(layer) = document.settings().layer(id) else { return };
    match document.layer_extent(id) {
        Some(area) => ctx.send(Command::from(ViewCommand::ShowArea(area))),
        None => {
            let news = format!("The layer “{}” asks for nothing in this domain yet.", layer.name);
            ctx.session.notices_mut().tell(news);
        }
    }
}

/// Changes what the distance of a layer is measured to. Other kinds of layers stay as they are.
fn measure_to(layer: &mut Layer, target: DistanceTo) {
    if let Some(DistanceLayer { to, .. }) = layer.kind.get_mut() {
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
