//! Fast strokes on a mesh whose base layer is a formula: the time until the mesh matches the paint.
//!
//! The mesh is fine below a wave. A stroke above the wave adds many triangles, and one along it fewer. Below
//! it the mesh is already finer than the stroke asks for: no triangle changes, but all around the stroke are
//! looked at. The times include drawing the pixels. *undone* is the time to undo the stroke.

use std::time::{Duration, Instant};

use glam::dvec2;
use meshbrush_benches::window::{BRUSH, SLICE, Slices, wave};
use meshbrush_core::document::{Document, Follower, Settings};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::Layer;
use meshbrush_mesh::mesh::Progress;

/// How often each stroke is repeated; medians are printed.
const ROUNDS: usize = 5;
/// Height of a stroke at its left end.
const STROKES: [(&str, f64); 3] = [("above the wave", 0.8), ("along the wave", 0.5), ("below the wave", 0.2)];

/// Fine below a wave, coarse above it.
fn document(fine: f64) -> Document {
    let (transfer, layers) = (Transfer::between(0.7 * fine, 0.2), Layer::default_stack(wave(0.45, fine)));
    let settings = Settings { transfer, layers, ..Settings::default() };
    Document::new(settings, None).expect("valid settings")
}

fn paint(document: &mut Document, height: f64) {
    document.begin_stroke(BRUSH);
    for i in 0..=20 {
        let along = f64::from(i) / 20.0;
        document.extend_stroke(dvec2(0.02 + 0.96 * along, height + 0.1 * along));
    }
    document.finish_stroke();
}

/// Returns the time until the mesh is in step with the document.
fn settle(document: &mut Document, follower: &mut Follower) -> Duration {
    let start = Instant::now();
    let mut slices = Slices::default();
    loop {
        if document.advance_stroke(SLICE) == Progress::Done
            && slices
                .one(|visits| follower.advance(document, visits).expect("the budget is far").is_settled())
        {
            return start.elapsed();
        }
    }
}

fn median_ms(mut times: Vec<Duration>) -> f64 {
    times.sort();
    1e3 * times[times.len() / 2].as_secs_f64()
}

fn main() {
    for fine in [0.0025, 0.00125] {
        let mut document = document(fine);
        let mut follower = Follower::new(&mut document).expect("it has a mesh");
        eprintln!("A mesh of {} triangles", follower.mesh().triangle_count());
        for (name, height) in STROKES {
            let (mut painted, mut undone, mut triangles) = (Vec::new(), Vec::new(), 0);
            for _ in 0..ROUNDS {
                paint(&mut document, height);
                painted.push(settle(&mut document, &mut follower));
                triangles = follower.mesh().triangle_count();
                document.undo();
                undone.push(settle(&mut document, &mut follower));
            }
            let [painted, undone] = [painted, undone].map(median_ms);
            eprintln!("  {name}: {painted:6.1} ms to {triangles} triangles, undone {undone:6.1} ms");
        }
    }
}
