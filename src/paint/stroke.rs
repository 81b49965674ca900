use std::collections::{BTreeMap, VecDeque};

use glam::DVec2;

use super::tiles::{TILE, TilePixels, TilePlace, tile_area, tiles_touching};
use super::{Brush, Medium, PaintRasters, Patch, distance_to_segment};
use crate::field::f32_not_below;
use crate::geometry::Rect;
use crate::raster::PixelRect;

/// One gesture with a brush, from press to release.
///
/// Within a stroke, going twice over the same place does no more than going once: each pixel keeps the fullest coverage
/// that it got, and its new value follows from that and from its value before the stroke.
#[derive(Clone, Debug)]
pub struct Stroke {
    brush: Brush,
    /// Where a painted diameter grades to at the rim, in world units.
    h_max: f64,
    /// Where the brush was led to last, in world units.
    last: Option<DVec2>,
    /// The way that is not laid down yet.
    pending: VecDeque<Segment>,
    touched: BTreeMap<TilePlace, Touched>,
}

/// A straight piece of a stroke's way.
#[derive(Clone, Debug)]
struct Segment {
    /// Its ends, in world units.
    ends: [DVec2; 2],
    /// The pixels that it may change.
    area: PixelRect,
    /// The tiles there that it reaches and that are still to be done.
    tiles: Vec<TilePlace>,
}

#[derive(Clone, Debug)]
struct Touched {
    before: TilePixels,
    coverage: Box<[f32]>,
}

impl Stroke {
    /// A stroke that has touched nothing yet. `h_max` is the largest target diameter, in world units.
    pub fn new(brush: Brush, h_max: f64) -> Self {
        Self { brush, h_max, last: None, pending: VecDeque::new(), touched: BTreeMap::new() }
    }

    /// The brush in use.
    pub fn brush(&self) -> &Brush {
        &self.brush
    }

    /// Leads the brush on to `point` in world units; [`Self::advance`] lays down what it does on the way. A point that is not finite
    /// is passed over.
    pub fn lead_to(&mut self, layers: &PaintRasters, point: DVec2) {
        if point.is_finite() {
            let from = self.last.replace(point).unwrap_or(point);
            self.pending.push_back(Segment::new([from, point], self.brush.on(layers).radius, layers));
        }
    }

    /// Lays down about `pixels` of what is left of the way, and returns those that may have changed; `None` once nothing is left.
    pub fn advance(&mut self, layers: &mut PaintRasters, pixels: usize) -> Option<PixelRect> {
        let mut segment = self.pending.pop_front()?;
        let [from, to] = segment.ends;
        let brush = self.brush.on(layers);
        let mut changed = PixelRect { min: [0, 0], max: [0, 0] };
        for _ in 0..pixels.div_ceil((TILE * TILE) as usize) {
            let Some(place) = segment.tiles.pop() else { return Some(changed) };
            let stamped = self.stamp_tile(layers, place, segment.area, |pixel| {
                brush.coverage(distance_to_segment(pixel, from, to))
            });
            changed = changed.union(&stamped);
        }
        self.pending.push_front(segment);
        Some(changed)
    }

    /// Whether all of the way is laid down.
    pub fn is_laid_down(&self) -> bool {
        self.pending.is_empty()
    }

    /// The old pixels of all that the stroke touched.
    pub fn finish(self) -> Patch {
        Patch::from_tiles(self.touched.into_iter().map(|(place, touched)| (place, touched.before)).collect())
    }

    fn stamp_tile(
        &mut self,
        layers: &mut PaintRasters,
        place: TilePlace,
        area: PixelRect,
        coverage_at: impl Fn(DVec2) -> f64,
    ) -> PixelRect {
        let tile = tile_area(place, layers.risk.size());
        let touched = self.touched.entry(place).or_insert_with(|| {
            let before = TilePixels::copied(layers, place);
            let coverage = vec![0.0; before.risk.len()].into();
            Touched { before, coverage }
        });
        let columns = (tile.max[0] - tile.min[0]) as usize;
        let common = PixelRect {
            min: [tile.min[0].max(area.min[0]), tile.min[1].max(area.min[1])],
            max: [tile.max[0].min(area.max[0]), tile.max[1].min(area.max[1])],
        };
        let pixel_center = layers.risk.pixel_centers();
        for (x, y) in common.pixels() {
            let coverage = coverage_at(pixel_center(x, y)) as f32;
            let i = (y - tile.min[1]) as usize * columns + (x - tile.min[0]) as usize;
            if coverage > touched.coverage[i] {
                touched.coverage[i] = coverage;
                let amount = f64::from(coverage) * self.brush.strength;
                let old = [touched.before.risk[i], touched.before.diameter[i]];
                let [risk, diameter] = laid_down(self.brush.medium, amount, old, self.h_max);
                layers.risk.set(x, y, risk);
                layers.diameter.set(x, y, diameter);
            }
        }
        common
    }
}

