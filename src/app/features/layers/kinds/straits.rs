//! Layers that ask for triangles across straits.

use eframe::egui::Ui;

use super::water::{ChangedWater, WaterRows};
use crate::app::command::Command;
use crate::app::kit::{Addition, FrameState, LayerKindRow, add_layer, set_kind_once};
use crate::app::widgets::{Icon, ValueRow, format};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::{Layer, LayerKind, StraitDiscs, Straits};

/// Triangles across straits.
pub static STRAITS: LayerKindRow = LayerKindRow {
    place: 8,
    is_of: |kind| matches!(kind, LayerKind::Straits(_)),
    icon: Icon::STRAITS,
    tool: None,
    additions: &[Addition {
        title: "straits of the domain",
        command: |state| add_layer(LayerKind::straits(&state.session.document().settings().transfer)),
    }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let LayerKind::Straits(Straits { across, found }) = &layer.kind else { return };
    let rows = WaterRows {
        across: *across,
        between: found.between(),
        across_help: "Least number of triangles on each segment across the water, from one coast to another.",
        from_help: "Narrower straits get triangles as if they were so wide.",
        to_help: "Wider water is no strait.",
    };
    let changed = rows.show(ui, state);
    let Settings { domain, boundary_marks: marks, .. } = state.session.document().settings();
    let narrowest = found.discs().first().map(|disc| domain.on_earth(disc.width, disc.center));
    let narrowest =
        narrowest.map_or("none".to_owned(), |width| state.unit().after(&format::digits(width, 4)));
    ValueRow::new("Narrowest strait", &narrowest)
        .help("Width of the narrowest strait of the domain.")
        .show(ui);
    if let Some(ChangedWater { across, between }) = changed {
        let found = between.map_or_else(|| found.clone(), |between| StraitDiscs::of(domain, marks, between));
        set_kind_once(layer, LayerKind::Straits(Straits { across, found }), commands);
    }
}
