//! Opens all parts of a boundary that lie somewhere, in one step.

use glam::DVec2;

use super::stretches::length;
use super::{BoundaryKind, BoundaryMarks, BoundaryPiece, BoundaryPieces, BoundaryType};
use crate::geometry::Rect;

/// Distance between two places of the boundary that are looked at, as a share of its extent.
const STEP: f64 = 5e-4;
/// Halvings of such a distance to find where a part begins.
const HALVINGS: u32 = 40;

impl BoundaryPieces {
    /// Returns the marks with which the parts of the boundary are open where `is_open` holds, but for
    /// islands; `None` where it holds nowhere. Pieces that are open already stay whole. Parts shorter than a
    /// two-thousandth of the extent of the boundary can be missed.
    pub fn opened(&self, marks: &BoundaryMarks, is_open: impl Fn(DVec2) -> bool) -> Option<BoundaryMarks> {
        let points = self.list().iter().flat_map(|piece| &piece.points);
        let extent = Rect::holding(points.copied())?;
        let step = STEP * extent.size().max_element();
        let mut opened = marks.clone();
        let (mut types, mut is_met) = (Vec::new(), false);
        for (number, piece) in self.list().iter().enumerate() {
            if piece.kind == BoundaryKind::Island {
                continue;
            }
            let parts = parts(piece, step, &is_open);
            is_met |= parts.iter().any(|part| part.is_open);
            if piece.boundary_type().is_open() {
                // It stays in one piece.
                continue;
            }
            if parts.iter().all(|part| part.is_open == parts[0].is_open) {
                if parts[0].is_open {
                    opened = self.retyped(&opened, number, Some(BoundaryType::Open));
                }
                continue;
            }
            // Each part has a type of its own, so that the place of the old one does not matter.
            opened = self.retyped(&opened, number, None);
            opened.splits.extend(
                parts.iter().map(|part| part.points[0]).filter(|&at| self.is_new_split(piece, marks, at)),
            );
            types.extend(parts.iter().filter_map(|part| {
                let of_part = if part.is_open { Some(BoundaryType::Open) } else { piece.set_type };
                Some((part.middle(), of_part?))
            }));
        }
        opened.types.extend(types);
        is_met.then_some(opened)
    }

    /// Returns whether a piece can be split at a place: not at its ends, and not where it is split already.
    fn is_new_split(&self, piece: &BoundaryPiece, marks: &BoundaryMarks, at: DVec2) -> bool {
        let ends = [piece.points[0], piece.points[piece.points.len() - 1]];
        let taken = marks.splits.iter().chain(ends.iter().filter(|_| !piece.is_closed()));
        taken.into_iter().all(|other| other.distance(at) > 2.0 * self.tolerance())
    }
}

/// A part of a piece, all of which is open, or none.
struct PiecePart {
    is_open: bool,
    points: Vec<DVec2>,
}

impl PiecePart {
    fn middle(&self) -> DVec2 {
        super::pieces::middle(&self.points)
    }
}

/// Returns the parts of a piece in their order. Where a closed piece changes, its first part begins at a
/// change.
fn parts(piece: &BoundaryPiece, step: f64, is_open: &impl Fn(DVec2) -> bool) -> Vec<PiecePart> {
    let first = piece.points[0];
    let mut parts = vec![PiecePart { is_open: is_open(first), points: vec![first] }];
    for ends in piece.points.windows(2) {
        let steps = (length(ends) / step).ceil().max(1.0) as u32;
        let share = |n: u32| f64::from(n) / f64::from(steps);
        for n in 1..=steps {
            let [from, to] = [n - 1, n].map(|n| ends[0].lerp(ends[1], share(n)));
            let part = parts.last_mut().expect("there is one");
            if is_open(to) == part.is_open {
                part.points.push(to);
                continue;
            }
            let change = change(from, to, is_open);
            part.points.push(change);
            let is_open = !part.is_open;
            parts.push(PiecePart { is_open, points: vec![change, to] });
        }
    }
    if piece.is_closed() && parts.len() > 1 && parts[0].is_open == parts[parts.len() - 1].is_open {
        let last = parts.pop().expect("there are two");
        let before = std::mem::take(&mut parts[0].points);
        parts[0].points = [last.points, before].concat();
    }
    parts
}

/// Returns the place between two points where it begins or ends to be open.
fn change(from: DVec2, to: DVec2, is_open: &impl Fn(DVec2) -> bool) -> DVec2 {
    let before = is_open(from);
    let [mut low, mut high] = [from, to];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_open(middle) == before { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
