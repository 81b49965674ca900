//! Lines with fewer corners, by the method of Douglas and Peucker.

use glam::DVec2;

use super::nearest_on_segment;

/// How often a part of a line is divided at most. Beyond that all of its corners stay: a spiral of a million
/// corners could otherwise take a time in proportion to their square.
const MOST_DIVISIONS: u32 = 64;

/// Returns which corners of a line stay where those are left out that are at most a tolerance from the
/// straight way between two that stay. Both ends stay. `admits` is asked whether such a way, from one corner
/// to another one by their numbers, can take the place of the corners between them.
///
/// A part is divided at *all* corners that are farthest from its chord, so the same corners stay in both
/// directions.
pub fn corners_that_stay(
    line: &[DVec2],
    tolerance: f64,
    mut admits: impl FnMut([usize; 2]) -> bool,
) -> Vec<bool> {
    let mut stays = vec![true; line.len()];
    let mut parts = vec![(0, line.len().saturating_sub(1), 0)];
    while let Some((first, last, divisions)) = parts.pop() {
        if last < first + 2 || divisions == MOST_DIVISIONS {
            continue;
        }
        let chord = chord(line, first, last);
        let distance = |n: usize| line[n].distance(nearest_on_segment(line[n], chord));
        let farthest = (first + 1..last).map(distance).fold(0.0, f64::max);
        if farthest <= tolerance && admits([first, last]) {
            stays[first + 1..last].fill(false);
            continue;
        }
        let mut from = first;
        for n in (first + 1..last).filter(|&n| distance(n) == farthest) {
            parts.push((from, n, divisions + 1));
            from = n;
        }
        parts.push((from, last, divisions + 1));
    }
    stays
}

/// The ends of a chord, the lower one first: the same numbers in both directions.
fn chord(line: &[DVec2], first: usize, last: usize) -> [DVec2; 2] {
    let [a, b] = [line[first], line[last]];
    if [b.x, b.y] < [a.x, a.y] { [b, a] } else { [a, b] }
}
