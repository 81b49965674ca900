use glam::{DVec2, dvec2};

use super::*;
use crate::field::f32_not_below;
use crate::mesh::TargetChange;
use crate::paint::{DiameterChange, Medium, Preview, StrokePlan};
use crate::raster::PixelGrid;

const FINER: Medium = Medium::Diameter(0.01, DiameterChange::Finer);
const COARSER: Medium = Medium::Diameter(0.03, DiameterChange::Coarser);
const ANY: Medium = Medium::Diameter(0.02, DiameterChange::Any);
const RISK: Brush = Brush { medium: Medium::Risk(1.0), radius: 0.1, hardness: 0.5, strength: 0.8 };
const H_MAX: f64 = 0.5;

fn preview(plan: &StrokePlan, h_max: f64, bounds: Rect, raster: &TiledRaster) -> (TiledRaster, Vec<Repaint>) {
    Preview::new(plan, h_max, bounds, raster).finish()
}

fn risks() -> TiledRaster {
    TiledRaster::new(PixelGrid::filling(&Rect::UNIT, [200, 150]), 0.0)
}

fn diameters() -> TiledRaster {
    TiledRaster::new(*risks().grid(), f32::INFINITY)
}

fn stroke(raster: &TiledRaster, brush: Brush, points: &[DVec2]) -> Stroke {
    let mut stroke = Stroke::new(brush, H_MAX, Rect::UNIT);
    points.iter().for_each(|&p| stroke.extend(raster, p));
    stroke
}

fn finished(mut stroke: Stroke, raster: &mut TiledRaster) -> Patch {
    while stroke.advance(raster, usize::MAX).is_some() {}
    assert!(stroke.is_drawn());
    stroke.finish(raster)
}

fn painted(raster: &mut TiledRaster, brush: Brush, points: &[DVec2]) -> Patch {
    finished(stroke(raster, brush, points), raster)
}

fn random_points(random: &mut fastrand::Rng, count: usize) -> Vec<DVec2> {
    (0..count).map(|_| dvec2(random.f64(), random.f64())).collect()
}

/// Fails if the values at a random point outside of the changed areas differ, or if no area there has a range
/// that holds the value of `held` and the direction of the change. Returns how many points inside differ.
fn assert_changes_within(
    changed: &[Repaint],
    held: &TiledRaster,
    [before, after]: [&TiledRaster; 2],
    random: &mut fastrand::Rng,
) -> usize {
    let points = random_points(random, 2000);
    let differing = points.iter().filter(|&&p| before.sample(p) != after.sample(p));
    let is_known = |p: DVec2| {
        let value = held.sample(p);
        let holds = |range: &ValueRange| range.least <= value && value <= range.greatest;
        let rises = before.sample(p) < after.sample(p);
        let asks_for_more = rises == (before.blank() == 0.0);
        let permits = |change: TargetChange| match change {
            TargetChange::Finer => asks_for_more,
            TargetChange::Coarser => !asks_for_more,
            TargetChange::Any => true,
        };
        changed
            .iter()
            .any(|repaint| repaint.area.contains(p) && holds(&repaint.before) && permits(repaint.change))
    };
    differing.inspect(|&&p| assert!(is_known(p), "{p}")).count()
}

