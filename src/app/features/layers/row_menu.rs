//! The menu of a row of the list of layers, opened by the secondary button or by keyboard.

use eframe::egui::{Popup, Response};

use super::{EXPORT_GRID, OPEN_MASK};
use crate::app::features::regions::{RegionCommand, RegionTarget};
use meshbrush_core::layers::Layer;
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, MENU_WIDTH, Menu, menu_item};
use meshbrush_ui::widgets::key_menu::{enter_menu, menu_of};

/// Shows the menu of a layer while it is open. What acts on the selected layer selects this one first.
pub fn show(state: &FrameState<'_>, layer: &Layer, row: &Response, commands: &mut Vec<Command>) {
    let id = Popup::default_response_id(row);
    menu_of(row).show(|ui| {
        ui.set_min_width(MENU_WIDTH);
        let mut chosen = Vec::new();
        let items = items(state, layer);
        let buttons: Vec<_> = items.iter().map(|item| menu_item(ui, item, &mut chosen)).collect();
        if !chosen.is_empty() {
            commands.push(Command::from(LayerCommand::Select(layer.id)));
            commands.append(&mut chosen);
        }
        enter_menu(ui.ctx(), id, &buttons);
    });
}

fn items(state: &FrameState<'_>, layer: &Layer) -> Vec<CatalogItem> {
    let id = layer.id;
    let layers = &state.session.document().settings().layers;
    let is_alone = layers.len() > 1 && layers.iter().all(|other| other.visible == (other.id == id));
    let solo = if is_alone { "Show all layers" } else { "Show only this layer" };
    let entry = |title: &str, command: Command| CatalogItem::new(Menu::Layer, title, command);
    let item = |title: &str, command| entry(title, Command::from(command));
    let draw_mask = Command::from(RegionCommand::Target(RegionTarget::Mask));
    vec![
        item("Zoom to the layer", LayerCommand::ZoomTo(id)),
        item(solo, LayerCommand::Solo(id)).enabled(layers.len() > 1),
        item("Layer is visible", LayerCommand::Show(id, !layer.visible)).checked(layer.visible),
        item("Layer is locked", LayerCommand::Lock(id, !layer.locked)).checked(layer.locked),
        item("Rename layer", LayerCommand::AskName(id)).group(),
        item("Duplicate layer", LayerCommand::Duplicate(id)),
        entry("Draw mask", draw_mask).enabled(!layer.locked).group(),
        entry("Mask from file…", Command::from(FileCommand::Ask(&OPEN_MASK))).enabled(!layer.locked),
        item("Remove mask", LayerCommand::Mask(id, None)).enabled(!layer.locked && layer.mask.is_some()),
        entry("Export as a grid…", Command::from(FileCommand::Ask(&EXPORT_GRID))).group(),
        item("Clear the layer", LayerCommand::Clear(id))
            .enabled(!layer.locked && layer.paints().is_some())
            .group(),
        item("Delete layer", LayerCommand::Delete(id)).enabled(!layer.locked),
    ]
}
