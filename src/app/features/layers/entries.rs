//! The layers in menus and in the palette.

use eframe::egui::{Key, Modifiers};

use super::EXPORT_GRID;
use super::selected::combine_name;
use meshbrush_core::layers::{Combine, Layer, LayerId};
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu, NOT_QUERYING, Submenu};

/// Returns the stack of layers, and the selected one.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let mut items = additions(state);
    items.extend(selected_layer(state));
    items.extend(stack(state));
    let limits = state.session.document().settings().gradation.is_some();
    items.push(item("Limit gradation", LayerCommand::LimitGradation(!limits)).checked(limits).group());
    items
}

fn item(title: impl Into<String>, command: LayerCommand) -> CatalogItem {
    CatalogItem::new(Menu::Layer, title, Command::from(command))
}

/// Returns the commands that add a layer, for each kind.
fn additions(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let additions = state.layer_kinds.iter().flat_map(|kind| kind.additions);
    let items = additions.enumerate().map(|(i, addition)| {
        let title = format!("Add layer: {}", addition.title);
        let item = CatalogItem::new(Menu::Layer, title, (addition.command)(state)).within(Submenu::AddLayer);
        if i == 0 { item.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::N) } else { item }
    });
    items.collect()
}

/// Returns the commands for the selected layer.
fn selected_layer(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let layer = state.session.document().active_layer();
    let is = |test: fn(&Layer) -> bool| layer.is_some_and(test);
    // Without a selected layer the entries are greyed out.
    let id = layer.map_or(LayerId(0), |layer| layer.id);
    let (visible, locked) = (is(|layer| layer.visible), is(|layer| layer.locked));
    let combine = |combine: Combine, title: &str| {
        let chosen = layer.is_some_and(|layer| layer.combine == combine);
        let title = format!("Combine: {title}");
        item(title, LayerCommand::Combine(id, combine)).checked(chosen).enabled(is(|layer| !layer.locked))
    };
    let mut items = vec![
        item("Duplicate layer", LayerCommand::Duplicate(id)).ctrl(Key::J).group(),
        item("Delete layer", LayerCommand::Delete(id)).keys(Modifiers::SHIFT, Key::Delete),
        item("Rename layer", LayerCommand::AskName(id)).key(Key::F2),
        item("Layer is visible", LayerCommand::Show(id, !visible))
            .keys(Modifiers::SHIFT, Key::H)
            .checked(visible),
        item("Layer is locked", LayerCommand::Lock(id, !locked)).checked(locked),
        item("Show only the selected layer", LayerCommand::Solo(id)),
        item("Zoom to the selected layer", LayerCommand::ZoomTo(id)),
        item("Clear the selected layer", LayerCommand::Clear(id)),
        CatalogItem::new(
            Menu::Layer,
            "Export the selected layer as a grid…",
            Command::from(FileCommand::Ask(&EXPORT_GRID)),
        ),
    ];
    for item in &mut items {
        item.enabled = layer.is_some();
    }
    // A locked layer keeps what it has.
    items[1].enabled = is(|layer| !layer.locked);
    items[7].enabled = is(|layer| !layer.locked && layer.paints().is_some());
    let combines = Combine::ALL.map(|mode| combine(mode, combine_name(mode)));
    items.extend(combines.map(|item| item.within(Submenu::Combine)));
    items
}

/// Selecting and moving within the stack.
fn stack(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let document = state.session.document();
    let layers = &document.settings().layers;
    let selected = document.active_layer();
    let place = selected.and_then(|selected| layers.iter().position(|layer| layer.id == selected.id));
    let id = selected.map_or(LayerId(0), |layer| layer.id);
    let above = place.map(|place| place + 1).filter(|&above| above < layers.len());
    let below = place.and_then(|place| place.checked_sub(1));
    // Without a selected layer, the keys begin at the ends of the stack.
    let next_above = if place.is_some() { above } else { (!layers.is_empty()).then_some(0) };
    let next_below = if place.is_some() { below } else { layers.len().checked_sub(1) };
    let select = |title: &str, place: Option<usize>| {
        let id = place.map_or(LayerId(0), |place| layers[place].id);
        item(title, LayerCommand::Select(id)).enabled(place.is_some())
    };
    let move_to = |title: &str, place: Option<usize>| {
        item(title, LayerCommand::Move(id, place.unwrap_or(0))).enabled(place.is_some())
    };
    // With the query tool these keys lead through the bisection tree.
    let has_keys = !state.tools.tool.queries;
    vec![
        select("Select the layer above", next_above).key(Key::PageUp).only(NOT_QUERYING, has_keys).group(),
        select("Select the layer below", next_below).key(Key::PageDown).only(NOT_QUERYING, has_keys),
        move_to("Move layer up", above).ctrl(Key::ArrowUp).ctrl(Key::CloseBracket),
        move_to("Move layer down", below).ctrl(Key::ArrowDown).ctrl(Key::OpenBracket),
    ]
}
