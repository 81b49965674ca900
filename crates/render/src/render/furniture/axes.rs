//! Ticks of coordinates along the lower and the left side of a map.

use super::glyphs;
use crate::scene::Camera;
use meshbrush_core::earth::GraticuleLine;
use meshbrush_mesh::text::{LengthUnit, decimals_for, fixed, tick_step};

/// Least distance between labelled ticks, in heights of the text: across, and upwards.
const GAPS: [f64; 2] = [4.5, 3.2];
/// Most labels of an axis in a plane.
const MOST_LABELS: f64 = 12.0;
/// Least space between two labels below the map, in heights of the text.
const LABEL_GAP: f64 = 1.2;
/// Most ticks of an axis: where coordinates are too coarse for a step, there are none.
const MOST_TICKS: i64 = 2000;

/// The coordinates along the sides of a map.
#[derive(Clone, Debug)]
pub enum MapAxes {
    /// x and y in the plane of the document.
    Plane(LengthUnit),
    /// Meridians and parallels.
    Earth(Vec<GraticuleLine>),
}

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapTick {
    /// Its distance from the left or upper side of the map, in pixels.
    pub(super) at_px: f64,
    /// Its coordinate; empty at a mark between those with coordinates.
    pub(super) label: String,
}

impl MapAxes {
    /// Returns what the axes across and upwards are called; nothing where their labels say it.
    pub(super) fn titles(&self) -> Option<[String; 2]> {
        let Self::Plane(unit) = self else { return None };
        Some(["x", "y"].map(|name| match unit.symbol() {
            "" => name.to_owned(),
            symbol => format!("{name} in {symbol}"),
        }))
    }

    /// Returns the ticks across, from the left, and upwards, in a text of a height in pixels.
    pub(super) fn ticks(&self, camera: &Camera, text_px: f64) -> [Vec<MapTick>; 2] {
        match self {
            Self::Plane(_) => [0, 1].map(|axis| even_ticks(camera, axis, text_px)),
            Self::Earth(lines) => [true, false].map(|is_meridian| {
                let lines = lines.iter().filter(|line| line.is_meridian == is_meridian);
                with_room(lines.filter_map(|line| crossing(line, camera)).collect(), is_meridian, text_px)
            }),
        }
    }
}

/// Returns the ticks at round coordinates: x along axis 0, y along axis 1.
fn even_ticks(camera: &Camera, axis: usize, text_px: f64) -> Vec<MapTick> {
    let bounds = camera.lattice().bounds();
    let (from, to) = (bounds.min[axis], bounds.max[axis]);
    let label = |value: f64, step: f64| fixed(value, decimals_for(step));
    let mut gap = (GAPS[axis] * text_px).max((to - from) * camera.px_per_world() / MOST_LABELS);
    let mut chosen = tick_step(gap / camera.px_per_world());
    if axis == 0 {
        // Wider labels need more room, and a larger step may need fewer decimals.
        let widths = [from, to].map(|end| glyphs::width(&label(end, chosen.0), text_px));
        gap = gap.max(widths[0].max(widths[1]) + LABEL_GAP * text_px);
        chosen = tick_step(gap / camera.px_per_world());
    }
    let (step, parts) = chosen;
    let minor = step / f64::from(parts);
    // A side that ends at a tick has it, whatever the last bit says.
    let slack = 1e-9 * (to - from) / minor;
    let (first, last) = ((from / minor - slack).ceil() as i64, (to / minor + slack).floor() as i64);
    if last.saturating_sub(first) > MOST_TICKS {
        return Vec::new();
    }
    let tick = |number: i64| {
        let mut world = bounds.min;
        world[axis] = number as f64 * minor;
        let is_major = number % i64::from(parts) == 0;
        let label = if is_major { label(world[axis], step) } else { String::new() };
        MapTick { at_px: camera.screen_from_world(world)[axis], label }
    };
    (first..=last).map(tick).collect()
}

/// Returns where a meridian crosses the lower side of the map, or a parallel the left one.
fn crossing(line: &GraticuleLine, camera: &Camera) -> Option<MapTick> {
    let bounds = camera.lattice().bounds();
    let (across, along) = if line.is_meridian { (1, 0) } else { (0, 1) };
    let at = line
        .crossings(across, bounds.min[across])
        .find(|at| bounds.min[along] <= at[along] && at[along] <= bounds.max[along])?;
    Some(MapTick { at_px: camera.screen_from_world(at)[along], label: line.label.clone() })
}

/// Returns the ticks in their order, with the labels that have room: each, or every second or third one.
fn with_room(mut ticks: Vec<MapTick>, is_across: bool, text_px: f64) -> Vec<MapTick> {
    ticks.sort_by(|a, b| a.at_px.total_cmp(&b.at_px));
    let half = |tick: &MapTick| match is_across {
        true => 0.5 * (glyphs::width(&tick.label, text_px) + LABEL_GAP * text_px),
        false => 0.5 * GAPS[1] * text_px,
    };
    let has_room = |pair: [&MapTick; 2]| pair[1].at_px - pair[0].at_px >= half(pair[0]) + half(pair[1]);
    let every = (1..=ticks.len().max(1)).find(|&every| {
        let labelled: Vec<&MapTick> = ticks.iter().step_by(every).collect();
        labelled.windows(2).all(|pair| has_room([pair[0], pair[1]]))
    });
    for (index, tick) in ticks.iter_mut().enumerate() {
        if index % every.unwrap_or(1) != 0 {
            tick.label.clear();
        }
    }
    ticks
}
