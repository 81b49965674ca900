//! The layers of the size field: the stack, and the parameters of the selected layer.

use eframe::egui::{Frame, Margin, Popup, ScrollArea, Ui, UiBuilder, vec2};

use super::{list, selected};
use meshbrush_kit::kit::command::{Command, LayerCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, MENU_WIDTH, Menu, Panel, Tab, menu_item};
use meshbrush_ui::theme::metrics;
use meshbrush_ui::widgets::{Icon, Section, ToolButton};

/// The stack, from the top, and the parameters of the selected layer.
pub static LAYERS: Panel = Panel { name: "layers", tab: Tab::Layers, place: 0, show };

/// Least height of the parameters of the selected layer, in points.
const LEAST_PARAMETERS: f32 = 144.0;
/// Height of the buttons below the list with the space around them, in points.
const BUTTONS: f32 = 48.0;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Layers").show(ui, |ui| {
        // The list gives way to the parameters below it.
        let room = ui.available_height() - BUTTONS - LEAST_PARAMETERS;
        list::show(ui, state, room, commands);
        buttons(ui, state, commands);
    });
    let margin = Margin::symmetric(metrics::PANEL_MARGIN as i8, 0);
    let place = ui.available_rect_before_wrap().expand2(vec2(metrics::PANEL_MARGIN, 0.0));
    ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
        ScrollArea::vertical().id_salt("selected layer").auto_shrink(false).min_scrolled_height(0.0).show(
            ui,
            |ui| {
                Frame::new().inner_margin(margin).show(ui, |ui| selected::show(ui, state, commands));
            },
        );
    });
}

/// Shows the buttons that change the stack of layers.
fn buttons(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let document = state.session.document();
    let layers = &document.settings().layers;
    let selected = document.active_layer();
    let place = selected.and_then(|selected| layers.iter().position(|layer| layer.id == selected.id));
    let up = place.map(|place| place + 1).filter(|&place| place < layers.len());
    let down = place.and_then(|place| place.checked_sub(1));
    let id = selected.map(|layer| layer.id);
    let deletes = selected.is_some_and(|layer| !layer.locked);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        add_button(ui, state, commands);
        let mut button = |icon, name, command: Option<LayerCommand>| {
            let button = ToolButton::small(icon, name).entry(name);
            if ui.add_enabled_ui(command.is_some(), |ui| button.show(ui)).inner.clicked() {
                commands.extend(command.map(Command::from));
            }
        };
        button(Icon::COPY, "Duplicate layer", id.map(LayerCommand::Duplicate));
        let delete = id.filter(|_| deletes).map(LayerCommand::Delete);
        button(Icon::DELETE, "Delete layer", delete);
        let moved = |place: Option<usize>| Some(LayerCommand::Move(id?, place?));
        button(Icon::UP, "Move layer up", moved(up));
        button(Icon::DOWN, "Move layer down", moved(down));
    });
}

/// The button that opens the list of what can be added.
fn add_button(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let response = ToolButton::small(Icon::ADD, "Add layer").show(ui);
    Popup::menu(&response).show(|ui| {
        ui.set_min_width(MENU_WIDTH);
        for (number, kind) in state.layer_kinds.iter().enumerate() {
            for (i, addition) in kind.additions.iter().enumerate() {
                let item = CatalogItem::new(Menu::Layer, addition.title, (addition.command)(state));
                let item = if i == 0 && number > 0 { item.group() } else { item };
                menu_item(ui, &item, commands);
            }
        }
    });
}
