use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec2, dvec2};

use super::*;

/// The pixels of depth 0 in the model, along both axes.
const PIXELS: Range<i32> = -64..128;
const DEEPEST: u8 = 2;

fn grid() -> PixelGrid {
    PixelGrid { origin: dvec2(-3.0, 7.0), pixel: dvec2(0.5, 0.25) }
}

/// Every pixel of the deepest depth, stored one by one.
struct Model {
    tiles: BTreeMap<TilePlace, Vec<f32>>,
    values: Vec<f32>,
}

impl Model {
    const FIRST: i32 = PIXELS.start << DEEPEST;
    const SIDE: i32 = (PIXELS.end - PIXELS.start) << DEEPEST;

    fn new(blank: f32) -> Self {
        Self { tiles: BTreeMap::new(), values: vec![blank; (Self::SIDE * Self::SIDE) as usize] }
    }

    fn index(x: i32, y: i32) -> usize {
        ((y - Self::FIRST) * Self::SIDE + x - Self::FIRST) as usize
    }

    /// Paints all tiles from the coarsest on, so that finer ones cover coarser ones.
    fn repaint(&mut self, blank: f32) {
        self.values.fill(blank);
        for (place, values) in &self.tiles {
            let width = 1 << (DEEPEST - place.depth);
            let side = 32 * width;
            for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
                let value = values[(y / width * 32 + x / width) as usize];
                self.values[Self::index(place.x * side + x, place.y * side + y)] = value;
            }
        }
    }

    /// Returns least and greatest value of a square, and whether all of it is in the model.
    fn range(&self, scale: i32, x: i32, y: i32, blank: f32) -> [f32; 2] {
        let side = 1_i64 << (scale + i32::from(DEEPEST));
        let clip = |n: i32| {
            let [first, end] = [i64::from(n) * side, (i64::from(n) + 1) * side];
            let [low, high] = [i64::from(Self::FIRST), i64::from(Self::FIRST + Self::SIDE)];
            (first.clamp(low, high) as i32..end.clamp(low, high) as i32, first < low || end > high)
        };
        let ((columns, beyond_x), (rows, beyond_y)) = (clip(x), clip(y));
        let pixels = rows.flat_map(|y| columns.clone().map(move |x| Self::index(x, y)));
        let values = pixels.map(|i| self.values[i]).chain((beyond_x || beyond_y).then_some(blank));
        values.fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
    }
}

fn random_values(random: &mut fastrand::Rng) -> Vec<f32> {
    let one = random.u8(..) as f32;
    let kind = random.u8(..4);
    (0..1024).map(|_| if kind == 0 { one } else { random.u8(..) as f32 }).collect()
}

/// Returns a place for a tile with a parent, or the place of a tile without children.
fn random_place(random: &mut fastrand::Rng, tiles: &BTreeMap<TilePlace, Vec<f32>>) -> TilePlace {
    let parents: Vec<_> = tiles.keys().filter(|place| place.depth < DEEPEST).collect();
    if parents.is_empty() || random.u8(..4) == 0 {
        return TilePlace { depth: 0, x: random.i32(-2..4), y: random.i32(-2..4) };
    }
    parents[random.usize(..parents.len())].children()[random.usize(..4)]
}

fn check(raster: &TiledRaster, model: &Model, random: &mut fastrand::Rng) {
    let blank = raster.blank();
    for n in 0..150 {
        let scale = if n == 0 { 9 } else { random.i32(-i32::from(DEEPEST) - 2..4) };
        let side = 2.0_f64.powi(-scale);
        let middle = |n: f64| ((n * 200.0 - 68.0) * side).floor() as i32;
        let (x, y) = (middle(random.f64()), middle(random.f64()));
        // Squares below the model's pixels have the value of the pixel around them.
        let below = (-i32::from(DEEPEST) - scale).max(0);
        let [least, greatest] = model.range(scale + below, x >> below, y >> below, blank);
        assert_eq!(raster.range(scale, x, y), ValueRange { least, greatest }, "{scale} {x} {y}");
        let point = grid().square(scale, x, y).center();
        let fine = (grid().pixel_from_world(point) * 4.0).floor();
        let [value, _] = model.range(-i32::from(DEEPEST), fine.x as i32, fine.y as i32, blank);
        assert_eq!(raster.sample(point), value);
    }
    for scale in 4..10 {
        for (x, y) in (-2..3).flat_map(|x| (-2..3).map(move |y| (x, y))) {
            let [least, greatest] = model.range(scale, x, y, blank);
            assert_eq!(raster.range(scale, x, y), ValueRange { least, greatest }, "{scale} {x} {y}");
        }
    }
    let all = model.values.iter().fold([blank; 2], |[a, b], &v| [a.min(v), b.max(v)]);
    assert_eq!(raster.whole_range(), ValueRange { least: all[0], greatest: all[1] });
    let listed: Vec<_> = raster.tiles().map(|(place, tile)| (place, tile.values().to_vec())).collect();
    assert_eq!(listed, model.tiles.clone().into_iter().collect::<Vec<_>>());
}

