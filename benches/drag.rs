//! Dragging a setting: how often the mesh is replaced while a slider or a handle moves.
//!
//! Two seconds of a drag with 60 moves a second. After each move the follower works for 7 ms, as in the
//! window. The rest of a frame is not waited for. Reported are the mesh updates in the two seconds, and per
//! second.
//!
//! Three settings are dragged (the shape of the transfer curve, the smallest diameter, the coarse spacing),
//! on a mesh of 34 thousand triangles and on one of two million.

use std::time::Instant;

use meshbrush_benches::window::{FRAME_BUDGET, Slices, wave};
use meshbrush_core::document::{Document, Follower, MeshChange, Setting, Settings};
use meshbrush_core::layers::Layer;

const SECONDS: usize = 2;
const MOVES: usize = 60 * SECONDS;

/// Fine below a wave, coarse above it; the smallest diameter decides the size of the mesh.
fn document(h_min: f64) -> Document {
    let mut settings = Settings::default();
    (settings.transfer.h_min, settings.transfer.h_risk) = (h_min, h_min);
    settings.layers = Layer::default_stack(wave(0.45, 0.0001));
    Document::new(settings, None).expect("valid settings")
}

/// Drags one setting and returns how often another mesh was shown.
fn drag(document: &mut Document, follower: &mut Follower, setting: impl Fn(f64) -> Setting) -> usize {
    let (mut updates, mut slices) = (0, Slices::default());
    follower.take_change();
    for step in 1..=MOVES {
        document.set(setting(step as f64 / MOVES as f64)).expect("it can be met");
        let deadline = Instant::now() + FRAME_BUDGET;
        while Instant::now() < deadline {
            if slices
                .one(|visits| follower.advance(document, visits).expect("the budget is far").is_settled())
            {
                break;
            }
        }
        updates += usize::from(follower.take_change() == Some(MeshChange::Replaced));
    }
    document.end_gesture();
    updates
}

fn main() {
    for h_min in [0.0085, 0.0011] {
        let mut document = document(h_min);
        let mut follower = Follower::new(&mut document).expect("it has a mesh");
        eprintln!("A mesh of {} triangles", follower.mesh().triangle_count());
        let spacing = document.settings().spacing;
        let mut report = |name: &str, setting: &dyn Fn(f64) -> Setting| {
            let updates = drag(&mut document, &mut follower, setting);
            let per_second = updates as f64 / SECONDS as f64;
            eprintln!("  {name:17} {updates:4} updates, {per_second:5.1} a second");
        };
        report("transfer curve", &|t| Setting::TransferShape(1.0 + t));
        report("smallest diameter", &|t| Setting::SmallestDiameter(h_min * (1.0 + 0.1 * t)));
        report("coarse spacing", &|t| Setting::Spacing(spacing * (1.0 + 0.2 * t)));
    }
}
