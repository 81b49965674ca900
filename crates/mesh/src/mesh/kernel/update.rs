//! Updates the mesh after the rule has changed in some places: refines and coarsens it only there.
//!
//! ```text
//!   changed rectangle                            bitsets over the array of triangles
//!        │ search                                ┌──────────────┐
//!        ├─ exceeds its target ────────────────► │  exceeding   │ ─ refine ─► children keep the mark
//!        └─ every triangle found ──────────────► │  loose       │ ─ coarsen ► parents become loose
//!                                                └──────────────┘
//!   order: search first, then refine while anything exceeds, then coarsen; done when both are empty
//! ```
//!
//! # What is done
//!
//! Three kinds of work, always in this order: *search* for the triangles that touch a changed rectangle;
//! *refine* those that exceed their target, until none does; *coarsen*: remove nodes that are no longer
//! needed, until there is none.
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
//! Where the triangle budget is met while nodes could go, these go first, until none can. By the same
//! argument the mesh is then nowhere finer than M*, and what is bisected from there on belongs to M*: the
//! budget is met again only if M* does not fit.
//!
//! # How the work survives the moves
//!
//! Coarsening fills a gap in the arrays with the last entry. What is still to be done is a set of marks on
//! places of the array, and the mark moves with its entry. The search alone remembers ids, and during it
//! nothing moves.
//!
//! Triangles are taken from the end of the array: the youngest first. Those are near in space and in memory,
//! and when a place is painted and erased again, entries leave from the end and no other has to move.

use glam::DVec2;

use super::changes::ChangeLog;
use super::coarsen::Star;
use super::{
    Answer, Bitset, Changes, Diameters, Element, LimitError, Limits, Mesh, Progress, RectSearch, RefineError,
    Triangle, TriangleId,
};
use crate::geometry::{LatticePoint, LatticeRect};

/// Brings a mesh up to date where its rule has changed, in slices.
///
/// For a mesh that satisfied a monotone rule before ([`Mesh::refine`] makes one), the result is the mesh made
/// from scratch, up to the order of its entries. The minimum of a target over the closed triangle is such a
/// rule; the report's Eq. (12), the minimum over the vertices, is not. Time and memory go with the triangles
/// that touch the changed rectangles, and those that change, and not with the mesh. The mesh is conforming
/// after every slice.
///
/// ```
/// use meshbrush_mesh::geometry::{Lattice, LatticeRect, Rect};
/// use meshbrush_mesh::mesh::{Element, Limits, Mesh, Progress, Updater};
///
/// // Level 9 wherever a triangle touches a square, level 2 elsewhere.
/// let exceeds = |element: &Element, square: &LatticeRect| {
///     element.triangle.level() < if square.touches(element.corners) { 9 } else { 2 }
/// };
/// let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000)?;
/// let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default())?;
/// let square = |x| mesh.lattice().rect_around(&Rect::around(glam::dvec2(x, 0.4), 0.05)).unwrap();
/// let (before, after) = (square(0.3), square(0.6));
/// mesh.refine(&Limits::default(), |element| exceeds(element, &before))?;
///
/// let mut updater = Updater::new(Limits::default());
/// updater.add(before);
/// updater.add(after);
/// while updater.advance(&mut mesh, |element| exceeds(element, &after), 100)? == Progress::More {
///     assert!(mesh.violations().is_empty()); // it could be drawn
/// }
/// # let mut scratch = Mesh::coarse_grid(&lattice, |_| true, &Limits::default())?;
/// # scratch.refine(&Limits::default(), |element| exceeds(element, &after))?;
/// assert_eq!(mesh.fingerprint(), scratch.fingerprint());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Updater {
    limits: Limits,
    /// Rectangles yet to be searched.
    areas: Vec<Area>,
    /// The search under way, and what it is for.
    search: Option<(RectSearch, Area)>,
    /// Triangles found by the search under way; otherwise empty.
    reached: Bitset,
    /// Triangles that may exceed their target.
    exceeding: Bitset,
    /// Triangles whose newest vertex may have become free to go.
    loose: Bitset,
    chain: Vec<TriangleId>,
    log: ChangeLog,
    /// The most triangles since memory was last given back.
    most_triangles: usize,
}

