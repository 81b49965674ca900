use std::collections::{BTreeMap, VecDeque};

use glam::DVec2;

use super::brush::{least_radius, nearest_on_path};
use super::tiles::{TILE, TilePixels, TilePlace, tile_area, tiles_touching};
use super::{Brush, Mirror, PaintRasters, Patch, PathPoint};
use crate::geometry::Rect;
use crate::raster::PixelRect;

/// One gesture with a brush, from press to release.
///
/// The pointer gives a polyline. Each of its segments covers a capsule, and the stroke covers their union:
///
/// ```text
///      .-----------.         coverage of a pixel: 1 in the core, smoothly down to 0 at the rim;
///    /  .---------.  \       where capsules overlap, the largest coverage counts
///   |  | o-------o |  |
///    \  '---------'  /       o---o  segment of the pointer's path
///      '-----------'         inner line: core (hardness × radius); outer line: rim (radius)
/// ```
///
/// A pixel's new value follows from its value before the stroke and its largest coverage. So passing over a
/// place twice within a stroke does no more than passing over it once, and a stroke gives the same pixels
/// however it is sliced.
#[derive(Clone, Debug)]
pub struct Stroke {
    brush: Brush,
    /// The largest target diameter, in world units: a painted diameter grows to it at the rim.
    h_max: f64,
    mirror: Mirror,
    /// The last point of the path.
    last: Option<PathPoint>,
    /// Segments that are not drawn yet, in order.
    pending: VecDeque<Segment>,
    touched: BTreeMap<TilePlace, Touched>,
}

/// A straight piece of the path, from one point of the pointer to the next.
#[derive(Clone, Debug)]
struct Segment {
    ends: [PathPoint; 2],
    /// The pixels that it may change.
    area: PixelRect,
    /// The tiles in `area` that it reaches and that are not stamped yet.
    tiles: Vec<TilePlace>,
}

/// A tile that the stroke reached.
#[derive(Clone, Debug)]
struct Touched {
    /// Its pixels before the stroke.
    before: TilePixels,
    /// The largest coverage of each pixel so far, 0 to 1, in the order of the pixels.
    coverage: Box<[f32]>,
}

impl Stroke {
    /// A stroke that has touched nothing yet. `h_max` is the largest target diameter, in world units.
    pub fn new(brush: Brush, h_max: f64) -> Self {
        let mirror = Mirror::default();
        Self { brush, h_max, mirror, last: None, pending: VecDeque::new(), touched: BTreeMap::new() }
    }

    /// The stroke, repeated in the lines of `mirror`.
    pub fn mirrored(self, mirror: Mirror) -> Self {
        Self { mirror, ..self }
    }

    /// The brush in use.
    pub fn brush(&self) -> &Brush {
        &self.brush
    }

    /// Extends the path to a point; [`Self::advance`] draws the new segment. A point that is not finite is
    /// ignored.
    pub fn extend(&mut self, paint: &PaintRasters, point: impl Into<PathPoint>) {
        let point = point.into();
        if point.is_finite() {
            // As thin as the rasters can show, at least.
            let least = least_radius(paint) / self.brush.on(paint).radius;
            let point = PathPoint { size: point.size.max(least), ..point };
            let from = self.last.replace(point).unwrap_or(point);
            let segments = self.mirror.segments([from, point]);
            self.pending.extend(segments.map(|ends| Segment::new(ends, &self.brush, paint)));
        }
    }

    /// Draws about `pixels` of the next segment, whole tiles of it. Returns the rectangle in which pixels may
    /// have changed, `None` if nothing was left to draw.
    pub fn advance(&mut self, paint: &mut PaintRasters, pixels: usize) -> Option<PixelRect> {
        let mut segment = self.pending.pop_front()?;
        let (ends, brush) = (segment.ends, self.brush.on(paint));
        let mut changed = PixelRect { min: [0, 0], max: [0, 0] };
        for _ in 0..pixels.div_ceil((TILE * TILE) as usize) {
            let Some(place) = segment.tiles.pop() else { return Some(changed) };
            let stamped =
                self.stamp_tile(paint, place, segment.area, |pixel| brush.coverage_of_segment(pixel, ends));
            changed = changed.union(&stamped);
        }
        self.pending.push_front(segment);
        Some(changed)
    }

