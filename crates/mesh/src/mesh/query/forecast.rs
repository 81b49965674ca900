//! Counts the changes that an update would make to a mesh, without making them.
//!
//! A bisection makes one node, and the node identifies the bisection: it is the middle of the edge that the
//! one or two bisected triangles share. So a coarse grid and a set of nodes determine a mesh, and an update
//! adds some nodes and removes others. The work is the same as in [`Updater`](crate::mesh::Updater), in the
//! same order; but the updater changes entries, and the forecast notes nodes. Triangles that are not in the
//! array are known by their corners alone: parent, children and the mirror image across the bisection edge
//! follow from the lattice, as the head of `coarsen.rs` shows.
//!
//! ```text
//!          o                 m comes: both triangles are bisected, so one node gained is two triangles gained
//!        /   \               (one at the boundary); m goes: the two are put back
//!      o---m---o
//!        \   /               fates: m → comes | goes | stays
//!          o
//! ```

use super::forecast_questions::{Asked, Loose, OfMesh, OfParents, OfTree};
use crate::geometry::{LatticePoint, LatticeRect, NumberMap};
use crate::mesh::kernel::{
    Bitset, ChangedArea, LevelsWithin, Limits, Mesh, Progress, RectSearch, RefineError, SharedRule,
    TargetChange, TreeTriangle, TriangleId, WalkStarts, ask_all,
};

/// Triangles of a batch, unless a slice is smaller.
const BATCH: usize = 4096;
/// The memory for more nodes is not used again: a map is emptied in time that is proportional to its room.
const MOST_KEPT: usize = 1 << 16;

/// Counts what [`Updater`](crate::mesh::Updater) would do after a change of the rule, in slices, and leaves
/// the mesh alone.
///
/// The mesh must be up to date with the former rule, and it must not change until the count is done. Time and
/// memory are proportional to the number of triangles that touch the changed rectangle or would be added or
/// removed.
///
/// ```
/// use meshbrush_mesh::geometry::{Lattice, Rect};
/// use meshbrush_mesh::mesh::{Forecast, Limits, Mesh, Progress};
///
/// let lattice = Lattice::covering(Rect::UNIT, 0.5, 1_000_000)?;
/// let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default())?;
/// let square = mesh.lattice().rect_around(&Rect::around(glam::dvec2(0.3, 0.4), 0.1)).unwrap();
/// let mut forecast = Forecast::new(square, &Limits::default());
/// let exceeds = |corners, level| level < 2 && square.touches(corners);
/// assert_eq!(forecast.advance(&mesh, &|| exceeds, |_, _| true, usize::MAX)?, Progress::Done);
///
/// let before = mesh.raw_triangle_count() as i64;
/// mesh.refine(&Limits::default(), |element| exceeds(element.corners, element.triangle.level()))?;
/// assert_eq!(before + forecast.change(), mesh.raw_triangle_count() as i64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Forecast {
    level_cap: u32,
    /// Where the rule has changed, and how, as far as that is still to be searched.
    areas: Vec<ChangedArea>,
    /// The area that is searched.
    search: Option<(ChangedArea, RectSearch)>,
    /// Triangles found by the search of this area.
    reached: Bitset,
    /// Triangles that were asked about: one touches several areas.
    asked: Bitset,
    /// Newest vertices of triangles found by the search: all triangles around one give the same star, or
    /// none.
    centres: Bitset,
    /// Triangles that may exceed their target: entries of the mesh, or parts of such.
    open: Vec<Asked>,
    /// Entries whose newest vertex can perhaps be removed, one for each of those, to be examined when all
    /// triangles are satisfied.
    loose: Vec<TriangleId>,
    /// Triangles that coarsening would restore and whose newest vertex can perhaps be removed.
    restored: Vec<TreeTriangle>,
    chain: Vec<TreeTriangle>,
    fates: NumberMap<LatticePoint, Fate>,
    starts: WalkStarts,
    added: usize,
    removed: usize,
    change: i64,
    /// Memory that is used again, empty between calls.
    batch: Vec<Asked>,
}

/// The change of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Comes,
    Goes,
    /// A triangle that was cut there would exceed its target.
    Stays,
}

