//! Edges on which the cost is smaller than inside the triangles beside them.
//!
//! A path along an edge costs what the cost density says there, which may be less than inside both triangles:
//! `if(x == 0.5, 1, 10)` on a line of the mesh. The derivative of v along the edge is that in both triangles,
//! so it suffices that the affine function of one of them is below the density on the edge. Where neither is,
//! the smaller one is lowered.
//!
//! An edge stands for the strip of all points at most `inset` from it, the part of the triangles in which
//! [`Minorant::new`] does not look.

use glam::DVec2;

use super::minorant::Minorant;
use super::quadratic::QuadraticSpace;
use crate::geometry::Rect;
use crate::path::CostDensity;

/// How often an edge is halved at most to find that a minorant is below the density on it.
const MOST_HALVINGS: u32 = 5;

/// A triangle beside an edge.
#[derive(Clone, Copy)]
struct EdgeSide {
    element: usize,
    /// The places of the ends of the edge among its corners, in an order that both triangles share.
    ends: [usize; 2],
}

/// Lowers minorants until on each edge one of those beside it is below the density.
pub(super) fn lower_at_edges(
    cost: &dyn CostDensity,
    space: &QuadraticSpace,
    minorants: &mut [Minorant],
    inset: f64,
) {
    for sides in edges(space) {
        let sides = sides.into_iter().flatten();
        let along = |side: &EdgeSide, minorants: &[Minorant]| {
            side.ends.map(|end| minorants[side.element].at_corners[end])
        };
        let sum = |side: &EdgeSide| along(side, minorants).iter().sum::<f64>();
        let Some(lower) = sides.min_by(|a, b| sum(a).total_cmp(&sum(b))) else { continue };
        let corners = space.elements[lower.element].flat.corners;
        // The neighbourhood of a node belongs to the node: no path has a length there.
        let [a, b] = lower.ends.map(|end| corners[end]);
        let cap = (b - a) * (8.0 * inset / a.distance(b)).min(0.25);
        let ends = [a + cap, b - cap];
        let factor = factor_below(cost, ends, along(&lower, minorants), inset, MOST_HALVINGS);
        if factor < 1.0 {
            minorants[lower.element].scale(factor);
        }
    }
}

/// Returns the triangles beside each edge: one or two.
fn edges(space: &QuadraticSpace) -> Vec<[Option<EdgeSide>; 2]> {
    let mut edges = vec![[None; 2]; space.values - space.nodes];
    for (element, triangle) in space.elements.iter().enumerate() {
        for opposite in 0..3 {
            let mut ends = [(opposite + 1) % 3, (opposite + 2) % 3];
            ends.sort_by_key(|&end| triangle.values[end]);
            let sides = &mut edges[triangle.values[3 + opposite] as usize - space.nodes];
            sides[usize::from(sides[0].is_some())] = Some(EdgeSide { element, ends });
        }
    }
    edges
}

/// Returns a factor, at most 1, that brings an affine function below the density in the strip around a
/// segment. It has the given values, which are positive, at the ends.
fn factor_below(
    cost: &dyn CostDensity,
    [a, b]: [DVec2; 2],
    [at_a, at_b]: [f64; 2],
    inset: f64,
    halvings: u32,
) -> f64 {
    // Twice the strip: as far as both triangles leave it out.
    let strip = Rect::spanning(a, b).expanded(2.0 * inset);
    let greatest = at_a.max(at_b);
    let range = cost.range(&strip);
    let factor = range.least / greatest;
    if factor >= 1.0 {
        return 1.0;
    }
    if let Some(slopes) = cost.derivatives(&strip) {
        // Without a jump, what holds beside the strip holds in it, up to the rise over its small width.
        let steepest: f64 = slopes.iter().map(|slope| slope.least.abs().max(slope.greatest.abs())).sum();
        let own = (at_a - at_b).abs() / a.distance(b);
        let rounded = 1.0 - 4.0 * inset * (steepest + own) / at_a.min(at_b);
        if rounded >= factor {
            return rounded;
        }
    }
    if halvings == 0 || range.least == range.greatest || factor.is_nan() {
        return factor;
    }
    let (middle, at_middle) = (a.midpoint(b), 0.5 * (at_a + at_b));
    let halves = [([a, middle], [at_a, at_middle]), ([middle, b], [at_middle, at_b])];
    halves
        .map(|(ends, values)| factor_below(cost, ends, values, inset, halvings - 1))
        .into_iter()
        .fold(1.0, f64::min)
}
