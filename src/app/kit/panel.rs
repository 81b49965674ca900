//! A section of the side panel, and the rows that many have.
//!
//! A panel is a function of the state that it shows; it changes nothing, but sends commands.

use eframe::egui::{Response, RichText, Ui};

use super::FrameState;
use crate::app::command::{Command, EditCommand};
use crate::app::theme::{font, tokens};
use crate::app::widgets::{self, ActionButton};
use meshbrush_core::document::Setting;

/// A section of the side panel.
pub struct Panel {
    /// Identifies it.
    pub name: &'static str,
    /// The panels that it stands among.
    pub group: PanelGroup,
    /// Whether it is shown only while a tool that lists it is selected.
    pub only_with_tool: bool,
    /// Draws it.
    pub show: fn(&mut Ui, &FrameState<'_>, &mut Vec<Command>),
}

impl Panel {
    /// Returns whether it is opened and scrolled to in this frame.
    pub fn is_revealed(&self, state: &FrameState<'_>) -> bool {
        state.view.revealed_panel == Some(self.name)
    }
}

/// Panels that belong together, in the order of the side panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PanelGroup {
    /// Panels about the target diameter.
    Size,
    /// The queried triangle, and points that are followed.
    Inspect,
    /// Paths through the mesh.
    Paths,
    /// How the mesh is made, and its figures.
    Mesh,
    /// The domain, its boundary, and what is behind it.
    Domain,
    /// How all of it is drawn.
    View,
}

impl PanelGroup {
    /// All of them, from the top.
    pub const ALL: [Self; 6] = [Self::Size, Self::Inspect, Self::Paths, Self::Mesh, Self::Domain, Self::View];
}

/// Rows of buttons: name, whether it is enabled, and the command that it sends.
pub fn button_rows<Row, C>(ui: &mut Ui, rows: impl IntoIterator<Item = Row>, commands: &mut Vec<C>)
where
    Row: IntoIterator<Item = (&'static str, bool, C)>,
{
    for row in rows {
        ui.horizontal(|ui| {
            for (name, enabled, command) in row {
                let button = ActionButton::new(name);
                if ui.add_enabled_ui(enabled, |ui| ui.add(button)).inner.clicked() {
                    commands.push(command);
                }
            }
        });
    }
}

/// Sends the end of a gesture when a control was released.
pub fn end_gesture_when_released(response: &Response, commands: &mut Vec<Command>) {
    if widgets::edit_done(response) {
        commands.push(Command::Edit(EditCommand::EndGesture));
    }
}

/// Sends a setting as a gesture of its own.
pub fn set_once(setting: Setting, commands: &mut Vec<Command>) {
    commands.extend([Command::Edit(EditCommand::Set(setting)), Command::Edit(EditCommand::EndGesture)]);
}

/// A remark in small print.
pub fn remark(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).font(font::caption()).color(tokens(ui).faint));
    ui.add_space(4.0);
}