#[test]
fn ranges_samples_and_undo_agree_with_a_raster_of_single_pixels() {
    let mut random = fastrand::Rng::with_seed(12);
    for blank in [0.0, f32::INFINITY] {
        let mut raster = TiledRaster::new(grid(), blank);
        let mut model = Model::new(blank);
        let mut undo = vec![];
        for step in 0..120 {
            let place = random_place(&mut random, &model.tiles);
            let is_leaf = place.children().iter().all(|child| !model.tiles.contains_key(child));
            let values = (!is_leaf || random.u8(..4) > 0).then(|| random_values(&mut random));
            let tile = values.as_ref().map(|values| Arc::new(Tile::from_values(values).unwrap()));
            let before = raster.clone();
            undo.push((place, raster.exchange(place, tile), before));
            match values {
                Some(values) => model.tiles.insert(place, values),
                None => model.tiles.remove(&place),
            };
            if step % 8 == 0 {
                model.repaint(blank);
                check(&raster, &model, &mut random);
            }
        }
        let count = raster.tiles().map(|(place, _)| place.depth).max();
        assert_eq!(count, Some(DEEPEST));
        for (place, old, before) in undo.into_iter().rev() {
            raster.exchange(place, old);
            assert_eq!(raster, before);
            assert_eq!(raster.whole_range(), before.whole_range());
        }
        assert!(raster.is_blank() && raster.bytes() == 0 && raster.tile_count() == 0);
    }
}

#[test]
fn descending_from_the_coarsest_squares_meets_every_tile() {
    let mut raster = TiledRaster::new(grid(), 0.0);
    let far = [[-90_000, 40_000], [-89_000, 40_001], [12, -7]];
    for [x, y] in far {
        raster.exchange(TilePlace { depth: 0, x, y }, Some(Arc::new(Tile::filled(0.5))));
    }
    let mut squares = vec![];
    let coarsest = raster.coarsest();
    for (x, y) in (-2..2).flat_map(|x| (-2..2).map(move |y| (x, y))) {
        if !raster.range(coarsest, x, y).is_one() {
            squares.push([x, y]);
        }
    }
    assert!((1..=4).contains(&squares.len()), "{squares:?}");
    for scale in (5..coarsest).rev() {
        let quarters = |[x, y]: [i32; 2]| [0, 1, 2, 3].map(|n| [2 * x + (n & 1), 2 * y + (n >> 1)]);
        let below = squares.into_iter().flat_map(quarters);
        squares = below.filter(|&[x, y]| raster.range(scale, x, y).greatest > 0.0).collect();
    }
    squares.sort();
    assert_eq!(squares, far);
}

#[test]
fn a_change_of_a_clone_leaves_the_original_and_shares_the_other_tiles() {
    let mut raster = TiledRaster::new(grid(), 0.0);
    let places = [0, 1].map(|x| TilePlace { depth: 0, x, y: 0 });
    for place in places {
        raster.exchange(place, Some(Arc::new(Tile::filled(0.25))));
    }
    let mut changed = raster.clone();
    changed.change(places[0], |tile| tile.set(3, 4, 1.0));
    let at = grid().square(0, 3, 4).center();
    assert_eq!([raster.sample(at), changed.sample(at)], [0.25, 1.0]);
    assert_eq!([raster.whole_range().greatest, changed.whole_range().greatest], [0.25, 1.0]);
    assert!(raster != changed);
    assert!(Arc::ptr_eq(raster.tile(places[1]).unwrap(), changed.tile(places[1]).unwrap()));
}

#[test]
fn merging_a_redundant_tile_changes_no_value() {
    let mut raster = TiledRaster::new(grid(), 0.0);
    let parent = TilePlace { depth: 0, x: -1, y: 2 };
    let child = parent.children()[2];
    let mut random = fastrand::Rng::with_seed(1);
    raster.exchange(parent, Some(Arc::new(Tile::from_values(&random_values(&mut random)).unwrap())));
    raster.exchange(child, Some(Arc::new(raster.inherited(child))));
    raster.change(child, |tile| [0, 1].iter().for_each(|&x| tile.set(x, 0, 99.5)));
    assert!(!raster.is_redundant(child) && !raster.is_redundant(parent));
    raster.change(child, |tile| [0, 1].iter().for_each(|&x| tile.set(x, 1, 99.5)));
    assert!(raster.is_redundant(child));
    let area = child.area(&grid());
    let points: Vec<DVec2> = (0..1024)
        .map(|n| area.min + area.size() * (dvec2(f64::from(n % 32), f64::from(n / 32)) + 0.5) / 32.0)
        .collect();
    let before: Vec<f32> = points.iter().map(|&p| raster.sample(p)).collect();
    assert!(before.contains(&99.5));
    raster.merge(child);
    assert_eq!(points.iter().map(|&p| raster.sample(p)).collect::<Vec<_>>(), before);
    assert_eq!(raster.tile_count(), 1);
}