impl Updater {
    /// Creates an updater without work, for one mesh that nothing else changes.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            areas: Vec::new(),
            search: None,
            reached: Bitset::default(),
            exceeding: Bitset::default(),
            loose: Bitset::default(),
            chain: Vec::new(),
            log: ChangeLog::default(),
            most_triangles: 0,
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
        self.areas.push(Area { area, reports_all: false });
    }

    /// Adds a changed rectangle as [`Self::add`] does, and reports all triangles that touch it as changed
    /// ([`Self::take_changes`]), because data derived from each triangle alone changed as well.
    pub fn add_and_report(&mut self, area: LatticeRect) {
        let area = ChangedArea { rect: area, change: TargetChange::Any, falloff: None };
        self.areas.push(Area { area, reports_all: true });
    }

    /// Returns whether nothing is left to do.
    pub fn is_done(&self) -> bool {
        self.areas.is_empty()
            && self.search.is_none()
            && self.exceeding.count() == 0
            && self.loose.count() == 0
    }

    /// Drops the remaining work. The mesh is conforming, but may be coarser or finer than it should be where
    /// work remained, until it is made from scratch.
    pub fn cancel(&mut self) {
        self.areas.clear();
        self.search = None;
        for marks in [&mut self.reached, &mut self.exceeding, &mut self.loose] {
            marks.clear();
        }
    }

    /// Returns the entries of the mesh that changed since the last call, or `None` if none did.
    pub fn take_changes(&mut self) -> Option<Changes> {
        self.log.take()
    }

    /// Returns how often the mesh was changed so far. When this grows, the picture is out of date.
    pub fn steps(&self) -> u64 {
        self.log.steps()
    }

    /// Returns the memory taken, in bytes: a fraction of a byte for each triangle.
    pub fn bytes(&self) -> usize {
        let marks = [&self.reached, &self.exceeding, &self.loose, &self.log.triangles, &self.log.nodes];
        marks.map(Bitset::bytes).iter().sum()
    }

    /// Works until done or until `visits` triangles were looked at. A visit bisects one pair at each level at
    /// most.
    ///
    /// `exceeds` returns whether an element's diameter exceeds its target. It must depend on the element
    /// alone, be monotone, and answer as before outside the rectangles that were added. A parent that
    /// coarsening could restore is not an entry of the array; `exceeds` gets it with the nodes and neighbours
    /// that it would have.
    ///
    /// # Errors
    /// Fails when the rule fails, or a limit is reached. The mesh is conforming and the work is kept: after a
    /// change of the rule that is added it may go on.
    pub fn advance<A: Answer>(
        &mut self,
        mesh: &mut Mesh,
        mut exceeds: impl FnMut(&Element) -> A,
        visits: usize,
    ) -> Result<Progress, RefineError<A::Error>> {
        let diameters = Diameters::of(mesh);
        let cap = self.limits.level_cap();
        let mut exceeds = |element: &Element| -> Result<bool, A::Error> {
            Ok(element.triangle.level() < cap && exceeds(element).into_result()?)
        };
        // The count of triangles up to which neither memory nor the limits need a look.
        let mut room = 0;
        self.most_triangles = self.most_triangles.max(mesh.raw_triangle_count());
        // Ends: see the head of this file.
        for _ in 0..visits {
            if self.search.is_some() || !self.areas.is_empty() {
                self.search_on(mesh, &diameters, &mut exceeds)?;
            } else if let Some(id) = self.exceeding.last() {
                let id = TriangleId::from_index(id);
                if !exceeds(&mesh.element_with(id, &diameters))? {
                    self.exceeding.remove(id.index());
                    continue;
                }
                match self.refine(mesh, id, &mut room) {
                    Err(error) if error.is_over_budget() && self.loose.count() > 0 => {
                        self.loosen(mesh, &diameters, &mut exceeds)?;
                    }
                    done => done.map_err(LimitError::with_rule)?,
                }
            } else if self.loose.count() > 0 {
                self.loosen(mesh, &diameters, &mut exceeds)?;
            } else {
                break;
            }
        }
        if !self.is_done() {
            return Ok(Progress::More);
        }
        if mesh.raw_triangle_count() < self.most_triangles / 4 {
            mesh.give_memory_back();
            self.most_triangles = mesh.raw_triangle_count();
        }
        Ok(Progress::Done)
    }

    /// One step of the search: a triangle or half a coarse cell.
    #[inline]
    fn search_on<E>(
        &mut self,
        mesh: &Mesh,
        diameters: &Diameters,
        exceeds: &mut impl FnMut(&Element) -> Result<bool, E>,
    ) -> Result<(), E> {
        let Some((search, area)) = &mut self.search else {
            if let Some(area) = self.areas.pop() {
                self.search = Some((RectSearch::new(mesh, area.area.rect), area));
            }
            return Ok(());
        };
        let Area { area, reports_all } = area;
        if let Some(id) = search.found() {
            let [asks, loosens] = area.concerns(mesh, mesh.corners(id), mesh.triangle(id).level());
            if asks && exceeds(&mesh.element_with(id, diameters))? {
                self.exceeding.insert(id.index());
            }
            if loosens {
                self.loose.insert(id.index());
            }
            if *reports_all {
                self.log.triangle(id);
                self.log.step();
            }
            search.spread_from(mesh, id, &mut self.reached);
        } else if !search.enter_next(mesh, &mut self.reached) {
            self.search = None;
            self.reached.clear();
        }
        Ok(())
    }

    /// Bisects a triangle and what must be bisected with it.
    #[inline]
    fn refine(&mut self, mesh: &mut Mesh, id: TriangleId, room: &mut usize) -> Result<(), LimitError> {
        let level = mesh.triangle(id).level();
        if level >= mesh.lattice().deepest_level() {
            return Err(RefineError::too_fine(mesh.lattice(), mesh.node(mesh.triangle(id).vertices[0])));
        }
        let most_new = Mesh::most_new_triangles(level);
        if mesh.raw_triangle_count() + most_new > *room {
            *room = mesh.room_for(id, most_new, &self.limits)?;
        }
        let (first_node, first_new) = (mesh.raw_nodes().len(), mesh.raw_triangle_count());
        let mut new = first_new;
        let Self { chain, exceeding, log, .. } = self;
        mesh.refine_triangle_with(id, chain, |_, parent| {
            if exceeding.contains(parent.index()) {
                exceeding.insert(new);
            }
            log.triangles.insert(parent.index());
            log.triangles.insert(new);
            new += 1;
        });
        // The neighbour across a new child's bisection edge bordered on the parent's entry before.
        for new in first_new..new {
            if let Some(outer) = mesh.raw_triangles()[new].raw_neighbours[0].triangle() {
                log.triangle(outer);
            }
        }
        for node in first_node..mesh.raw_nodes().len() {
            log.nodes.insert(node);
        }
        log.step();
        Ok(())
    }

    /// Takes one loose mark, and lets the newest vertex of that triangle go if it can.
    fn loosen<E>(
        &mut self,
        mesh: &mut Mesh,
        diameters: &Diameters,
        exceeds: &mut impl FnMut(&Element) -> Result<bool, E>,
    ) -> Result<(), E> {
        let Some(last) = self.loose.last() else { return Ok(()) };
        let Some(star) = mesh.star_of(TriangleId::from_index(last)) else {
            self.loose.remove(last);
            return Ok(());
        };
        let parents = mesh.parents(&star);
        let mut needed = false;
        for parent in parents.iter().flatten() {
            needed = needed || exceeds(&mesh.element_of(parent, diameters))?;
        }
        // They have the same newest vertex: one question answers for all of them.
        star.children().for_each(|child| {
            self.loose.remove(child.index());
        });
        if !needed {
            self.coarsen(mesh, &star, &parents);
        }
        Ok(())
    }

    fn coarsen(&mut self, mesh: &mut Mesh, star: &Star, parents: &[Option<Triangle>; 2]) {
        mesh.merge(star, parents, &mut self.log);
        for parent in star.places() {
            self.exceeding.remove(parent.index());
            self.loose.insert(parent.index());
        }
        // The highest first: so the last entry of the array is never itself one to be removed later.
        for freed in star.freed() {
            let last = mesh.raw_triangle_count() - 1;
            self.exceeding.swap_removed(last, freed.index());
            self.loose.swap_removed(last, freed.index());
            mesh.remove_triangle(freed, &mut self.log);
        }
        mesh.remove_node(star.centre(), &mut self.log);
    }
}

