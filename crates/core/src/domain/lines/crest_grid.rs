//! Crests from grids of heights.

use glam::DVec2;

use super::{Crest, Line, LineMeasure};
use crate::geometry::Rect;
use crate::raster::Raster;

/// Pixels, in columns and rows, within which a pixel counts for a place without a value, as for depths.
const FARTHEST_PIXEL: u32 = 64;
/// Places between two changes of the pixels around a line. A grid is quadratic along a line there, and with
/// four of them a profile that is linear is off by at most a 64th of what is not linear in a pixel.
const PLACES_A_PIXEL: usize = 4;
/// How far a profile with fewer places may be from one with all, in metres.
const TOLERANCE: f64 = 0.000_5;

/// The crest of a line from a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct CrestOnGrid {
    /// The profile.
    pub crest: Crest,
    /// How far the farthest pixel is whose height a place without a value has, in world units; `None` where
    /// all places have their own.
    pub farthest: Option<f64>,
}

/// The place of a line at which a grid has no height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoCrest {
    /// The place in world units.
    pub place: DVec2,
}

impl CrestOnGrid {
    /// Returns the heights of a grid along the part of a line that is in a rectangle; the grid is linear
    /// between the centres of its pixels. A place without a value has that of the nearest pixel within 64
    /// columns and rows.
    ///
    /// # Errors
    /// Fails with a place that is farther away from all of them. For a line that is not in the rectangle the
    /// crest has the height of its first end, or 0 where there is none.
    pub fn of(line: &Line, raster: &Raster, bounds: &Rect) -> Result<Self, NoCrest> {
        let (mut pairs, mut farthest) = (Vec::new(), None);
        for (ends, shares) in LineMeasure::new(line).edges() {
            let Some([from, to]) = part_in(ends, bounds) else { continue };
            for at in places(ends, [from, to], raster) {
                let place = ends[0] + at * (ends[1] - ends[0]);
                let height = match raster.linear_at(place) {
                    Some(height) => height,
                    None => {
                        let nearest = raster.nearest(place, FARTHEST_PIXEL).ok_or(NoCrest { place })?;
                        farthest = Some(nearest.distance.max(farthest.unwrap_or(0.0)));
                        nearest.value
                    }
                };
                pairs.push([shares[0] + at * (shares[1] - shares[0]), height]);
            }
        }
        let crest = match pairs.is_empty() {
            true => Crest::Height(line.points.first().and_then(|&p| raster.linear_at(p)).unwrap_or(0.0)),
            false => Crest::Profile(thinned(&pairs)),
        };
        Ok(Self { crest, farthest })
    }
}

/// Returns the part of a segment in a rectangle, as shares of its length.
fn part_in([a, b]: [DVec2; 2], bounds: &Rect) -> Option<[f64; 2]> {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let (start, along) = (a[axis], b[axis] - a[axis]);
        if along == 0.0 {
            if !(bounds.min[axis]..=bounds.max[axis]).contains(&start) {
                return None;
            }
            continue;
        }
        let sides = [(bounds.min[axis] - start) / along, (bounds.max[axis] - start) / along];
        from = from.max(sides[0].min(sides[1]));
        to = to.min(sides[0].max(sides[1]));
    }
    (from <= to).then_some([from, to])
}

/// Returns where a part of a segment changes between pixels, and places between, as shares of the segment.
fn places([a, b]: [DVec2; 2], [from, to]: [f64; 2], raster: &Raster) -> Vec<f64> {
    let [first, other] = [from, to].map(|share| raster.pixel_from_world(a + share * (b - a)));
    let mut changes = vec![from, to];
    for axis in 0..2 {
        let (start, along) = (first[axis], other[axis] - first[axis]);
        // Centres of pixels, and the half pixel around the grid.
        let last = f64::from(raster.size()[axis]);
        let bound = |at: f64| (at - 0.5).clamp(-1.0, last);
        let (low, high) = (bound(start.min(start + along)), bound(start.max(start + along)));
        if along == 0.0 || !(low.is_finite() && high.is_finite()) {
            continue;
        }
        let centres = (low.ceil() as i64..=high.floor() as i64).map(|n| n as f64 + 0.5);
        let shares = centres.map(|centre| from + (centre - start) / along * (to - from));
        changes.extend(shares.filter(|share| (from..=to).contains(share)));
    }
    changes.sort_by(f64::total_cmp);
    changes.dedup();
    let between = |pair: &[f64]| {
        let (from, width) = (pair[0], pair[1] - pair[0]);
        (0..PLACES_A_PIXEL).map(move |n| from + width * n as f64 / PLACES_A_PIXEL as f64).collect::<Vec<_>>()
    };
    changes.windows(2).flat_map(between).chain([to]).collect()
}