    /// Whether the path is drawn to its last point.
    pub fn is_drawn(&self) -> bool {
        self.pending.is_empty()
    }

    /// Ends the stroke: the pixels before it of all tiles that it touched.
    pub fn finish(self) -> Patch {
        Patch::from_tiles(self.touched.into_iter().map(|(place, touched)| (place, touched.before)).collect())
    }

    /// Applies the brush to the pixels of one tile in `area`, and returns the rectangle of these pixels.
    fn stamp_tile(
        &mut self,
        paint: &mut PaintRasters,
        place: TilePlace,
        area: PixelRect,
        coverage_at: impl Fn(DVec2) -> f64,
    ) -> PixelRect {
        let tile = tile_area(place, paint.risk.size());
        // The first visit of the stroke keeps the tile as it was.
        let touched = self.touched.entry(place).or_insert_with(|| {
            let before = TilePixels::copied(paint, place);
            let coverage = vec![0.0; before.risk.len()].into();
            Touched { before, coverage }
        });
        let columns = (tile.max[0] - tile.min[0]) as usize;
        let common = PixelRect {
            min: [tile.min[0].max(area.min[0]), tile.min[1].max(area.min[1])],
            max: [tile.max[0].min(area.max[0]), tile.max[1].min(area.max[1])],
        };
        let pixel_center = paint.risk.pixel_centers();
        for (x, y) in common.pixels() {
            let coverage = coverage_at(pixel_center(x, y)) as f32;
            let i = (y - tile.min[1]) as usize * columns + (x - tile.min[0]) as usize;
            if coverage > touched.coverage[i] {
                // From the pixel before the stroke, not from its present value: the order of the segments
                // does not matter.
                touched.coverage[i] = coverage;
                let old = [touched.before.risk[i], touched.before.diameter[i]];
                let [risk, diameter] = self.brush.painted_pixel(coverage, old, self.h_max);
                paint.risk.set(x, y, risk);
                paint.diameter.set(x, y, diameter);
            }
        }
        common
    }
}

impl Segment {
    fn new(ends: [PathPoint; 2], brush: &Brush, paint: &PaintRasters) -> Self {
        let [from, to] = ends.map(|end| end.at);
        let radius = widest(&ends, brush, paint);
        let area = paint.risk.pixels_touching(&Rect::spanning(from, to).expanded(radius));
        let (size, pixel) = (paint.risk.size(), paint.risk.pixel_size());
        let reaches = |&place: &TilePlace| {
            let PixelRect { min, max } = tile_area(place, size);
            let [low, high] = [min, max].map(|[x, y]| DVec2::new(x.into(), y.into()) * pixel);
            let (middle, half_diagonal) = (0.5 * (low + high), 0.5 * (high - low).length());
            let (_, distance) = nearest_on_path(paint.risk.bounds().min + middle, [from, to]);
            // Rounding does not matter: at the rim the coverage is 0.
            distance <= radius + half_diagonal
        };
        Self { ends, area, tiles: tiles_touching(area).filter(reaches).collect() }
    }
}

