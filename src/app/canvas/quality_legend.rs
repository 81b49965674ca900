//! The legends of overlays that show how good triangles are.

use eframe::egui::{Rect, Ui, vec2};

use super::legend::{ROW, WIDTH, below_scale, boxed, no_layer, scale};
use super::overlay_palette::{
    EDGE_RATIOS, LARGEST_ANGLES, MOST_SLACK, OverlayPalette, SMALLEST_ANGLES, VALENCES,
};
use crate::app::features::statistics::{NoTimeStep, Statistics};
use meshbrush_core::layers::DepthSurface;
use meshbrush_core::quality::QualityMeasure;
use meshbrush_kit::kit::FrameState;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::format;

/// Colours of a scale.
const CELLS: u16 = 16;

/// Shows the legend of a measure of triangles.
pub(super) fn show(
    ui: &Ui,
    inner: Rect,
    state: &FrameState<'_>,
    palette: &OverlayPalette,
    measure: QualityMeasure,
) -> Rect {
    let from_to = |[good, bad]: [f32; 2], unit: &str| {
        let text = |number: f32| format!("{}{unit}", format::digits(f64::from(number), 3));
        let middle = text(0.5 * (good + bad));
        match good < bad {
            true => [format!("≤ {}", text(good)), middle, format!("≥ {}", text(bad))],
            false => [format!("≤ {}", text(bad)), middle, format!("≥ {}", text(good))],
        }
    };
    let texts = |texts: [&str; 3]| texts.map(str::to_owned);
    let (title, ends, note) = match measure {
        QualityMeasure::SmallestAngle => ("Smallest angle", from_to(SMALLEST_ANGLES, "°"), String::new()),
        QualityMeasure::LargestAngle => ("Largest angle", from_to(LARGEST_ANGLES, "°"), String::new()),
        QualityMeasure::EdgeRatio => ("Longest / shortest edge", from_to(EDGE_RATIOS, ""), String::new()),
        QualityMeasure::Valence => {
            ("Triangles at a node", from_to(VALENCES, ""), "most of the three corners".into())
        }
        QualityMeasure::TargetRatio => {
            ("Longest edge / h̄", texts(["≤ 0.5", "1", "≥ 2"]), "finer, coarser than h̄".into())
        }
        QualityMeasure::TimeStep => match time_note(state) {
            Ok(note) => ("Time step / smallest", texts(["1", "4", "≥ 16"]), note),
            Err(missing) => return no_layer(ui, inner, "Time step", missing.reason()),
        },
    };
    let spoken = format!("Legend: {title} {} to {}", ends[0], ends[2]);
    let has_note = if note.is_empty() { 0.0 } else { ROW };
    let place = boxed(ui, inner, vec2(WIDTH, 30.0 + has_note), title, &spoken);
    let color = |cell: u16| palette.quality(measure, number_of_cell(measure, cell));
    scale(ui, place, (0..CELLS).map(color), ends);
    below_scale(ui, place, note);
    place
}

/// Returns the number in the middle of a cell of the scale.
fn number_of_cell(measure: QualityMeasure, cell: u16) -> f32 {
    let share = (f32::from(cell) + 0.5) / f32::from(CELLS);
    let between = |[one, other]: [f32; 2]| one.min(other) + share * (one - other).abs();
    match measure {
        QualityMeasure::SmallestAngle => between(SMALLEST_ANGLES),
        QualityMeasure::LargestAngle => between(LARGEST_ANGLES),
        QualityMeasure::EdgeRatio => between(EDGE_RATIOS),
        QualityMeasure::Valence => between(VALENCES),
        QualityMeasure::TargetRatio => (2.0 * share - 1.0).exp2(),
        QualityMeasure::TimeStep => (MOST_SLACK * share).exp2(),
    }
}

/// Says what the smallest time step is, where the panel has found it.
///
/// # Errors
/// Says why there are no time steps.
fn time_note(state: &FrameState<'_>) -> Result<String, NoTimeStep> {
    let settings = state.session.document().settings();
    if settings.unit == LengthUnit::Degree {
        return Err(NoTimeStep::Degrees);
    }
    if DepthSurface::of(&settings.layers).is_none() {
        return Err(NoTimeStep::NoDepths);
    }
    let smallest = state.feature::<Statistics>().smallest_time_step(state.session);
    Ok(smallest.map_or_else(String::new, |seconds| format!("smallest {}", format::time(seconds))))
}
