//! Coarsening: bisections are undone by the table of `bisect`, read from right to left.
//!
//! A node can go when it is the newest vertex of every triangle around it [ChenZhang2010]: two pairs of
//! siblings, or one pair at the boundary.
//!
//! ```text
//!          o                       o
//!        / | \                   /   \
//!      / a | a'\               /   a   \       a, a' and b, b' are siblings; m is their newest vertex
//!     o----m----o     =>      o---------o
//!      \ b | b'/               \   b   /
//!        \ | /                   \   /
//!          o                       o
//! ```
//!
//! # Who is whose sibling
//!
//! Call the half of a square cell that a diagonal cuts off a *half*, and the quarter that two diagonals cut
//! out a *quarter*. Let s = δ / 2ʲ. A triangle of level 2j is a half of a cell of side s with corners at
//! multiples of s, and one of level 2j + 1 is a quarter of such a cell, its newest vertex the centre. The
//! proof is by induction. The coarse triangles (j = 0) are halves. Bisecting a half gives two quarters of the
//! same cell. Bisecting a quarter, at the side of its cell, gives two triangles with legs of s/2 along the
//! axes, which are halves of cells of side s/2.
//!
//! The corners of such a half are an old corner of the large cell, the middle of the large cell's side, and
//! its centre. Measured in s/2 they have none, one and two odd coordinates: call that number their *rank*.
//! Algorithm 1 lists them in this order, as (end of the cut edge, midpoint, apex of the parent). The cut edge
//! of a half joins its first vertex to its third. Hence, with m the newest vertex:
//!
//! | level      | coordinates in        | vertices, by rank      | apex of the parent       | kept child begins with    |
//! |------------|-----------------------|------------------------|--------------------------|---------------------------|
//! | 2j + 1 ≥ 3 | δ / 2ʲ                | (0, 1, m) or (1, 2, m) | the one of rank 1        | rank 0                    |
//! | 2j + 2 ≥ 4 | δ / 2ʲ, as its parent | (end, m, apex)         | the third                | the end of the lower rank |
//!
//! The last entry of the table holds because the parent's vertices are listed in the line above: its cut
//! edge, from first to second vertex, runs from the lower rank to the higher, and the kept child has the
//! parent's first vertex. The diagonals thus join the corners whose sum of coordinates is even. In the cells
//! of the coarse grid it is the falling one, the antidiagonal: at level 1 the parent's apex lies diagonally
//! below or above m with both coordinates on the same side, and all triangles run anticlockwise, so that of
//! the two children at level 2 the kept one does, and the new one, a mirror image, does not.
//!
//! So the lattice determines the vertices of every triangle and their order: a mesh that is coarsened and
//! refined again has the same triangles as one that never was coarsened, up to their numbers.

use std::ops::Range;

use super::changes::ChangeLog;
use super::{Mesh, Neighbour, NodeId, Orientation, Triangle, TriangleId};
use crate::geometry::{Lattice, LatticePoint};

/// The two children of one parent, named as in `bisect`.
#[derive(Clone, Copy, Debug)]
pub(in crate::mesh) struct Siblings {
    kept: TriangleId,
    new: TriangleId,
}

impl Siblings {
    /// Returns the entry that the parent takes: the lower one. A coarse triangle's entry is lower than all
    /// that were appended, so that it stays with a descendant of that coarse triangle.
    fn place(&self) -> TriangleId {
        self.kept.min(self.new)
    }

    /// Returns the entry that becomes free.
    fn freed(&self) -> TriangleId {
        self.kept.max(self.new)
    }
}

/// All triangles around a node that is the newest vertex of each: those that a bisection made, if none of
/// them has been bisected since.
#[derive(Clone, Copy, Debug)]
pub(in crate::mesh) struct Star {
    centre: NodeId,
    one: Siblings,
    /// `None` where the cut edge is on the boundary.
    other: Option<Siblings>,
}

impl Star {
    pub(in crate::mesh) fn centre(&self) -> NodeId {
        self.centre
    }

    fn sides(&self) -> impl Iterator<Item = Siblings> {
        std::iter::once(self.one).chain(self.other)
    }

    /// Returns the triangles around the centre.
    pub(in crate::mesh) fn children(&self) -> impl Iterator<Item = TriangleId> {
        self.sides().flat_map(|side| [side.kept, side.new])
    }

    /// Returns the entries that the parents take.
    pub(in crate::mesh) fn places(&self) -> impl Iterator<Item = TriangleId> {
        self.sides().map(|side| side.place())
    }

    /// Returns the entries that become free, the highest first.
    pub(in crate::mesh) fn freed(&self) -> impl Iterator<Item = TriangleId> + use<> {
        let (one, other) = (self.one.freed(), self.other.map(|side| side.freed()));
        let higher = other.map_or(one, |other| one.max(other));
        std::iter::once(higher).chain(other.map(|other| one.min(other)))
    }
}