/// How the target diameters of a rule change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetChange {
    /// None becomes larger: no triangle that exceeded its target ceases to.
    Finer,
    /// None becomes smaller: no triangle that satisfied its target ceases to.
    Coarser,
    /// Any change.
    Any,
}

/// A rectangle to be searched.
#[derive(Clone, Copy, Debug)]
struct Area {
    area: ChangedArea,
    /// Whether all triangles that touch it count as changed.
    reports_all: bool,
}

/// A rectangle in which the target diameters of a rule have changed, and what is known of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangedArea {
    /// Triangles that touch it can get another answer.
    pub rect: LatticeRect,
    /// The change of the target diameters.
    pub change: TargetChange,
    /// A lower bound of the target diameters that changed; `None` if it is unknown.
    pub falloff: Option<Falloff>,
}

/// A least diameter that grows with the distance from the cause of a change: no smaller target diameter is
/// other than before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falloff {
    /// The rectangle that contains the cause of the change.
    pub core: LatticeRect,
    /// The least diameter there, in world units.
    pub least: f64,
    /// The growth of this diameter per unit of length.
    pub slope: f64,
}

impl ChangedArea {
    /// Returns whether a triangle can have begun to exceed its target, and whether its parent can have ceased
    /// to.
    #[inline]
    pub fn concerns(&self, mesh: &Mesh, corners: [LatticePoint; 3], level: u32) -> [bool; 2] {
        let least = self.falloff.map_or(0.0, |falloff| falloff.least_at(mesh, corners));
        // The answer for a triangle changes only if a changed target diameter is smaller than the triangle's.
        let exceeds = |level: u32| mesh.diameter(level) > least;
        let asks = self.change != TargetChange::Coarser && exceeds(level);
        // A triangle without a parent has no node that could go.
        let loosens = self.change != TargetChange::Finer && level > 0 && exceeds(level - 1);
        [asks, loosens]
    }
}

impl Falloff {
    /// Returns the least diameter in a triangle, in world units.
    #[inline]
    fn least_at(&self, mesh: &Mesh, [a, b, c]: [LatticePoint; 3]) -> f64 {
        let Self { core, least, slope } = self;
        let gap =
            |low: u32, high: u32, from: u32, to: u32| low.saturating_sub(to).max(from.saturating_sub(high));
        let x = gap(core.min.x, core.max.x, a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let y = gap(core.min.y, core.max.y, a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let step = mesh.lattice().step();
        let distance = (DVec2::new(f64::from(x), f64::from(y)) * step).length();
        // A little less, for rounding errors here and where the target diameters are computed.
        (least + slope * distance) * (1.0 - 1e-9)
    }
}
