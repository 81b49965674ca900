//! What the window knows of a kind of layer.

use eframe::egui::Ui;

use super::{FrameState, Tool};
use crate::app::command::{Command, EditCommand, LayerCommand};
use crate::app::widgets::Icon;
use meshbrush_core::layers::{Layer, LayerKind};

/// What the window knows of a kind of layer.
pub struct LayerKindRow {
    /// Whether a layer is of this kind.
    pub is_of: fn(&LayerKind) -> bool,
    /// Its sign in the list.
    pub icon: Icon,
    /// What adds a layer of this kind.
    pub additions: &'static [Addition],
    /// The tool that edits layers of this kind on the canvas, besides the brush.
    pub tool: Option<Tool>,
    /// Shows the parameters of a layer of this kind.
    pub parameters: fn(&mut Ui, &FrameState<'_>, &Layer, &mut Vec<Command>),
}

/// A way to add a layer.
pub struct Addition {
    /// What is added, as menus say it.
    pub title: &'static str,
    /// What adds it.
    pub command: fn(&FrameState<'_>) -> Command,
}

/// The command that adds a layer.
pub fn add_layer(kind: LayerKind) -> Command {
    Command::Layer(LayerCommand::Add(Box::new(kind)))
}

/// Changes what a layer asks for. Further changes join the gesture.
pub fn set_kind(layer: &Layer, kind: LayerKind, commands: &mut Vec<Command>) {
    commands.push(Command::Layer(LayerCommand::SetKind(layer.id, Box::new(kind))));
}

/// Changes what a layer asks for, as a gesture of its own.
pub fn set_kind_once(layer: &Layer, kind: LayerKind, commands: &mut Vec<Command>) {
    set_kind(layer, kind, commands);
    commands.push(Command::Edit(EditCommand::EndGesture));
}