/// Returns how many triangles of the domain come when one is bisected, or go below zero.
fn gain(triangle: &TreeTriangle, is_in_domain: &impl Fn([LatticePoint; 3], u32) -> bool) -> i64 {
    let counts = |triangle: &TreeTriangle| i64::from(is_in_domain(triangle.corners(), triangle.level()));
    triangle.children().iter().map(counts).sum::<i64>() - counts(triangle)
}

impl Forecast {
    /// Creates a forecast without counts. `area` contains all points where the rule has changed.
    pub fn new(area: LatticeRect, limits: &Limits) -> Self {
        let area = ChangedArea { rect: area, change: TargetChange::Any, falloff: None };
        Self::of_changes(vec![area], limits).expect("there is an area")
    }

    /// Creates a forecast without counts for areas that contain all points where the rule has changed, with
    /// what is known of the changes; `None` without an area.
    pub fn of_changes(areas: Vec<ChangedArea>, limits: &Limits) -> Option<Self> {
        (!areas.is_empty()).then(|| Self {
            level_cap: limits.level_cap(),
            areas,
            search: None,
            reached: Bitset::default(),
            asked: Bitset::default(),
            centres: Bitset::default(),
            open: Vec::new(),
            loose: Vec::new(),
            restored: Vec::new(),
            chain: Vec::new(),
            fates: NumberMap::default(),
            starts: WalkStarts::default(),
            added: 0,
            removed: 0,
            change: 0,
            batch: Vec::new(),
        })
    }

    /// [`Self::of_changes`] in the memory of another forecast, perhaps of another mesh, which is faster.
    pub fn of_changes_in(memory: Self, areas: Vec<ChangedArea>, limits: &Limits) -> Option<Self> {
        let new = Self::of_changes(areas, limits)?;
        if memory.fates.capacity() > MOST_KEPT {
            return Some(new);
        }
        let Self { reached, asked, centres, open, loose, restored, chain, fates, starts, batch, .. } =
            memory.emptied();
        Some(Self { reached, asked, centres, open, loose, restored, chain, fates, starts, batch, ..new })
    }

    /// Returns the forecast with nothing found, in the same memory.
    fn emptied(mut self) -> Self {
        [&mut self.reached, &mut self.asked, &mut self.centres].into_iter().for_each(Bitset::clear);
        [&mut self.open, &mut self.batch].into_iter().for_each(Vec::clear);
        [&mut self.restored, &mut self.chain].into_iter().for_each(Vec::clear);
        self.loose.clear();
        self.fates.clear();
        self.starts.clear();
        self
    }

    /// Returns the triangles that would come, as far as counted.
    pub fn added(&self) -> usize {
        self.added
    }

    /// Returns the triangles that would go, as far as counted. Zero until all that come are counted.
    pub fn removed(&self) -> usize {
        self.removed
    }

    /// Returns how many triangles more there would be in the domain, or fewer below zero, as far as counted.
    pub fn change(&self) -> i64 {
        self.change
    }

    /// Counts until done or until `visits` triangles were looked at.
    ///
    /// `rule` is the new rule, which is asked on the threads of the current pool of rayon. It must be
    /// monotone, and equal to the former rule outside the area. `is_in_domain` returns whether a triangle, by
    /// corners and level, lies in the domain.
    ///
    /// # Errors
    /// Fails when the rule fails, or a target is finer than the lattice. The triangle budget is not checked;
    /// that is up to the caller.
    pub fn advance<R: SharedRule>(
        &mut self,
        mesh: &Mesh,
        rule: &R,
        is_in_domain: impl Fn([LatticePoint; 3], u32) -> bool,
        visits: usize,
    ) -> Result<Progress, RefineError<R::Error>> {
        let gain = |triangle: &TreeTriangle| gain(triangle, &is_in_domain);
        let mut left = visits;
        // Ends: as the update does, see the head of `update/mod.rs`.
        while left > 0 {
            let most = left.min(BATCH);
            let looked = if !self.open.is_empty() {
                self.bisect_on(mesh, rule, gain, most)?
            } else if self.search.is_some() || !self.areas.is_empty() {
                self.search_on(mesh, rule, most).map_err(RefineError::Rule)?
            } else if !self.restored.is_empty() || !self.loose.is_empty() {
                self.coarsen_on(mesh, rule, gain, most).map_err(RefineError::Rule)?
            } else {
                return Ok(Progress::Done);
            };
            left -= looked.clamp(1, left);
        }
        Ok(Progress::More)
    }

