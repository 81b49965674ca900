//! Refinement until a rule holds everywhere: Algorithms 2 and 10 to 12.
//!
//! ```text
//! while the work list has a triangle t:
//!     if t satisfies the rule: take it off the list
//!     else: RefineTriangle(t)                     its children take its place on the list
//!
//! RefineTriangle(t):
//!     let n be the triangle across the bisection edge of t
//!     if n is coarser than t: RefineTriangle(n)   then a child of n lies across, at the level of t
//!     bisect t and n together, or t alone at the boundary
//! ```
//!
//! RefineTriangle is the recursion of [Maubach1995] and [Kossaczky1994]. Each call goes one level up, so it
//! ends at a coarse triangle at the latest. All calls together add at most a constant times as many triangles
//! as exceed their target [BDD2004].

use super::memory::try_make_room;
use super::{
    Answer, Diameters, Element, LimitError, Limits, Mesh, NodeId, Progress, RefineError, TriangleId,
};

/// Refinement of a mesh in slices (Algorithm 12).
///
/// The mesh is conforming after every slice. The result does not depend on the slices or on the order of
/// visits: the report goes through the array from end to end; this goes from leaf to leaf of the bisection
/// tree, so that what it touches is near in space and still in the cache.
///
/// The report asks about each entry of the array until it is satisfied, and never again. But compatibility
/// may bisect it later, and with the vertex rule a child can exceed its target where its parent did not: the
/// new node may lie where the target is smaller. So that Eq. (14) holds, the children of a triangle that was
/// satisfied are asked about too.
#[derive(Clone, Debug)]
pub struct Refiner {
    limits: Limits,
    work: WorkList,
    chain: Vec<TriangleId>,
    capped: usize,
}

impl Refiner {
    /// Creates the work that visits every triangle of `mesh` and all their descendants.
    pub fn new(mesh: &Mesh, limits: Limits) -> Self {
        let mut refiner = Self { limits, work: WorkList::default(), chain: Vec::new(), capped: 0 };
        refiner.restart(mesh);
        refiner
    }

    /// Starts again, for any mesh, and reuses the memory of the previous work.
    ///
    /// Together with `clone_from` of the coarse mesh this builds a mesh again at the speed of the cache; new
    /// memory costs about as much time as the work.
    pub fn restart(&mut self, mesh: &Mesh) {
        self.restart_with(mesh, self.limits);
    }

    /// Starts again as [`Self::restart`] does, with other limits.
    pub(super) fn restart_with(&mut self, mesh: &Mesh, limits: Limits) {
        self.limits = limits;
        self.work.restart(mesh.triangles.len());
        self.capped = 0;
    }

    /// Refines until done or until `visits` triangles were asked about.
    ///
    /// `exceeds` is the local refinement condition (Eq. 13): whether an element's diameter exceeds its
    /// target. It must depend on the element alone.
    ///
    /// # Errors
    /// Fails when the rule fails, or a limit is reached.
    pub fn advance<A: Answer>(
        &mut self,
        mesh: &mut Mesh,
        mut exceeds: impl FnMut(&Element) -> A,
        visits: usize,
    ) -> Result<Progress, RefineError<A::Error>> {
        let deepest = mesh.lattice.deepest_level();
        let cap = self.limits.level_cap();
        let diameters = Diameters::of(mesh);
        // The count of triangles up to which neither memory nor the limits need a look.
        let mut room = 0;
        // Ends: each turn is done with a triangle or takes it one level down, and levels are bounded.
        for _ in 0..visits {
            let Some(id) = self.work.current() else { return Ok(Progress::Done) };
            if !exceeds(&mesh.element_with(id, &diameters)).into_result()? {
                self.work.next();
                continue;
            }
            // It exceeds its target: bisect it, unless its level forbids.
            let level = mesh.triangle(id).level();
            if level >= cap {
                self.capped += 1;
                self.work.next();
                continue;
            }
            if level >= deepest {
                return Err(RefineError::too_fine(&mesh.lattice, mesh.node(mesh.triangle(id).vertices[0])));
            }
            let most_new = Mesh::most_new_triangles(level);
            if mesh.triangles.len() + most_new > room {
                room = self.room_for(mesh, id, most_new).map_err(LimitError::with_rule)?;
            }
            mesh.refine_triangle_with(id, &mut self.chain, |_, parent| self.work.bisected(parent));
        }
        Ok(if self.work.current().is_none() { Progress::Done } else { Progress::More })
    }

