//! The window's own values, and a field that its benches share.

use std::time::Duration;

use meshbrush_core::field::Formula;
use meshbrush_core::layers::LayerKind;
use meshbrush_core::paint::{Brush, Medium};

/// `FRAME_BUDGET` in `app/frame.rs`.
pub const FRAME_BUDGET: Duration = Duration::from_millis(7);
/// `SLICE` in `app/slices.rs`.
pub const SLICE: usize = 2048;
/// `MESH_SLICE` in `app/slices.rs`.
pub const MESH_SLICE: usize = 256;
/// The default brush on the unit square.
pub const BRUSH: Brush = Brush { medium: Medium::Risk(1.0), radius: 0.06, hardness: 0.35, strength: 0.8 };

/// On the unit square, a target diameter of `fine` below a wave at about `height`, and 0.2 above it: so a
/// stroke crosses fine and coarse parts.
pub fn wave(height: f64, fine: f64) -> LayerKind {
    let formula = format!("if(y < {height} + 0.1 * sin(7 * x), {fine}, 0.2)");
    LayerKind::target(Formula::parse(&formula).expect("a valid formula"))
}
