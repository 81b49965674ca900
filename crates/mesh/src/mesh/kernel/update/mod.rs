//! Updates the mesh after the rule has changed in some places: refines and coarsens it only there.
//!
//! ```text
//!   changed rectangle                            bitsets over the array of triangles
//!        │ search                                ┌──────────────┐
//!        ├─ exceeds its target ────────────────► │  exceeding   │ ─ refine ─► children keep the mark
//!        └─ every triangle found ──────────────► │  loose       │ ─ coarsen ► parents become loose
//!                                                └──────────────┘
//! ```
//!
//! # What is done
//!
//! There are three passes: *search* for the triangles that touch a changed rectangle; *refine* those that
//! exceed their target, until none does; *coarsen*: remove nodes that are no longer needed, until there are
//! none. Rectangles that touch are all searched before the mesh changes: afterwards there may be a hundred
//! times as many triangles in both. Others wait until the mesh has changed. Rectangles that are large
//! together are searched at the same time, in parts of the array, of which each is refined and coarsened
//! before the next one: the mesh begins to follow at once.
//!
//! Each pass works in batches: one thread collects triangles, all threads ask the rule about them, and one
//! thread changes the mesh.
//!
//! ```text
//!   search     collect triangles    ask: does it exceed its target?     mark
//!   refine     take marked ones     ask: does it, and those within it?  bisect, and mark the children
//!   coarsen    take marked stars    ask: does a parent exceed?          put the parents back, and mark them
//!              one thread           all threads                         one thread
//! ```
//!
//! The batches depend on the work alone and not on the number of threads, and so do the arrays.
//!
//! # Why it ends at the mesh made from scratch
//!
//! The rule must be monotone: a triangle inside a satisfied triangle is satisfied. Then the conforming
//! refinements that satisfy it have a smallest one, M*, which every other refines. The work keeps two
//! promises at all times:
//!
//! 1. A triangle that exceeds its target is marked as *exceeding*. (Some marked triangles may not.)
//! 2. A node that can be removed has a triangle around it that is marked as *loose*. A node can be removed if
//!    it is the newest vertex of all triangles around it (four, or two at the boundary) and neither parent
//!    exceeds its target.
//!
//! A change of the rule within a rectangle keeps them once it is searched: every triangle that touches the
//! rectangle is tested, and marked as loose, since a parent that touches it has a child that does. Where
//! targets only become smaller, no triangle is marked as loose; where they only become larger, none is
//! tested. Bisection keeps them: the children take over the mark of their parent, and if it had none they are
//! satisfied by monotony. Coarsening keeps them: only a restored triangle can make a node around it
//! removable, and restored triangles are marked as loose.
//!
//! Once no mark is left, all triangles are satisfied and no node can be removed. Then the mesh is M*. Suppose
//! it were finer. Take a triangle of the deepest level among those strictly inside a triangle of M*. No
//! triangle around its newest vertex was bisected, or there would be a deeper one; and the parents are inside
//! triangles of M*, so they are satisfied. So that node could be removed.
//!
//! # Why it ends, and how soon
//!
//! A triangle that exceeds its target is bisected in every mesh that satisfies the rule, and so are the
//! triangles that compatibility requires: created nodes belong to M*. Once all triangles are satisfied,
//! removed nodes do not. So as long as the rule stays the same, each node is created or removed at most once,
//! and only nodes in which the meshes before and after differ. Beyond that, the rule is called once for each
//! triangle that touches a rectangle, and a few times for each that changes. The search starts in the coarse
//! triangles that the rectangle touches and goes from neighbour to neighbour. Nothing looks at the rest of
//! the mesh.
//!
//! That holds once all rectangles are searched. Before, a node may go that the triangles of another rectangle
//! need: it is created again when that one is searched, so this is twice at most.
//!
//! Where the triangle budget is met while nodes could go, these go first: all rectangles are searched, and
//! nodes removed until none can. By the same argument the mesh is then nowhere finer than M*, and what is
//! bisected from there on belongs to M*: the budget is met again only if M* does not fit.
//!
//! # How the work survives the moves
//!
//! Coarsening fills gaps in the arrays with the last entries. What is still to be done is a set of marks on
//! places of the array, and the mark moves with its entry. The list of triangles that may exceed their
//! target, which also has what is known about those within them, is rebuilt from the marks. A search from
//! neighbour to neighbour remembers ids, and during it nothing moves. A search down the array has looked at
//! all entries from some place on: bisection appends behind it, and the last entries, which fill gaps, lie
//! behind it, or are still to be looked at.
//!
//! Triangles are taken from the end of the array: the youngest first. Those are near in space and in memory,
//! and when a place is painted and erased again, entries leave from the end and no other has to move.

mod area;
mod coarsen;
mod known;
mod questions;
mod refine;
mod scan;
mod search;

