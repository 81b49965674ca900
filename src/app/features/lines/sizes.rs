//! Layers that ask for what the lines of the document need.

use eframe::egui::Ui;

use meshbrush_core::layers::{Layer, LayerKind, LineSizes};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{Addition, FrameState, LayerKindRow, add_layer, remark, set_kind_once};
use meshbrush_ui::widgets::{Icon, NumberRow};

/// Triangles across the gaps between parts of lines.
pub static LINE_SIZES: LayerKindRow = LayerKindRow {
    place: 11,
    is_of: |kind| kind.is::<LineSizes>(),
    icon: Icon::PATH,
    tool: None,
    additions: &[Addition {
        title: "sizes for lines",
        command: |_| add_layer(LayerKind::Lines(LineSizes::default())),
    }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(LineSizes { across, gaps }) = layer.kind.get() else { return };
    let mut across = *across;
    let help = "How many triangles are across the gap between two parts of lines. One is enough for edges along \
                nearly all of them.";
    if NumberRow::new("Triangles across", &mut across).range(0.01..=1000.0).help(help).show(ui).changed() {
        set_kind_once(layer, LineSizes { across, gaps: gaps.clone() }, commands);
    }
    if state.session.document().settings().lines.is_empty() {
        remark(ui, "The document has no lines: the layer asks for nothing. Add lines in the tab Domain.");
    }
}
