//! A bounding-volume hierarchy (BVH) of rectangles: which of them meet a place, and which is nearest to a
//! point.

use std::ops::{ControlFlow, Range};

use glam::DVec2;

use super::{Rect, z_order};

/// Children of a node.
const FANOUT: usize = 8;

/// A packed bounding-volume hierarchy: items are sorted along a Z-order curve and joined in groups of eight,
/// these groups again, and so on. No links are stored.
///
/// ```text
/// level 1    |        box of all         |
/// level 0    | box | box | box | box | bo|      each over eight items
/// items       ||||| ||||| ||||| ||||| |||       along the curve
/// ```
#[doc(alias = "BVH")]
#[derive(Clone, Debug)]
pub struct BoxTree {
    /// The items along the curve.
    items: Vec<u32>,
    /// The boxes of the items.
    boxes: Vec<Rect>,
    /// For each item, its position along the curve.
    places: Vec<u32>,
    /// The boxes of the groups, from groups of items up to a single one; empty without items.
    levels: Vec<Vec<Rect>>,
}

/// A group of a [`BoxTree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoxGroup {
    /// 0 for a group of items.
    pub level: usize,
    /// The number of the box on its level.
    pub index: usize,
}

impl BoxTree {
    /// Indexes rectangles, which must be finite. An item is its number in the list.
    pub fn new(boxes: &[Rect]) -> Self {
        let Some(bounds) = boxes.iter().copied().reduce(|a, b| a.union(&b)) else {
            return Self { items: Vec::new(), boxes: Vec::new(), places: Vec::new(), levels: Vec::new() };
        };
        let key = |item: u32| z_order(boxes[item as usize].center(), &bounds);
        let mut sorted: Vec<(u32, u32)> = (0..boxes.len() as u32).map(|item| (key(item), item)).collect();
        sorted.sort_unstable();
        let items: Vec<u32> = sorted.into_iter().map(|(_, item)| item).collect();
        let mut places = vec![0; items.len()];
        for (place, &item) in items.iter().enumerate() {
            places[item as usize] = place as u32;
        }
        let boxes: Vec<Rect> = items.iter().map(|&item| boxes[item as usize]).collect();
        let mut levels: Vec<Vec<Rect>> = vec![boxes.chunks(FANOUT).filter_map(union).collect()];
        while let Some(finer) = levels.last().filter(|level| level.len() > 1) {
            levels.push(finer.chunks(FANOUT).filter_map(union).collect());
        }
        Self { items, boxes, places, levels }
    }

    /// Returns the smallest rectangle that holds all.
    pub fn bounds(&self) -> Option<Rect> {
        self.levels.last().and_then(|top| top.first()).copied()
    }

    /// Returns memory, in bytes.
    pub fn bytes(&self) -> usize {
        let groups: usize = self.levels.iter().map(|level| size_of_val(&**level)).sum();
        size_of_val(&*self.items) + size_of_val(&*self.places) + size_of_val(&*self.boxes) + groups
    }

    /// Replaces the rectangle of an item. Its group stays, so that many large changes make queries slower.
    pub fn set(&mut self, item: u32, rect: Rect) {
        let place = self.places[item as usize] as usize;
        self.boxes[place] = rect;
        for group in self.groups_of(item) {
            let members = self.members(group);
            let boxes = if group.level == 0 { &self.boxes } else { &self.levels[group.level - 1] };
            if let Some(all) = union(&boxes[members]) {
                self.levels[group.level][group.index] = all;
            }
        }
    }

    /// Returns the groups that an item is in, the smallest first.
    pub fn groups_of(&self, item: u32) -> impl Iterator<Item = BoxGroup> + use<> {
        let place = self.places[item as usize] as usize;
        let levels = self.levels.len() as u32;
        (0..levels).map(move |level| BoxGroup { level: level as usize, index: place / FANOUT.pow(level + 1) })
    }

    /// Returns the number of levels of groups.
    pub fn level_count(&self) -> usize {
        self.levels.len()
    }

    /// Returns the number of groups of a level.
    pub fn group_count(&self, level: usize) -> usize {
        self.levels[level].len()
    }

