//! The level that a legend lights while the pointer is on it.

use egui::{Id, Ui};

use super::FrameState;
use super::command::{Command, ViewCommand};

/// Shows the level under the pointer alone, and all again when the pointer leaves the legend of this name.
/// Two legends can be shown: each takes back only what it has asked for.
pub fn light_level(
    ui: &Ui,
    legend: &'static str,
    hovered: Option<u32>,
    state: &FrameState<'_>,
    commands: &mut Vec<Command>,
) {
    let id = Id::unique(("level that a legend lights", legend));
    let lit: Option<u32> = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    if hovered != lit || (lit.is_some() && lit != state.view.lone_level) {
        ui.data_mut(|data| data.insert_temp(id, hovered));
        commands.push(Command::from(ViewCommand::ShowLevel(hovered)));
    }
}