    /// Makes room for the next call of RefineTriangle, which appends at most `most_new` triangles; returns
    /// how many triangles the mesh can have before this must be asked again.
    #[cold]
    fn room_for(&mut self, mesh: &mut Mesh, id: TriangleId, most_new: usize) -> Result<usize, LimitError> {
        let room = mesh.room_for(id, most_new, &self.limits)?;
        let limit = self.limits.most_triangles();
        try_make_room(&mut self.work.after, most_new, limit)?;
        Ok(room.min(self.work.after.capacity()))
    }

    /// Returns how many triangles asked for more than [`Limits::max_level`] allows.
    pub fn capped(&self) -> usize {
        self.capped
    }
}

/// The triangles still to be asked about.
///
/// They are a linked list in the order of the leaves of the bisection tree: a new triangle goes in behind its
/// sibling, which keeps their parent's place. Children of triangles that the list has passed wait on a stack.
///
/// ```text
///   passed          head
///   0   1   2   │   3 → 5 → 4 → END          bisecting 5 appends 6:   3 → 5 → 6 → 4 → END
///       ↑       │
///   bisected meanwhile: 1 and its new child go onto the stack, and are taken before 3
/// ```
#[derive(Clone, Debug, Default)]
struct WorkList {
    /// For each triangle the next one in the list, or `END`, or `PASSED`.
    after: Vec<u32>,
    /// The first triangle of the list.
    head: u32,
    /// The stack.
    reopened: Vec<u32>,
    /// The head, or an entry taken from the stack, which is on neither.
    current: u32,
}

impl WorkList {
    const END: u32 = u32::MAX;
    const PASSED: u32 = u32::MAX - 1;

    fn restart(&mut self, count: usize) {
        self.after.clear();
        self.after.extend(1..=count as u32);
        if let Some(last) = self.after.last_mut() {
            *last = Self::END;
        }
        self.head = if count == 0 { Self::END } else { 0 };
        self.reopened.clear();
        self.current = self.head;
    }

    /// Returns the triangle to ask about.
    #[inline]
    fn current(&self) -> Option<TriangleId> {
        (self.current != Self::END).then_some(TriangleId(self.current))
    }

    /// The current triangle is done; continues with the next.
    #[inline]
    fn next(&mut self) {
        let next = std::mem::replace(&mut self.after[self.current as usize], Self::PASSED);
        if next != Self::PASSED {
            self.head = next;
        }
        self.current = self.reopened.pop().unwrap_or(self.head);
    }

    /// `parent` was bisected, and its new child is the next entry of the triangle array.
    #[inline]
    fn bisected(&mut self, parent: TriangleId) {
        let new = self.after.len() as u32;
        let place = &mut self.after[parent.index()];
        let next = *place;
        if next != Self::PASSED {
            *place = new;
        } else {
            self.reopened.push(new);
            // The current triangle is asked about again in any case.
            if parent.0 != self.current {
                self.reopened.push(parent.0);
            }
        }
        self.after.push(next);
    }
}

impl Mesh {
    /// Refines in one go; [`Refiner`] does it in slices. Returns how many triangles the level cap left
    /// coarser than their target.
    ///
    /// # Errors
    /// Fails as [`Refiner::advance`] does.
    pub fn refine<A: Answer>(
        &mut self,
        limits: &Limits,
        exceeds: impl FnMut(&Element) -> A,
    ) -> Result<usize, RefineError<A::Error>> {
        let mut refiner = Refiner::new(self, *limits);
        refiner.advance(self, exceeds, usize::MAX)?;
        Ok(refiner.capped())
    }

