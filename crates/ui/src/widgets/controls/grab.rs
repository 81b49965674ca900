//! Handles that are dragged.

use egui::{Event, Id, PointerButton, Pos2, Rect, Ui, Vec2};

/// A handle that is held.
#[derive(Clone, Copy)]
struct Held {
    /// The vector from the pointer to the middle of the handle, in points.
    offset: Vec2,
}

/// Returns the position to which a drag moves the handle at `position` in this frame. It is grabbed within
/// `size`, in points.
///
/// egui tests where the pointer is at the end of a frame, so a slow frame that brings a press together with
/// the movement or the release after it would miss the handle. The events say where the press was.
pub(super) fn target(ui: &Ui, id: Id, position: Pos2, size: Vec2) -> Option<Pos2> {
    let mut held: Option<Held> = ui.data(|data| data.get_temp(id));
    let mut target = None;
    for event in ui.input(|input| input.events.clone()) {
        match event {
            Event::PointerButton { pos, button: PointerButton::Primary, pressed: true, .. } => {
                let hit = Rect::from_center_size(position, size).contains(pos) && is_free_at(ui, pos);
                held = hit.then(|| Held { offset: position - pos });
            }
            Event::PointerMoved(pos) => target = held.map(|held| pos + held.offset).or(target),
            Event::PointerButton { button: PointerButton::Primary, pressed: false, .. } => held = None,
            _ => {}
        }
    }
    held = held.filter(|_| ui.input(|input| input.pointer.primary_down()));
    ui.data_mut(|data| match held {
        Some(held) => {
            data.insert_temp(id, held);
        }
        None => data.remove::<Held>(id),
    });
    if held.is_some() && !ui.ctx().is_being_dragged(id) {
        ui.ctx().set_dragged_id(id);
    }
    target
}

/// Returns whether a press at `pos` meets this panel, and nothing over it.
fn is_free_at(ui: &Ui, pos: Pos2) -> bool {
    ui.is_enabled() && ui.clip_rect().contains(pos) && ui.ctx().layer_id_at(pos) == Some(ui.layer_id())
}
