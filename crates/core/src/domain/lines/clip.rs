//! The parts of a line on the grid and beyond it.

use glam::DVec2;

use super::Line;
use crate::geometry::{Lattice, LatticePoint};

/// A part of a line.
pub(super) enum ClippedPart {
    /// On the grid: the ends on the lattice, the lower one first.
    Within { ends: [LatticePoint; 2], backwards: bool },
    /// Beyond the grid: the ends in world units.
    Beyond([DVec2; 2]),
    /// A corner that is not a finite number.
    NotFinite,
}

/// Cuts a line where it leaves the grid. Parts without length on the lattice are left out.
pub(super) fn clip(line: &Line, lattice: &Lattice) -> Vec<ClippedPart> {
    let mut parts = Vec::new();
    if line.points.iter().any(|p| !p.is_finite()) {
        parts.push(ClippedPart::NotFinite);
    }
    for [a, b] in line.edges().filter(|[a, b]| a.is_finite() && b.is_finite() && a != b) {
        // The same numbers in both directions.
        let backwards = [b.x, b.y] < [a.x, a.y];
        let [low, high] = if backwards { [b, a] } else { [a, b] };
        let mut cut = cut(low, high, lattice);
        if backwards {
            cut.reverse();
            cut.iter_mut().for_each(turn);
        }
        parts.append(&mut cut);
    }
    parts
}

/// Turns a part that [`cut`] returned.
fn turn(part: &mut ClippedPart) {
    match part {
        ClippedPart::Within { backwards, .. } => *backwards = !*backwards,
        ClippedPart::Beyond(ends) => ends.swap(0, 1),
        ClippedPart::NotFinite => {}
    }
}

fn cut(low: DVec2, high: DVec2, lattice: &Lattice) -> Vec<ClippedPart> {
    let Some([from, to]) = shares_within(low, high, lattice) else {
        return vec![ClippedPart::Beyond([low, high])];
    };
    let at = |share: f64| low + share * (high - low);
    let (first, last) = (if from > 0.0 { at(from) } else { low }, if to < 1.0 { at(to) } else { high });
    let (a, b) = (lattice.nearest(first), lattice.nearest(last));
    let mut parts = Vec::new();
    if from > 0.0 {
        parts.push(ClippedPart::Beyond([low, first]));
    }
    if a != b {
        parts.push(ClippedPart::Within { ends: [a.min(b), a.max(b)], backwards: b < a });
    }
    if to < 1.0 {
        parts.push(ClippedPart::Beyond([last, high]));
    }
    parts
}

/// Returns the part of a segment within the grid as shares of its length (Liang and Barsky). What is at most
/// half a lattice step beyond a side counts as within.
fn shares_within(low: DVec2, high: DVec2, lattice: &Lattice) -> Option<[f64; 2]> {
    let (bounds, rim) = (lattice.bounds(), 0.5 * lattice.step());
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let (start, along) = (low[axis], high[axis] - low[axis]);
        let (least, most) = (bounds.min[axis] - rim[axis], bounds.max[axis] + rim[axis]);
        if along == 0.0 {
            if start < least || start > most {
                return None;
            }
            continue;
        }
        // Within the rim an end stays where it is; beyond it, the segment ends on the side of the grid.
        let share = |side: f64| (side - start) / along;
        let (enter, leave) = if along > 0.0 { (least, most) } else { (most, least) };
        let side = |limit: f64| limit.clamp(bounds.min[axis], bounds.max[axis]);
        if (along > 0.0 && start < enter) || (along < 0.0 && start > enter) {
            from = from.max(share(side(enter)));
        }
        let end = high[axis];
        if (along > 0.0 && end > leave) || (along < 0.0 && end < leave) {
            to = to.min(share(side(leave)));
        }
    }
    (from < to && (to - from).is_finite()).then_some([from, to])
}