#[test]
fn undo_and_redo_of_strokes_restore_every_tile() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut changes = 0;
    for (blank, media) in [
        (risks(), [Medium::Risk(1.0), Medium::Risk(0.5), Medium::Eraser, Medium::Risk(0.0)]),
        (diameters(), [FINER, ANY, COARSER, Medium::Eraser]),
    ] {
        let mut raster = blank.clone();
        let mut done = vec![];
        for medium in [media, media].concat() {
            let points: Vec<_> = random_points(&mut random, 3).iter().map(|p| *p * 1.2).collect();
            let radius = [0.3, 0.1, 0.03, 0.01][random.usize(..4)];
            let brush = Brush { medium, radius, strength: random.f64(), ..RISK };
            let before = raster.clone();
            let patch = painted(&mut raster, brush, &points);
            done.push((before, patch, raster.clone()));
        }
        assert!(raster.tiles().any(|(place, _)| place.depth == 0));
        assert!(raster.tiles().any(|(place, _)| place.depth >= 4));
        for (before, patch, after) in done.iter_mut().rev() {
            let areas = patch.exchange(&mut raster);
            assert_eq!(raster, *before);
            changes += assert_changes_within(&areas, after, [&*after, &*before], &mut random);
            let areas = patch.exchange(&mut raster);
            assert_eq!(raster, *after);
            assert_changes_within(&areas, before, [&*before, &*after], &mut random);
            patch.exchange(&mut raster);
        }
        assert_eq!(raster, blank);
        assert_eq!(raster.tile_count(), 0);
    }
    assert!(changes > 1000, "{changes}");
}

