//! Layers of a raster.

use std::sync::Arc;

use eframe::egui::Ui;

use super::curve::curve_rows;
use super::{Addition, KindPanel, set_kind_once};
use crate::app::command::{Command, FileCommand, ShellCommand};
use crate::app::features::layers::{OPEN_DIAMETERS, OPEN_RISK, OPEN_VALUES};
use crate::app::frame::FrameState;
use crate::app::widgets::{Icon, ValueRow, format, segmented};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Layer, LayerKind, RasterReading, RasterSource, ValueCurve};
use meshbrush_io::io;

/// A picture or a grid.
pub const RASTER: KindPanel = KindPanel {
    is_of: |kind| matches!(kind, LayerKind::Raster { .. }),
    icon: Icon::RASTER,
    additions: &[
        Addition {
            title: "picture or grid, as risk…",
            command: |_| Command::File(FileCommand::Ask(&OPEN_RISK)),
        },
        Addition {
            title: "grid, as target diameter…",
            command: |_| Command::File(FileCommand::Ask(&OPEN_DIAMETERS)),
        },
        Addition {
            title: "picture or grid, through a curve…",
            command: |_| Command::File(FileCommand::Ask(&OPEN_VALUES)),
        },
    ],
    parameters,
};

/// What the values of a raster mean, without a curve's knots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    Diameter,
    Risk,
    Curve,
}

impl Meaning {
    const CHOICES: [(Self, &str); 3] =
        [(Self::Diameter, "Diameter"), (Self::Risk, "Risk"), (Self::Curve, "Curve")];

    fn of(reading: &RasterReading) -> Self {
        match reading {
            RasterReading::Diameter => Self::Diameter,
            RasterReading::Risk => Self::Risk,
            RasterReading::Curve(_) => Self::Curve,
        }
    }
}

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let LayerKind::Raster { source, reading } = &layer.kind else { return };
    let mut meaning = Meaning::of(reading);
    let mut set = |reading| {
        set_kind_once(layer, LayerKind::Raster { source: source.clone(), reading }, commands);
    };
    if segmented(ui, "What the values mean", &mut meaning, &Meaning::CHOICES).changed() {
        match read_as(meaning, source, reading, &state.session.document().settings().transfer) {
            Ok(reading) => set(reading),
            Err(problem) => commands.push(Command::Shell(ShellCommand::Report(problem))),
        }
    } else if let RasterReading::Curve(curve) = reading
        && let Some(curve) = curve_rows(ui, curve, state.unit())
    {
        set(RasterReading::Curve(Arc::new(curve)));
    }
    ui.add_space(4.0);
    source_rows(ui, source);
}

/// The reading of a raster with another meaning. A new curve is fine where the layer was fine: where the risk
/// is greatest or the diameter least.
///
/// # Errors
/// A sentence, when the values cannot have that meaning.
fn read_as(
    meaning: Meaning,
    source: &RasterSource,
    before: &RasterReading,
    transfer: &Transfer,
) -> Result<RasterReading, String> {
    let (risk, diameter) = (io::layers::RasterReading::Risk, io::layers::RasterReading::Diameter);
    let checked = |reading| {
        let problem = io::layers::check_values(&source.raster, reading);
        problem.map_err(|problem| format!("{}: {problem}", source.name))
    };
    Ok(match meaning {
        Meaning::Risk => checked(&risk).map(|()| RasterReading::Risk)?,
        Meaning::Diameter => checked(&diameter).map(|()| RasterReading::Diameter)?,
        Meaning::Curve => {
            let Transfer { h_min, h_max, .. } = *transfer;
            let ends = if *before == RasterReading::Risk { [h_max, h_min] } else { [h_min, h_max] };
            let curve = source.raster.finite_range().and_then(|range| ValueCurve::over(range, ends));
            let curve = curve.ok_or_else(|| {
                let name = &source.name;
                format!("No pixel of {name} has a value, so there is nothing to make a curve of.")
            })?;
            RasterReading::Curve(Arc::new(curve))
        }
    })
}

/// Where a raster is from, and its size.
pub fn source_rows(ui: &mut Ui, source: &RasterSource) {
    ValueRow::new("File", &source.name).help("The file that the layer was read from.").show(ui);
    let [columns, rows] = source.raster.raster().size().map(|side| format::count(u64::from(side)));
    let pixels = format!("{columns} × {rows}");
    ValueRow::new("Pixels", &pixels).help("Columns and rows of the raster; all of them count.").show(ui);
}
