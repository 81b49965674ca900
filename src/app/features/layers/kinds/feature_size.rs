//! Layers that ask for triangles across the water, by how wide it is.

use eframe::egui::Ui;

use crate::app::command::Command;
use crate::app::kit::{Addition, FrameState, LayerKindRow, add_layer, remark, set_kind_once};
use crate::app::widgets::{Icon, NumberRow};
use meshbrush_core::layers::{FeatureSize, Layer, LayerKind, WaterMiddle};

/// Triangles across the water.
pub static FEATURE_SIZE: LayerKindRow = LayerKindRow {
    place: 9,
    is_of: |kind| matches!(kind, LayerKind::FeatureSize(_)),
    icon: Icon::FEATURE_SIZE,
    tool: None,
    additions: &[Addition {
        title: "feature size of the domain",
        command: |state| add_layer(LayerKind::feature_size(&state.session.document().settings().transfer)),
    }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let LayerKind::FeatureSize(FeatureSize { across, found }) = &layer.kind else { return };
    let (mut across, [mut from, mut to]) = (*across, found.between());
    let unit = state.unit().symbol();
    let row = NumberRow::new("Triangles across", &mut across).range(1.0..=1000.0);
    let help = "How many triangles are across a channel. Away from its shores and its middle they grow with the way.";
    let is_number_changed = row.help(help).show(ui).changed();
    let row = NumberRow::new("Widths from", &mut from).range(f64::MIN_POSITIVE..=to).unit(unit);
    let help = "The middle of the water is found where it is at least so wide; straits count in any case.";
    let mut are_widths_changed = row.help(help).show(ui).changed();
    let row = NumberRow::new("Widths to", &mut to).range(from..=f64::MAX).unit(unit);
    let help = "Wider water has no middle: there the diameter only grows with the way from narrower places.";
    are_widths_changed |= row.help(help).show(ui).changed();
    let domain = &state.session.document().settings().domain;
    if domain.region().is_none() {
        remark(ui, "The domain has no coast, as it has no polygons: the layer asks for nothing.");
    } else if found.discs().is_empty() {
        remark(ui, "Nowhere is the water so wide between two coasts: the layer asks for nothing.");
    }
    let are_valid = from > 0.0 && from < to;
    if is_number_changed || are_widths_changed && are_valid {
        let found = if are_widths_changed { WaterMiddle::of(domain, [from, to]) } else { found.clone() };
        set_kind_once(layer, LayerKind::FeatureSize(FeatureSize { across, found }), commands);
    }
}