    /// Returns the members of a group: places along the curve for level 0, numbers on the level below for
    /// others.
    pub fn members(&self, group: BoxGroup) -> Range<usize> {
        let count = if group.level == 0 { self.items.len() } else { self.levels[group.level - 1].len() };
        group.index * FANOUT..count.min((group.index + 1) * FANOUT)
    }

    /// Returns the values of the members of a group, joined one after the other with `start`. `finer` has the
    /// joined values of the groups on the levels below.
    pub fn joined(
        &self,
        group: BoxGroup,
        finer: &[Vec<f64>],
        of_item: impl Fn(u32) -> f64,
        (start, join): (f64, fn(f64, f64) -> f64),
    ) -> f64 {
        let members = self.members(group);
        match group.level {
            0 => members.map(|place| of_item(self.items[place])).fold(start, join),
            level => finer[level - 1][members].iter().copied().fold(start, join),
        }
    }

    /// Returns [`Self::joined`] of every group, by level.
    pub fn all_joined(
        &self,
        of_item: impl Fn(u32) -> f64,
        (start, join): (f64, fn(f64, f64) -> f64),
    ) -> Vec<Vec<f64>> {
        let mut values = Vec::new();
        for level in 0..self.level_count() {
            let groups = (0..self.group_count(level)).map(|index| BoxGroup { level, index });
            let joined = groups.map(|group| self.joined(group, &values, &of_item, (start, join)));
            let joined = joined.collect();
            values.push(joined);
        }
        values
    }

    /// Returns the item at a place along the curve.
    pub fn item_at(&self, place: usize) -> u32 {
        self.items[place]
    }

    /// Visits all items in the groups that `enter` accepts. A group that it does not accept is left out with
    /// all its members.
    pub fn descend(
        &self,
        mut enter: impl FnMut(BoxGroup, &Rect) -> bool,
        mut visit: impl FnMut(u32, &Rect) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        match self.levels.len() {
            0 => ControlFlow::Continue(()),
            levels => self.descend_into(BoxGroup { level: levels - 1, index: 0 }, &mut enter, &mut visit),
        }
    }