#[test]
fn strokes_give_the_values_of_the_formula_at_every_depth() {
    // Coverage by a click, written down once more.
    fn coverage(brush: &Brush, distance: f64) -> f64 {
        let t = ((brush.radius - distance) / (brush.radius * (1.0 - brush.hardness))).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
    let mut random = fastrand::Rng::with_seed(8);
    let mut worst: f64 = 0.0;
    for _ in 0..12 {
        let mut raster = risks();
        let mut done: Vec<(Brush, DVec2)> = vec![];
        for _ in 0..4 {
            let medium = Medium::Risk(if random.bool() { 1.0 } else { 0.25 });
            let radius = 0.2 * 0.5_f64.powi(random.i32(0..6));
            let brush = Brush { medium, radius, hardness: 0.2, strength: random.f64() };
            let at = dvec2(0.5, 0.5) + 0.1 * (dvec2(random.f64(), random.f64()) - 0.5);
            painted(&mut raster, brush, &[at]);
            done.push((brush, at));
        }
        for point in random_points(&mut random, 600) {
            let scale = 0.2 * 0.5_f64.powi(random.i32(0..6));
            let point = dvec2(0.5, 0.5) + (point - 0.5) * scale;
            let expected = done.iter().fold(0.0, |risk, (brush, at)| {
                let Medium::Risk(aim) = brush.medium else { unreachable!() };
                risk + brush.strength * coverage(brush, point.distance(*at)) * (aim - risk)
            });
            worst = worst.max((f64::from(raster.sample(point)) - expected).abs());
        }
    }
    // A radius of 32 pixels or more, a slope of 1.5 / 0.8 of a radius, four strokes.
    assert!((0.001..0.1).contains(&worst), "{worst}");
}

#[test]
fn each_pixel_is_that_of_the_largest_coverage_by_a_segment() {
    let mut random = fastrand::Rng::with_seed(29);
    let grid = PixelGrid::filling(&Rect::UNIT, [300, 200]);
    let (mut whole, mut partly) = (0, 0);
    for round in 0..40 {
        let medium = [FINER, COARSER, ANY, Medium::Eraser, Medium::Risk(1.0), Medium::Risk(0.0)][round % 6];
        let blank = if round % 6 < 4 { f32::INFINITY } else { 0.0 };
        let mut raster = TiledRaster::new(grid, blank);
        let first = if blank == 0.0 { RISK } else { Brush { medium: ANY, ..RISK } };
        painted(&mut raster, Brush { radius: 0.4, ..first }, &random_points(&mut random, 2));
        let before = raster.clone();
        let hardness = [0.0, 0.7, 1.0][random.usize(..3)];
        let brush = Brush { medium, radius: 0.25 + 0.3 * random.f64(), hardness, strength: 1.0 };
        let steady = random.bool();
        let points: Vec<PathPoint> = (0..random.usize(1..4))
            .map(|_| PathPoint {
                at: dvec2(random.f64(), random.f64()),
                size: if steady { 1.0 } else { 0.7 + 0.3 * random.f64() },
                strength: if steady { 0.9 } else { random.f64() },
            })
            .collect();
        let mut gesture = stroke(&raster, brush, &[]);
        for &point in &points {
            gesture.extend(&raster, point);
            gesture.extend(&raster, point);
        }
        finished(gesture, &mut raster);
        assert_eq!(raster.tiles().map(|(place, _)| place.depth).max(), Some(0));
        for (x, y) in (0..200).flat_map(|y| (0..300).map(move |x| (x, y))) {
            let center = grid.origin + (dvec2(f64::from(x), f64::from(y)) + 0.5) * grid.pixel;
            let ends = points.windows(2).map(|ends| [ends[0], ends[1]]).chain([[points[0]; 2]]);
            let coverages = ends.map(|ends| brush.coverage_of_segment(center, ends) as f32);
            let coverage = coverages.fold(0.0, f32::max);
            let old = before.sample(center);
            let expected =
                if coverage > 0.0 { brush.painted_value(coverage, old, blank, H_MAX) } else { old };
            assert_eq!(raster.sample(center).to_bits(), expected.to_bits(), "{round}: {x}, {y}");
            whole += usize::from(coverage == 0.9);
            partly += usize::from(coverage > 0.0 && coverage < 0.9);
        }
    }
    assert!(whole > 100_000 && partly > 100_000, "{whole} {partly}");
}

#[test]
fn a_stroke_at_4096_times_zoom_has_the_same_pixels_as_at_depth_0() {
    let grid = PixelGrid { origin: DVec2::ZERO, pixel: DVec2::splat(1.0 / 2048.0) };
    let points = [dvec2(0.11, 0.12), dvec2(0.16, 0.14), dvec2(0.15, 0.08)];
    let brush = Brush { radius: 0.02, ..RISK };
    for (blank, medium) in [(0.0, Medium::Risk(1.0)), (f32::INFINITY, FINER)] {
        let mut coarse = TiledRaster::new(grid, blank);
        let mut fine = coarse.clone();
        let brush = Brush { medium, ..brush };
        painted(&mut coarse, brush, &points);
        painted(&mut fine, Brush { radius: brush.radius / 4096.0, ..brush }, &points.map(|p| p / 4096.0));
        let mut values = vec![];
        for (x, y) in (100..400).flat_map(|x| (100..400).map(move |y| (f64::from(x), f64::from(y)))) {
            let center = dvec2(x + 0.5, y + 0.5) / 2048.0;
            assert_eq!(coarse.sample(center), fine.sample(center / 4096.0));
            values.push(coarse.sample(center).to_bits());
        }
        values.sort_unstable();
        values.dedup();
        assert!(values.len() > 1000, "{} values", values.len());
        assert_eq!(fine.tiles().last().map(|(place, _)| place.depth), Some(12));
        let [tiles, more_tiles] = [&coarse, &fine].map(TiledRaster::tile_count);
        assert!(more_tiles < 2 * tiles + 12, "{tiles} {more_tiles}");
        assert!(fine.bytes() < 1_000_000, "{}", fine.bytes());
    }
}

#[test]
fn slices_do_not_change_a_stroke_and_distant_tiles_are_not_touched() {
    let points = [dvec2(0.1, 0.1), dvec2(0.9, 0.9), dvec2(0.9, 0.95)];
    let mut random = fastrand::Rng::with_seed(5);
    let mut whole = TiledRaster::new(PixelGrid::filling(&Rect::UNIT, [1000, 900]), 0.0);
    // Something deeper, on the way.
    painted(&mut whole, Brush { radius: 0.01, ..RISK }, &[dvec2(0.5, 0.52)]);
    let (mut sliced, brush) = (whole.clone(), Brush { radius: 0.04, ..RISK });
    painted(&mut whole, brush, &points);
    let mut stroke = stroke(&sliced, brush, &points);
    let (mut slices, mut changes) = (0, 0);
    let (start, mut before) = (sliced.clone(), sliced.clone());
    while let Some(repaint) = stroke.advance(&mut sliced, 1) {
        let most = 32.01 / 900.0;
        assert!(repaint.area.size().max_element() <= most);
        if slices % 2 == 0 {
            changes += assert_changes_within(&[repaint], &start, [&before, &sliced], &mut random);
        }
        before = sliced.clone();
        slices += 1;
    }
    assert!(stroke.is_drawn() && changes > 20, "{changes}");
    stroke.finish(&mut sliced);
    assert_eq!(sliced, whole);
    let tiles = sliced.tiles().filter(|(place, _)| place.depth == 0).count();
    assert!(slices >= tiles && (80..200).contains(&tiles), "{tiles} of 900 tiles in {slices} slices");
}

#[test]
fn a_slice_over_what_is_painted_ends_after_its_tiles() {
    let mut raster = TiledRaster::new(PixelGrid::filling(&Rect::UNIT, [1000, 900]), 0.0);
    let [a, b] = [dvec2(0.2, 0.5), dvec2(0.8, 0.5)];
    // The way back covers nothing more.
    let mut stroke = stroke(&raster, Brush { radius: 0.1, ..RISK }, &[a, b, a]);
    let mut slices = 0;
    while stroke.advance(&mut raster, 1).is_some() {
        slices += 1;
    }
    let tiles = raster.tile_count();
    assert!(slices >= 2 * tiles - 1, "{slices} slices for {tiles} tiles, twice");
}

#[test]
fn passing_over_a_place_twice_in_one_stroke_does_no_more_than_once() {
    let (a, b) = (dvec2(0.2, 0.5), dvec2(0.8, 0.5));
    let (mut once, mut twice) = (risks(), risks());
    painted(&mut once, RISK, &[a, b]);
    painted(&mut twice, RISK, &[a, b, a, b]);
    assert_eq!(once, twice);
    painted(&mut twice, RISK, &[a, b]);
    assert!((once.sample(a) - 0.8).abs() < 1e-6);
    assert!((twice.sample(a) - 0.96).abs() < 1e-6);
}

#[test]
fn passing_over_a_place_twice_with_other_sizes_does_no_more_than_once() {
    let at = dvec2(0.5, 0.5);
    for sizes in [[1.0, 0.05], [0.05, 1.0]] {
        let mut raster = risks();
        let mut stroke = stroke(&raster, RISK, &[]);
        for size in sizes {
            // Two points at each size: a segment of this size alone, and one between the sizes.
            let point = PathPoint { at, size, strength: 1.0 };
            [point, point].into_iter().for_each(|point| stroke.extend(&raster, point));
        }
        while stroke.advance(&mut raster, usize::MAX).is_some() {}
        assert!(raster.tiles().any(|(place, _)| place.depth == 5));
        stroke.finish(&mut raster);
        assert!((raster.sample(at) - 0.8).abs() < 1e-6 && (raster.whole_range().greatest - 0.8).abs() < 1e-6);
    }
}

#[test]
fn a_brush_smaller_than_the_smallest_pixel_paints_a_pixel() {
    for (blank, medium) in [(risks(), Medium::Risk(1.0)), (diameters(), FINER), (diameters(), ANY)] {
        for radius in [1e-3, 1e-6, 1e-12, 0.0] {
            let mut raster = blank.clone();
            let brush = Brush { medium, radius, hardness: 1.0, strength: 1.0 };
            painted(&mut raster, brush, &[dvec2(0.33333, 0.77777)]);
            assert!(!raster.is_blank(), "{medium:?} {radius}");
        }
    }
}

#[test]
fn a_preview_equals_the_stroke_and_changes_nothing() {
    let mut random = fastrand::Rng::with_seed(4);
    let mut changes = 0;
    for (mut raster, media) in [
        (risks(), [Medium::Risk(1.0), Medium::Risk(0.3), Medium::Eraser]),
        (diameters(), [FINER, COARSER, ANY]),
    ] {
        for _ in 0..12 {
            let medium = media[random.usize(..media.len())];
            let radius = 0.01 + 0.2 * random.f64().powi(4);
            let brush = Brush { medium, radius, hardness: random.f64(), strength: random.f64() };
            let from = dvec2(random.f64(), random.f64()) * 1.2 - 0.1;
            let to = if random.bool() { from } else { from + 0.1 * dvec2(random.f64(), random.f64()) };
            let mirror = Mirror { x: random.bool().then_some(0.5), y: random.bool().then_some(0.4) };
            let plan = StrokePlan { brush, mirror, from, to };
            let (before, tiles) = (raster.clone(), raster.tile_count());
            let (predicted, areas) = preview(&plan, H_MAX, Rect::UNIT, &raster);
            assert_eq!(raster.tile_count(), tiles);
            assert!(raster == before);
            let mut sliced = Preview::new(&plan, H_MAX, Rect::UNIT, &raster);
            while !sliced.advance(3000) {}
            assert!(sliced.finish().0 == predicted);
            let mut stroke = stroke(&raster, brush, &[]).mirrored(mirror);
            [from, to].into_iter().for_each(|point| stroke.extend(&raster, point));
            finished(stroke, &mut raster);
            assert!(raster == predicted, "{brush:?}");
            changes += assert_changes_within(&areas, &before, [&before, &raster], &mut random);
        }
    }
    assert!(changes > 500, "{changes}");
}

#[test]
fn setting_a_risk_reaches_it_from_below_and_above_in_one_stroke() {
    let at = dvec2(0.5, 0.5);
    for start in [0.0, 0.3, 0.9] {
        let mut raster = risks();
        painted(&mut raster, Brush { medium: Medium::Risk(start), strength: 1.0, ..RISK }, &[at]);
        painted(&mut raster, Brush { medium: Medium::Risk(0.55), strength: 1.0, ..RISK }, &[at]);
        assert_eq!(raster.sample(at), 0.55, "from {start}");
    }
}

#[test]
fn lowering_removes_a_share_of_the_risk_and_ends_blank() {
    let at = dvec2(0.5, 0.5);
    let mut raster = risks();
    painted(&mut raster, Brush { strength: 1.0, ..RISK }, &[at]);
    let lower = Brush { medium: Medium::Risk(0.0), strength: 0.5, hardness: 1.0, radius: 0.2 };
    painted(&mut raster, lower, &[at]);
    assert_eq!(raster.sample(at), 0.5);
    for _ in 0..10 {
        painted(&mut raster, lower, &[at]);
    }
    assert!(raster.is_blank() && raster.tile_count() == 0);
}

#[test]
fn diameters_change_only_in_the_directions_of_the_brush() {
    let at = dvec2(0.5, 0.5);
    let start = Brush { medium: ANY, strength: 1.0, ..RISK };
    let after = |medium| {
        let mut raster = diameters();
        painted(&mut raster, start, &[at]);
        painted(&mut raster, Brush { medium, ..start }, &[at]);
        [raster.sample(at), raster.sample(dvec2(0.1, 0.1))]
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
    let mut raster = TiledRaster::new(PixelGrid::filling(&Rect::UNIT, [200, 200]), 0.0);
    let mut stroke = stroke(&raster, RISK, &[]).mirrored(Mirror { x: Some(0.5), y: Some(0.5) });
    for point in [dvec2(0.2, 0.3), dvec2(0.3, 0.1), dvec2(0.55, 0.2)] {
        stroke.extend(&raster, point);
    }
    while stroke.advance(&mut raster, 1).is_some() {}
    let side = 800;
    let risk =
        |x: i32, y: i32| raster.sample(dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5) / f64::from(side));
    for (x, y) in (0..side / 2).step_by(3).flat_map(|x| (0..side / 2).step_by(3).map(move |y| (x, y))) {
        for (i, j) in [(side - 1 - x, y), (x, side - 1 - y), (side - 1 - x, side - 1 - y)] {
            assert!((risk(x, y) - risk(i, j)).abs() < 1e-5);
        }
    }
    assert!(risk(160, 240) > 0.7);
    stroke.finish(&mut raster).exchange(&mut raster);
    assert!(raster.is_blank());
}

#[test]
fn size_and_strength_of_a_path_follow_its_points() {
    let mut raster = risks();
    let mut stroke = stroke(&raster, Brush { hardness: 1.0, strength: 1.0, ..RISK }, &[]);
    stroke.extend(&raster, PathPoint { at: dvec2(0.2, 0.5), size: 0.2, strength: 0.5 });
    stroke.extend(&raster, PathPoint { at: dvec2(0.8, 0.5), size: 1.0, strength: 1.0 });
    finished(stroke, &mut raster);
    let risk = |x, y| raster.sample(dvec2(x, y));
    assert!((risk(0.2, 0.5) - 0.5).abs() < 0.01 && risk(0.8, 0.5) > 0.99);
    assert!(risk(0.2, 0.53) == 0.0 && risk(0.8, 0.59) > 0.9, "thin where it begins, thick where it ends");
}

#[test]
fn erasing_at_full_strength_leaves_an_empty_raster_at_any_depth() {
    let points = [dvec2(0.45, 0.45), dvec2(0.55, 0.5)];
    for mut raster in [risks(), diameters()] {
        let medium = if raster.blank() == 0.0 { Medium::Risk(1.0) } else { FINER };
        for (radius, eraser) in [(0.1, 0.3), (0.02, 0.3), (0.3, 0.05)] {
            painted(&mut raster, Brush { medium, radius, ..RISK }, &points);
            painted(&mut raster, Brush { medium, radius: radius / 3.0, ..RISK }, &points);
            assert!(!raster.is_blank());
            let eraser = Brush { medium: Medium::Eraser, radius: eraser, hardness: 1.0, strength: 1.0 };
            let rows = (0..32).map(|n| f64::from(n) / 31.0);
            let path = rows.flat_map(|y| [dvec2(0.0, y), dvec2(1.0, y)]);
            let path: Vec<DVec2> = if eraser.radius < 0.1 { path.collect() } else { points.to_vec() };
            painted(&mut raster, eraser, &path);
            assert!(raster.is_blank() && raster.tile_count() == 0 && raster.bytes() == 0);
        }
    }
}

#[test]
fn a_hair_across_everything_and_a_pen_that_touches_down_take_few_tiles() {
    let grid = PixelGrid::filling(&Rect::UNIT, [2048, 2048]);
    let end = |x: f64, size| PathPoint { at: dvec2(x, 0.3), size, strength: 1.0 };
    let count = |radius, ends| {
        let segment = Segment::new(Brush { radius, ..RISK }, ends, &Rect::UNIT, &grid, 4096).unwrap();
        let depth = segment.places.iter().map(|place| place.depth).max();
        (segment.places.len(), depth.unwrap())
    };
    let (tiles, depth) = count(1e-7, [end(0.0, 1.0), end(1.0, 1.0)]);
    assert!((1000..8000).contains(&tiles) && depth > 4, "{tiles} tiles of depth {depth}");
    let (tiles, depth) = count(0.01, [end(0.5, 0.0), end(0.5, 0.0)]);
    assert!((1..5).contains(&tiles) && depth == 4, "{tiles} tiles of depth {depth}");
    let (_, narrow) = count(0.001, [end(0.5, 0.25), end(0.51, 0.25)]);
    let (_, wide) = count(0.001, [end(0.5, 1.0), end(0.51, 1.0)]);
    for ends in [[end(0.5, 0.25), end(0.51, 1.0)], [end(0.5, 1.0), end(0.51, 0.25)]] {
        assert_eq!(count(0.001, ends).1, narrow, "the narrower end decides");
    }
    assert!(narrow > wide);
    let (tiles, _) = count(0.01, [end(0.5, 0.01), end(0.6, 1.0)]);
    assert!(tiles < 4000, "{tiles}");
    let (tiles, depth) = count(1e30, [end(0.5, 1.0), end(1e200, 1.0)]);
    assert_eq!((tiles, depth), (64 * 64, 0));
    let far = Segment::new(RISK, [end(7.0, 1.0), end(1e300, 1.0)], &Rect::UNIT, &grid, 4096);
    assert!(far.is_none());
}

#[test]
fn a_long_stroke_with_a_hair_takes_a_bounded_number_of_tiles() {
    let mut raster = risks();
    let mut stroke = Stroke::new(Brush { radius: 1e-6, ..RISK }, 1.0, Rect::UNIT);
    for n in 0..200 {
        stroke.extend(&raster, dvec2(f64::from(n % 2), f64::from(n) / 200.0));
    }
    assert!(stroke.tiles < 70_000, "{} tiles", stroke.tiles);
    while stroke.advance(&mut raster, 1 << 20).is_some() {}
    // Each segment crosses x = 0.5 in the middle of its rise, and a pixel is never wider than 1/200.
    let is_painted = |y: f64| (-500..500).any(|n| raster.sample(dvec2(0.5, y + f64::from(n) * 1e-5)) > 0.0);
    for n in 1..200 {
        assert!(is_painted((f64::from(n) - 0.5) / 200.0), "segment {n}");
    }
}

#[test]
fn points_that_are_not_finite_and_brushes_for_other_rasters_change_nothing() {
    let mut raster = risks();
    assert!(painted(&mut raster, RISK, &[dvec2(f64::NAN, 0.5), dvec2(f64::INFINITY, 0.0)]).is_empty());
    painted(&mut raster, Brush { medium: FINER, ..RISK }, &[dvec2(0.5, 0.5)]);
    assert!(raster.is_blank() && raster.tile_count() == 0);
}

#[test]
fn full_strength_gives_exactly_the_target() {
    let mut random = fastrand::Rng::with_seed(73);
    for _ in 0..2000 {
        let (target, h_max) = (1e-4 + 0.1 * random.f64(), 0.2 + random.f64());
        let medium = Medium::Diameter(target, DiameterChange::Finer);
        let brush = Brush { medium, radius: 0.1, hardness: 1.0, strength: 1.0 };
        let painted = brush.painted_value(1.0, f32::INFINITY, f32::INFINITY, h_max);
        let next_below = f32::from_bits(painted.to_bits() - 1);
        assert!(f64::from(painted) >= target && f64::from(next_below) < target, "{painted} {target}");
        // A target that a pixel can have is met exactly.
        let target = f64::from(painted);
        for change in [DiameterChange::Finer, DiameterChange::Any] {
            let brush = Brush { medium: Medium::Diameter(target, change), ..brush };
            assert_eq!(brush.painted_value(1.0, f32::INFINITY, f32::INFINITY, h_max), painted, "{change:?}");
        }
    }
}

/// Errors are asked for or not: nothing between them counts half.
#[test]
fn errors_are_painted_and_erased_where_the_brush_covers_half_or_more() {
    let brush = |medium| Brush { medium, radius: 1.0, hardness: 0.5, strength: 0.8 };
    for (coverage, is_painted) in [(1.0, true), (0.7, true), (0.6, false), (0.0, false)] {
        let painted = brush(Medium::Error(0.25)).painted_value(coverage, f32::MAX, f32::MAX, 1.0);
        assert_eq!(painted, if is_painted { 0.25 } else { f32::MAX }, "{coverage}");
        let erased = brush(Medium::Eraser).painted_value(coverage, 0.25, f32::MAX, 1.0);
        assert_eq!(erased, if is_painted { f32::MAX } else { 0.25 }, "{coverage}");
    }
}
