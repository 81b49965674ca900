//! What the window knows of a kind of layer.

use egui::Ui;

use super::{FrameState, Tool};
use crate::kit::command::{Command, EditCommand, LayerCommand};
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_ui::widgets::{Icon, NumberRow, toggle_row};

/// What the window knows of a kind of layer.
pub struct LayerKindRow {
    /// Its place in menus: kinds with a lower number stand first.
    pub place: u8,
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

/// The kinds of layers of all features, as menus list them.
pub type LayerKinds = &'static [&'static LayerKindRow];

/// A way to add a layer.
pub struct Addition {
    /// What is added, as menus say it.
    pub title: &'static str,
    /// What adds it.
    pub command: fn(&FrameState<'_>) -> Command,
}

/// The command that adds a layer.
pub fn add_layer(kind: impl Into<LayerKind>) -> Command {
    Command::from(LayerCommand::Add(Box::new(kind.into())))
}

/// Changes what a layer asks for. Further changes join the gesture.
pub fn set_kind(layer: &Layer, kind: impl Into<LayerKind>, commands: &mut Vec<Command>) {
    commands.push(Command::from(LayerCommand::SetKind(layer.id, Box::new(kind.into()))));
}

/// Changes what a layer asks for, as a gesture of its own.
pub fn set_kind_once(layer: &Layer, kind: impl Into<LayerKind>, commands: &mut Vec<Command>) {
    set_kind(layer, kind, commands);
    commands.push(Command::from(EditCommand::EndGesture));
}

/// Shows the distance beyond which a layer asks for nothing. Returns whether it changed.
pub fn range_rows(ui: &mut Ui, state: &FrameState<'_>, range: &mut f64) -> bool {
    let mut is_limited = range.is_finite();
    if toggle_row(ui, "Limit the range", &mut is_limited).changed() {
        let extent = state.session.document().settings().domain.bounds.size().max_element();
        *range = if is_limited { 0.1 * extent } else { f64::INFINITY };
        return true;
    }
    let row = NumberRow::new("Range", range).range(f64::MIN_POSITIVE..=f64::MAX).unit(state.unit().symbol());
    is_limited && row.help("Beyond this distance the layer asks for nothing.").show(ui).changed()
}
