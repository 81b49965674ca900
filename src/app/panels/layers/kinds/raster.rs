//! Layers of a raster.

use eframe::egui::Ui;

use super::{Addition, KindPanel, set_kind_once};
use crate::app::command::Command;
use crate::app::dialogs::FileRequest;
use crate::app::frame::FrameState;
use crate::app::widgets::{Icon, ValueRow, format, segmented};
use crate::layers::{Layer, LayerKind, RasterReading};

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
    let choices = [("Diameter", RasterReading::Diameter), ("Risk", RasterReading::Risk)];
    let before = choices.iter().position(|(_, known)| known == reading);
    let mut chosen = before;
    let named = [0, 1].map(|place| (Some(place), choices[place].0));
    if segmented(ui, "What the values mean", &mut chosen, &named).changed()
        && let Some(place) = chosen
    {
        let kind = LayerKind::Raster { source: source.clone(), reading: choices[place].1.clone() };
        set_kind_once(layer, kind, commands);
    }
    ui.add_space(4.0);
    ValueRow::new("File", &source.name).help("The file that the layer was read from.").show(ui);
    let [columns, rows] = source.raster.raster().size().map(|side| format::count(u64::from(side)));
    let pixels = format!("{columns} × {rows}");
    ValueRow::new("Pixels", &pixels).help("Columns and rows of the raster; all of them count.").show(ui);
}