/// Returns whether `end`, an end of a triangle's bisection edge, is the apex of the parent, by the table at
/// the head of this file. The triangle has the vertices `end`, `newest` and the other end; its `level` is not
/// 0.
#[inline]
pub(super) fn is_parents_apex(
    end: LatticePoint,
    newest: LatticePoint,
    level: u32,
    lattice: &Lattice,
) -> bool {
    match level {
        1 => (end.x < newest.x) == (end.y < newest.y),
        // In units half as large as the table's: a corner has two even coordinates, the centre two odd ones.
        level if level.is_multiple_of(2) => rank(end, level, lattice) == 2,
        level => rank(end, level, lattice) == 1,
    }
}

/// Returns how many coordinates of a node are odd, in units of the cells of which the triangles of an odd
/// `level` are quarters.
#[inline]
fn rank(node: LatticePoint, level: u32, lattice: &Lattice) -> u32 {
    let cell = lattice.halvings() - level / 2;
    (node.x >> cell & 1) + (node.y >> cell & 1)
}

impl Mesh {
    /// Returns the star around the newest vertex of `id`, if it is one: `None` for a coarse triangle, and
    /// where a triangle around that node was bisected.
    #[inline]
    pub(in crate::mesh) fn star_of(&self, id: TriangleId) -> Option<Star> {
        let centre = self.triangle(id).newest_vertex()?;
        let (one, facing) = self.siblings(id)?;
        let Some(facing) = facing.triangle() else { return Some(Star { centre, one, other: None }) };
        // Across half of the cut edge: its level is the same, or it was bisected.
        if self.triangle(facing).level() != self.triangle(id).level() {
            return None;
        }
        let (other, _) = self.siblings(facing)?;
        debug_assert_eq!(self.triangle(facing).newest_vertex(), Some(centre));
        Some(Star { centre, one, other: Some(other) })
    }

    /// Returns a triangle with its sibling, and what lies across its half of the cut edge; `None` where the
    /// sibling was bisected.
    #[inline]
    fn siblings(&self, id: TriangleId) -> Option<(Siblings, Neighbour)> {
        let triangle = self.triangle(id);
        let apex = self.parents_apex(id);
        // The legs meet in the newest vertex. One ends in the apex of the parent: there lies the sibling.
        let [_, second, _] = triangle.edges();
        let (sibling, facing) = if second.0 == apex || second.1 == apex { (1, 2) } else { (2, 1) };
        let across = triangle.raw_neighbours[sibling].triangle();
        let sibling = across.expect("a triangle and its sibling cover their parent");
        if self.triangle(sibling).level() != triangle.level() {
            return None;
        }
        let siblings = if self.is_kept(id, sibling) {
            Siblings { kept: id, new: sibling }
        } else {
            Siblings { kept: sibling, new: id }
        };
        Some((siblings, triangle.raw_neighbours[facing]))
    }

    /// Returns the place of the parent's apex among the vertices of a triangle that is not coarse.
    #[inline]
    fn parents_apex(&self, id: TriangleId) -> usize {
        let triangle = self.triangle(id);
        let level = triangle.level();
        if level.is_multiple_of(2) {
            return 2;
        }
        let [first, _, newest] = triangle.vertices;
        usize::from(!is_parents_apex(self.node(first), self.node(newest), level, &self.lattice))
    }

    /// Returns whether `id` is the kept child, and not its sibling.
    #[inline]
    fn is_kept(&self, id: TriangleId, sibling: TriangleId) -> bool {
        match self.triangle(id).level() {
            level if !level.is_multiple_of(2) => self.parents_apex(id) == 1,
            2 => self.triangle(id).orientation() == Orientation::Anticlockwise,
            level => {
                let first = |id| self.node(self.triangle(id).vertices[0]);
                let rank = |id| rank(first(id), level - 1, &self.lattice);
                rank(id) < rank(sibling)
            }
        }
    }

    /// Returns the parents of a star, for [`Self::merge`] to restore.
    #[inline]
    pub(in crate::mesh) fn parents(&self, star: &Star) -> [Option<Triangle>; 2] {
        let across = |side: Siblings| Neighbour::from(side.place());
        let one = self.parent(star.one, star.other.map_or(Neighbour::BOUNDARY, across));
        [Some(one), star.other.map(|other| self.parent(other, across(star.one)))]
    }

