//! A section of a dock, and the rows that many have.
//!
//! A panel is a function of the state that it shows; it changes nothing, but sends commands.

use egui::{Response, RichText, Ui};

use super::{FrameState, Tab};
use crate::kit::command::{Command, EditCommand};
use meshbrush_core::document::Setting;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{self, ActionButton, shown_keys};

/// A section of a dock.
pub struct Panel {
    /// Identifies it.
    pub name: &'static str,
    /// Where it is.
    pub tab: Tab,
    /// Its place there: panels with a lower number stand first.
    pub place: u8,
    /// Draws it.
    pub show: fn(&mut Ui, &FrameState<'_>, &mut Vec<Command>),
}

impl Panel {
    /// Returns whether it is opened and scrolled to in this frame.
    pub fn is_revealed(&self, state: &FrameState<'_>) -> bool {
        state.view.revealed_panel == Some(self.name)
    }
}

/// Rows of buttons: name, whether it is enabled, and the command that it sends. A row that has no room goes
/// on in the next line.
pub fn button_rows<Row, C>(ui: &mut Ui, rows: impl IntoIterator<Item = Row>, commands: &mut Vec<C>)
where
    Row: IntoIterator<Item = (&'static str, bool, C)>,
{
    for row in rows {
        ui.horizontal_wrapped(|ui| {
            for (name, enabled, command) in row {
                if ui.add_enabled(enabled, ActionButton::new(name)).clicked() {
                    commands.push(command);
                }
            }
        });
    }
}

/// Sends the end of a gesture when a control was released.
pub fn end_gesture_when_released(response: &Response, commands: &mut Vec<Command>) {
    if widgets::edit_done(response) {
        commands.push(Command::from(EditCommand::EndGesture));
    }
}

/// Sends a setting as a gesture of its own.
pub fn set_once(setting: Setting, commands: &mut Vec<Command>) {
    commands.extend([Command::from(EditCommand::Set(setting)), Command::from(EditCommand::EndGesture)]);
}

/// Shows a remark in small print. A key is written as in tips: as the id of its entry in braces.
pub fn remark(ui: &mut Ui, text: &str) {
    let text = shown_keys::with_keys(ui.ctx(), text);
    ui.label(RichText::new(text).font(font::caption()).color(tokens(ui).faint));
    ui.add_space(4.0);
}