#[test]
fn the_areas_that_differ_hold_every_pixel_that_does_and_none_of_shared_tiles() {
    let place = |x| TilePlace { depth: 0, x, y: 1 };
    let mut before = TiledRaster::new(grid(), 0.0);
    (0..4).for_each(|x| _ = before.exchange(place(x), Some(Arc::new(Tile::filled(1.0)))));
    let mut after = before.clone();
    let mut values = vec![1.0; 1024];
    values[32 * 5 + 7] = 2.0;
    after.exchange(place(1), Some(Arc::new(Tile::from_values(&values).unwrap())));
    after.exchange(place(2), None);
    after.exchange(place(9), Some(Arc::new(Tile::filled(3.0))));
    for (one, other) in [(&after, &before), (&before, &after)] {
        let areas = one.areas_that_differ(other).unwrap();
        let changed = grid().origin + grid().pixel * (dvec2(32.0 + 7.0, 32.0 + 5.0) + 0.5);
        let middle = |x: f64| grid().origin + grid().pixel * 32.0 * dvec2(x + 0.5, 1.5);
        for at in [changed, middle(2.0), middle(9.0)] {
            assert!(areas.iter().any(|area| area.contains(at)), "{at} {areas:?}");
        }
        for at in [middle(0.0), middle(1.0), middle(3.0)] {
            assert!(!areas.iter().any(|area| area.contains(at)), "{at} {areas:?}");
        }
    }
    assert_eq!(after.areas_that_differ(&after.clone()), Some(Vec::new()));
    assert_eq!(after.areas_that_differ(&TiledRaster::new(grid(), 1.0)), None);
}

#[test]
fn tiles_without_a_parent_or_beyond_the_limits_are_refused() {
    let tile = || Arc::new(Tile::filled(1.0));
    let read = |places: &[TilePlace]| {
        TiledRaster::from_tiles(grid(), 0.0, places.iter().map(|&place| (place, tile()))).map(|_| ())
    };
    let parent = TilePlace { depth: 0, x: 3, y: -4 };
    let child = TilePlace { depth: 1, x: 7, y: -8 };
    assert_eq!(read(&[parent, child]), Ok(()));
    assert_eq!(read(&[child, parent]), Err(child));
    let far = TilePlace { x: TilePlace::FARTHEST + 1, ..parent };
    assert_eq!(read(&[parent, far]), Err(far));
}

/// Squares that no number of 32 bits counts lie beyond all tiles.
#[test]
fn squares_however_far_away_are_blank() {
    let mut raster = TiledRaster::new(grid(), 0.5);
    raster.exchange(TilePlace { depth: 0, x: 0, y: 0 }, Some(Arc::new(Tile::filled(2.0))));
    for far in [1_i64 << 31, 1 << 40, -(1 << 33), i64::MAX / 2] {
        for scale in [-8, -1, 0, 3] {
            for at in [[far, 0], [0, far], [far, -far]] {
                let range = raster.range_anywhere(scale, at);
                assert_eq!((range.least, range.greatest), (0.5, 0.5), "{scale} {at:?}");
            }
        }
    }
    assert_eq!(raster.range_anywhere(0, [3, 4]).least, 2.0);
}

/// Run by hand, in release: `cargo test --release … nanoseconds_per_range -- --ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn nanoseconds_per_range() {
    let grid = PixelGrid { origin: DVec2::ZERO, pixel: DVec2::splat(1.0 / 2048.0) };
    let mut raster = TiledRaster::new(grid, 0.0);
    let mut random = fastrand::Rng::with_seed(5);
    for (y, x) in (0..64).flat_map(|y| (0..64).map(move |x| (y, x))) {
        let values: Vec<f32> = (0..1024).map(|_| random.f32()).collect();
        raster.exchange(TilePlace { depth: 0, x, y }, Some(Arc::new(Tile::from_values(&values).unwrap())));
    }
    for depth in 1..=12 {
        let place = TilePlace { depth, x: 5 << depth, y: 6 << depth };
        raster.exchange(place, Some(Arc::new(raster.inherited(place))));
    }
    for (name, scale, side) in [
        ("coarse squares", 4, 128),
        ("pixels", 0, 2048),
        ("eighths of pixels, no deeper tile there", -3, 2048 * 8),
        ("pixels / 4096, no deeper tile there", -12, 2048 * 4096),
    ] {
        let count = 20_000_000;
        let start = std::time::Instant::now();
        let (mut x, mut y, mut sum) = (side / 2, side / 2, 0.0);
        for n in 0_i32..count {
            // Neighbours, in the order of a mesher; every 64 calls another position.
            (x, y) = if n % 64 == 0 {
                (random.i32(..side), random.i32(..side))
            } else {
                (x ^ (n & 3), y ^ (n >> 2 & 3))
            };
            sum += raster.range(scale, x, y).least;
        }
        eprintln!("{name}: {:.1} ns ({sum})", start.elapsed().as_nanos() as f64 / f64::from(count));
    }
}
