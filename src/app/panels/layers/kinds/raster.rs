//! Layers of a raster.

use eframe::egui::Ui;

use super::{Addition, KindPanel, set_kind_once};
use crate::app::command::Command;
use crate::app::dialogs::FileRequest;
use crate::app::frame::FrameState;
use crate::app::widgets::{Icon, ValueRow, format, segmented};
use crate::layers::{Layer, LayerKind, RasterReading, RasterSource};

/// A picture or a grid.
pub const RASTER: KindPanel = KindPanel {
    is_of: |kind| matches!(kind, LayerKind::Raster { .. }),
    icon: Icon::RASTER,
    additions: &[
        Addition { title: "picture or grid, as risk…", command: |_| Command::Ask(FileRequest::OpenImage) },
        Addition {
            title: "grid, as target diameter…",
            command: |_| Command::Ask(FileRequest::OpenDiameters),
        },
    ],
    parameters,
};

fn parameters(ui: &mut Ui, _state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let LayerKind::Raster { source, reading } = &layer.kind else { return };
    let mut readings = vec![("Diameter", RasterReading::Diameter), ("Risk", RasterReading::Risk)];
    if matches!(reading, RasterReading::Curve(_)) {
        readings.push(("Curve", reading.clone()));
    }
    let named: Vec<_> = readings.iter().enumerate().map(|(place, (name, _))| (place, *name)).collect();
    let mut chosen = readings.iter().position(|(_, known)| known == reading).unwrap_or_default();
    if segmented(ui, "What the values mean", &mut chosen, &named).changed() {
        let kind = LayerKind::Raster { source: source.clone(), reading: readings[chosen].1.clone() };
        set_kind_once(layer, kind, commands);
    }
    ui.add_space(4.0);
    source_rows(ui, source);
}

/// Where a raster is from, and its size.
pub fn source_rows(ui: &mut Ui, source: &RasterSource) {
    ValueRow::new("File", &source.name).help("The file that the layer was read from.").show(ui);
    let [columns, rows] = source.raster.raster().size().map(|side| format::count(u64::from(side)));
    let pixels = format!("{columns} × {rows}");
    ValueRow::new("Pixels", &pixels).help("Columns and rows of the raster; all of them count.").show(ui);
}
