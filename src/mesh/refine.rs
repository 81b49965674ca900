//! Refinement until a rule holds everywhere: Algorithms 2 and 10 to 12.

use glam::DVec2;

use super::{Mesh, Triangle, TriangleId, bisection_edge_length};
use crate::geometry::{Lattice, LatticePoint};

/// What a mesh may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Most triangles; refinement that would pass it stops with an error. A triangle and its share of the nodes take
    /// 36 bytes.
    pub max_triangles: usize,
    /// Deepest level, or `None` for as deep as the lattice goes. Triangles at this level count as satisfied.
    pub max_level: Option<u32>,
}

impl Default for Limits {
    /// 50 million triangles (1.8 GB), and any level.
    fn default() -> Self {
        Self { max_triangles: 50_000_000, max_level: None }
    }
}

/// A triangle as a refinement rule sees it.
pub struct Element<'a> {
    /// The entry of the triangle array.
    pub triangle: &'a Triangle,
    /// Its vertices in lattice coordinates, in its order.
    pub corners: [LatticePoint; 3],
    /// The grid and lattice of the mesh.
    pub lattice: &'a Lattice,
    spacing: f64,
}

impl Element<'_> {
    /// Length of the bisection edge in world units (Eq. 1): what a rule compares with the target diameter.
    #[inline]
    pub fn diameter(&self) -> f64 {
        bisection_edge_length(self.spacing, self.triangle.level())
    }

    /// The vertices in world coordinates, in the triangle's order.
    #[inline]
    pub fn world_corners(&self) -> [DVec2; 3] {
        self.corners.map(|c| self.lattice.world_from_lattice(c))
    }
}

/// A rule met a target diameter that no mesh can satisfy, or that is no number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "The target diameter is {value} at x = {}, y = {}: it must be a positive number everywhere in the domain.",
    at.x, at.y
)]
pub struct InvalidTarget {
    /// Where, in world coordinates.
    pub at: DVec2,
    /// The value met there.
    pub value: f64,
}

/// Why refinement stopped before every triangle was satisfied. The mesh is conforming all the same.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RefineError {
    /// The rule met a bad target.
    #[error(transparent)]
    InvalidTarget(#[from] InvalidTarget),
    /// The next call would pass the triangle budget.
    #[error(
        "The mesh needs more than {limit} triangles, which is the limit. Raise the smallest diameter, paint less, \
         or raise the limit."
    )]
    TooManyTriangles {
        /// [`Limits::max_triangles`].
        limit: usize,
    },
    /// The target is smaller than the lattice can resolve.
    #[error(
        "The target diameter near x = {}, y = {} is too small: below {smallest:e} (level {level}) nodes would leave the \
         lattice. Raise the smallest diameter or choose a smaller coarse spacing.",
        at.x, at.y
    )]
    TooFine {
        /// A vertex of the triangle that could not be bisected, in world coordinates.
        at: DVec2,
        /// The smallest diameter that the lattice allows, in world units.
        smallest: f64,
        /// Its level.
        level: u32,
    },
}

/// Whether a sliced piece of work is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Nothing is left to do.
    Done,
    /// The allowance was used up; call again.
    More,
}

/// Refinement of a mesh in slices (Algorithm 12).
///
/// The mesh is conforming after every slice. The result does not depend on the slices or on the order of visits: the
/// report goes through the array from end to end; this goes depth first, so that what it touches is still in the cache.
///
/// The report asks about each entry of the array until it is satisfied, and never again. But compatibility may bisect it
/// later, and with the vertex rule a child can exceed its target where its parent did not: the new node may lie where
/// the target is smaller. So that Eq. (14) holds, an entry that was satisfied is asked about again when it is bisected.
#[derive(Clone, Debug)]
pub struct Refiner {
    limits: Limits,
    next: usize,
    end: usize,
    pending: Vec<TriangleId>,
    satisfied: TriangleSet,
    chain: Vec<TriangleId>,
    capped: usize,
}

/// One bit for each triangle.
#[derive(Clone, Debug, Default)]
struct TriangleSet(Vec<u64>);

impl TriangleSet {
    #[inline]
    fn insert(&mut self, id: TriangleId) {
        let word = id.index() / 64;
        if word >= self.0.len() {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= 1 << (id.index() % 64);
    }

    /// Takes `id` out, and says whether it was in.
    #[inline]
    fn remove(&mut self, id: TriangleId) -> bool {
        let Some(word) = self.0.get_mut(id.index() / 64) else { return false };
        let bit = 1 << (id.index() % 64);
        let was_in = *word & bit != 0;
        *word &= !bit;
        was_in
    }
}

impl Refiner {
    /// Work that visits every triangle of `mesh` and whatever comes of it.
    pub fn new(mesh: &Mesh, limits: Limits) -> Self {
        let end = mesh.triangles.len();
        let (pending, satisfied, chain) = (Vec::new(), TriangleSet::default(), Vec::new());
        Self { limits, next: 0, end, pending, satisfied, chain, capped: 0 }
    }

