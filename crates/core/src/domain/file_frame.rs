//! A rectangle in the coordinates of a file, and the part of the file's shapes in it.
//!
//! Longitudes go round the Earth: a shape counts wherever it is in the frame after whole turns, so that a
//! frame from 170° to 190° meets shapes on both sides of the antimeridian.

use std::borrow::Cow;

use glam::DVec2;

use super::boundary::NamedPolygon;
use super::complexity::check_complexity;
use super::{Polygon, Region, RegionError, Ring};
use crate::earth::{GeographicExtent, wrapped};
use crate::geometry::Rect;

/// A ring is clipped roughly to the frame and this share of its size on each side, before the overlay clips
/// it to the frame itself: so the edges along the rough clip are outside.
const ROUGH: f64 = 0.125;
/// The share of the extent of data that a frame around them adds on each side.
const MARGIN: f64 = 0.1;

/// A rectangle in the coordinates of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileFrame {
    /// The rectangle.
    pub rect: Rect,
    /// Whether the coordinates are longitudes and latitudes in degrees.
    pub in_degrees: bool,
}

impl FileFrame {
    /// Returns a frame around rings or lines, a tenth of their extent larger on each side where `has_margin`;
    /// `None` where they have no extent.
    pub fn around<'a>(
        rings: impl Iterator<Item = &'a [DVec2]> + Clone,
        in_degrees: bool,
        has_margin: bool,
    ) -> Option<Self> {
        let rect = match in_degrees {
            true => {
                let GeographicExtent { west, width, south, north, .. } = GeographicExtent::from_rings(rings)?;
                Rect::new(DVec2::new(west, south), DVec2::new(west + width, north))
            }
            false => Rect::holding(rings.flatten().copied())?,
        };
        let margin = if has_margin { MARGIN * rect.size().max_element() } else { 0.0 };
        let mut grown = Rect::new(rect.min - margin, rect.max + margin);
        if in_degrees {
            grown.min.y = grown.min.y.max(-90.0);
            grown.max.y = grown.max.y.min(90.0);
            if grown.size().x > 360.0 {
                (grown.min.x, grown.max.x) = (-180.0, 180.0);
            }
        }
        grown.is_proper().then_some(Self { rect: grown, in_degrees })
    }

    /// Returns the part of polygons in the frame. Each keeps its name.
    ///
    /// # Errors
    /// Fails when they have too many corners, crossings or long edges in the frame.
    pub fn clipped(&self, polygons: &[NamedPolygon]) -> Result<Vec<NamedPolygon>, RegionError> {
        let mut clipped = Vec::new();
        for named in polygons {
            let within = self.polygons_within(std::slice::from_ref(&named.polygon));
            check_complexity(&within, &self.rect)?;
            let parts = self.parts(within);
            clipped
                .extend(parts.into_iter().map(|polygon| NamedPolygon { polygon, name: named.name.clone() }));
        }
        Ok(clipped)
    }

    /// Returns what polygons cover in the frame, on the grid of the regions there.
    fn parts(&self, polygons: Vec<Polygon>) -> Vec<Polygon> {
        let is_inside = |ring: &Ring| ring.iter().all(|&at| self.rect.contains(at));
        match polygons.iter().flatten().all(is_inside) {
            true => {
                let snapped = |ring: &Ring| Region::snapped(ring, &self.rect);
                polygons.iter().map(|rings| rings.iter().map(snapped).collect()).collect()
            }
            false => Region::covered(&polygons, self.rect),
        }
    }

    /// Returns the polygons that meet the frame, moved by whole turns and clipped to its surroundings.
    pub(super) fn polygons_within(&self, polygons: &[Polygon]) -> Vec<Polygon> {
        let surroundings = self.surroundings();
        let mut within = Vec::new();
        for rings in polygons {
            let Some(outer) = rings.first() else { continue };
            for turn in self.turns(&self.in_one_piece(outer)) {
                let part = |ring: &Ring| clipped_to(&moved(&self.in_one_piece(ring), turn), &surroundings);
                let mut parts: Polygon = rings.iter().map(part).collect();
                if parts[0].len() > 2 {
                    parts.retain(|ring| ring.len() > 2);
                    within.push(parts);
                }
            }
        }
        within
    }

    /// Returns the lines that meet the frame, moved by whole turns.
    pub(super) fn lines_within(&self, lines: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
        let mut within = Vec::new();
        for line in lines {
            let line = if self.in_degrees { Cow::Owned(without_jumps(line)) } else { Cow::Borrowed(&**line) };
            within.extend(self.turns(&line).map(|turn| moved(&line, turn)));
        }
        within
    }

    /// Returns a point after the whole turns that bring it into the frame; `None` if none do.
    pub(super) fn moved_into(&self, at: DVec2) -> Option<DVec2> {
        let turns = if self.in_degrees { ((self.rect.min.x - at.x) / 360.0).ceil() } else { 0.0 };
        let moved = DVec2::new(at.x + 360.0 * turns, at.y);
        self.rect.contains(moved).then_some(moved)
    }

    /// Returns the longitudes by which a shape is moved to meet the frame.
    fn turns(&self, points: &[DVec2]) -> impl Iterator<Item = f64> {
        let extent = Rect::holding(points.iter().copied());
        let is_met = move |extent: Rect, turn: f64| {
            let offset = DVec2::new(turn, 0.0);
            Rect::new(extent.min + offset, extent.max + offset).intersection(&self.rect).is_some()
        };
        let (first, last) = match (extent, self.in_degrees) {
            (Some(extent), true) => (
                ((self.rect.min.x - extent.max.x) / 360.0).floor() as i32,
                ((self.rect.max.x - extent.min.x) / 360.0).ceil() as i32,
            ),
            _ => (0, 0),
        };
        let turns = (first..=last).map(|turn| 360.0 * f64::from(turn));
        turns.filter(move |&turn| extent.is_some_and(|extent| is_met(extent, turn)))
    }

    /// Returns a ring of longitudes and latitudes without jumps from one side of the antimeridian to the
    /// other. A ring around a pole stays as it is: files cut it along the antimeridian.
    fn in_one_piece<'a>(&self, ring: &'a [DVec2]) -> Cow<'a, [DVec2]> {
        let joined = if self.in_degrees { without_jumps(ring) } else { Vec::new() };
        match (joined.first(), joined.last()) {
            (Some(first), Some(last)) if !is_jump(*last, *first) => Cow::Owned(joined),
            _ => Cow::Borrowed(ring),
        }
    }

    fn surroundings(&self) -> Rect {
        let margin = ROUGH * self.rect.size();
        Rect::new(self.rect.min - margin, self.rect.max + margin)
    }
}