use super::changes::ChangeLog;
use super::{Bitset, Changes, Limits, Mesh, Progress, RefineError, SharedRule, TriangleId, WalkStarts};
use crate::geometry::LatticeRect;
use area::Area;
pub use area::{ChangedArea, Falloff, TargetChange};
use coarsen::Freed;
use known::KnownLevels;
use questions::{FoundEntry, LooseStar, OpenTriangle};
use search::Search;

/// Triangles of a batch, unless a slice is smaller: few enough to stay in the cache.
const BATCH: usize = 4096;

/// Brings a mesh up to date where its rule has changed, in slices.
///
/// For a mesh that satisfied a monotone rule before ([`Mesh::refine`] makes one), the result is the mesh made
/// from scratch, up to the order of its entries. The minimum of a target over the closed triangle is such a
/// rule; the report's Eq. (12), the minimum over the vertices, is not. Time and memory are proportional to
/// the triangles that touch the changed rectangles or change, and not to the mesh; all triangles are looked
/// at only where the rectangles cover an eighth of the lattice. The mesh is conforming after every slice.
///
/// ```
/// use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect, Rect};
/// use meshbrush_mesh::mesh::{Limits, Mesh, Progress, Updater};
///
/// // Level 9 wherever a triangle touches a square, level 2 elsewhere.
/// let rule = |square: LatticeRect| {
///     move || {
///         move |corners: [LatticePoint; 3], level: u32| level < if square.touches(corners) { 9 } else { 2 }
///     }
/// };
/// let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000)?;
/// let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default())?;
/// let square = |x| mesh.lattice().rect_around(&Rect::around(glam::dvec2(x, 0.4), 0.05)).unwrap();
/// let (before, after) = (square(0.3), square(0.6));
/// mesh.refine_in_blocks(&Limits::default(), &rule(before))?;
///
/// let mut updater = Updater::new(Limits::default());
/// updater.add(before);
/// updater.add(after);
/// while updater.advance(&mut mesh, &rule(after), 100)? == Progress::More {
///     assert!(mesh.violations().is_empty()); // it could be drawn
/// }
/// # let mut scratch = Mesh::coarse_grid(&lattice, |_| true, &Limits::default())?;
/// # scratch.refine_in_blocks(&Limits::default(), &rule(after))?;
/// assert_eq!(mesh.fingerprint(), scratch.fingerprint());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Updater {
    limits: Limits,
    /// Rectangles yet to be searched.
    areas: Vec<Area>,
    /// The search under way.
    search: Option<Search>,
    /// The bounding box of the rectangles that were searched since the mesh last had no marks.
    searched: Option<LatticeRect>,
    /// Triangles found by a search from neighbour to neighbour; otherwise empty, and used to sort places.
    reached: Bitset,
    /// Triangles that may exceed their target.
    exceeding: Bitset,
    /// The same as a list, unless it is empty: the last ones are asked about first.
    open: Vec<OpenTriangle>,
    /// The number of entries at the beginning of this list whose answers are those of a former rule.
    outdated: usize,
    /// What is known of the triangles in this list.
    known: KnownLevels,
    /// Triangles whose newest vertex may have become free to go.
    loose: Bitset,
    /// Whether the budget was met while nodes could go.
    is_short: bool,
    log: ChangeLog,
    /// The most triangles since memory was last given back.
    most_triangles: usize,
    /// Where searches begin to walk, as long as no entry moves.
    starts: WalkStarts,
    /// Memory that is used again, empty between calls.
    chain: Vec<TriangleId>,
    found: Vec<FoundEntry>,
    batch: Vec<OpenTriangle>,
    stars: Vec<LooseStar>,
    freed: Freed,
}

/// The pass that comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NextPass {
    Search,
    Refine,
    Coarsen,
    Nothing,
}