    /// Refines until done or until `visits` triangles were asked about.
    ///
    /// `exceeds` is the local refinement condition (Eq. 13): whether an element's diameter exceeds its target. It
    /// must depend on the element alone.
    ///
    /// # Errors
    /// When the rule meets a bad target, or a limit is reached.
    pub fn run(
        &mut self,
        mesh: &mut Mesh,
        mut exceeds: impl FnMut(&Element) -> Result<bool, InvalidTarget>,
        visits: usize,
    ) -> Result<Progress, RefineError> {
        let deepest = mesh.lattice.deepest_level();
        let cap = self.limits.max_level.unwrap_or(u32::MAX);
        let spacing = mesh.lattice.spacing();
        let mut visits_left = visits;
        while let Some(id) = self.next_triangle() {
            // Each turn takes `id` one level down, and levels are bounded: this ends.
            loop {
                if visits_left == 0 {
                    self.pending.push(id);
                    return Ok(Progress::More);
                }
                visits_left -= 1;
                if !exceeds(&mesh.element(id, spacing))? {
                    self.satisfied.insert(id);
                    break;
                }
                let level = mesh.triangle(id).level();
                if level >= cap {
                    self.capped += 1;
                    break;
                }
                if level >= deepest {
                    return Err(too_fine(mesh, id));
                }
                // The closure bisects at most one pair for each level above this one.
                if mesh.triangles.len() + 2 * (level as usize + 1) > self.limits.max_triangles {
                    return Err(RefineError::TooManyTriangles { limit: self.limits.max_triangles });
                }
                let first_new = mesh.triangles.len();
                let (satisfied, pending) = (&mut self.satisfied, &mut self.pending);
                mesh.refine_triangle_with(id, &mut self.chain, |bisected| {
                    if satisfied.remove(bisected) {
                        pending.push(bisected);
                    }
                });
                pending.extend((first_new..mesh.triangles.len()).map(TriangleId::from_index));
            }
        }
        Ok(Progress::Done)
    }

    /// How many triangles asked for more than [`Limits::max_level`] allows.
    pub fn capped(&self) -> usize {
        self.capped
    }

    #[inline]
    fn next_triangle(&mut self) -> Option<TriangleId> {
        self.pending.pop().or_else(|| {
            let id = TriangleId::from_index(self.next);
            self.next += 1;
            (id.index() < self.end).then_some(id)
        })
    }
}

fn too_fine(mesh: &Mesh, id: TriangleId) -> RefineError {
    let level = mesh.lattice.deepest_level();
    RefineError::TooFine { at: mesh.world_corners(id)[0], smallest: mesh.diameter(level), level }
}

impl Mesh {
    /// Refines in one go; [`Refiner`] does it in slices. Returns how many triangles the level cap left
    /// coarser than their target.
    ///
    /// # Errors
    /// As [`Refiner::run`].
    pub fn refine(
        &mut self,
        limits: &Limits,
        exceeds: impl FnMut(&Element) -> Result<bool, InvalidTarget>,
    ) -> Result<usize, RefineError> {
        let mut refiner = Refiner::new(self, *limits);
        refiner.run(self, exceeds, usize::MAX)?;
        Ok(refiner.capped())
    }

    /// Bisects one triangle, and first whatever must be bisected to keep the mesh compatible (Algorithms 10 and 11).
    ///
    /// New triangles and nodes are appended; the entry `id` becomes one of the two children.
    ///
    /// # Panics
    /// When the id is not of this mesh, or the triangle is at the deepest level of the lattice.
    #[doc(alias = "completion")]
    pub fn refine_triangle(&mut self, id: TriangleId) {
        assert!(self.triangle(id).level() < self.lattice.deepest_level(), "nodes would leave the lattice");
        self.refine_triangle_with(id, &mut Vec::new(), |_| {});
    }

    /// As [`Self::refine_triangle`], with a stack to reuse; tells of every entry that it bisects. Each entry of the chain
    /// is one level above the one before, so it ends at a coarse triangle at the latest.
    #[inline]
    fn refine_triangle_with(
        &mut self,
        id: TriangleId,
        chain: &mut Vec<TriangleId>,
        mut bisected: impl FnMut(TriangleId),
    ) {
        debug_assert!(chain.is_empty());
        let mut current = id;
        loop {
            let level = self.triangle(current).level();
            match self.triangle(current).neighbours[0].triangle() {
                None => self.bisect_at_boundary(current),
                Some(across) if self.triangle(across).level() == level => {
                    self.bisect_pair(current, across);
                    bisected(across);
                }
                Some(across) => {
                    chain.push(current);
                    current = across;
                    continue;
                }
            }
            bisected(current);
            match chain.pop() {
                Some(waiting) => current = waiting,
                None => return,
            }
        }
    }

    #[inline]
    pub(super) fn element(&self, id: TriangleId, spacing: f64) -> Element<'_> {
        Element { triangle: self.triangle(id), corners: self.corners(id), lattice: &self.lattice, spacing }
    }
}
