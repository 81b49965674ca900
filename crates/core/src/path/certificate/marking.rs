//! Which triangles to bisect, and how often.

use glam::DVec2;

use super::conic_program::ConicSolution;
use super::minorant::Minorant;
use super::quadratic::QuadraticSpace;
use super::setup::ReachableTriangles;

/// One round aims to leave at least this part of what is lost: estimates are too rough for more.
const LEAST_LEFT: f64 = 0.12;
/// One round aims at no more than this part.
const MOST_LEFT: f64 = 0.7;
/// A round multiplies the number of triangles by at most this factor, if more than [`ALWAYS`] result.
const GROWTH: f64 = 3.5;
/// A round may make this number of triangles from any number.
const ALWAYS: f64 = 8000.0;
/// How often a bisection halves what a triangle loses, and the most bisections of a triangle in one round.
const ELSEWHERE: (f64, f64) = (1.5, 3.0);
/// The values for triangles where the cost jumps: the flow goes around a bisected triangle, through the next
/// one.
const AT_A_JUMP: (f64, f64) = (1.0, 4.0);
/// Bisections of the range in which the equal loss is searched.
const SEARCH_STEPS: usize = 60;

/// Returns the loss of the bound in each triangle, in the unit of the cost, as far as it follows from the
/// flow z of the dual.
///
/// ```text
/// η = Σ |z_i| (mean c − mean ℓ)            the cost is more than its minorant
///   + least c · (Σ |z_i| − |Σ z_i|)        the path is curved
///   + least c · Σ |z_i| · h / distance     the path may take a short cut through a hole
/// ```
pub(super) fn estimates(
    space: &QuadraticSpace,
    minorants: &[Minorant],
    solution: &ConicSolution,
    kept: &ReachableTriangles,
) -> Vec<f64> {
    let distance =
        space.elements[kept.start].flat.centroid().distance(space.elements[kept.goal].flat.centroid());
    let one = |index: usize| {
        let (element, minorant, flows) = (&space.elements[index], &minorants[index], &solution.flows[index]);
        let lengths: f64 = flows.iter().map(|flow| flow.length()).sum();
        let straight = flows.iter().sum::<DVec2>().length();
        let affine = minorant.affine_mean();
        // Limited, since the cost may be infinite where next to nothing flows.
        let above = (minorant.mean - affine).clamp(0.0, 3.0 * affine);
        let diameter = element.flat.diameter();
        let short_cut = if kept.cut[index] { diameter / distance.max(diameter) } else { 0.0 };
        let lost = lengths * above + minorant.least * ((lengths - straight).max(0.0) + lengths * short_cut);
        if lost.is_finite() { lost } else { 0.0 }
    };
    (0..space.elements.len()).map(one).collect()
}

/// Returns how often to bisect each triangle so that all together lose about `goal`.
///
/// One bisection divides what a triangle on the path loses by about 2^(3/2): its part of the path is shorter
/// by √2, and an affine function misses half as much. A path is a line, so n bisections make 2^(n/2)
/// triangles on it. The number of triangles is least where all lose equally. Where the cost jumps, a
/// bisection gains less.
///
/// A goal that takes many more triangles is approached in several rounds: estimates improve from round to
/// round, and one large program costs more than several small ones. No round makes more than `most`
/// triangles, unless the goal is to keep [`MOST_LEFT`] of what is lost.
pub(super) fn bisections(estimates: &[f64], minorants: &[Minorant], goal: f64, most: usize) -> Vec<u32> {
    let all: f64 = estimates.iter().sum();
    let most = most.min((GROWTH * estimates.len() as f64).max(ALWAYS) as usize);
    let mut goal = goal.max(LEAST_LEFT * all);
    // Ends: with all that is lost as the goal, nothing is bisected.
    loop {
        let found = bisections_for(estimates, minorants, goal);
        let triangles: u64 = found.iter().map(|&more| 1 << more).sum();
        if triangles <= most as u64 || goal >= MOST_LEFT * all {
            return found;
        }
        goal = (1.2 * goal).min(MOST_LEFT * all);
    }
}

/// [`bisections`] for one goal.
fn bisections_for(estimates: &[f64], minorants: &[Minorant], goal: f64) -> Vec<u32> {
    let left = |equal: f64| -> f64 {
        let after = |one: f64| if one > equal { equal * libm::cbrt(one / equal) } else { one };
        estimates.iter().map(|&one| after(one)).sum()
    };
    let (mut low, mut high) = (0.0, estimates.iter().copied().fold(0.0, f64::max));
    for _ in 0..SEARCH_STEPS {
        let middle = 0.5 * (low + high);
        if left(middle) > goal {
            high = middle;
        } else {
            low = middle;
        }
    }
    let equal = high.max(f64::MIN_POSITIVE);
    let wanted = |(&one, minorant): (&f64, &Minorant)| {
        let (halvings, most) = if minorant.has_jump() { AT_A_JUMP } else { ELSEWHERE };
        (libm::log2(one / equal) / halvings).round().clamp(0.0, most) as u32
    };
    estimates.iter().zip(minorants).map(wanted).collect()
}
