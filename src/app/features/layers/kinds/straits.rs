//! Layers that ask for triangles across straits.

use eframe::egui::Ui;

use super::water::{ChangedWater, WaterRows};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::Domain;
use meshbrush_core::layers::{Layer, LayerKind, MedialBall, MedialBalls, Straits};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::{Addition, FrameState, LayerKindRow, add_layer, remark, set_kind_once};
use meshbrush_ui::widgets::{Icon, ValueRow, format};

/// Triangles across straits.
pub static STRAITS: LayerKindRow = LayerKindRow {
    place: 8,
    is_of: |kind| kind.is::<Straits>(),
    icon: Icon::STRAITS,
    tool: None,
    additions: &[Addition {
        title: "straits of the domain",
        command: |state| add_layer(LayerKind::straits(&state.session.document().settings().transfer)),
    }],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(Straits { across, found }) = layer.kind.get() else { return };
    let rows = WaterRows {
        across: *across,
        between: found.between(),
        across_help: "Least number of triangles on each segment across the water, from one coast to another.",
        from_help: "Narrower straits get triangles as if they were so wide.",
        to_help: "Wider water is no strait.",
    };
    let changed = rows.show(ui, state);
    let Settings { domain, boundary_marks: marks, transfer, .. } = state.session.document().settings();
    show_narrowest(ui, state, (domain, found.narrowest(domain)), commands);
    if let Some(width) = found.narrowest(domain).map(|passage| domain.on_earth(passage.width, passage.center))
        && width < (across + 1.0) * transfer.h_min
    {
        remark(ui, "The smallest diameter leaves fewer triangles across the narrowest strait.");
    }
    if let Some(ChangedWater { across, between }) = changed {
        let found = between.map_or_else(|| found.clone(), |between| MedialBalls::of(domain, marks, between));
        set_kind_once(layer, Straits { across, found }, commands);
    }
}

fn show_narrowest(
    ui: &mut Ui,
    state: &FrameState<'_>,
    (domain, narrowest): (&Domain, Option<MedialBall>),
    commands: &mut Vec<Command>,
) {
    let Some(MedialBall { center, width, .. }) = narrowest else {
        let help = "No passage between two shores has wider water on both sides.";
        ValueRow::new("Narrowest strait", "none").help(help).show(ui);
        return;
    };
    let width = domain.on_earth(width, center);
    let text = state.unit().after(&format::digits(width, 4));
    let help = "Width of the narrowest passage between two shores, with wider water on both sides. A click goes there.";
    if ValueRow::new("Narrowest strait", &text).help(help).link().show(ui).clicked() {
        commands.push(Command::from(ViewCommand::LookAt(center)));
    }
}