/// Returns whether an edge goes the shorter way across the antimeridian. An edge of a whole turn runs along a
/// parallel around the Earth.
fn is_jump(from: DVec2, to: DVec2) -> bool {
    let east = (to.x - from.x).abs();
    180.0 < east && east < 360.0
}

/// Returns points whose longitudes do not jump.
fn without_jumps(points: &[DVec2]) -> Vec<DVec2> {
    let mut turn = 0.0;
    let mut joined: Vec<DVec2> = Vec::with_capacity(points.len());
    for (n, &at) in points.iter().enumerate() {
        if n > 0 && is_jump(points[n - 1], at) {
            let east = at.x - points[n - 1].x;
            turn += wrapped(east) - east;
        }
        joined.push(DVec2::new(at.x + turn, at.y));
    }
    joined
}

fn moved(points: &[DVec2], turn: f64) -> Vec<DVec2> {
    points.iter().map(|&at| DVec2::new(at.x + turn, at.y)).collect()
}

/// Returns a ring clipped to a rectangle, side by side (Sutherland and Hodgman): parts of it can run along
/// the sides, there and back.
fn clipped_to(ring: &[DVec2], rect: &Rect) -> Ring {
    if ring.iter().all(|&at| rect.contains(at)) {
        return ring.to_vec();
    }
    let sides = [(0, rect.min.x, 1.0), (0, rect.max.x, -1.0), (1, rect.min.y, 1.0), (1, rect.max.y, -1.0)];
    sides.into_iter().fold(ring.to_vec(), |ring, (axis, value, sign)| {
        let beyond = |at: DVec2| sign * (at[axis] - value);
        let mut clipped = Vec::with_capacity(ring.len());
        for (n, &at) in ring.iter().enumerate() {
            let before = ring[(n + ring.len() - 1) % ring.len()];
            if (beyond(before) < 0.0) != (beyond(at) < 0.0) {
                let mut crossing = before.lerp(at, beyond(before) / (beyond(before) - beyond(at)));
                crossing[axis] = value;
                clipped.push(crossing);
            }
            if beyond(at) >= 0.0 {
                clipped.push(at);
            }
        }
        clipped
    })
}
