//! The rows of the stack: selected, shown, locked, renamed and dragged.

use eframe::egui::{Context, CursorIcon, Id, Rect, Response, ScrollArea, Ui, pos2};

use super::kinds::kind_of;
use super::pictures::layer_color32;
use super::row_menu;
use super::selected::combine_name;
use crate::app::features::layers::LayerEditor;
use meshbrush_core::layers::{Layer, LayerId};
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::command::{Command, LayerCommand};
use meshbrush_ui::theme::tokens;
use meshbrush_ui::widgets::{LayerRow, LayerRowAnswer};

/// Rows that are in sight at least; of more, a half row says that they scroll.
const LEAST_ROWS: f32 = 3.5;

/// A name that is being typed, in egui's memory.
#[derive(Clone, Debug)]
struct NewName {
    layer: LayerId,
    text: String,
    /// Whether the field was shown.
    is_shown: bool,
}

impl NewName {
    /// Keeps what was typed for the next frame. Returns it once it was entered.
    fn keep(self, ui: &Ui, answer: LayerRowAnswer) -> Option<String> {
        if !matches!(answer, LayerRowAnswer::Named | LayerRowAnswer::NotNamed) {
            ui.data_mut(|data| data.insert_temp(new_name_id(), Self { is_shown: true, ..self }));
            return None;
        }
        ui.data_mut(|data| data.remove::<Self>(new_name_id()));
        (answer == LayerRowAnswer::Named).then(|| self.text.trim().to_owned())
    }
}

fn new_name_id() -> Id {
    Id::unique("new name of a layer")
}

/// Turns the name of a layer in the list into a field, from the next frame on.
pub fn ask_name(ctx: &Context, layer: &Layer) {
    let new_name = NewName { layer: layer.id, text: layer.name.clone(), is_shown: false };
    ctx.data_mut(|data| data.insert_temp(new_name_id(), new_name));
}

/// Shows the rows, the top layer first, in at most `room` points of height if that is enough for a few.
pub fn show(ui: &mut Ui, state: &FrameState<'_>, room: f32, commands: &mut Vec<Command>) {
    let layers = &state.session.document().settings().layers;
    let height = room.max(LEAST_ROWS.min(layers.len() as f32) * LayerRow::HEIGHT);
    let area = ScrollArea::vertical().max_height(height).min_scrolled_height(height).id_salt("layers");
    area.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let rows: Vec<Response> = layers.iter().rev().map(|layer| row(ui, state, layer, commands)).collect();
        drag(ui, layers, &rows, commands);
    });
}

fn row(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) -> Response {
    let selected = state.session.document().active_layer().map(|layer| layer.id);
    let new_name = ui.data(|data| data.get_temp::<NewName>(new_name_id()));
    let mut new_name = new_name.filter(|new_name| new_name.layer == layer.id);
    let row = LayerRow {
        id: layer.id.0,
        name: &layer.name,
        icon: kind_of(state.layer_kinds, &layer.kind).icon,
        kind: layer.kind.label(),
        combine: combine_name(layer.combine),
        color: layer_color32(layer.id),
        picture: state.feature::<LayerEditor>().pictures.texture(layer.id),
        visible: layer.visible,
        locked: layer.locked,
        selected: selected == Some(layer.id),
        begins_typing: new_name.as_ref().is_some_and(|new_name| !new_name.is_shown),
    };
    let (response, answer) = row.show(ui, new_name.as_mut().map(|new_name| &mut new_name.text));
    row_menu::show(state, layer, &response, commands);
    if let Some(new_name) = new_name {
        let name = new_name.keep(ui, answer).filter(|name| !name.is_empty() && *name != layer.name);
        commands.extend(name.map(|name| Command::from(LayerCommand::Rename(layer.id, name))));
    }
    let command = match answer {
        _ if response.secondary_clicked() => LayerCommand::Select(layer.id),
        LayerRowAnswer::Selected => LayerCommand::Select(layer.id),
        LayerRowAnswer::AsksName => LayerCommand::AskName(layer.id),
        LayerRowAnswer::Shown(visible) => LayerCommand::Show(layer.id, visible),
        LayerRowAnswer::Locked(locked) => LayerCommand::Lock(layer.id, locked),
        _ => return response,
    };
    commands.push(Command::from(command));
    response
}

/// Marks where the dragged row would go, and moves its layer there when it is released.
///
/// ```text
///   gap 0 ────
///   row 0
///   gap 1 ────
///   row 1
///   gap 2 ────
/// ```
fn drag(ui: &mut Ui, layers: &[Layer], rows: &[Response], commands: &mut Vec<Command>) {
    let Some(from) = rows.iter().position(|row| row.dragged() || row.drag_stopped()) else { return };
    let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else { return };
    let gap = rows.iter().filter(|row| row.rect.center().y < pointer.y).count();
    let stays = gap == from || gap == from + 1;
    if rows[from].dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        if !stays {
            paint_gap(ui, rows, gap);
        }
        // A list that scrolls follows the pointer.
        let row = Rect::from_center_size(pos2(rows[from].rect.center().x, pointer.y), rows[from].rect.size());
        ui.scroll_to_rect(row, None);
    } else if !stays && ui.input(|input| input.pointer.any_released()) {
        let above = if gap < from { gap } else { gap - 1 };
        let place = layers.len() - 1 - above;
        commands.push(Command::from(LayerCommand::Move(layers[layers.len() - 1 - from].id, place)));
    }
}

fn paint_gap(ui: &Ui, rows: &[Response], gap: usize) {
    let y = rows.get(gap).map_or_else(|| rows[gap - 1].rect.bottom(), |row| row.rect.top());
    let line = Rect::from_x_y_ranges(rows[0].rect.x_range(), y - 1.0..=y + 1.0);
    ui.painter().rect_filled(line, 1.0, tokens(ui).accent);
}
