//! The positions of the triangles of a mesh: a bounding rectangle for each group of consecutive entries.
//!
//! A mesh is refined triangle by triangle and block by block, so consecutive entries are close to each other
//! on the plane, and a small part of a picture meets few groups. The picture does not depend on the groups,
//! only the time does.

use std::ops::Range;

use rayon::prelude::*;

use meshbrush_mesh::geometry::{LatticePoint, LatticeRect};
use meshbrush_mesh::mesh::Triangle;

/// Triangles in a group.
const GROUP: usize = 64;
/// Number of groups that a thread examines at a time.
const GROUPS_PER_TASK: usize = 64;

/// The bounding rectangles of all groups, in the order of the triangles; `None` for a group outside the
/// domain.
#[derive(Debug, Default, PartialEq)]
pub(super) struct TriangleGroups {
    rects: Vec<Option<LatticeRect>>,
}

impl TriangleGroups {
    pub(super) fn new(nodes: &[LatticePoint], triangles: &[Triangle]) -> Self {
        let groups = triangles.par_chunks(GROUP).with_min_len(GROUPS_PER_TASK);
        Self { rects: groups.map(|group| rect_around(nodes, group)).collect() }
    }

    /// Follows a change of the entries in ascending ranges, and of the length of the array.
    pub(super) fn follow(
        &mut self,
        nodes: &[LatticePoint],
        triangles: &[Triangle],
        changed: &[Range<usize>],
    ) {
        let count = triangles.len().div_ceil(GROUP);
        let present = self.rects.len().min(count);
        self.rects.resize(count, None);
        let groups_of = |range: &Range<usize>| range.start / GROUP..range.end.div_ceil(GROUP).min(count);
        let mut next = 0;
        // New groups are among the changes, but the last of the former groups may have become shorter.
        let last = present.saturating_sub(1)..count;
        for groups in changed.iter().map(groups_of).chain([last]) {
            for group in groups.start.max(next)..groups.end {
                let end = triangles.len().min((group + 1) * GROUP);
                self.rects[group] = rect_around(nodes, &triangles[group * GROUP..end]);
            }
            next = next.max(groups.end);
        }
    }

    /// Returns each group that has a bounding rectangle, with that rectangle. The last group may extend
    /// beyond the end of the array.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Range<usize>, LatticeRect)> {
        let groups = self.rects.iter().enumerate();
        groups.filter_map(|(group, rect)| rect.map(|rect| (group * GROUP..(group + 1) * GROUP, rect)))
    }
}

/// Returns the bounding rectangle of the triangles in the domain, or `None` if there are none.
fn rect_around(nodes: &[LatticePoint], triangles: &[Triangle]) -> Option<LatticeRect> {
    let inside = triangles.iter().filter(|triangle| !triangle.is_outside());
    let mut points = inside.flat_map(|triangle| triangle.vertices).map(|vertex| nodes[vertex.index()]);
    let first = points.next()?;
    Some(points.fold(LatticeRect { min: first, max: first }, |LatticeRect { min, max }, p| LatticeRect {
        min: LatticePoint::new(min.x.min(p.x), min.y.min(p.y)),
        max: LatticePoint::new(max.x.max(p.x), max.y.max(p.y)),
    }))
}
