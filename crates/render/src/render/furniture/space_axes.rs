//! Axes of a view in space: the outline of the box around the surface, with coordinates along its lower front
//! edges and heights along an upright one.
//!
//! ```text
//!  Heights × 20
//!        300 ┼───────────╮        Nothing of the surface is before these lines: they are where the box ends.
//!            │ surface    ╲
//!          0 ┼╲            │
//!             ┼ ╲        ╱
//!            10   ╲  ┼ ╱ 5
//! ```

use glam::{DVec2, dvec2};

use super::axes::MapAxes;
use super::glyphs;
use crate::render::space_look::SpaceLook;
use crate::scene::SpaceCamera;
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::text::{decimals_for, digits, fixed, tick_step};

/// Lengths of ticks, and from an edge to a label, in heights of the text.
const TICK: f64 = 0.45;
const TO_LABEL: f64 = 0.8;
/// Least space between two labels, across and upwards, and between labels and the title of their axis.
const LABEL_GAPS: DVec2 = DVec2::new(1.2, 0.9);
const TITLE_GAP: f64 = 0.7;
/// From the upper end of the axis of heights to the middle of its title.
const ABOVE: f64 = 1.6;
/// Most labels of an axis.
const MOST_LABELS: f64 = 12.0;
/// The least length of the axis of heights, in heights of the text: in the view from above it has none.
const LEAST_RISE: f64 = 2.5;
/// An axis that goes to the side by less than this share of its height has its numbers beside it.
const STEEP: f64 = 0.35;
/// A difference in pixels that nobody sees.
const SAME_PX: f64 = 0.01;

/// The axes of a view in space.
#[derive(Clone, Debug)]
pub struct SpaceAxes {
    /// The view.
    pub space: SpaceLook,
    /// The coordinates in the plane.
    pub axes: MapAxes,
    /// The grid that the surface is over.
    pub lattice: Lattice,
}

/// Lines and texts of axes, in pixels from the upper left corner of the map.
#[derive(Clone, Debug, Default)]
pub(super) struct SpaceFrame {
    /// The outline of the box.
    pub(super) outline: Vec<DVec2>,
    /// The three axes and their ticks.
    pub(super) lines: Vec<[DVec2; 2]>,
    /// Titles and labels: none covers another one.
    pub(super) labels: Vec<SpaceLabel>,
}

/// A text at an axis.
#[derive(Clone, Debug)]
pub(super) struct SpaceLabel {
    pub(super) text: String,
    /// The upper left and the lower right corner of its capital letters.
    pub(super) place: [DVec2; 2],
}

/// An edge of the box, with the direction that leads out of it.
struct BoxEdge {
    from: DVec2,
    to: DVec2,
    out: DVec2,
}

impl SpaceLabel {
    /// Returns a text that touches a point from the side to which a direction of length 1 leads.
    fn beside(text: String, at: DVec2, out: DVec2, text_px: f64) -> Self {
        let half = 0.5 * size_of(&text, text_px);
        let middle = at + out * half;
        Self { text, place: [middle - half, middle + half] }
    }

    fn has_room_beside(&self, other: &Self, text_px: f64) -> bool {
        let gap = 0.3 * text_px;
        let ([a, b], [c, d]) = (self.place, other.place);
        a.x > d.x + gap || c.x > b.x + gap || a.y > d.y + gap || c.y > b.y + gap
    }
}

/// Returns the size of a text.
fn size_of(text: &str, text_px: f64) -> DVec2 {
    dvec2(glyphs::width(text, text_px), glyphs::CAPITAL * text_px)
}

impl BoxEdge {
    fn at(&self, share: f64) -> DVec2 {
        self.from.lerp(self.to, share)
    }

    /// Returns the least distance along the edge at which two labels are beside each other.
    fn least_gap(&self, label: DVec2, text_px: f64) -> f64 {
        let along = (self.to - self.from).normalize_or_zero().abs();
        let gaps = (label + LABEL_GAPS * text_px) / along.max(DVec2::splat(1e-9));
        gaps.min_element()
    }

    fn tick(&self, share: f64, text_px: f64) -> [DVec2; 2] {
        let at = self.at(share);
        [at, at + TICK * text_px * self.out]
    }

    fn label(&self, text: String, share: f64, text_px: f64) -> SpaceLabel {
        SpaceLabel::beside(text, self.at(share) + TO_LABEL * text_px * self.out, self.out, text_px)
    }

