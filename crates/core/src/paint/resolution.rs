//! The resolution of a segment of a stroke, and the tiles that it covers.

use glam::DVec2;

use super::brush::nearest_on_path;
use super::{Brush, PathPoint};
use crate::geometry::Rect;
use crate::raster::{PixelGrid, TILE, Tile, TilePlace, power_of_two};

/// Smallest radius of a brush in pixels of the tiles that it paints on.
const LEAST_RADIUS_PX: f64 = 32.0;

/// A segment is painted at most this many levels deeper than its widest point or the whole brush needs.
const MOST_EXTRA_DEPTH: u8 = 3;

/// Largest distance from any point to the nearest centre of a pixel, in pixels.
const HALF_DIAGONAL_PX: f64 = 0.71;

/// A straight piece of a stroke's path, from one point of the pointer to the next.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    brush: Brush,
    ends: [PathPoint; 2],
    /// The largest radius, in world units.
    radius: f64,
    /// The rectangle that the segment may change, in world units.
    area: Rect,
    /// The tiles that are not stamped yet; the last one is stamped next.
    pub places: Vec<TilePlace>,
}

impl Segment {
    /// Creates a segment of the path of a stroke that reaches no further than `bounds`. Returns `None` if it
    /// reaches no pixel within them. It has at most about `most_tiles` tiles, unless depth 0 has more.
    pub fn new(
        brush: Brush,
        ends: [PathPoint; 2],
        bounds: &Rect,
        grid: &PixelGrid,
        most_tiles: usize,
    ) -> Option<Self> {
        let widest = brush.radius * ends[0].size.max(ends[1].size);
        let reach = Rect::spanning(ends[0].at, ends[1].at).expanded(widest);
        let mut depth = wanted_depth(&brush, &ends, grid);
        let reached = reach.intersection(bounds)?;
        let is_affordable = |depth| tile_count(depth, &ends, widest, &reached, grid) <= most_tiles as f64;
        while depth > 0 && !(is_affordable(depth) && tiles_touching(&reached, depth, grid).is_some()) {
            depth -= 1;
        }
        // A brush is narrower than a pixel only where the depth is limited. It is then widened until it
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

    /// Returns the coverage of each pixel of a tile, 0 to 1; `None` if it is 0 everywhere.
    pub fn coverage_of(&self, place: TilePlace, grid: &PixelGrid) -> Option<Box<Tile>> {
        let pixels = self.pixels(place, grid);
        let [from, to] = self.ends;
        if from.size != to.size || from.strength != to.strength {
            return coverage_by(place, grid, pixels, |point| {
                self.brush.coverage_of_segment(point, self.ends)
            });
        }
        let brush = Brush { radius: self.brush.radius * from.size, ..self.brush };
        let path = [from.at, to.at];
        if pixels == [[0; 2], [TILE; 2]] && is_in_core(&brush, path, &place.area(grid)) {
            return Some(Box::new(Tile::filled(from.strength as f32))).filter(|_| from.strength > 0.0);
        }
        coverage_by(place, grid, pixels, |point| {
            from.strength * brush.coverage(nearest_on_path(point, path).1)
        })
    }

    /// Returns the columns and rows of the pixels of a tile that the segment may change, counted within the
    /// tile: [first, end], [x, y] each.
    pub fn pixels(&self, place: TilePlace, grid: &PixelGrid) -> [[i32; 2]; 2] {
        let scale = power_of_two(i32::from(place.depth));
        let first = DVec2::new(f64::from(place.x), f64::from(place.y)) * f64::from(TILE);
        let within = |point: DVec2, round: fn(DVec2) -> DVec2| {
            let pixel = round(grid.pixel_from_world(point) * scale) - first;
            pixel.to_array().map(|n| n.clamp(0.0, f64::from(TILE)) as i32)
        };
        [within(self.area.min, DVec2::floor), within(self.area.max, DVec2::ceil)]
    }

    /// Returns the rectangle of the pixels of a tile that the segment may change, in world units.
    pub fn area_on(&self, place: TilePlace, grid: &PixelGrid) -> Rect {
        let pixels = self.pixels(place, grid);
        place.area_of_pixels(pixels, grid)
    }

    /// Returns whether the segment may cover a point of a tile.
    pub fn reaches(&self, place: TilePlace, grid: &PixelGrid) -> bool {
        let tile = place.area(grid);
        let (_, distance) = nearest_on_path(tile.center(), self.ends.map(|end| end.at));
        // Rounding does not matter: at the rim the coverage is 0.
        distance <= self.radius + 0.5 * tile.size().length() && tile.intersection(&self.area).is_some()
    }
}

/// Returns whether the core of a brush of one width covers a tile.
fn is_in_core(brush: &Brush, path: [DVec2; 2], tile: &Rect) -> bool {
    // The distance from a segment is convex, so it is largest at a corner. Corners are farther from the path
    // than centres of pixels, by more than rounding.
    let corners =
        [tile.min, DVec2::new(tile.max.x, tile.min.y), tile.max, DVec2::new(tile.min.x, tile.max.y)];
    corners.iter().all(|&corner| nearest_on_path(corner, path).1 <= brush.core_radius())
}

/// Returns the coverage of the pixels of a tile from that of a point; `None` if it is 0 everywhere. `pixels`
/// are those that may be covered, as [`Segment::pixels`] returns them.
#[inline]
fn coverage_by(
    place: TilePlace,
    grid: &PixelGrid,
    [[left, lowest], [right, top]]: [[i32; 2]; 2],
    coverage: impl Fn(DVec2) -> f64,
) -> Option<Box<Tile>> {
    let pixel = grid.pixel * power_of_two(-i32::from(place.depth));
    let first = DVec2::new(f64::from(place.x), f64::from(place.y)) * f64::from(TILE) + 0.5;
    let mut tile = Box::new(Tile::filled(0.0));
    let mut greatest = 0.0f32;
    for y in lowest..top {
        for (x, value) in (left..).zip(tile.row_mut([left, y], (right - left).max(0) as usize)) {
            let center = grid.origin + (first + DVec2::new(f64::from(x), f64::from(y))) * pixel;
            *value = coverage(center) as f32;
            greatest = greatest.max(*value);
        }
    }
    (greatest > 0.0).then_some(tile)
}

/// Returns the smallest depth at which the brush is wide enough all along a segment, within
/// [`MOST_EXTRA_DEPTH`].
fn wanted_depth(brush: &Brush, ends: &[PathPoint; 2], grid: &PixelGrid) -> u8 {
    let needed = |size: f64| {
        let radius_px =
            |depth: &u8| brush.radius * size / grid.pixel.max_element() * power_of_two(i32::from(*depth));
        (0..TilePlace::DEEPEST)
            .find(|depth| radius_px(depth) >= LEAST_RADIUS_PX)
            .unwrap_or(TilePlace::DEEPEST)
    };
    let [from, to] = [ends[0].size, ends[1].size].map(needed);
    // A pen that touches down has almost no width yet, so the need of the whole brush is a limit as well.
    from.max(to).min(from.min(to).min(needed(1.0)) + MOST_EXTRA_DEPTH)
}

/// Returns about how many tiles of a depth a segment has in an area that it reaches.
fn tile_count(depth: u8, ends: &[PathPoint; 2], radius: f64, area: &Rect, grid: &PixelGrid) -> f64 {
    let tile = grid.pixel * f64::from(TILE) * power_of_two(-i32::from(depth));
    let length = (ends[1].at - ends[0].at).length().min(area.size().length());
    let width = 2.0 * radius + tile.max_element();
    (length + width) * width / (tile.x * tile.y)
}

/// Returns the tiles of a depth that touch a rectangle, row by row, or `None` if one is beyond the limits.
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
