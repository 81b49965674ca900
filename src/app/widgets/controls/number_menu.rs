//! The menu of a number: its default, and the clipboard.

use eframe::egui::{Button, Event, Id, Popup, Response, Ui, ViewportCommand};

use super::number_input::NumberInput;

/// How a number in a field is changed, for its tooltip.
pub(super) const WAYS: &str =
    "Type it, drag it, or hold Ctrl and turn the wheel. Right-click for its default, Copy and Paste.";
/// Seconds that the window waits for the contents of the clipboard.
const PATIENCE: f64 = 1.0;

/// Shows the menu of a number after a secondary click on `response`. Returns the default if it was chosen.
/// What is pasted goes into the cell `cell`; without one, nothing can be pasted.
pub(super) fn number_menu(
    ui: &Ui,
    response: &Response,
    input: &NumberInput<'_>,
    cell: Option<Id>,
) -> Option<f64> {
    let mut reset = None;
    Popup::context_menu(response).show(|menu| {
        menu.set_min_width(160.0);
        if let Some(default) = input.default {
            let text = format!("Reset to {}", (input.show)(default));
            if menu.add_enabled(default != input.value, Button::new(text)).clicked() {
                reset = Some(default);
                menu.close();
            }
        }
        if menu.button("Copy").clicked() {
            menu.copy_text(input.exact());
            menu.close();
        }
        if let Some(cell) = cell
            && menu.button("Paste").clicked()
        {
            let now = ui.input(|input| input.time);
            ui.data_mut(|data| data.insert_temp(awaiting(cell), now));
            ui.ctx().send_viewport_cmd(ViewportCommand::RequestPaste);
            menu.close();
        }
    });
    reset
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