    /// Returns the parent of two siblings: the rule at the head of `bisect`, backwards.
    #[inline]
    fn parent(&self, Siblings { kept, new }: Siblings, across: Neighbour) -> Triangle {
        let (kept, new) = (self.triangle(kept), self.triangle(new));
        let kind = kept.level_and_side().coarser();
        let [a, ..] = kept.vertices;
        let vertices = if kind.level().is_multiple_of(2) {
            [a, new.vertices[0], new.vertices[1]]
        } else {
            [a, new.vertices[0], new.vertices[2]]
        };
        // The kept child runs as its parent does.
        let mut parent = Triangle::new(vertices, [across; 3], kept.orientation(), kind);
        let (kept, new) = (kept.raw_neighbours[0], new.raw_neighbours[0]);
        parent.raw_neighbours = if parent.matched() { [across, kept, new] } else { [across, new, kept] };
        parent
    }

    /// Restores the parents of a star, which [`Self::parents`] returned.
    ///
    /// ```text
    ///          o                       o
    ///        / | \                   /   \          the parents stand in the entries `star.places()`; the entries
    ///      / a | a'\               /   a   \        `star.freed()` and the node are no longer referred to, and are
    ///     o----m----o     =>      o---------o       to be removed
    ///      \ b | b'/               \   b   /
    ///        \ | /                   \   /
    ///          o                       o
    /// ```
    pub(super) fn merge(&mut self, star: &Star, parents: &[Option<Triangle>; 2], log: &mut ChangeLog) {
        for (side, parent) in star.sides().zip(parents.iter().flatten()) {
            let (place, freed) = (side.place(), side.freed());
            if let Some(outer) = self.triangle(freed).raw_neighbours[0].triangle() {
                self.replace_neighbour(outer, freed.into(), place.into());
                log.triangle(outer);
            }
            for vertex in self.triangle(freed).vertices {
                let noted = &mut self.triangle_at[vertex.index()];
                *noted = if *noted == freed { place } else { *noted };
            }
            let children = [place, freed].map(|id| self.triangle(id).level_and_side());
            self.counts.merged(children, parent.level_and_side());
            self.triangles[place.index()] = *parent;
            log.triangle(place);
        }
        log.step();
    }

    /// Removes entries that nothing refers to any more, given as ascending ranges. The last entries take
    /// their places; `moved` is called with each (from, to).
    pub(super) fn remove_triangles(
        &mut self,
        freed: &[Range<usize>],
        log: &mut ChangeLog,
        mut moved: impl FnMut(usize, usize),
    ) {
        debug_assert!(
            freed.first().is_none_or(|range| range.start >= self.coarse_triangles()),
            "a coarse triangle's entry is never freed"
        );
        let (left, moves) = closing_moves(freed, self.triangles.len());
        for (from, to) in moves {
            let triangle = self.triangles[from];
            self.triangles[to] = triangle;
            let [last, id] = [from, to].map(TriangleId::from_index);
            for neighbour in triangle.raw_neighbours.iter().filter_map(|n| n.triangle()) {
                self.replace_neighbour(neighbour, last.into(), id.into());
                log.triangle(neighbour);
            }
            for vertex in triangle.vertices {
                let noted = &mut self.triangle_at[vertex.index()];
                *noted = if *noted == last { id } else { *noted };
            }
            log.triangle(id);
            moved(from, to);
        }
        self.triangles.truncate(left);
        log.triangles.truncate(left);
    }

    /// Removes nodes that no triangle uses any more, given as ascending ranges. The last nodes take their
    /// places.
    pub(super) fn remove_nodes(&mut self, freed: &[Range<usize>], log: &mut ChangeLog) {
        let (left, moves) = closing_moves(freed, self.nodes.len());
        for (from, to) in moves {
            let [last, id] = [from, to].map(NodeId::from_index);
            // No coarse node is ever moved, so that the triangles around it are joined by edges.
            let mut round = [None; 8];
            let found = self.raw_triangles_around(last, self.raw_triangle_at(last));
            round.iter_mut().zip(found).for_each(|(place, id)| *place = Some(id));
            for triangle in round.into_iter().flatten() {
                let vertices = &mut self.triangles[triangle.index()].vertices;
                *vertices = vertices.map(|v| if v == last { id } else { v });
                log.triangle(triangle);
            }
            self.nodes[to] = self.nodes[from];
            self.triangle_at[to] = self.triangle_at[from];
            log.node(id);
        }
        self.nodes.truncate(left);
        self.triangle_at.truncate(left);
        log.nodes.truncate(left);
    }
}