    /// Looks at up to `most` triangles of the areas. Returns how many.
    fn search_on<R: SharedRule>(&mut self, mesh: &Mesh, rule: &R, most: usize) -> Result<usize, R::Error> {
        let mut found = std::mem::take(&mut self.batch);
        let mut search = self.search.take();
        let mut looked = 0;
        while looked < most {
            let Some((area, triangles)) = &mut search else {
                let begin = |area: ChangedArea| (area, RectSearch::new(mesh, area.rect, area.levels(mesh)));
                search = self.areas.pop().map(begin);
                if search.is_none() {
                    break;
                }
                continue;
            };
            looked += 1;
            if let Some(id) = triangles.found() {
                if triangles.has_level(mesh.triangle(id).level()) {
                    self.look_at(mesh, id, area, &mut found);
                }
                triangles.spread_from(mesh, id, &mut self.reached);
            } else if !triangles.enter_next(mesh, &mut self.reached, &mut self.starts) {
                self.reached.clear();
                search = None;
            }
        }
        self.search = search;
        let asked = ask_all(&OfMesh { level_cap: self.level_cap }, &mut found, rule);
        if asked.is_ok() {
            self.open.extend(found.iter().filter(|asked| asked.exceeds()));
        }
        found.clear();
        self.batch = found;
        asked.map(|()| looked)
    }

    /// Notes what a change can have done to a triangle that touches its area.
    #[inline]
    fn look_at(&mut self, mesh: &Mesh, id: TriangleId, area: &ChangedArea, found: &mut Vec<Asked>) {
        let [asks, loosens] = area.concerns(mesh, mesh.corners(id), mesh.triangle(id).level());
        if asks && self.asked.insert(id.index()) {
            found.push(Asked { triangle: TreeTriangle::of(mesh, id), known: LevelsWithin::UNKNOWN });
        }
        // Where a triangle around it was bisected, the newest vertex is looked at once that one is restored.
        if loosens
            && let Some(centre) = mesh.triangle(id).newest_vertex()
            && self.centres.insert(centre.index())
            && mesh.star_of(id).is_some()
        {
            self.loose.push(id);
        }
    }

    /// Asks about up to `most` triangles, and notes that those are bisected that exceed their target.
    fn bisect_on<R: SharedRule>(
        &mut self,
        mesh: &Mesh,
        rule: &R,
        gain: impl Fn(&TreeTriangle) -> i64,
        most: usize,
    ) -> Result<usize, RefineError<R::Error>> {
        let mut batch = std::mem::take(&mut self.batch);
        batch.extend(self.open.drain(self.open.len().saturating_sub(most)..));
        ask_all(&OfTree { level_cap: self.level_cap }, &mut batch, rule).map_err(RefineError::Rule)?;
        for asked in batch.iter().filter(|asked| asked.exceeds()) {
            let &Asked { triangle, known } = asked;
            if triangle.level() >= self.level_cap {
                continue;
            }
            if triangle.level() >= mesh.lattice().deepest_level() {
                return Err(RefineError::too_fine(mesh.lattice(), triangle.apex()));
            }
            self.bisect(mesh, triangle, &gain);
            let children = triangle.children().map(|triangle| Asked { triangle, known });
            self.open
                .extend(children.iter().filter(|child| child.known.exceeds(child.level()) != Some(false)));
        }
        let looked = batch.len();
        batch.clear();
        self.batch = batch;
        Ok(looked)
    }