/// The largest radius along a segment, in world units.
pub(super) fn widest(ends: &[PathPoint; 2], brush: &Brush, paint: &PaintRasters) -> f64 {
    brush.on(paint).radius * ends[0].size.max(ends[1].size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::f32_not_below;
    use crate::paint::{DiameterChange, Medium, Preview, StrokePlan};
    use glam::dvec2;

    const SIZE: [u32; 2] = [200, 150];
    const FINER: Medium = Medium::Diameter(0.01, DiameterChange::Finer);
    const COARSER: Medium = Medium::Diameter(0.03, DiameterChange::Coarser);
    const ANY: Medium = Medium::Diameter(0.02, DiameterChange::Any);
    const RISK: Brush = Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 0.5, strength: 0.8 };

    fn painted(paint: &mut PaintRasters, brush: Brush, points: &[DVec2]) -> Patch {
        let mut stroke = Stroke::new(brush, 0.5);
        points.iter().for_each(|&p| stroke.extend(paint, p));
        while stroke.advance(paint, usize::MAX).is_some() {}
        stroke.finish()
    }

    #[test]
    fn undo_and_redo_of_a_stroke_restore_every_pixel() {
        let mut random = fastrand::Rng::with_seed(3);
        let blank = PaintRasters::blank(Rect::UNIT, SIZE);
        let mut paint = blank.clone();
        let mut done = vec![];
        for medium in [Medium::Risk(1.0), FINER, ANY, COARSER, Medium::Eraser, Medium::Risk(0.5)] {
            let points: Vec<_> = (0..5).map(|_| dvec2(random.f64(), random.f64()) * 1.2).collect();
            let before = paint.clone();
            let patch = painted(&mut paint, Brush { medium, ..RISK }, &points);
            done.push((before, patch, paint.clone()));
        }
        for (before, patch, after) in done.iter_mut().rev() {
            patch.exchange(&mut paint);
            assert_eq!(paint, *before);
            patch.exchange(&mut paint);
            assert_eq!(paint, *after);
            patch.exchange(&mut paint);
        }
        assert_eq!(paint, blank);
    }

    #[test]
    fn slices_do_not_change_a_stroke_and_distant_tiles_are_not_touched() {
        let points = [dvec2(0.1, 0.1), dvec2(0.9, 0.9), dvec2(0.9, 0.95)];
        let brush = Brush { radius: 0.02, ..RISK };
        let size = [1000, 900];
        let (mut whole, mut sliced) =
            (PaintRasters::blank(Rect::UNIT, size), PaintRasters::blank(Rect::UNIT, size));
        painted(&mut whole, brush, &points);
        let mut stroke = Stroke::new(brush, 0.5);
        points.iter().for_each(|&p| stroke.extend(&sliced, p));
        let mut slices = 0;
        while !stroke.is_drawn() {
            let before = sliced.clone();
            let area = stroke.advance(&mut sliced, 1).expect("something is left");
            assert!(area.max[0] - area.min[0] <= TILE && area.max[1] - area.min[1] <= TILE);
            let differ = |&(x, y): &(u32, u32)| before.risk.get(x, y) != sliced.risk.get(x, y);
            assert!(sliced.risk.all().pixels().filter(differ).all(|(x, y)| area.contains(x, y)));
            slices += 1;
        }
        assert_eq!(stroke.advance(&mut sliced, 1), None);
        assert_eq!(sliced, whole);
        let tiles = stroke.touched.len();
        assert!(slices >= tiles && (20..70).contains(&tiles), "{tiles} of 240 tiles in {slices} slices");
    }

    #[test]
    fn passing_over_a_place_twice_in_one_stroke_does_no_more_than_once() {
        let (a, b) = (dvec2(0.2, 0.5), dvec2(0.8, 0.5));
        let (mut once, mut twice) =
            (PaintRasters::blank(Rect::UNIT, SIZE), PaintRasters::blank(Rect::UNIT, SIZE));
        painted(&mut once, RISK, &[a, b]);
        painted(&mut twice, RISK, &[a, b, a, b]);
        assert_eq!(once, twice);
        painted(&mut twice, RISK, &[a, b]);
        assert!((once.risk.sample(a).unwrap() - 0.8).abs() < 1e-6);
        assert!((twice.risk.sample(a).unwrap() - 0.96).abs() < 1e-6);
    }

    #[test]
    fn a_brush_smaller_than_a_pixel_paints_a_pixel() {
        for medium in [Medium::Risk(1.0), FINER, ANY] {
            let mut paint = PaintRasters::blank(Rect::UNIT, SIZE);
            let brush = Brush { medium, radius: 1e-9, hardness: 1.0, strength: 1.0 };
            painted(&mut paint, brush, &[dvec2(0.33333, 0.77777)]);
            assert!(!paint.is_blank());
        }
    }

    #[test]
    fn a_preview_equals_the_stroke() {
        let mut random = fastrand::Rng::with_seed(4);
        let mut paint = PaintRasters::blank(Rect::UNIT, SIZE);
        let mut changed = 0;
        for _ in 0..60 {
            let media = [Medium::Risk(1.0), Medium::Risk(0.3), FINER, COARSER, ANY, Medium::Eraser];
            let medium = media[random.usize(..media.len())];
            let radius = 0.3 * random.f64().powi(4);
            let brush = Brush { medium, radius, hardness: random.f64(), strength: random.f64() };
            let from = dvec2(random.f64(), random.f64()) * 1.2 - 0.1;
            let to = if random.bool() { from } else { dvec2(random.f64(), random.f64()) };
            let mirror = Mirror { x: random.bool().then_some(0.5), y: random.bool().then_some(0.4) };
            let before = paint.clone();
            let preview = Preview::new(&StrokePlan { brush, mirror, from, to }, 0.5, &before);
            let mut stroke = Stroke::new(brush, 0.5).mirrored(mirror);
            [from, to].into_iter().for_each(|point| stroke.extend(&paint, point));
            while stroke.advance(&mut paint, usize::MAX).is_some() {}
            for (x, y) in before.risk.all().pixels() {
                let was = [before.risk.get(x, y), before.diameter.get(x, y)];
                let predicted = preview.pixel(&before, x, y).unwrap_or(was);
                assert_eq!([paint.risk.get(x, y), paint.diameter.get(x, y)], predicted, "{brush:?}");
                let listed = preview.areas().any(|area| area.contains(x, y));
                assert!(listed || predicted == was);
                changed += usize::from(predicted != was);
            }
        }
        assert!(changed > 10_000, "{changed}");
    }

    #[test]
    fn setting_a_risk_reaches_it_from_below_and_above_in_one_stroke() {
        let at = dvec2(0.5, 0.5);
        for start in [0.0, 0.3, 0.9] {
            let mut paint = PaintRasters::blank(Rect::UNIT, SIZE);
            painted(&mut paint, Brush { medium: Medium::Risk(start), strength: 1.0, ..RISK }, &[at]);
            painted(&mut paint, Brush { medium: Medium::Risk(0.55), strength: 1.0, ..RISK }, &[at]);
            assert_eq!(paint.risk.sample(at), Some(0.55), "from {start}");
        }
    }

    #[test]
    fn lowering_removes_a_share_of_the_risk_and_ends_blank() {
        let at = dvec2(0.5, 0.5);
        let mut paint = PaintRasters::blank(Rect::UNIT, SIZE);
        painted(&mut paint, Brush { strength: 1.0, ..RISK }, &[at]);
        let lower = Brush { medium: Medium::Risk(0.0), strength: 0.5, hardness: 1.0, radius: 0.2 };
        painted(&mut paint, lower, &[at]);
        assert_eq!(paint.risk.sample(at), Some(0.5));
        for _ in 0..10 {
            painted(&mut paint, lower, &[at]);
        }
        assert!(paint.is_blank());
    }

    #[test]
    fn diameters_change_only_in_the_directions_of_the_brush() {
        let at = dvec2(0.5, 0.5);
        let start = Brush { medium: ANY, strength: 1.0, ..RISK };
        let after = |medium| {
            let mut paint = PaintRasters::blank(Rect::UNIT, SIZE);
            painted(&mut paint, start, &[at]);
            painted(&mut paint, Brush { medium, ..start }, &[at]);
            [paint.diameter.sample(at).unwrap(), paint.diameter.sample(dvec2(0.1, 0.1)).unwrap()]
        };
        let blank = f32::INFINITY;
        assert_eq!(after(Medium::Diameter(0.01, DiameterChange::Finer)), [f32_not_below(0.01), blank]);
        assert_eq!(after(Medium::Diameter(0.01, DiameterChange::Coarser)), [f32_not_below(0.02), blank]);
        assert_eq!(after(Medium::Diameter(0.04, DiameterChange::Finer)), [f32_not_below(0.02), blank]);
        assert_eq!(after(Medium::Diameter(0.04, DiameterChange::Coarser)), [f32_not_below(0.04), blank]);
        assert_eq!(after(Medium::Diameter(0.01, DiameterChange::Any)), [f32_not_below(0.01), blank]);
        assert_eq!(after(Medium::Diameter(0.04, DiameterChange::Any)), [f32_not_below(0.04), blank]);
    }

    #[test]
    fn a_mirrored_stroke_is_symmetric_and_one_gesture() {
        let size = [200, 200];
        let mut paint = PaintRasters::blank(Rect::UNIT, size);
        let mut stroke = Stroke::new(RISK, 0.5).mirrored(Mirror { x: Some(0.5), y: Some(0.5) });
        for point in [dvec2(0.2, 0.3), dvec2(0.3, 0.1), dvec2(0.55, 0.2)] {
            stroke.extend(&paint, point);
        }
        while stroke.advance(&mut paint, 1).is_some() {}
        for (x, y) in paint.risk.all().pixels() {
            let images = [(199 - x, y), (x, 199 - y), (199 - x, 199 - y)];
            for (i, j) in images {
                assert!((paint.risk.get(x, y) - paint.risk.get(i, j)).abs() < 1e-5);
            }
        }
        stroke.finish().exchange(&mut paint);
        assert!(paint.is_blank());
    }

    #[test]
    fn size_and_strength_of_a_path_follow_its_points() {
        let mut paint = PaintRasters::blank(Rect::UNIT, [400, 400]);
        let mut stroke = Stroke::new(Brush { hardness: 1.0, strength: 1.0, ..RISK }, 0.5);
        stroke.extend(&paint, PathPoint { at: dvec2(0.2, 0.5), size: 0.2, strength: 0.5 });
        stroke.extend(&paint, PathPoint { at: dvec2(0.8, 0.5), size: 1.0, strength: 1.0 });
        while stroke.advance(&mut paint, usize::MAX).is_some() {}
        let risk = |x, y| paint.risk.sample(dvec2(x, y)).unwrap();
        assert!((risk(0.2, 0.5) - 0.5).abs() < 0.01 && risk(0.8, 0.5) > 0.99);
        assert!(risk(0.2, 0.53) == 0.0 && risk(0.8, 0.59) > 0.9, "thin where it begins, thick where it ends");
    }

    #[test]
    fn erasing_at_full_strength_leaves_blank_rasters() {
        let mut paint = PaintRasters::blank(Rect::UNIT, SIZE);
        let points = [dvec2(0.3, 0.3), dvec2(0.6, 0.7)];
        painted(&mut paint, RISK, &points);
        painted(&mut paint, Brush { medium: FINER, ..RISK }, &points);
        assert!(!paint.is_blank());
        let eraser = Brush { medium: Medium::Eraser, radius: 0.3, hardness: 1.0, strength: 1.0 };
        painted(&mut paint, eraser, &points);
        assert!(paint.is_blank());
    }

    #[test]
    fn points_that_are_not_finite_are_ignored() {
        let mut paint = PaintRasters::blank(Rect::UNIT, SIZE);
        painted(&mut paint, RISK, &[dvec2(f64::NAN, 0.5), dvec2(f64::INFINITY, 0.0)]);
        assert!(paint.is_blank());
    }
}
