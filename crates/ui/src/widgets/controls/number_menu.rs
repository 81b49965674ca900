//! The menu of a number: its default, and the clipboard.

use egui::{Button, Event, Id, Popup, Response, Ui, ViewportCommand};

use super::number_input::NumberInput;
use crate::widgets::key_menu::{enter_menu, menu_of};

/// How a number in a field is changed, for its tooltip.
pub(super) const WAYS: &str = "Type it, drag it, or hold Ctrl and turn the wheel. Right-click or Shift+F10 for its default, Copy and Paste.";
/// Seconds that the window waits for the contents of the clipboard.
const PATIENCE: f64 = 1.0;

/// Shows the menu of a number after a secondary click on `response`, or after Shift+F10 while it has the
/// focus. Returns the default if it was chosen. What is pasted goes into the cell `cell`; without one,
/// nothing can be pasted.
pub(super) fn number_menu(
    ui: &Ui,
    response: &Response,
    input: &NumberInput<'_>,
    cell: Option<Id>,
) -> Option<f64> {
    let id = Popup::default_response_id(response);
    menu_of(response).show(|menu| entries(ui, menu, id, input, cell)).and_then(|shown| shown.inner)
}

fn entries(ui: &Ui, menu: &mut Ui, id: Id, input: &NumberInput<'_>, cell: Option<Id>) -> Option<f64> {
    menu.set_min_width(160.0);
    let reset = input.default.map(|default| {
        let text = format!("Reset to {}", (input.show)(default));
        (menu.add_enabled(default != input.value, Button::new(text)), default)
    });
    let copy = menu.button("Copy");
    let paste = cell.map(|cell| (menu.button("Paste"), cell));
    if copy.clicked() {
        menu.copy_text(input.exact());
    }
    if let Some((_, cell)) = paste.as_ref().filter(|(paste, _)| paste.clicked()) {
        let now = ui.input(|input| input.time);
        ui.data_mut(|data| data.insert_temp(awaiting(*cell), now));
        ui.ctx().send_viewport_cmd(ViewportCommand::RequestPaste);
    }
    let chosen = reset.as_ref().filter(|(button, _)| button.clicked()).map(|(_, default)| *default);
    let buttons: Vec<_> =
        reset.map(|reset| reset.0).into_iter().chain([copy]).chain(paste.map(|paste| paste.0)).collect();
    if buttons.iter().any(Response::clicked) {
        menu.close();
    }
    enter_menu(menu.ctx(), id, &buttons);
    chosen
}

/// Returns the text that arrived from the clipboard for the cell `cell`, after *Paste* was chosen.
pub(super) fn pasted(ui: &Ui, cell: Id) -> Option<String> {
    let since = ui.data(|data| data.get_temp::<f64>(awaiting(cell)))?;
    let text = ui.input(|input| {
        input.events.iter().find_map(|event| match event {
            Event::Paste(text) => Some(text.clone()),
            _ => None,
        })
    });
    if text.is_some() || ui.input(|input| input.time) > since + PATIENCE {
        ui.data_mut(|data| data.remove::<f64>(awaiting(cell)));
    }
    text
}

/// Keeps in egui's memory when a cell began to wait for the clipboard.
fn awaiting(cell: Id) -> Id {
    cell.with("awaiting the clipboard")
}
