//! Layers that ask for one diameter where a raster lies between two values.

use eframe::egui::Ui;

use super::raster::source_rows;
use crate::app::features::layers::OPEN_BAND;
use meshbrush_core::layers::{BandLayer, Layer};
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};
use meshbrush_kit::kit::{Addition, FrameState, LayerKindRow, set_kind_once};
use meshbrush_ui::widgets::{Icon, NumberRow};

/// A band of the values of a raster.
pub static BAND: LayerKindRow = LayerKindRow {
    place: 6,
    is_of: |kind| kind.is::<BandLayer>(),
    icon: Icon::BAND,
    tool: None,
    additions: &[
        Addition { title: "band of a raster…", command: |_| Command::from(LayerCommand::AddBand) },
        Addition { title: "band of a file…", command: |_| Command::from(FileCommand::Ask(&OPEN_BAND)) },
    ],
    parameters,
};

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(BandLayer { source, between, diameter }) = layer.kind.get() else { return };
    let ([mut least, mut greatest], mut diameter) = (*between, *diameter);
    let row = NumberRow::new("Values from", &mut least).range(f64::MIN..=greatest);
    let mut changed = row.help("The least value of the raster in the band.").show(ui).changed();
    let row = NumberRow::new("Values to", &mut greatest).range(least..=f64::MAX);
    changed |= row.help("The greatest value of the raster in the band.").show(ui).changed();
    let row = NumberRow::new("Diameter", &mut diameter).range(f64::MIN_POSITIVE..=f64::MAX);
    let help =
        "Target diameter where the value of the raster is in the band; elsewhere the layer asks for nothing.";
    changed |= row.unit(state.unit().symbol()).help(help).show(ui).changed();
    source_rows(ui, state, source);
    if changed {
        let source = source.clone();
        set_kind_once(layer, BandLayer { source, between: [least, greatest], diameter }, commands);
    }
}