    /// Notes that a triangle is bisected, and before it those that must be to keep the mesh compatible. Each
    /// of the chain is one level above the one before.
    ///
    /// The triangle is an entry of the mesh, or part of one: no node of the mesh lies in the middle of its
    /// edges.
    fn bisect(&mut self, mesh: &Mesh, triangle: TreeTriangle, gain: impl Fn(&TreeTriangle) -> i64) {
        self.chain.push(triangle);
        while let Some(&triangle) = self.chain.last() {
            let midpoint = triangle.midpoint();
            // Those that are pushed below had no node there, either.
            if self.fate(midpoint) == Some(true) {
                self.chain.pop();
                continue;
            }
            let across = triangle.across(mesh);
            if let Some(across) = across
                && let Some(parent) = across.parent(mesh.lattice())
                && !self.is_node(mesh, across.apex(), &across)
            {
                self.chain.push(parent);
                continue;
            }
            self.chain.pop();
            self.fates.insert(midpoint, Fate::Comes);
            self.added += 1 + usize::from(across.is_some());
            self.change += gain(&triangle) + across.as_ref().map_or(0, &gain);
        }
    }

    /// Looks at up to `most` triangles, and notes that the newest vertices go that can.
    fn coarsen_on<R: SharedRule>(
        &mut self,
        mesh: &Mesh,
        rule: &R,
        gain: impl Fn(&TreeTriangle) -> i64,
        most: usize,
    ) -> Result<usize, R::Error> {
        let mut stars = Vec::new();
        let mut looked = 0;
        while looked < most {
            looked += 1;
            if let Some(triangle) = self.restored.pop() {
                stars.extend(self.star(mesh, &triangle, false));
            } else if let Some(id) = self.loose.pop() {
                stars.extend(self.star(mesh, &TreeTriangle::of(mesh, id), true));
            } else {
                break;
            }
        }
        ask_all(&OfParents { level_cap: self.level_cap }, &mut stars, rule)?;
        for Loose { at, parents, .. } in stars.into_iter().filter(|loose| !loose.is_needed) {
            self.fates.insert(at, Fate::Goes);
            self.removed += parents.iter().flatten().count();
            self.change -= parents.iter().flatten().map(&gain).sum::<i64>();
            self.restored.extend(parents.into_iter().flatten());
        }
        Ok(looked)
    }

    /// Returns the newest vertex of a triangle and the parents around it, if all of them could be restored;
    /// `None` where its fate is known. Until the parents are asked about, it stays. `are_entries` says that
    /// all triangles around the vertex are entries of the mesh.
    fn star(&mut self, mesh: &Mesh, triangle: &TreeTriangle, are_entries: bool) -> Option<Loose> {
        let at = triangle.apex();
        if self.fates.contains_key(&at) {
            return None;
        }
        let parent = triangle.parent(mesh.lattice())?;
        let parents = [Some(parent), parent.across(mesh)];
        // An entry of the mesh is bisected only if a node comes.
        if !are_entries || self.added > 0 {
            let children = parents.iter().flatten().flat_map(TreeTriangle::children);
            // What was restored is whole.
            if children
                .filter(|child| are_entries || child != triangle)
                .any(|child| self.is_bisected(mesh, &child, are_entries))
            {
                return None;
            }
        }
        self.fates.insert(at, Fate::Stays);
        Some(Loose { at, parents, is_needed: false })
    }

    fn is_bisected(&mut self, mesh: &Mesh, triangle: &TreeTriangle, is_entry: bool) -> bool {
        if triangle.level() >= mesh.lattice().deepest_level() {
            return false;
        }
        let midpoint = triangle.midpoint();
        self.fate(midpoint).unwrap_or_else(|| !is_entry && self.was_node(mesh, midpoint, triangle))
    }

    /// Returns whether a point of a triangle, which may lie on its rim, is a node as far as counted.
    #[inline]
    fn is_node(&mut self, mesh: &Mesh, point: LatticePoint, of: &TreeTriangle) -> bool {
        self.fate(point).unwrap_or_else(|| self.was_node(mesh, point, of))
    }

    /// Returns whether a point is a node as far as counted, where that differs from the mesh or was found
    /// out.
    #[inline]
    fn fate(&self, point: LatticePoint) -> Option<bool> {
        self.fates.get(&point).map(|fate| *fate != Fate::Goes)
    }

    fn was_node(&mut self, mesh: &Mesh, point: LatticePoint, of: &TreeTriangle) -> bool {
        let coarse = of.coarse_entry(mesh).expect("triangles are made within the domain");
        let id = self.starts.walk(mesh, coarse, point);
        mesh.corners(id).contains(&point)
    }
}
