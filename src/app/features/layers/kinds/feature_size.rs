//! Layers that ask for triangles across the water, by how wide it is.

use eframe::egui::Ui;

use super::water::{ChangedWater, WaterRows};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::{FeatureSize, Layer, LayerKind, MedialAxis};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{Addition, FrameState, LayerKindRow, add_layer, remark, set_kind_once};
use meshbrush_ui::widgets::Icon;

/// Triangles across the water.
pub static FEATURE_SIZE: LayerKindRow = LayerKindRow {
    place: 9,
    is_of: |kind| kind.is::<FeatureSize>(),
    icon: Icon::FEATURE_SIZE,
    tool: None,
    additions: &[Addition {
        title: "feature size of the domain",
        command: |state| add_layer(LayerKind::feature_size(&state.session.document().settings().transfer)),
    }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(FeatureSize { across, found }) = layer.kind.get() else { return };
    let rows = WaterRows {
        across: *across,
        between: found.between(),
        across_help: "How many triangles are across a channel. Away from its shores and its middle they grow with the way.",
        from_help: "The middle of the water is found where it is at least so wide; straits count in any case.",
        to_help: "Wider water has no middle: there the diameter only grows with the way from narrower places.",
    };
    let changed = rows.show(ui, state);
    let Settings { domain, boundary_marks: marks, .. } = state.session.document().settings();
    if domain.region().is_some() && found.discs().is_empty() {
        remark(ui, "Nowhere is the water so wide between two coasts: the layer asks for nothing.");
    }
    if let Some(ChangedWater { across, between }) = changed {
        let found = between.map_or_else(|| found.clone(), |between| MedialAxis::of(domain, marks, between));
        set_kind_once(layer, FeatureSize { across, found }, commands);
    }
}
