//! Layers of threats.

use eframe::egui::Ui;

use super::KindPanel;
use crate::app::command::Command;
use crate::app::frame::FrameState;
use crate::app::widgets::{Icon, ValueRow, format};
use crate::layers::{Layer, LayerKind};

/// Places with a risk around them.
pub const THREATS: KindPanel = KindPanel {
    is_of: |kind| matches!(kind, LayerKind::Threats(_)),
    icon: Icon::THREATS,
    additions: &[],
    parameters,
};

fn parameters(ui: &mut Ui, _state: &FrameState<'_>, layer: &Layer, _commands: &mut Vec<Command>) {
    let LayerKind::Threats(threats) = &layer.kind else { return };
    let count = format::count(threats.list().len() as u64);
    ValueRow::new("Threats", &count).help("Places with a risk around them, in this layer.").show(ui);
}
