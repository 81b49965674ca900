//! An index of rectangles of items that are already in order along a curve.

use std::ops::{ControlFlow, Range};

use super::Rect;
use super::box_tree::{meet, union};

/// Items of a run, and runs of a longer one.
const LENGTH: usize = 16;

/// The boxes of runs of 16 items, of 16 such runs, and so on. It is a bounding-volume hierarchy that gives
/// the same answers as a [`BoxTree`](super::BoxTree) in a twentieth of the memory, as it stores neither the
/// items nor their rectangles but asks for them. It is fast where items with similar numbers are close
/// together in the plane.
///
/// ```text
/// level 1    |          box of all         |
/// level 0    |  box   |  box   |  box   | b|    each over sixteen items
/// items       0 ... 15 16 .. 31 32 .. 47 48     in the order of their numbers
/// ```
#[doc(alias = "BVH")]
#[derive(Clone, Debug)]
pub struct BoxRuns {
    count: usize,
    /// From runs of items up to a single one; empty without items.
    levels: Vec<Vec<Rect>>,
}

impl BoxRuns {
    /// Indexes items, numbered from 0, by their rectangles, which must be finite.
    pub fn new(count: usize, rectangle: impl Fn(u32) -> Rect) -> Self {
        let run = |first| (first..count.min(first + LENGTH)).map(|item| rectangle(item as u32));
        let runs = (0..count).step_by(LENGTH).filter_map(|first| run(first).reduce(|a, b| a.union(&b)));
        let mut levels: Vec<Vec<Rect>> = vec![runs.collect()];
        while let Some(finer) = levels.last().filter(|level| level.len() > 1) {
            levels.push(finer.chunks(LENGTH).filter_map(union).collect());
        }
        Self { count, levels }
    }

    /// Returns the smallest rectangle that holds all.
    pub fn bounds(&self) -> Option<Rect> {
        self.levels.last().and_then(|top| top.first()).copied()
    }

    /// Visits the items whose rectangles meet a closed rectangle, in the order of their numbers, until
    /// `visit` breaks. `rectangle` returns the rectangle of an item, as it was for [`Self::new`].
    pub fn visit_meeting(
        &self,
        area: &Rect,
        rectangle: impl Fn(u32) -> Rect,
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let top = self.levels.len() - 1;
        self.descend(top, 0..self.levels[top].len(), area, &mut |item| match meet(&rectangle(item), area) {
            true => visit(item),
            false => ControlFlow::Continue(()),
        })
    }

    /// Visits the items of some runs of a level.
    fn descend(
        &self,
        level: usize,
        runs: Range<usize>,
        area: &Rect,
        visit: &mut impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for run in runs.filter(|&run| meet(&self.levels[level][run], area)) {
            let first = run * LENGTH;
            match level.checked_sub(1) {
                None => (first..self.count.min(first + LENGTH)).try_for_each(|item| visit(item as u32))?,
                Some(finer) => {
                    let inner = first..self.levels[finer].len().min(first + LENGTH);
                    self.descend(finer, inner, area, visit)?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    /// Rectangles along a line that turns, so that neighbours are close together.
    fn along_a_line(random: &mut fastrand::Rng, count: usize) -> Vec<Rect> {
        let at = |n: usize| dvec2((n % 100) as f64, (n / 100) as f64) / 100.0;
        (0..count).map(|n| Rect::around(at(n), 0.02 * random.f64())).collect()
    }

    #[test]
    fn the_items_that_meet_a_rectangle_are_those_of_a_look_at_each() {
        let mut random = fastrand::Rng::with_seed(43);
        for count in [0, 1, 15, 16, 17, 256, 257, 4097, 9000] {
            let boxes = along_a_line(&mut random, count);
            let runs = BoxRuns::new(count, |item| boxes[item as usize]);
            assert_eq!(runs.bounds(), boxes.iter().copied().reduce(|a, b| a.union(&b)));
            for _ in 0..50 {
                let corner = dvec2(1.4 * random.f64() - 0.2, 1.4 * random.f64() - 0.2);
                let area = Rect::new(corner, corner + 0.2 * dvec2(random.f64(), random.f64()));
                let expected: Vec<u32> =
                    (0..count as u32).filter(|&n| boxes[n as usize].intersection(&area).is_some()).collect();
                let most = random.usize(1..=expected.len().max(1));
                let mut found = Vec::new();
                let mut visit = |item| {
                    found.push(item);
                    if found.len() == most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
                };
                let end = runs.visit_meeting(&area, |item| boxes[item as usize], &mut visit);
                assert_eq!(found, expected[..most.min(expected.len())]);
                assert_eq!(end.is_break(), !expected.is_empty());
            }
        }
    }

    #[test]
    fn a_small_rectangle_is_found_with_few_looks() {
        let mut random = fastrand::Rng::with_seed(44);
        let boxes = along_a_line(&mut random, 10_000);
        let runs = BoxRuns::new(boxes.len(), |item| boxes[item as usize]);
        let looks = std::cell::Cell::new(0);
        for _ in 0..100 {
            let at = dvec2(random.f64(), random.f64());
            let look = |item: u32| {
                looks.set(looks.get() + 1);
                boxes[item as usize]
            };
            let _ = runs.visit_meeting(&Rect::new(at, at), look, |_| ControlFlow::Continue(()));
        }
        assert!(looks.get() < 100 * 200, "{}", looks.get());
    }
}
