//! The kinds of layers: a table with a file for each.

mod band;
mod corridor;
mod curve;
mod distance;
mod formula;
mod paint;
mod raster;
mod threats;

use eframe::egui::Ui;

use crate::app::command::{Command, EditCommand, LayerCommand};
use crate::app::frame::FrameState;
use crate::app::widgets::Icon;
use meshbrush_core::layers::{Layer, LayerKind, Quantity};

/// What the window knows of a kind of layer.
pub struct KindPanel {
    /// Whether a layer is of this kind.
    pub is_of: fn(&LayerKind) -> bool,
    /// Its sign in the list.
    pub icon: Icon,
    /// What adds a layer of this kind.
    pub additions: &'static [Addition],
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

/// All kinds, as menus list them.
pub static LAYER_KINDS: [KindPanel; 7] = [
    paint::PAINT,
    formula::FORMULA,
    raster::RASTER,
    threats::THREATS,
    distance::DISTANCE,
    corridor::CORRIDOR,
    band::BAND,
];

/// The kind of a layer.
pub fn kind_of(kind: &LayerKind) -> &'static KindPanel {
    LAYER_KINDS.iter().find(|panel| (panel.is_of)(kind)).unwrap_or(&LAYER_KINDS[0])
}

/// The command that adds a layer.
fn add(kind: LayerKind) -> Command {
    Command::Layer(LayerCommand::Add(Box::new(kind)))
}

/// Changes what a layer asks for. Further changes join the gesture.
fn set_kind(layer: &Layer, kind: LayerKind, commands: &mut Vec<Command>) {
    commands.push(Command::Layer(LayerCommand::SetKind(layer.id, Box::new(kind))));
}

/// Changes what a layer asks for, as a gesture of its own.
fn set_kind_once(layer: &Layer, kind: LayerKind, commands: &mut Vec<Command>) {
    set_kind(layer, kind, commands);
    commands.push(Command::Edit(EditCommand::EndGesture));
}

/// The name of a quantity.
const fn quantity_name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Risk => "Risk",
        Quantity::Diameter => "Diameter",
    }
}