impl Segment {
    fn new(ends: [DVec2; 2], radius: f64, layers: &PaintRasters) -> Self {
        let [from, to] = ends;
        let area = layers.risk.pixels_touching(&Rect::spanning(from, to).expanded(radius));
        let (size, pixel) = (layers.risk.size(), layers.risk.pixel_size());
        let reaches = |&place: &TilePlace| {
            let PixelRect { min, max } = tile_area(place, size);
            let [low, high] = [min, max].map(|[x, y]| DVec2::new(x.into(), y.into()) * pixel);
            let (middle, half_diagonal) = (0.5 * (low + high), 0.5 * (high - low).length());
            let distance = distance_to_segment(layers.risk.bounds().min + middle, from, to);
            // Rounding does not matter: the rim of the brush does nothing.
            distance <= radius + half_diagonal
        };
        Self { ends, area, tiles: tiles_touching(area).filter(reaches).collect() }
    }
}

/// What a stroke does that is a single touch of the brush: told, not laid down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dab {
    brush: Brush,
    /// As for a stroke.
    h_max: f64,
    at: DVec2,
    area: PixelRect,
}

impl Dab {
    /// A touch of `brush` at a point in world units, which must be finite. `h_max` is the largest target diameter.
    pub fn new(brush: Brush, h_max: f64, at: DVec2, layers: &PaintRasters) -> Self {
        let brush = brush.on(layers);
        let area = layers.risk.pixels_touching(&Rect::around(at, brush.radius));
        Self { brush, h_max, at, area }
    }

    /// The pixels that may change.
    pub fn area(&self) -> PixelRect {
        self.area
    }

    /// Risk and diameter of a pixel once touched, by column and row.
    pub fn pixel(&self, layers: &PaintRasters, x: u32, y: u32) -> [f32; 2] {
        let old = [layers.risk.get(x, y), layers.diameter.get(x, y)];
        let coverage = self.brush.coverage((layers.risk.pixel_center(x, y) - self.at).length()) as f32;
        if coverage > 0.0 {
            laid_down(self.brush.medium, f64::from(coverage) * self.brush.strength, old, self.h_max)
        } else {
            old
        }
    }
}

