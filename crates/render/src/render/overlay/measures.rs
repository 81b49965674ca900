//! How good triangles are, as colours with their legend.

use rayon::prelude::*;

use super::{OverlayColors, PictureOverlay};
use crate::colormap::overlay_palette::{
    EDGE_RATIOS, LARGEST_ANGLES, LINK_COSINES, LINK_LENGTHS, MOST_SLACK, OverlayPalette, SMALLEST_ANGLES,
    VALENCES,
};
use crate::render::furniture::Legend;
use meshbrush_core::layers::LevelCache;
use meshbrush_core::quality::{QualityMeasure, TriangleMeasures};
use meshbrush_mesh::text::digits;

/// Colours of a scale.
const CELLS: u16 = 16;
/// Triangles that a thread takes at a time, with a cache of its own.
const GRAIN: usize = 4096;

/// Returns the colours of all triangles by a measure, with the legend. `time` says a time in seconds; `None`
/// where no triangle has the measure.
pub fn measure_overlay(
    measures: &TriangleMeasures<'_>,
    measure: QualityMeasure,
    palette: &OverlayPalette,
    time: impl Fn(f64) -> String,
) -> Option<PictureOverlay> {
    let least = (measure == QualityMeasure::TimeStep).then(|| measures.least_time_step());
    let note = match least {
        Some(least) => format!("smallest {}", time(least?)),
        None => String::new(),
    };
    let colors = measure_colors(measures, measure, palette, least.flatten().unwrap_or(1.0));
    Some(PictureOverlay {
        legend: measure_legend(measure, palette, note),
        neutral: palette.neutral(),
        colors: OverlayColors::Triangles(colors.into()),
    })
}

/// Returns the colour of each triangle by a measure, whose numbers are divided by `scale`: the least one for
/// time steps, and 1 for others. Neutral where a triangle has no number.
fn measure_colors(
    measures: &TriangleMeasures<'_>,
    measure: QualityMeasure,
    palette: &OverlayPalette,
    scale: f64,
) -> Vec<[u8; 4]> {
    let count = measures.mesh().triangles().len();
    let of_all = measures.of_all(measure);
    let number = |triangle: usize, squares: &mut LevelCache| match &of_all {
        Some(numbers) => Some(numbers[triangle]).filter(|number| !number.is_nan()),
        None => measures.of(measure, triangle, squares),
    };
    let part = |from: usize| -> Vec<[u8; 4]> {
        let mut squares = LevelCache::default();
        let triangles = from..count.min(from + GRAIN);
        triangles
            .map(|triangle| match number(triangle, &mut squares) {
                Some(number) => palette.quality(measure, number as f32 / scale as f32),
                None => palette.neutral(),
            })
            .collect()
    };
    (0..count).into_par_iter().step_by(GRAIN).flat_map_iter(part).collect()
}

/// Returns the legend of a measure. `note` says what the smallest time step is.
pub fn measure_legend(measure: QualityMeasure, palette: &OverlayPalette, note: String) -> Legend {
    let from_to = |[good, bad]: [f32; 2], unit: &str| {
        let text = |number: f32| format!("{}{unit}", digits(f64::from(number), 3));
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
        QualityMeasure::LinkLength => {
            ("Link / cell size", from_to(LINK_LENGTHS, ""), "shortest of the cell's links".into())
        }
        QualityMeasure::LinkCosine => {
            ("Orthogonality", from_to(LINK_COSINES, ""), "cosine of link and edge".into())
        }
        QualityMeasure::TargetRatio => {
            ("Longest edge / h̄", texts(["≤ 0.5", "1", "≥ 2"]), "finer, coarser than h̄".into())
        }
        QualityMeasure::TimeStep => ("Time step / smallest", texts(["1", "4", "≥ 16"]), note),
    };
    let color = |cell: u16| palette.quality(measure, number_of_cell(measure, cell));
    Legend::scale(title, (0..CELLS).map(color), ends, note)
}

/// Returns the number in the middle of a cell of the scale of a legend.
fn number_of_cell(measure: QualityMeasure, cell: u16) -> f32 {
    let share = (f32::from(cell) + 0.5) / f32::from(CELLS);
    let between = |[one, other]: [f32; 2]| one.min(other) + share * (one - other).abs();
    match measure {
        QualityMeasure::SmallestAngle => between(SMALLEST_ANGLES),
        QualityMeasure::LargestAngle => between(LARGEST_ANGLES),
        QualityMeasure::EdgeRatio => between(EDGE_RATIOS),
        QualityMeasure::Valence => between(VALENCES),
        QualityMeasure::LinkLength => between(LINK_LENGTHS),
        QualityMeasure::LinkCosine => between(LINK_COSINES),
        QualityMeasure::TargetRatio => (2.0 * share - 1.0).exp2(),
        QualityMeasure::TimeStep => (MOST_SLACK * share).exp2(),
    }
}