/// Returns how many entries an array keeps without those of some ascending ranges, and the moves (from, to)
/// by which its last entries fill the gaps, from both ends in ascending order.
///
/// ```text
///   0 1 2 x 4 x 6 x 8 9     three of ten are freed: 8 moves to 3, and 9 to 5
/// ```
fn closing_moves(
    freed: &[Range<usize>],
    length: usize,
) -> (usize, impl Iterator<Item = (usize, usize)> + use<'_>) {
    let left = length - freed.iter().map(ExactSizeIterator::len).sum::<usize>();
    let gaps = freed.iter().flat_map(move |range| range.start.min(left)..range.end.min(left));
    // What lies between the freed ranges behind the end.
    let starts = std::iter::once(left).chain(freed.iter().map(move |range| range.end.max(left)));
    let ends = freed.iter().map(move |range| range.start.max(left)).chain([length]);
    let last = starts.zip(ends).flat_map(|(start, end)| start..end);
    (left, last.zip(gaps))
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::Limits;
    use crate::mesh::kernel::Bitset;

    /// Returns a rectangle with a corner and a node cut out, so that diagonals and sides are on the boundary.
    fn coarse() -> Mesh {
        let removed = [DVec2::ZERO, dvec2(0.75, 0.5)];
        let bounds = Rect::new(DVec2::ZERO, dvec2(1.25, 1.0));
        Mesh::coarse_grid(
            &Lattice::covering(bounds, 0.25, 1_000_000).unwrap(),
            |p| !removed.contains(&p),
            &Limits::default(),
        )
        .unwrap()
    }

    /// Returns the last of the chain of triangles that must be bisected before `id`, or `id` itself.
    fn first_to_bisect(mesh: &Mesh, mut id: TriangleId) -> TriangleId {
        loop {
            match mesh.triangle(id).raw_neighbours[0].triangle() {
                Some(across) if mesh.triangle(across).level() < mesh.triangle(id).level() => id = across,
                _ => return id,
            }
        }
    }

    fn bisect(mesh: &mut Mesh, id: TriangleId) {
        match mesh.triangle(id).raw_neighbours[0].triangle() {
            None => mesh.bisect_at_boundary(id),
            Some(across) => mesh.bisect_pair(id, across),
        }
    }

    /// Returns the triangle to bisect next: near a place of its own for each seed, so that all levels are
    /// met, or anywhere.
    fn any_triangle(mesh: &Mesh, random: &mut fastrand::Rng, seed: usize) -> TriangleId {
        let focus = TriangleId::from_index(seed % mesh.coarse_triangles());
        let anywhere = TriangleId::from_index(random.usize(..mesh.triangles.len()));
        first_to_bisect(mesh, if random.u8(..8) > 0 { focus } else { anywhere })
    }

    #[test]
    fn the_last_entries_fill_the_gaps() {
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..300 {
            let (length, share) = (random.usize(0..200), random.f64());
            let is_freed: Vec<bool> = (0..length).map(|_| random.f64() < share).collect();
            let mut freed = Bitset::default();
            (0..length).filter(|&place| is_freed[place]).for_each(|place| _ = freed.insert(place));
            let (freed, mut array) = (freed.take_ranges(), Vec::from_iter(0..length));
            let (end, moves) = closing_moves(&freed, length);
            moves.for_each(|(from, to)| array[to] = array[from]);
            array.truncate(end);
            array.sort_unstable();
            assert!(array.into_iter().eq((0..length).filter(|&place| !is_freed[place])));
        }
    }

    #[test]
    fn a_bisection_taken_back_leaves_no_trace() {
        let deepest = coarse().lattice().deepest_level();
        let (mut levels, mut at_boundary) = ([0; 61], [0; 2]);
        for seed in 0..30 {
            let mut random = fastrand::Rng::with_seed(seed as u64);
            let mut mesh = coarse();
            for step in 0..400 {
                let count = mesh.triangles.len();
                let id = any_triangle(&mesh, &mut random, seed);
                let level = mesh.triangle(id).level();
                if level == deepest {
                    continue;
                }
                let before = mesh.clone();
                bisect(&mut mesh, id);
                levels[level as usize] += 1;
                at_boundary[level as usize % 2] += usize::from(mesh.triangles.len() == count + 1);
                let new = (count..mesh.triangles.len()).map(TriangleId::from_index);
                for child in new.chain([id]) {
                    let star = mesh.star_of(child).expect("nothing was bisected since");
                    let mut log = ChangeLog::default();
                    let mut again = mesh.clone();
                    again.merge(&star, &mesh.parents(&star), &mut log);
                    let mut freed: Vec<_> = star.freed().map(|id| id.index()..id.index() + 1).collect();
                    freed.reverse();
                    again.remove_triangles(&freed, &mut log, |_, _| ());
                    let centre = star.centre().index();
                    again.remove_nodes(std::slice::from_ref(&(centre..centre + 1)), &mut log);
                    assert_eq!(again.nodes, before.nodes);
                    assert_eq!(again.triangles, before.triangles, "child {child:?} of {id:?}, level {level}");
                    assert!(step % 50 > 0 || again.violations().is_empty());
                }
            }
        }
        assert!(levels[..deepest as usize].iter().all(|&n| n > 0), "{levels:?}");
        assert!(at_boundary.iter().all(|&n| n > 20), "{at_boundary:?}");
    }
}
