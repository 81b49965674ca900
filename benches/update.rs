//! A dab on meshes of ten thousand to ten million triangles, as the window follows and prices it: through
//! document, follower and pricer, in slices of the window's pace.
//!
//! *paint*, *erase*: a dab is painted and erased at the same place. *moving*: a dab is painted at the next of
//! eight places and the oldest of three is erased, so that entries are removed from the middle of the arrays
//! and others fill the gaps. *price of* either: what it would add or remove. *scratch*: a mesh made again.
//! Drawing the pixels is not counted.
//!
//! Times are medians, on one thread and on all of the machine; changes are the triangles added or removed.

use glam::{DVec2, dvec2};
use meshbrush_benches::documents::{SIDE, diameter, painted};
use meshbrush_benches::scene::Scene;
use meshbrush_benches::window::{Pool, median_ms, pools};
use meshbrush_core::document::Price;
use meshbrush_core::paint::{Brush, DiameterChange, Medium};

/// Radius of a dab in pixels, and the level that it asks for: about ten thousand triangles.
const RADIUS: f64 = 78.0;
const LEVEL: u8 = 12;
/// Centres of the dabs in pixels, in the left half.
const PLACES: [[u32; 2]; 8] =
    [[200, 200], [600, 300], [250, 700], [800, 750], [300, 1200], [750, 1100], [200, 1700], [700, 1800]];
/// Level of the right half, and the rows that it fills.
const SIZES: [(u8, u32); 5] = [(5, 2048), (9, 1500), (12, 1950), (13, 2048), (16, 1220)];
/// How often each edit is repeated.
const ROUNDS: usize = 40;

fn brush(medium: Medium) -> Brush {
    Brush { medium, radius: RADIUS / f64::from(SIDE), hardness: 1.0, strength: 1.0 }
}

/// The centre of a pixel.
fn point(pixel: [u32; 2]) -> DVec2 {
    let [x, y] = pixel.map(|v| (f64::from(v) + 0.5) / f64::from(SIDE));
    dvec2(x, y)
}

fn fine() -> Medium {
    // A little more, or a rounded pixel asks for the next level.
    Medium::Diameter(diameter(LEVEL) * (1.0 + 1e-6), DiameterChange::Finer)
}

fn report(pool: &Pool, scene: &mut Scene) {
    let count = scene.triangles();
    let at = point(PLACES[3]);
    let (mut paint, mut erase, mut prices) = (Vec::new(), Vec::new(), [Vec::new(), Vec::new()]);
    let mut change = 0;
    for _ in 0..ROUNDS {
        let painting = scene.price(brush(fine()), at);
        paint.push(scene.dab(brush(fine()), at));
        change = scene.triangles() - count;
        assert_eq!(painting.1, Price::Change(change as i64));
        let erasing = scene.price(brush(Medium::Eraser), at);
        erase.push(scene.dab(brush(Medium::Eraser), at));
        assert_eq!(erasing.1, Price::Change(-(change as i64)));
        prices[0].push(painting.0);
        prices[1].push(erasing.0);
    }
    let mut moving = Vec::new();
    for n in 0..ROUNDS {
        let (painted, erased) = (point(PLACES[n % 8]), point(PLACES[(n + 5) % 8]));
        let time = scene.dab(brush(fine()), painted) + scene.dab(brush(Medium::Eraser), erased);
        // The first rounds put dabs where the later ones erase them.
        moving.extend((n >= 8).then_some(time));
    }
    PLACES.iter().for_each(|&place| _ = scene.dab(brush(Medium::Eraser), point(place)));
    assert_eq!(scene.triangles(), count);
    let [painting, erasing] = prices.map(median_ms);
    println!(
        "{count:9} triangles, {} threads, {change} changes: paint {:.3} ms, erase {:.3}, moving {:.3}; price of painting \
         {painting:.3}, of erasing {erasing:.3}",
        pool.threads,
        median_ms(paint),
        median_ms(erase),
        median_ms(moving),
    );
}

fn main() {
    for (level, rows) in SIZES {
        let mut scene = Scene::new(painted(level, rows));
        for pool in &pools() {
            pool.run(|| report(pool, &mut scene));
        }
    }
}