    /// Bisects one triangle, and before it those that must be bisected to keep the mesh compatible
    /// (Algorithms 10 and 11).
    ///
    /// New triangles and nodes are appended; the entry `id` becomes one of the two children.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh, or the triangle is at the deepest level of the lattice.
    #[doc(alias = "completion")]
    pub fn refine_triangle(&mut self, id: TriangleId) {
        assert!(self.triangle(id).level() < self.lattice.deepest_level(), "nodes would leave the lattice");
        self.refine_triangle_with(id, &mut Vec::new(), |_, _| {});
    }

    /// Bisects a triangle together with the one across its bisection edge (Algorithm 8), or alone where that
    /// edge is on the boundary (Algorithm 19), and returns the new node.
    ///
    /// Returns `None`, and leaves the mesh as it is, where the triangle across is coarser: that one must be
    /// bisected before, as [`Self::refine_triangle`] does.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh, or the triangle is at the deepest level of the lattice.
    pub fn bisect_compatible(&mut self, id: TriangleId) -> Option<NodeId> {
        let level = self.triangle(id).level();
        assert!(level < self.lattice.deepest_level(), "nodes would leave the lattice");
        match self.triangle(id).raw_neighbours[0].triangle() {
            None => self.bisect_at_boundary(id),
            Some(across) if self.triangle(across).level() == level => self.bisect_pair(id, across),
            Some(_) => return None,
        }
        Some(NodeId::from_index(self.nodes.len() - 1))
    }

    /// Does the work of [`Self::refine_triangle`] with a stack to reuse. Calls `bisected` with every entry
    /// that it bisects, in the order of the new entries. Each entry of the chain is one level above the one
    /// before, so it ends at a coarse triangle at the latest.
    #[inline]
    pub fn refine_triangle_with(
        &mut self,
        id: TriangleId,
        chain: &mut Vec<TriangleId>,
        mut bisected: impl FnMut(&mut Self, TriangleId),
    ) {
        debug_assert!(chain.is_empty());
        let mut current = id;
        loop {
            let level = self.triangle(current).level();
            match self.triangle(current).raw_neighbours[0].triangle() {
                None => {
                    self.bisect_at_boundary(current);
                    bisected(self, current);
                }
                Some(across) if self.triangle(across).level() == level => {
                    self.bisect_pair(current, across);
                    bisected(self, current);
                    bisected(self, across);
                }
                Some(across) => {
                    chain.push(current);
                    current = across;
                    continue;
                }
            }
            match chain.pop() {
                Some(waiting) => current = waiting,
                None => return,
            }
        }
    }

    /// Makes room for a call of [`Self::refine_triangle`] that appends at most `most_new` triangles; returns
    /// how many triangles there can be before this must be asked again.
    ///
    /// # Errors
    /// Fails when the call would pass the triangle budget, or the system has no more memory.
    #[cold]
    pub(super) fn room_for(
        &mut self,
        id: TriangleId,
        most_new: usize,
        limits: &Limits,
    ) -> Result<usize, LimitError> {
        let (count, limit) = (self.triangles.len(), limits.most_triangles());
        // Close to the limit the call is counted exactly.
        if count + most_new > limit && count + self.closure_size(id) > limit {
            return Err(limits.passed());
        }
        Ok(self.make_room(most_new, limit)?.min(limit))
    }

    /// Returns the most triangles that [`Self::refine_triangle`] appends for one of this level: the closure
    /// bisects at most one pair at each level down to it.
    #[inline]
    pub(super) fn most_new_triangles(level: u32) -> usize {
        2 * (level as usize + 1)
    }

    /// Returns how many triangles [`Self::refine_triangle`] would append.
    fn closure_size(&self, id: TriangleId) -> usize {
        let (mut current, mut size) = (id, 0);
        // Ends: as in `refine_triangle_with`.
        loop {
            let triangle = self.triangle(current);
            match triangle.raw_neighbours[0].triangle() {
                None => return size + 1,
                Some(across) => {
                    size += 2;
                    if self.triangle(across).level() == triangle.level() {
                        return size;
                    }
                    current = across;
                }
            }
        }
    }
}
