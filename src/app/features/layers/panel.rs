//! The layers of the size field: the stack, and the parameters of the selected layer.

use eframe::egui::{Popup, Ui};

use super::{LayerCommand, list, selected};
use crate::app::command::{Command, EditCommand};
use crate::app::kit::{
    CatalogItem, FrameState, Menu, Panel, PanelGroup, end_gesture_when_released, kinds_of_layers, menu_item,
};
use crate::app::widgets::{Icon, Section, SliderRow, ToolButton, toggle_row};
use meshbrush_core::document::{Setting, Settings};

/// The stack, from the top, and the parameters of the selected layer.
pub static LAYERS: Panel = Panel { name: "layers", group: PanelGroup::Size, only_with_tool: false, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let reveal = list::asks_name_now(ui);
    Section::new("Layers").reveal(reveal).show(ui, |ui| {
        list::show(ui, state, commands);
        buttons(ui, state, commands);
        gradation_rows(ui, state, commands);
    });
    selected::show(ui, state, commands);
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
        let mut button = |icon, name, key, command: Option<LayerCommand>| {
            let button = ToolButton::small(icon, name).key(key);
            if ui.add_enabled_ui(command.is_some(), |ui| button.show(ui)).inner.clicked() {
                commands.extend(command.map(Command::Layer));
            }
        };
        button(Icon::COPY, "Duplicate layer", "Ctrl+J", id.map(LayerCommand::Duplicate));
        let delete = id.filter(|_| deletes).map(LayerCommand::Delete);
        button(Icon::DELETE, "Delete layer", "Shift+Delete", delete);
        let moved = |place: Option<usize>| Some(LayerCommand::Move(id?, place?));
        button(Icon::UP, "Move layer up", "Ctrl+]", moved(up));
        button(Icon::DOWN, "Move layer down", "Ctrl+[", moved(down));
    });
}

/// The button that opens the list of what can be added.
fn add_button(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let response = ToolButton::small(Icon::ADD, "Add layer").show(ui);
    Popup::menu(&response).show(|ui| {
        ui.set_min_width(220.0);
        for (number, kind) in kinds_of_layers(state.rows).into_iter().enumerate() {
            for (i, addition) in kind.additions.iter().enumerate() {
                let item = CatalogItem::new(Menu::Layer, addition.title, (addition.command)(state));
                let item = if i == 0 && number > 0 { item.group() } else { item };
                menu_item(ui, &item, commands);
            }
        }
    });
}

/// Whether h̄ may change abruptly, or how fast it may change.
fn gradation_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let gradation = state.session.document().settings().gradation;
    let mut limits = gradation.is_some();
    if toggle_row(ui, "Limit gradation", &mut limits).changed() {
        commands.push(Command::Layer(LayerCommand::LimitGradation(limits)));
    }
    let Some(mut slope) = gradation else { return };
    let row = SliderRow::new("Gradation g", &mut slope, 0.02..=2.0).logarithmic();
    let row = row.typed_range(f64::MIN_POSITIVE..=f64::MAX).default(Settings::USUAL_GRADATION);
    let help = "Largest change of h̄ per unit of length, over the whole stack: the smaller, the more slowly \
                triangles grow with the distance from fine places.";
    let response = row.help(help).show(ui);
    if response.changed() {
        commands.push(Command::Edit(EditCommand::Set(Setting::Gradation(Some(slope)))));
    }
    end_gesture_when_released(&response, commands);
}
