//! A dab on meshes of ten thousand to ten million triangles, as the window follows and prices it: through
//! document, follower and pricer, in slices of the window's pace.
//!
//! *paint*, *erase*: a dab is painted and erased at the same place. *moving*: a dab is painted at the next of
//! eight places and the oldest of three is erased, so that entries are removed from the middle of the arrays
//! and others fill the gaps. *price of* either: what it would add or remove. *scratch*: a mesh made again.
//! Drawing the pixels is not counted.
//!
//! Times are medians, on one thread and on all of the machine; changes are the triangles added or removed.

use std::time::Duration;

use glam::{DVec2, dvec2};
use meshbrush_benches::documents::{SIDE, diameter, painted};
use meshbrush_benches::window::{Pool, Slices, median_ms, pools};
use meshbrush_core::document::{Document, Follower, Price, Pricer};
use meshbrush_core::paint::{Brush, DiameterChange, Medium, StrokePlan};
use meshbrush_mesh::mesh::Progress;

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

/// A mesh on the unit square with 512 coarse triangles.
struct Scene {
    document: Document,
    follower: Follower,
    slices: Slices,
}

impl Scene {
    fn new(level: u8, rows: u32) -> Self {
        let mut document = painted(level, rows);
        let follower = Follower::new(&mut document).expect("it has a mesh");
        Self { document, follower, slices: Slices::default() }
    }

    fn triangles(&self) -> usize {
        self.follower.mesh().raw_triangle_count()
    }

    /// Paints or erases the dab at a place, and returns the time of following it.
    fn dab(&mut self, place: [u32; 2], medium: Medium) -> Duration {
        self.document.begin_stroke(brush(medium));
        self.document.draw_to(point(place));
        self.document.end_stroke();
        self.slices.follow(&mut self.document, &mut self.follower)
    }

    /// Returns the time in which the price of a dab is known, and the price.
    fn price(&mut self, place: [u32; 2], medium: Medium) -> (Duration, Price) {
        let plan = StrokePlan::click(brush(medium), point(place));
        let mut pricer = Pricer::default();
        pricer.ask(Some(plan), &self.document, &self.follower);
        // The first slices paint the dab.
        let time = self
            .slices
            .run(|visits| pricer.advance(&self.document, &self.follower, visits) == Progress::Done);
        (time, pricer.price().expect("it is done"))
    }
}

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
    let place = PLACES[3];
    let (mut paint, mut erase, mut prices) = (Vec::new(), Vec::new(), [Vec::new(), Vec::new()]);
    let mut change = 0;
    for _ in 0..ROUNDS {
        let painting = scene.price(place, fine());
        paint.push(scene.dab(place, fine()));
        change = scene.triangles() - count;
        assert_eq!(painting.1, Price::Change(change as i64));
        let erasing = scene.price(place, Medium::Eraser);
        erase.push(scene.dab(place, Medium::Eraser));
        assert_eq!(erasing.1, Price::Change(-(change as i64)));
        prices[0].push(painting.0);
        prices[1].push(erasing.0);
    }
    let mut moving = Vec::new();
    for at in 0..ROUNDS {
        let time = scene.dab(PLACES[at % 8], fine()) + scene.dab(PLACES[(at + 5) % 8], Medium::Eraser);
        // The first rounds put dabs where the later ones erase them.
        moving.extend((at >= 8).then_some(time));
    }
    PLACES.iter().for_each(|&place| _ = scene.dab(place, Medium::Eraser));
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
        let mut scene = Scene::new(level, rows);
        for pool in &pools() {
            pool.run(|| report(pool, &mut scene));
        }
    }
}