impl Updater {
    /// Creates an updater without work, for one mesh that nothing else changes.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            areas: Vec::new(),
            search: None,
            searched: None,
            reached: Bitset::default(),
            exceeding: Bitset::default(),
            open: Vec::new(),
            outdated: 0,
            known: KnownLevels::EMPTY,
            loose: Bitset::default(),
            is_short: false,
            log: ChangeLog::default(),
            most_triangles: 0,
            starts: WalkStarts::default(),
            chain: Vec::new(),
            found: Vec::new(),
            batch: Vec::new(),
            stars: Vec::new(),
            freed: Freed::default(),
        }
    }

    /// Sets other limits on the size of the mesh. Work that a budget has stopped may continue.
    pub fn set_limits(&mut self, limits: Limits) {
        debug_assert!(limits.max_level == self.limits.max_level, "the level cap is part of the rule");
        self.limits = limits;
    }

    /// Adds a rectangle to the work: the rule may give another answer for triangles that touch it. Must be
    /// called before the next [`Self::advance`] after such a change, and may be called while earlier work is
    /// under way.
    pub fn add(&mut self, area: LatticeRect) {
        self.add_change(area, TargetChange::Any);
    }

    /// Adds a changed rectangle in which target diameters changed in one direction only. This calls the rule
    /// about half as often as [`Self::add`].
    pub fn add_change(&mut self, area: LatticeRect, change: TargetChange) {
        self.add_area(ChangedArea { rect: area, change, falloff: None });
    }

    /// Adds a changed area, with the sizes of triangles that the change cannot affect.
    pub fn add_area(&mut self, area: ChangedArea) {
        self.push(Area { changed: area, reports_all: false });
    }

    /// Adds a changed rectangle as [`Self::add`] does, and reports all triangles that touch it as changed
    /// ([`Self::take_changes`]), because data derived from each triangle alone changed as well.
    pub fn add_and_report(&mut self, area: LatticeRect) {
        let changed = ChangedArea { rect: area, change: TargetChange::Any, falloff: None };
        self.push(Area { changed, reports_all: true });
    }

    /// Empties the list of marked triangles; the marks stay.
    fn forget(&mut self) {
        self.open.clear();
        self.outdated = 0;
        self.known.clear();
    }

    fn push(&mut self, area: Area) {
        self.outdated = self.open.len();
        self.known.clear();
        self.areas.push(area);
    }

    /// Returns whether nothing is left to do.
    pub fn is_done(&self) -> bool {
        self.next_pass() == NextPass::Nothing
    }

    /// Returns whether rectangles are left to be searched.
    fn has_areas(&self) -> bool {
        self.search.is_some() || !self.areas.is_empty()
    }

    /// Returns the place of a rectangle that touches those searched since the mesh had no marks.
    fn area_beside(&self) -> Option<usize> {
        let searched = self.searched.filter(|_| self.search.is_none())?;
        self.areas.iter().rposition(|area| area.changed.rect.meets(&searched))
    }

    fn next_pass(&self) -> NextPass {
        let is_searching = match &self.search {
            Some(Search::Flood(..)) => true,
            Some(Search::Scan(scan)) => !scan.has_part(),
            None => false,
        };
        if is_searching || (self.is_short && self.has_areas()) || self.area_beside().is_some() {
            NextPass::Search
        } else if self.is_short && self.loose.count() > 0 {
            NextPass::Coarsen
        } else if self.exceeding.count() > 0 {
            NextPass::Refine
        } else if self.loose.count() > 0 {
            NextPass::Coarsen
        } else if self.has_areas() {
            NextPass::Search
        } else {
            NextPass::Nothing
        }
    }

    /// Drops the remaining work. The mesh is conforming, but may be coarser or finer than it should be where
    /// work remained, until it is made from scratch.
    pub fn cancel(&mut self) {
        self.areas.clear();
        self.forget();
        (self.search, self.searched, self.is_short) = (None, None, false);
        for marks in [&mut self.reached, &mut self.exceeding, &mut self.loose] {
            marks.clear();
        }
    }

    /// Returns the entries of the mesh that changed since the last call, or `None` if none did.
    pub fn take_changes(&mut self) -> Option<Changes> {
        self.log.take()
    }

    /// Returns the memory taken, in bytes: a fraction of a byte for each triangle.
    pub fn bytes(&self) -> usize {
        let marks = [&self.reached, &self.exceeding, &self.loose, &self.log.triangles, &self.log.nodes];
        marks.map(Bitset::bytes).iter().sum()
    }

    /// Works until done or until `visits` triangles were looked at. A visit bisects one pair at each level at
    /// most.
    ///
    /// `rule` says whether a triangle exceeds its target, and is asked on the threads of the current pool of
    /// rayon. It must be monotone, and answer as before outside the rectangles that were added. A closure
    /// that returns a closure is enough, as for [`Mesh::refine_in_blocks`].
    ///
    /// # Errors
    /// Fails when the rule fails, or a limit is reached. The mesh is conforming and the work is kept: after a
    /// change of the rule that is added it may go on.
    pub fn advance<R: SharedRule>(
        &mut self,
        mesh: &mut Mesh,
        rule: &R,
        visits: usize,
    ) -> Result<Progress, RefineError<R::Error>> {
        // The count of triangles up to which neither memory nor the limits need a look.
        let mut room = 0;
        self.most_triangles = self.most_triangles.max(mesh.raw_triangle_count());
        let mut left = visits;
        // Ends: see the head of this file.
        while left > 0 {
            let most = left.min(BATCH);
            let looked = match self.next_pass() {
                NextPass::Search => self.search_on(mesh, rule, most).map_err(RefineError::Rule)?,
                NextPass::Refine => {
                    self.is_short = false;
                    self.refine_on(mesh, rule, &mut room, most)?
                }
                NextPass::Coarsen => self.coarsen_on(mesh, rule, most).map_err(RefineError::Rule)?,
                NextPass::Nothing => break,
            };
            left -= looked.clamp(1, left);
        }
        if !self.is_done() {
            return Ok(Progress::More);
        }
        self.forget();
        if mesh.raw_triangle_count() < self.most_triangles / 4 {
            mesh.give_memory_back();
            self.most_triangles = mesh.raw_triangle_count();
        }
        Ok(Progress::Done)
    }
}