/// Leaves out pairs of a profile that the others give within [`TOLERANCE`] (Douglas and Peucker).
fn thinned(pairs: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut stays = vec![false; pairs.len()];
    let last = pairs.len() - 1;
    (stays[0], stays[last]) = (true, true);
    let mut parts = vec![[0, last]];
    while let Some([from, to]) = parts.pop() {
        let off = |n: usize| {
            let [[x0, z0], [x1, z1]] = [pairs[from], pairs[to]];
            let share = if x1 > x0 { (pairs[n][0] - x0) / (x1 - x0) } else { 0.0 };
            (pairs[n][1] - (z0 + share * (z1 - z0))).abs()
        };
        let farthest = (from + 1..to).max_by(|&n, &m| off(n).total_cmp(&off(m)));
        if let Some(at) = farthest.filter(|&at| off(at) > TOLERANCE) {
            stays[at] = true;
            parts.extend([[from, at], [at, to]]);
        }
    }
    pairs.iter().zip(stays).filter_map(|(pair, stays)| stays.then_some(*pair)).collect()
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::super::LineKind;
    use super::*;

    fn line(points: &[[f64; 2]]) -> Line {
        let points = points.iter().map(|&p| p.into()).collect();
        Line { name: "line".into(), points, closed: false, kind: LineKind::Edges }
    }

    #[test]
    fn a_profile_is_near_the_grid_everywhere() {
        let size = [40, 30];
        let values = (0..30).flat_map(|y| (0..40).map(move |x| ((x * x + 3 * y * x) as f32 / 200.0).sin()));
        let raster = Raster::from_values(Rect::UNIT, size, values.collect());
        let wall = line(&[[0.1, 0.2], [0.8, 0.35], [0.4, 0.9]]);
        let CrestOnGrid { crest, farthest } = CrestOnGrid::of(&wall, &raster, &Rect::UNIT).unwrap();
        assert_eq!((crest.check(), farthest), (Ok(()), None));
        let whole = wall.length();
        let mut before = 0.0;
        for [a, b] in wall.edges() {
            for n in 0..=2000 {
                let along = f64::from(n) / 2000.0;
                let place = a + along * (b - a);
                let height = crest.at((before + along * a.distance(b)) / whole);
                let expected = raster.linear_at(place).unwrap();
                assert!((height - expected).abs() < 0.03, "{place}: {height} for {expected}");
            }
            before += a.distance(b);
        }
    }

    #[test]
    fn a_plane_needs_few_places_and_a_gap_has_the_nearest_pixel() {
        let plane = |x: u32, y: u32| if x == 7 { f32::NAN } else { x as f32 + 2.0 * y as f32 };
        let values = (0..20).flat_map(|y| (0..20).map(move |x| plane(x, y)));
        let raster = Raster::from_values(Rect::UNIT, [20, 20], values.collect());
        let CrestOnGrid { crest, farthest } =
            CrestOnGrid::of(&line(&[[0.45, 0.1], [0.45, 0.9]]), &raster, &Rect::UNIT).unwrap();
        let Crest::Profile(pairs) = crest else { panic!("{crest:?}") };
        assert!(pairs.len() < 6 && farthest.is_none(), "{pairs:?}");
        let crossing = line(&[[0.3, 0.5], [0.45, 0.5]]);
        let found = CrestOnGrid::of(&crossing, &raster, &Rect::UNIT).unwrap();
        assert!(found.farthest.is_some_and(|farthest| farthest < 0.06), "{found:?}");
    }

    #[test]
    fn far_from_the_grid_there_is_no_crest_and_beyond_the_domain_none_is_needed() {
        let small = Rect::new(dvec2(0.0, 0.0), dvec2(0.001, 0.001));
        let raster = Raster::filled(small, [10, 10], 2.0);
        let wall = line(&[[0.1, 0.1], [0.9, 0.9]]);
        assert!(CrestOnGrid::of(&wall, &raster, &Rect::UNIT).is_err());
        let far = line(&[[1e9, 5.0], [5.0, 1e300]]);
        let found = CrestOnGrid::of(&far, &raster, &Rect::UNIT).unwrap();
        assert_eq!(found.crest, Crest::Height(0.0));
    }
}
