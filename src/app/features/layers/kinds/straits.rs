//! Layers that ask for triangles across straits.

use eframe::egui::Ui;

use crate::app::kit::{Addition, FrameState, LayerKindRow, add_layer, remark, set_kind_once};
use crate::app::widgets::{Icon, NumberRow, ValueRow, format};
use meshbrush_core::layers::{Layer, LayerKind, StraitDisc, StraitDiscs, Straits};

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

fn parameters(
    ui: &mut Ui,
    state: &FrameState<'_>,
    layer: &Layer,
    commands: &mut Vec<crate::app::command::Command>,
) {
    let LayerKind::Straits(Straits { across, found }) = &layer.kind else { return };
    let (mut across, [mut from, mut to]) = (*across, found.between());
    let unit = state.unit().symbol();
    let row = NumberRow::new("Triangles across", &mut across).range(1.0..=1000.0);
    let help = "Least number of triangles on each segment across the water, from one coast to another.";
    let is_number_changed = row.help(help).show(ui).changed();
    let row = NumberRow::new("Widths from", &mut from).range(f64::MIN_POSITIVE..=to).unit(unit);
    let help = "Narrower straits get triangles as if they were so wide.";
    let mut are_widths_changed = row.help(help).show(ui).changed();
    let row = NumberRow::new("Widths to", &mut to).range(from..=f64::MAX).unit(unit);
    are_widths_changed |= row.help("Wider water is no strait.").show(ui).changed();
    let domain = &state.session.document().settings().domain;
    if domain.region().is_none() {
        remark(ui, "The domain has no coast, as it has no polygons: the layer asks for nothing.");
    }
    let width = |disc: &StraitDisc| {
        disc.width / domain.projection.map_or(1.0, |projection| projection.scale_in_plane(disc.center))
    };
    let narrowest = found.discs().first().map(width);
    let narrowest =
        narrowest.map_or("none".to_owned(), |width| state.unit().after(&format::digits(width, 4)));
    ValueRow::new("Narrowest strait", &narrowest)
        .help("Width of the narrowest strait of the domain.")
        .show(ui);
    let are_valid = from > 0.0 && from < to;
    if is_number_changed || are_widths_changed && are_valid {
        let found = if are_widths_changed { StraitDiscs::of(domain, [from, to]) } else { found.clone() };
        set_kind_once(layer, LayerKind::Straits(Straits { across, found }), commands);
    }
}