    fn descend_into(
        &self,
        group: BoxGroup,
        enter: &mut impl FnMut(BoxGroup, &Rect) -> bool,
        visit: &mut impl FnMut(u32, &Rect) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if !enter(group, &self.levels[group.level][group.index]) {
            return ControlFlow::Continue(());
        }
        for member in self.members(group) {
            if group.level == 0 {
                visit(self.items[member], &self.boxes[member])?;
            } else {
                let inner = BoxGroup { level: group.level - 1, index: member };
                self.descend_into(inner, enter, visit)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Visits the items whose rectangles meet a closed rectangle, until `visit` breaks.
    pub fn visit_meeting(
        &self,
        area: &Rect,
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.descend(
            |_, bounds| meet(bounds, area),
            |item, bounds| if meet(bounds, area) { visit(item) } else { ControlFlow::Continue(()) },
        )
    }

    /// Returns the item for which `squared_distance` is least, with that. It must not be less than the
    /// squared distance from `p` to the rectangle of the item, but for rounding; ∞ leaves an item out. Of
    /// several items at the same distance, the first in the list.
    pub fn nearest(&self, p: DVec2, mut squared_distance: impl FnMut(u32) -> f64) -> Option<(u32, f64)> {
        let mut nearest = (f64::INFINITY, u32::MAX);
        if let Some(levels) = self.levels.len().checked_sub(1) {
            self.nearest_in(BoxGroup { level: levels, index: 0 }, p, &mut squared_distance, &mut nearest);
        }
        (nearest.0 < f64::INFINITY).then_some((nearest.1, nearest.0))
    }

    fn nearest_in(
        &self,
        group: BoxGroup,
        p: DVec2,
        squared_distance: &mut impl FnMut(u32) -> f64,
        nearest: &mut (f64, u32),
    ) {
        let members = self.members(group);
        if group.level == 0 {
            for place in members {
                if squared_distance_to(&self.boxes[place], p) <= nearest.0 {
                    let candidate = (squared_distance(self.items[place]), self.items[place]);
                    if candidate < *nearest {
                        *nearest = candidate;
                    }
                }
            }
            return;
        }
        // The nearest group first.
        let mut order = [(f64::INFINITY, 0); FANOUT];
        let boxes = &self.levels[group.level - 1];
        let count = members.len();
        for (entry, member) in order.iter_mut().zip(members) {
            *entry = (squared_distance_to(&boxes[member], p), member);
        }
        let order = &mut order[..count];
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &(distance, member) in &*order {
            if distance <= nearest.0 {
                let inner = BoxGroup { level: group.level - 1, index: member };
                self.nearest_in(inner, p, squared_distance, nearest);
            }
        }
    }
}

/// Returns whether two closed rectangles meet.
pub(super) fn meet(a: &Rect, b: &Rect) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

pub(super) fn union(boxes: &[Rect]) -> Option<Rect> {
    boxes.iter().copied().reduce(|a, b| a.union(&b))
}

/// Returns the squared distance from a point to a rectangle, less a margin for rounding errors.
fn squared_distance_to(rect: &Rect, p: DVec2) -> f64 {
    (p - p.clamp(rect.min, rect.max)).length_squared() * (1.0 - 1e-12)
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn boxes(random: &mut fastrand::Rng, count: usize) -> Vec<Rect> {
        let mut one = |_| {
            let min = dvec2(random.f64(), 0.2 * random.f64());
            Rect::new(min, min + 0.05 * dvec2(random.f64(), random.f64()))
        };
        (0..count).map(&mut one).collect()
    }

    fn distance(rect: &Rect, p: DVec2) -> f64 {
        let dx = (rect.min.x - p.x).max(p.x - rect.max.x).max(0.0);
        let dy = (rect.min.y - p.y).max(p.y - rect.max.y).max(0.0);
        dx * dx + dy * dy
    }

    fn assert_equals_referee(tree: &BoxTree, boxes: &[Rect], random: &mut fastrand::Rng) {
        for _ in 0..60 {
            let p = dvec2(3.0 * random.f64() - 1.0, 3.0 * random.f64() - 1.0);
            let area = Rect::new(p, p + random.f64());
            let mut found = Vec::new();
            let _ = tree.visit_meeting(&area, |item| {
                found.push(item as usize);
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            let meets = |n: &usize| boxes[*n].intersection(&area).is_some();
            assert_eq!(found, (0..boxes.len()).filter(meets).collect::<Vec<_>>());
            let nearest =
                (0..boxes.len()).min_by(|&a, &b| distance(&boxes[a], p).total_cmp(&distance(&boxes[b], p)));
            let answer = tree.nearest(p, |item| distance(&boxes[item as usize], p));
            assert_eq!(answer.map(|(item, _)| item as usize), nearest, "{p}");
        }
    }

    #[test]
    fn queries_equal_a_look_at_every_box() {
        let mut random = fastrand::Rng::with_seed(41);
        for count in [0, 1, 7, 8, 9, 64, 65, 700] {
            let mut boxes = boxes(&mut random, count);
            let mut tree = BoxTree::new(&boxes);
            assert_eq!(tree.bounds(), boxes.iter().copied().reduce(|a, b| a.union(&b)));
            assert_equals_referee(&tree, &boxes, &mut random);
            for _ in 0..count.min(50) {
                let item = random.usize(..count);
                boxes[item] = Rect::around(dvec2(2.0 * random.f64(), random.f64()), 0.1 * random.f64());
                tree.set(item as u32, boxes[item]);
            }
            assert_eq!(tree.bounds(), boxes.iter().copied().reduce(|a, b| a.union(&b)));
            assert_equals_referee(&tree, &boxes, &mut random);
        }
    }

    #[test]
    fn a_query_far_away_looks_at_few_boxes() {
        let mut random = fastrand::Rng::with_seed(42);
        let boxes = boxes(&mut random, 100_000);
        let tree = BoxTree::new(&boxes);
        let mut looks = 0;
        for _ in 0..100 {
            let p = dvec2(100.0 * random.f64() - 50.0, 100.0 * random.f64() - 50.0);
            tree.nearest(p, |item| {
                looks += 1;
                distance(&boxes[item as usize], p)
            });
        }
        assert!(looks < 100 * 400, "{looks}");
    }
}
