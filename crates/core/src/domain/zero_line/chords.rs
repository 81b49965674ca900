//! Divides chords of the zero line until the line is close to them.

use glam::DVec2;

use super::grid::{FormulaGrid, bisected};

/// Most points of one chord: those of a corner between curved sides are fewer.
const MOST_POINTS: usize = 512;
/// Where a chord is compared with the line, as shares of its length. The middle comes first: it divides best.
const SHARES: [f64; 3] = [0.5, 0.25, 0.75];
/// How far from the chord the line is looked for, in lengths of the chord.
const REACH: f64 = 4.0;

/// Returns the first end of a chord with the inside on its left, then places on the line between its ends, so
/// that the line is at most the tolerance beside the chords between them, where it can be followed.
pub(super) fn divided(grid: &FormulaGrid, [from, to]: [DVec2; 2]) -> Vec<DVec2> {
    let mut points = vec![from];
    // The ends of the chords that follow, the next one last.
    let mut ends = vec![to];
    while let Some(&to) = ends.last() {
        let from = points[points.len() - 1];
        let is_full = points.len() + ends.len() > MOST_POINTS;
        match place_beside(grid, [from, to]).filter(|_| !is_full) {
            Some(place) => ends.push(place),
            None => {
                points.push(to);
                ends.pop();
            }
        }
    }
    // The last end is the first one of the next chord.
    points.pop();
    points
}

/// Returns a place of the line that is more than the tolerance beside a chord, if one of those that are
/// compared is.
fn place_beside(grid: &FormulaGrid, [from, to]: [DVec2; 2]) -> Option<DVec2> {
    let (chord, tolerance) = (to - from, grid.tolerance());
    let length = chord.length();
    if length <= tolerance {
        return None;
    }
    let left = chord.perp() / length;
    SHARES.into_iter().find_map(|share| {
        let place = beside(grid, from + share * chord, left, REACH * length)?;
        let is_apart = |end: DVec2| place.distance(end) > 0.5 * tolerance;
        (is_apart(from) && is_apart(to)).then_some(place)
    })
}

/// Returns the place of the line beside a point of a chord, unless that is at most the tolerance away, or
/// farther than `reach`. `left` is the unit vector to the inside.
fn beside(grid: &FormulaGrid, at: DVec2, left: DVec2, reach: f64) -> Option<DVec2> {
    let tolerance = grid.tolerance();
    let holds = |along: f64| grid.holds(at + along * left);
    let side = match (holds(tolerance), holds(-tolerance)) {
        (true, false) => return None,
        (_, true) => -1.0,
        (false, false) => 1.0,
    };
    // Towards the outside, the line is where the inside ends; towards the inside, where it begins.
    let ends_inside = side > 0.0;
    let mut near = tolerance;
    while near < reach {
        let far = 4.0 * near;
        if holds(side * far) == ends_inside {
            let [near, far] = [near, far].map(|along| at + side * along * left);
            let ends = if ends_inside { [far, near] } else { [near, far] };
            return Some(bisected(grid, ends, halvings(far.distance(near), tolerance)));
        }
        near = far;
    }
    None
}

/// Returns how often a length is halved until it is an eighth of another one.
fn halvings(mut length: f64, other: f64) -> u32 {
    let mut count = 3;
    while length > other {
        length *= 0.5;
        count += 1;
    }
    count
}