/// New risk and diameter of a pixel from the old ones, where the brush works by `amount`, 0 to 1.
fn laid_down(medium: Medium, amount: f64, [risk, diameter]: [f32; 2], h_max: f64) -> [f32; 2] {
    match medium {
        Medium::Risk => [(f64::from(risk) + amount * (1.0 - f64::from(risk))) as f32, diameter],
        Medium::Diameter(target) => {
            let graded = if amount >= 1.0 { target } else { h_max * libm::pow(target / h_max, amount) };
            [risk, diameter.min(f32_not_below(graded))]
        }
        Medium::Eraser => {
            // The last trace goes too: a hundredth of risk that stays behind would keep the mesh refined.
            let risk = f64::from(risk) * (1.0 - amount);
            let risk = if risk < 0.01 { 0.0 } else { risk as f32 };
            let diameter = f64::from(diameter);
            let raised = diameter * libm::pow((h_max / diameter).max(1.0), amount);
            [risk, if raised >= 0.99 * h_max { f32::INFINITY } else { raised as f32 }]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    const SIZE: [u32; 2] = [200, 150];
    const RISK: Brush = Brush { medium: Medium::Risk, radius: 0.1, hardness: 0.5, strength: 0.8 };

    fn painted(layers: &mut PaintRasters, brush: Brush, points: &[DVec2]) -> Patch {
        let mut stroke = Stroke::new(brush, 0.5);
        points.iter().for_each(|&p| stroke.lead_to(layers, p));
        while stroke.advance(layers, usize::MAX).is_some() {}
        stroke.finish()
    }

    #[test]
    fn a_stroke_taken_back_and_done_again_is_the_same() {
        let mut random = fastrand::Rng::with_seed(3);
        let blank = PaintRasters::blank(Rect::UNIT, SIZE);
        let mut layers = blank.clone();
        let mut done = vec![];
        for medium in [Medium::Risk, Medium::Diameter(0.01), Medium::Eraser, Medium::Risk] {
            let points: Vec<_> = (0..5).map(|_| dvec2(random.f64(), random.f64()) * 1.2).collect();
            let before = layers.clone();
            let patch = painted(&mut layers, Brush { medium, ..RISK }, &points);
            done.push((before, patch, layers.clone()));
        }
        for (before, patch, after) in done.iter_mut().rev() {
            patch.exchange(&mut layers);
            assert_eq!(layers, *before);
            patch.exchange(&mut layers);
            assert_eq!(layers, *after);
            patch.exchange(&mut layers);
        }
        assert_eq!(layers, blank);
    }

    #[test]
    fn a_stroke_drawn_in_slices_is_the_same_and_leaves_distant_tiles_alone() {
        let points = [dvec2(0.1, 0.1), dvec2(0.9, 0.9), dvec2(0.9, 0.95)];
        let brush = Brush { radius: 0.02, ..RISK };
        let size = [1000, 900];
        let (mut whole, mut sliced) =
            (PaintRasters::blank(Rect::UNIT, size), PaintRasters::blank(Rect::UNIT, size));
        painted(&mut whole, brush, &points);
        let mut stroke = Stroke::new(brush, 0.5);
        points.iter().for_each(|&p| stroke.lead_to(&sliced, p));
        let mut slices = 0;
        while !stroke.is_laid_down() {
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
    fn going_over_the_same_place_twice_in_a_stroke_does_no_more_than_once() {
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
    fn a_brush_smaller_than_a_pixel_leaves_a_trace() {
        for medium in [Medium::Risk, Medium::Diameter(0.01)] {
            let mut layers = PaintRasters::blank(Rect::UNIT, SIZE);
            let brush = Brush { medium, radius: 1e-9, hardness: 1.0, strength: 1.0 };
            painted(&mut layers, brush, &[dvec2(0.33333, 0.77777)]);
            assert!(!layers.is_blank());
        }
    }

    #[test]
    fn a_dab_tells_what_a_stroke_of_one_point_lays_down() {
        let mut random = fastrand::Rng::with_seed(4);
        let mut layers = PaintRasters::blank(Rect::UNIT, SIZE);
        let mut changed = 0;
        for _ in 0..60 {
            let media = [Medium::Risk, Medium::Diameter(0.01), Medium::Eraser];
            let medium = media[random.usize(..3)];
            let radius = 0.3 * random.f64().powi(4);
            let brush = Brush { medium, radius, hardness: random.f64(), strength: random.f64() };
            let at = dvec2(random.f64(), random.f64()) * 1.2 - 0.1;
            let before = layers.clone();
            let dab = Dab::new(brush, 0.5, at, &before);
            painted(&mut layers, brush, &[at]);
            for (x, y) in before.risk.all().pixels() {
                let was = [before.risk.get(x, y), before.diameter.get(x, y)];
                let told = if dab.area().contains(x, y) { dab.pixel(&before, x, y) } else { was };
                assert_eq!([layers.risk.get(x, y), layers.diameter.get(x, y)], told);
                changed += usize::from(told != was);
            }
        }
        assert!(changed > 10_000, "{changed}");
    }

    #[test]
    fn a_full_eraser_leaves_nothing() {
        let mut layers = PaintRasters::blank(Rect::UNIT, SIZE);
        let points = [dvec2(0.3, 0.3), dvec2(0.6, 0.7)];
        painted(&mut layers, RISK, &points);
        painted(&mut layers, Brush { medium: Medium::Diameter(0.01), ..RISK }, &points);
        assert!(!layers.is_blank());
        let eraser = Brush { medium: Medium::Eraser, radius: 0.3, hardness: 1.0, strength: 1.0 };
        painted(&mut layers, eraser, &points);
        assert!(layers.is_blank());
    }

    #[test]
    fn points_that_are_no_numbers_change_nothing() {
        let mut layers = PaintRasters::blank(Rect::UNIT, SIZE);
        painted(&mut layers, RISK, &[dvec2(f64::NAN, 0.5), dvec2(f64::INFINITY, 0.0)]);
        assert!(layers.is_blank());
    }
}