    /// Returns round numbers between two along the edge, as shares of it with their texts.
    fn round_numbers(&self, [from, to]: [f64; 2], text_px: f64) -> Vec<(f64, String)> {
        let length_px = self.from.distance(self.to);
        if !(to > from && length_px > 0.0) {
            return Vec::new();
        }
        let label = |value: f64, step: f64| fixed(value, decimals_for(step));
        let in_numbers =
            |gap_px: f64| tick_step(gap_px.max(length_px / MOST_LABELS) / length_px * (to - from)).0;
        let mut step = in_numbers(self.least_gap(size_of("0", text_px), text_px));
        // A larger step may have shorter labels, and needs no more room.
        let widest = [from, to].map(|end| size_of(&label(end, step), text_px));
        step = in_numbers(self.least_gap(widest[0].max(widest[1]), text_px));
        let slack = 1e-9 * (to - from) / step;
        let numbers = (from / step - slack).ceil() as i64..=(to / step + slack).floor() as i64;
        let share = |value: f64| ((value - from) / (to - from)).clamp(0.0, 1.0);
        numbers.map(|n| n as f64 * step).map(|value| (share(value), label(value, step))).collect()
    }
}

impl SpaceAxes {
    /// Returns the lines and texts around a map of a size, in a text of a height in pixels.
    pub(super) fn frame(&self, map_size: [u32; 2], text_px: f64) -> SpaceFrame {
        let camera = self.space.view_in(&self.lattice, map_size).camera;
        let view = BoxView { camera, bounds: self.lattice.bounds(), ends: self.space.heights.ends() };
        let mut frame = SpaceFrame { outline: view.outline(), ..SpaceFrame::default() };
        let (mut titles, mut labels) = (Vec::new(), Vec::new());
        for axis in 0..2 {
            let edge = view.edge_along(axis);
            frame.lines.push([edge.from, edge.to]);
            let found = self.in_plane(&view, axis, &edge, text_px);
            frame.lines.extend(found.iter().map(|(share, _)| edge.tick(*share, text_px)));
            let of_axis: Vec<_> =
                found.into_iter().map(|(share, text)| edge.label(text, share, text_px)).collect();
            let depth = of_axis.iter().map(|label| (label.place[1] - label.place[0]).dot(edge.out.abs()));
            let depth = depth.fold(0.0, f64::max);
            if let Some(titles_of_axes) = self.axes.titles() {
                let at = edge.at(0.5) + (depth + (TO_LABEL + TITLE_GAP) * text_px) * edge.out;
                titles.push(SpaceLabel::beside(titles_of_axes[axis].clone(), at, edge.out, text_px));
            }
            labels.extend(of_axis);
        }
        if let Some(edge) = view.rise(LEAST_RISE * text_px) {
            frame.lines.push([edge.from, edge.to]);
            let scale = self.space.heights.scale;
            let heights = self.space.heights.ends().map(|steps| scale.height(f64::from(steps)));
            let found = edge.round_numbers(heights, text_px);
            frame.lines.extend(found.iter().map(|(share, _)| edge.tick(*share, text_px)));
            labels.extend(found.into_iter().map(|(share, text)| edge.label(text, share, text_px)));
            let title = self.title_of_heights();
            let half = 0.5 * size_of(&title, text_px);
            // One of its ends is over the axis, and the other one over the labels.
            let middle = edge.to + dvec2(edge.out.x * half.x, -ABOVE * text_px);
            titles.push(SpaceLabel { text: title, place: [middle - half, middle + half] });
        }
        for label in titles.into_iter().chain(labels) {
            if frame.labels.iter().all(|other| label.has_room_beside(other, text_px)) {
                frame.labels.push(label);
            }
        }
        frame
    }

    fn title_of_heights(&self) -> String {
        let factor = digits(self.space.exaggeration / self.space.metre, 3);
        if factor == "1" { "Heights".into() } else { format!("Heights × {factor}") }
    }

    /// Returns the coordinates along an edge of the box: x along axis 0, y along axis 1.
    fn in_plane(&self, view: &BoxView, axis: usize, edge: &BoxEdge, text_px: f64) -> Vec<(f64, String)> {
        let bounds = self.lattice.bounds();
        let (from, to) = (bounds.min[axis], bounds.max[axis]);
        match &self.axes {
            MapAxes::Plane(_) => edge.round_numbers([from, to], text_px),
            MapAxes::Earth(lines) => {
                let beside = view.side_of(axis);
                let lines = lines.iter().filter(|line| line.is_meridian == (axis == 0));
                let place = |line: &meshbrush_core::earth::GraticuleLine| {
                    let mut crossings = line.crossings(1 - axis, beside);
                    let at = crossings.find(|at| from <= at[axis] && at[axis] <= to)?;
                    Some(((at[axis] - from) / (to - from), line.label.clone()))
                };
                let mut found: Vec<(f64, String)> = lines.filter_map(place).collect();
                found.sort_by(|a, b| a.0.total_cmp(&b.0));
                thinned(found, edge, text_px)
            }
        }
    }
}

