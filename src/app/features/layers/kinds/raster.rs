//! Layers of a raster.

use std::sync::Arc;

use eframe::egui::Ui;

use super::curve::{curve_plot, curve_rows, default_curves};
use crate::app::features::layers::{OPEN_DIAMETERS, OPEN_RISK, OPEN_VALUES};
use meshbrush_core::document::Setting;
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Layer, LayerKind, RasterLayer, RasterReading, RasterSource, ValueCurve};
use meshbrush_core::raster::check_values;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::{
    Addition, FrameState, LayerKindRow, end_gesture_when_released, set_kind, set_kind_once, size_price_row,
};
use meshbrush_ui::widgets::{Icon, ValueRow, format, segmented};

/// A picture or a grid.
pub static RASTER: LayerKindRow = LayerKindRow {
    place: 2,
    is_of: |kind| kind.is::<RasterLayer>(),
    icon: Icon::RASTER,
    tool: None,
    additions: &[
        Addition {
            title: "picture or grid, as risk…",
            command: |_| Command::from(FileCommand::Ask(&OPEN_RISK)),
        },
        Addition {
            title: "grid, as target diameter…",
            command: |_| Command::from(FileCommand::Ask(&OPEN_DIAMETERS)),
        },
        Addition {
            title: "picture or grid, through a curve…",
            command: |_| Command::from(FileCommand::Ask(&OPEN_VALUES)),
        },
    ],
    parameters,
};

/// The meaning of the values of a raster, without a curve's knots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    Diameter,
    Risk,
    Error,
    Curve,
}

impl Meaning {
    const CHOICES: [(Self, &str); 4] =
        [(Self::Diameter, "Diameter"), (Self::Risk, "Risk"), (Self::Error, "Error"), (Self::Curve, "Curve")];

    fn of(reading: &RasterReading) -> Self {
        match reading {
            RasterReading::Diameter => Self::Diameter,
            RasterReading::Risk => Self::Risk,
            RasterReading::Error => Self::Error,
            RasterReading::Curve(_) => Self::Curve,
        }
    }
}

fn parameters(ui: &mut Ui, state: &FrameState<'_>, layer: &Layer, commands: &mut Vec<Command>) {
    let Some(RasterLayer { source, reading }) = layer.kind.get() else { return };
    let mut meaning = Meaning::of(reading);
    if segmented(ui, "What the values mean", &mut meaning, &Meaning::CHOICES).changed() {
        match read_as(meaning, source, reading, &state.session.document().settings().transfer) {
            Ok(reading) => {
                set_kind_once(layer, RasterLayer { source: source.clone(), reading }, commands);
            }
            Err(problem) => commands.push(Command::from(ShellCommand::Report(problem))),
        }
    } else if let RasterReading::Curve(curve) = reading {
        curve_controls(ui, state, layer, source, curve, commands);
    }
    ui.add_space(4.0);
    source_rows(ui, state, source);
}

/// Shows the curve as a plot and as numbers. A drag in the plot is one gesture.
fn curve_controls(
    ui: &mut Ui,
    state: &FrameState<'_>,
    layer: &Layer,
    source: &RasterSource,
    curve: &ValueCurve,
    commands: &mut Vec<Command>,
) {
    let kind = |curve| {
        let reading = RasterReading::Curve(Arc::new(curve));
        LayerKind::from(RasterLayer { source: source.clone(), reading })
    };
    ui.add_space(4.0);
    let (plotted, response) = curve_plot(ui, state, source, curve);
    if let Some(curve) = plotted {
        set_kind(layer, kind(curve), commands);
    }
    end_gesture_when_released(&response, commands);
    let default = default_curves(ui, state, source);
    let candidate = default.hovered.map(|curve| with_kind(state, layer, kind(curve)));
    let kinds = [Setting::Layers(Vec::new()).kind()];
    size_price_row(ui, state, &kinds, candidate, commands);
    if let Some(curve) = default.chosen.or(curve_rows(ui, curve, state.unit())) {
        set_kind_once(layer, kind(curve), commands);
    }
}

/// Returns the layers of the document, where one asks for something else.
fn with_kind(state: &FrameState<'_>, layer: &Layer, kind: LayerKind) -> Setting {
    let mut layers = state.session.document().settings().layers.clone();
    if let Some(changed) = layers.iter_mut().find(|other| other.id == layer.id) {
        changed.kind = kind;
    }
    Setting::Layers(layers)
}

/// Returns the reading of a raster with another meaning. A new curve is fine where the layer was fine: where
/// the risk is greatest or the diameter least.
///
/// # Errors
/// Fails with a sentence when the values cannot have that meaning.
fn read_as(
    meaning: Meaning,
    source: &RasterSource,
    before: &RasterReading,
    transfer: &Transfer,
) -> Result<RasterReading, String> {
    let checked = |reading: RasterReading| {
        let problem = check_values(&source.raster, (&reading).into());
        problem.map(|()| reading).map_err(|problem| format!("{}: {problem}", source.name))
    };
    Ok(match meaning {
        Meaning::Risk => checked(RasterReading::Risk)?,
        Meaning::Diameter => checked(RasterReading::Diameter)?,
        Meaning::Error => checked(RasterReading::Error)?,
        Meaning::Curve => {
            let Transfer { h_min, h_risk, h_max, shape: _ } = *transfer;
            let ends = if *before == RasterReading::Risk { [h_max, h_risk] } else { [h_min, h_max] };
            let curve = source.raster.finite_range().and_then(|range| ValueCurve::over(range, ends));
            let curve = curve.ok_or_else(|| {
                let name = &source.name;
                format!("No pixel of {name} has a value, so there is nothing to make a curve of.")
            })?;
            RasterReading::Curve(Arc::new(curve))
        }
    })
}

/// Shows the value of a raster at the pointer, its source, and its size.
pub fn source_rows(ui: &mut Ui, state: &FrameState<'_>, source: &RasterSource) {
    let text = match state.pointer.map(|point| source.raster.sample(point)) {
        Some(Some(value)) => format::digits(f64::from(value), 5),
        Some(None) => "none".into(),
        None => "–".into(),
    };
    let help = "The value of the raster at the pointer on the canvas, in the unit that the raster has.";
    ValueRow::new("Value at the pointer", &text).help(help).show(ui);
    ValueRow::new("File", &source.name).help("The file that the layer was read from.").show(ui);
    let [columns, rows] = source.raster.raster().size().map(|side| format::count(u64::from(side)));
    let pixels = format!("{columns} × {rows}");
    ValueRow::new("Pixels", &pixels).help("Columns and rows of the raster; all of them count.").show(ui);
}
