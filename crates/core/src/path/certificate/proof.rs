//! The proven bound, from the values of v alone.

use super::minorant::Minorant;
use super::quadratic::QuadraticSpace;

/// Bound of the effect of rounding on a sum, as a share of its terms.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What is proved by a function v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Proved {
    /// λ, rounded down: with it λ v is feasible.
    pub scale: f64,
    /// λ (v(goal) − v(start)), rounded down; 0 where nothing is proved.
    pub gain: f64,
}

/// Returns λ (v(goal) − v(start)) with the greatest λ for which λ v is feasible, both rounded down.
pub(super) fn proven_gain(
    space: &QuadraticSpace,
    minorants: &[Minorant],
    function: &[f64],
    gain: &[(u32, f64)],
) -> Proved {
    let terms = gain.iter().map(|&(number, weight)| weight * function[number as usize]);
    let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), term| (sum + term, size + term.abs()));
    let least = sum - ROUNDING * size;
    let scale = feasible_scale(space, minorants, function) * (1.0 - ROUNDING);
    let is_proof = least > 0.0 && scale > 0.0 && scale.is_finite();
    if is_proof { Proved { scale, gain: least * scale } } else { Proved { scale: 0.0, gain: 0.0 } }
}

/// Returns the least ℓ / |∇v| over the corners of all triangles.
///
/// The gradient of v is affine, so |∇v| is convex: with an affine ℓ the corners decide.
fn feasible_scale(space: &QuadraticSpace, minorants: &[Minorant], function: &[f64]) -> f64 {
    let mut least = f64::INFINITY;
    for (element, minorant) in space.elements.iter().zip(minorants) {
        let base = function[element.values[0] as usize];
        for corner in 0..3 {
            let frame = element.frame(corner);
            let derivative = |step| {
                let weights = element.along_edge(corner, step);
                // Relative to one of the values, which has no effect but on rounding.
                let terms = weights.map(|(number, weight)| weight * (function[number as usize] - base));
                (terms.iter().sum::<f64>(), terms.iter().map(|term| term.abs()).sum::<f64>())
            };
            let ((along, along_size), (other, other_size)) =
                (derivative(frame.step), derivative(3 - frame.step));
            let [first, second] = frame.gradient(along, other);
            let reach =
                element.flat.corners.iter().fold(0.0, |reach: f64, p| reach.max(p.abs().max_element()));
            // Corners are rounded as well: by an ulp of their coordinates.
            let rounding = ROUNDING * (1.0 + reach / frame.length);
            let size = along_size / frame.length + (other_size + along_size) / frame.across.abs();
            let steepness = libm::hypot(first, second) + rounding * size;
            least = least.min(minorant.at_corners[corner] / steepness);
        }
    }
    least
}