/// Returns each label that has room, or every second or third one.
fn thinned(found: Vec<(f64, String)>, edge: &BoxEdge, text_px: f64) -> Vec<(f64, String)> {
    let has_room = |every: &usize| {
        let labels: Vec<_> = found.iter().step_by(*every).collect();
        labels.windows(2).all(|pair| {
            let widest = pair.iter().map(|(_, text)| size_of(text, text_px)).fold(DVec2::ZERO, DVec2::max);
            edge.at(pair[0].0).distance(edge.at(pair[1].0)) >= edge.least_gap(widest, text_px)
        })
    };
    let every = (1..=found.len().max(1)).find(has_room).unwrap_or(1);
    found.into_iter().step_by(every).collect()
}

/// The box around a surface as a camera sees it.
struct BoxView {
    camera: SpaceCamera,
    bounds: Rect,
    /// The lowest and the highest height, in steps.
    ends: [u32; 2],
}

impl BoxView {
    fn px(&self, corner: [bool; 3]) -> DVec2 {
        let pick = |axis: usize| if corner[axis] { self.bounds.max[axis] } else { self.bounds.min[axis] };
        let height = self.ends[usize::from(corner[2])];
        self.camera.screen_from_world(dvec2(pick(0), pick(1)), f64::from(height))
    }

    /// Returns the corners around the box in the picture.
    fn outline(&self) -> Vec<DVec2> {
        // Corners that are at the same place in the picture differ by rounding.
        let corner = |n: u32| (self.px([1, 2, 4].map(|bit| n & bit != 0)) / SAME_PX).round() * SAME_PX;
        let mut corners: Vec<DVec2> = (0..8).map(corner).collect();
        corners.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let half = |corners: &mut dyn Iterator<Item = DVec2>| {
            let mut chain: Vec<DVec2> = Vec::new();
            for corner in corners {
                while let [.., a, b] = chain[..]
                    && (b - a).perp_dot(corner - b) <= 0.0
                {
                    chain.pop();
                }
                chain.push(corner);
            }
            chain
        };
        let (there, back) = (half(&mut corners.iter().copied()), half(&mut corners.iter().rev().copied()));
        there.into_iter().chain(back.into_iter().skip(1)).collect()
    }

    /// Returns whether the upper side along the other axis is nearer to the viewer: lower in the picture, or
    /// at the left where both are equally low.
    fn is_upper_nearer(&self, axis: usize) -> bool {
        let mut upper = [false; 3];
        upper[1 - axis] = true;
        let to_upper = self.px(upper) - self.px([false; 3]);
        if to_upper.y.abs() > SAME_PX { to_upper.y > 0.0 } else { to_upper.x < 0.0 }
    }

    /// Returns the coordinate along the other axis of the edge along an axis.
    fn side_of(&self, axis: usize) -> f64 {
        let side = if self.is_upper_nearer(axis) { self.bounds.max } else { self.bounds.min };
        side[1 - axis]
    }

    /// Returns the lower edge along an axis on the side of the viewer.
    fn edge_along(&self, axis: usize) -> BoxEdge {
        let (mut from, mut to, mut across) = ([false; 3], [false; 3], [false; 3]);
        let is_upper = self.is_upper_nearer(axis);
        (from[1 - axis], to[1 - axis], to[axis]) = (is_upper, is_upper, true);
        across[1 - axis] = !is_upper;
        let [from, to, across] = [from, to, across].map(|corner| self.px(corner));
        let out = (from - across).normalize_or(DVec2::Y);
        BoxEdge { from, to, out }
    }

    /// Returns the upright edge at the left, or at the right where the numbers of another axis are at the
    /// left; `None` where it is shorter than a length in pixels.
    fn rise(&self, least_px: f64) -> Option<BoxEdge> {
        let middle = 0.5 * (self.px([false; 3]).x + self.px([true, true, false]).x);
        let is_left = ![0, 1].map(|axis| self.edge_along(axis)).iter().any(|edge| {
            let along = edge.to - edge.from;
            along.x.abs() < STEEP * along.y.abs() && edge.from.x < middle
        });
        let out = if is_left { DVec2::NEG_X } else { DVec2::X };
        let feet = [[false, false], [true, false], [false, true], [true, true]];
        let outward = |[x, y]: [bool; 2]| {
            let at = self.px([x, y, false]);
            // Of two at a side, the lower one.
            at.dot(out) + 1e-3 * at.y
        };
        let foot = feet.into_iter().max_by(|a, b| outward(*a).total_cmp(&outward(*b)))?;
        let [from, to] = [false, true].map(|is_top| self.px([foot[0], foot[1], is_top]));
        (from.distance(to) >= least_px).then_some(BoxEdge { from, to, out })
    }
}
