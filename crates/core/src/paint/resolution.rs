//! How finely a segment of a stroke is painted, and on which tiles.

use glam::DVec2;

use super::brush::nearest_on_path;
use super::{Brush, PathPoint};
use crate::geometry::Rect;
use crate::raster::{PixelGrid, TILE, TilePlace, power_of_two};

/// The radius of a brush has at least this many pixels.
const LEAST_RADIUS_PX: f64 = 32.0;

/// A segment is painted at most this much deeper than its widest place or the whole brush needs.
const MOST_EXTRA_DEPTH: u8 = 3;

/// A segment is painted on about this many tiles at most, unless depth 0 has more: a hair across a whole sea
/// stays a few megabytes.
const MOST_TILES: f64 = 16_384.0;

/// Distance from any point to the nearest centre of a pixel, at most, in pixels.
const HALF_DIAGONAL_PX: f64 = 0.71;

/// A straight piece of a stroke's path, from one point of the pointer to the next.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    brush: Brush,
    ends: [PathPoint; 2],
    /// The largest radius, in world units.
    radius: f64,
    /// What it may change, in world units.
    area: Rect,
    /// The tiles that are not stamped yet; the last is next.
    pub places: Vec<TilePlace>,
}

impl Segment {
    /// A segment of the path of a stroke that reaches no further than `bounds`. `None` where it reaches no
    /// pixel within.
    pub fn new(brush: Brush, ends: [PathPoint; 2], bounds: &Rect, grid: &PixelGrid) -> Option<Self> {
        let widest = brush.radius * ends[0].size.max(ends[1].size);
        let reach = Rect::spanning(ends[0].at, ends[1].at).expanded(widest);
        let mut depth = wanted_depth(&brush, &ends, grid);
        while depth > 0 && !is_affordable(depth, &ends, widest, &reach.intersection(bounds)?, grid) {
            depth -= 1;
        }
        // Only where the depth is limited, a brush can be narrower than a pixel: it is widened until it
        // reaches the centre of one.
        let pixel = grid.pixel.max_element() * power_of_two(-i32::from(depth));
        let least = HALF_DIAGONAL_PX * pixel;
        let brush = Brush { radius: brush.radius.max(least), ..brush };
        let ends = ends.map(|end| PathPoint { size: end.size.max(least / brush.radius), ..end });
        let radius = brush.radius * ends[0].size.max(ends[1].size);
        let area = Rect::spanning(ends[0].at, ends[1].at).expanded(radius).intersection(bounds)?;
        let mut segment = Self { brush, ends, radius, area, places: Vec::new() };
        segment.places = tiles_touching(&area, depth, grid)?.filter(|&p| segment.reaches(p, grid)).collect();
        Some(segment)
    }

    /// Coverage of a pixel at a point in world units, 0 to 1.
    pub fn coverage(&self, point: DVec2) -> f64 {
        self.brush.coverage_of_segment(point, self.ends)
    }

    /// Columns and rows of the pixels of a tile that the segment may change, within the tile: [first, end],
    /// [x, y] each.
    pub fn pixels(&self, place: TilePlace, grid: &PixelGrid) -> [[i32; 2]; 2] {
        let scale = power_of_two(i32::from(place.depth));
        let first = DVec2::new(f64::from(place.x), f64::from(place.y)) * f64::from(TILE);
        let within = |point: DVec2, round: fn(DVec2) -> DVec2| {
            let pixel = round(grid.pixel_from_world(point) * scale) - first;
            pixel.to_array().map(|n| n.clamp(0.0, f64::from(TILE)) as i32)
        };
        [within(self.area.min, DVec2::floor), within(self.area.max, DVec2::ceil)]
    }

    /// The rectangle of the pixels of a tile that the segment may change, in world units.
    pub fn area_on(&self, place: TilePlace, grid: &PixelGrid) -> Rect {
        let pixels = self.pixels(place, grid);
        place.area_of_pixels(pixels, grid)
    }

    /// Whether the segment may cover a point of a tile.
    pub fn reaches(&self, place: TilePlace, grid: &PixelGrid) -> bool {
        let tile = place.area(grid);
        let (_, distance) = nearest_on_path(tile.center(), self.ends.map(|end| end.at));
        // Rounding does not matter: at the rim the coverage is 0.
        distance <= self.radius + 0.5 * tile.size().length() && tile.intersection(&self.area).is_some()
    }
}

/// The smallest depth at which the brush is wide enough all along a segment, within [`MOST_EXTRA_DEPTH`].
fn wanted_depth(brush: &Brush, ends: &[PathPoint; 2], grid: &PixelGrid) -> u8 {
    let needed = |size: f64| {
        let radius_px =
            |depth: &u8| brush.radius * size / grid.pixel.max_element() * power_of_two(i32::from(*depth));
        (0..TilePlace::DEEPEST)
            .find(|depth| radius_px(depth) >= LEAST_RADIUS_PX)
            .unwrap_or(TilePlace::DEEPEST)
    };
    let [from, to] = [ends[0].size, ends[1].size].map(needed);
    // A pen that touches down has almost no width yet: what the whole brush needs is a limit as well.
    from.max(to).min(from.min(to).min(needed(1.0)) + MOST_EXTRA_DEPTH)
}

/// Whether the tiles of a depth are within the limits of their places and not too many.
fn is_affordable(depth: u8, ends: &[PathPoint; 2], radius: f64, area: &Rect, grid: &PixelGrid) -> bool {
    let tile = grid.pixel * f64::from(TILE) * power_of_two(-i32::from(depth));
    let length = (ends[1].at - ends[0].at).length().min(area.size().length());
    let width = 2.0 * radius + tile.max_element();
    let count = (length + width) * width / (tile.x * tile.y);
    count <= MOST_TILES && tiles_touching(area, depth, grid).is_some()
}

/// The tiles of a depth that touch a rectangle, row by row; `None` if one is beyond the limits.
fn tiles_touching(
    area: &Rect,
    depth: u8,
    grid: &PixelGrid,
) -> Option<impl Iterator<Item = TilePlace> + use<>> {
    let tiles_per_pixel = power_of_two(i32::from(depth)) / f64::from(TILE);
    let tile_at = |point: DVec2, round: fn(DVec2) -> DVec2| {
        let [x, y] = round(grid.pixel_from_world(point) * tiles_per_pixel).to_array().map(|n| n as i32);
        TilePlace { depth, x, y }
    };
    let (first, end) = (tile_at(area.min, DVec2::floor), tile_at(area.max, DVec2::ceil));
    if !first.is_valid() || !end.is_valid() {
        return None;
    }
    let rows = first.y..end.y.max(first.y + 1);
    let columns = first.x..end.x.max(first.x + 1);
    Some(rows.flat_map(move |y| columns.clone().map(move |x| TilePlace { depth, x, y })))
}
