//! Bisection of a triangle together with its bisection neighbour: Algorithms 1, 8, 9 and 19 to 25 as one
//! rule.
//!
//! This is newest vertex bisection of compatibly divisible pairs [Mitchell1989], which for these triangles is
//! bisection of the longest edge [Rivara1984], by the vertex order of [Maubach1995].
//!
//! The report spells out eight routines, one for each way in which the level and the orientations of the two
//! parents can fall. All eight are this rule, applied to each parent by itself. With neighbours N = (across
//! the bisection edge, n₂, n₃), and *facing* for what lies across the half of the cut edge that a child
//! keeps:
//!
//! | parent        | kept child             | new child             | back-reference to move |
//! |---------------|------------------------|-----------------------|------------------------|
//! | matched       | (n₂, new, facing)      | (n₃, facing, kept)    | n₃, from kept to new   |
//! | not matched   | (n₃, facing, new)      | (n₂, kept, facing)    | n₂, from kept to new   |
//!
//! A parent is matched when k = 1 and O = 0, or k = 2 and O = 1 ([`Triangle::matched`]).
//!
//! Everything here is `#[inline(always)]`: half of the time of generation is spent here, and calls alone cost
//! 10 % of it.

use std::hint::select_unpredictable;

use super::{Mesh, Neighbour, NodeId, Triangle, TriangleId};

/// Returns the vertices of the kept and of the new child (Algorithm 1), as ids or as points.
#[inline(always)]
pub(super) fn children_vertices<V: Copy>([a, b, c]: [V; 3], midpoint: V, odd: bool) -> [[V; 3]; 2] {
    let by_level = |odd_level, even_level| select_unpredictable(odd, odd_level, even_level);
    let (second, third) = (by_level(midpoint, c), by_level(c, midpoint));
    [[a, by_level(midpoint, b), third], [b, second, third]]
}

/// The neighbours of the two children of one parent across the two halves of the cut edge.
#[derive(Clone, Copy)]
struct Facing {
    kept: Neighbour,
    new: Neighbour,
}

impl Mesh {
    /// Bisects two triangles of the same level that share their bisection edge (Algorithm 8).
    ///
    /// ```text
    ///          o                       o
    ///        /   \                   / | \          the midpoint m is a new node; first the child of `a`,
    ///      /   a   \               / a | a'\        then that of `b`, are appended to the array
    ///     o---------o     =>      o----m----o
    ///      \   b   /               \ b | b'/        (which half is kept depends on the parent's first vertex)
    ///        \   /                   \ | /
    ///          o                       o
    /// ```
    #[inline(always)]
    pub(in crate::mesh) fn bisect_pair(&mut self, a: TriangleId, b: TriangleId) {
        let midpoint = self.push_midpoint(a);
        self.counts.bisected(self.triangle(a).level_and_side());
        self.counts.bisected(self.triangle(b).level_and_side());
        let new_a = TriangleId::from_index(self.triangles.len());
        let new_b = TriangleId::from_index(self.triangles.len() + 1);
        // Parents that begin with the same vertex keep their children on the same half.
        let same_half = self.triangle(a).matched() != self.triangle(b).matched();
        let (facing_a, facing_b) = if same_half {
            (Facing { kept: b.into(), new: new_b.into() }, Facing { kept: a.into(), new: new_a.into() })
        } else {
            (Facing { kept: new_b.into(), new: b.into() }, Facing { kept: new_a.into(), new: a.into() })
        };
        self.bisect_side(a, midpoint, facing_a);
        self.bisect_side(b, midpoint, facing_b);
    }

    /// Bisects a triangle whose bisection edge is on the boundary (Algorithm 19).
    #[inline(always)]
    pub(in crate::mesh) fn bisect_at_boundary(&mut self, id: TriangleId) {
        let midpoint = self.push_midpoint(id);
        self.counts.bisected(self.triangle(id).level_and_side());
        let boundary = Neighbour::BOUNDARY;
        self.bisect_side(id, midpoint, Facing { kept: boundary, new: boundary });
    }

    #[inline(always)]
    fn push_midpoint(&mut self, id: TriangleId) -> NodeId {
        let [from, to] = self.triangle(id).bisection_edge();
        let midpoint = self.node(from).midpoint(self.node(to));
        let node = NodeId::from_index(self.nodes.len());
        self.nodes.push(midpoint);
        self.triangle_at.push(id);
        node
    }

    /// Replaces `parent` by one of its children and appends the other, by the rule at the head of this file.
    ///
    /// Which case applies is as good as random from one call to the next. So both outcomes are computed and
    /// one is selected: a wrong guess of the processor at a branch costs more than all of it.
    #[inline(always)]
    fn bisect_side(&mut self, parent: TriangleId, midpoint: NodeId, facing: Facing) {
        let t = *self.triangle(parent);
        let kept = Neighbour::from(parent);
        let new = Neighbour::from(TriangleId::from_index(self.triangles.len()));
        let [_, n2, n3] = t.raw_neighbours;
        let by_match = |yes, no| select_unpredictable(t.matched(), yes, no);
        let kept_sees = [by_match(n2, n3), by_match(new, facing.kept), by_match(facing.kept, new)];
        let new_sees = [by_match(n3, n2), by_match(facing.new, kept), by_match(kept, facing.new)];
        let moved = by_match(n3, n2);

        let odd = t.bisection_end() == 1;
        let [kept_vertices, new_vertices] = children_vertices(t.vertices, midpoint, odd);
        // Algorithm 1: at odd levels the second child is the mirror image of its parent.
        let new_orientation = if odd { t.orientation().reversed() } else { t.orientation() };
        let kind = t.level_and_side().finer();
        self.triangles[parent.index()] = Triangle::new(kept_vertices, kept_sees, t.orientation(), kind);
        self.triangles.push(Triangle::new(new_vertices, new_sees, new_orientation, kind));
        // The one node that the parent's entry loses; the new child has it.
        let [_, lost] = t.bisection_edge();
        self.triangle_at[lost.index()] = TriangleId::from_index(self.triangles.len() - 1);
        if let Some(moved) = moved.triangle() {
            self.replace_neighbour(moved, kept, new);
        }
    }

    /// Algorithm 20: `id` no longer borders on `old` but on `new`.
    #[inline(always)]
    pub(super) fn replace_neighbour(&mut self, id: TriangleId, old: Neighbour, new: Neighbour) {
        let neighbours = &mut self.triangles[id.index()].raw_neighbours;
        debug_assert!(neighbours.contains(&old), "neighbours are symmetric");
        *neighbours = neighbours.map(|n| select_unpredictable(n == old, new, n));
    }
}
