//! Counts the changes that an update would make to a mesh, without making them.
//!
//! A bisection makes one node, and the node identifies the bisection: it is the middle of the edge that the
//! one or two bisected triangles share. So a coarse grid and a set of nodes determine a mesh, and an update
//! adds some nodes and removes others. The work is the same as in [`Updater`](crate::mesh::Updater); but the
//! updater changes entries, and the forecast notes nodes. Triangles that are not in the array are known by
//! their corners alone: parent, children and the mirror image across the bisection edge follow from the
//! lattice, as the head of `coarsen.rs` shows.
//!
//! ```text
//!          o                 m comes: both triangles are bisected, so one node gained is two triangles gained
//!        /   \               (one at the boundary); m goes: the two are put back
//!      o---m---o
//!        \   /
//!          o
//! ```

use super::forecast_questions::{
    AskedTriangle, ForecastParentQuestions, LooseVertex, MeshQuestions, TreeQuestions,
};
use crate::geometry::{LatticePoint, LatticeRect, NumberMap, NumberSet};
use crate::mesh::kernel::{
    Bitset, ChangedArea, LevelsWithin, Limits, Mesh, Progress, RectSearch, RefineError, SharedRule,
    TargetChange, TreeTriangle, TriangleId, WalkStarts, ask_all,
};

/// Triangles of a batch, unless a slice is smaller.
const BATCH: usize = 4096;
/// Memory for more nodes than this is not reused: emptying a map takes time proportional to its capacity.
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
    open: Vec<AskedTriangle>,
    /// Triangles whose newest vertex can perhaps be removed, to be examined when all triangles are satisfied.
    loose: ByLevel,
    /// The nodes that come.
    coming: NumberSet<LatticePoint>,
    /// The place in its level of the restored triangle that stands for all with this newest vertex.
    restored: NumberMap<LatticePoint, usize>,
    starts: WalkStarts,
    added: usize,
    removed: usize,
    change: i64,
    /// Memory that is used again, empty between calls.
    batch: Vec<AskedTriangle>,
}

/// A triangle that is not bisected, as counted so far. It stands for all around its newest vertex.
#[derive(Clone, Copy, Debug)]
struct Whole {
    triangle: TreeTriangle,
    /// How many of them were restored; 0 where all are entries of the mesh.
    restored: usize,
}

/// Triangles, of which the finest are taken first.
#[derive(Clone, Debug, Default)]
struct ByLevel {
    levels: Vec<Vec<Whole>>,
    /// No finer level has any.
    finest: usize,
}

impl ByLevel {
    fn level_mut(&mut self, level: u32) -> &mut Vec<Whole> {
        let level = level as usize;
        if level >= self.levels.len() {
            self.levels.resize_with(level + 1, Vec::new);
        }
        self.finest = self.finest.max(level);
        &mut self.levels[level]
    }

    /// Returns the finest triangles.
    fn finest_mut(&mut self) -> Option<&mut Vec<Whole>> {
        while self.levels.get(self.finest)?.is_empty() {
            self.finest = self.finest.checked_sub(1)?;
        }
        self.levels.get_mut(self.finest)
    }

    fn clear(&mut self) {
        self.levels.iter_mut().for_each(Vec::clear);
        self.finest = 0;
    }
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
        Self::for_changes(vec![area], limits).expect("there is an area")
    }

    /// Creates a forecast without counts for areas that contain all points where the rule has changed, with
    /// what is known of the changes; `None` without an area.
    pub fn for_changes(areas: Vec<ChangedArea>, limits: &Limits) -> Option<Self> {
        (!areas.is_empty()).then(|| Self {
            level_cap: limits.level_cap(),
            areas,
            search: None,
            reached: Bitset::default(),
            asked: Bitset::default(),
            centres: Bitset::default(),
            open: Vec::new(),
            loose: ByLevel::default(),
            coming: NumberSet::default(),
            restored: NumberMap::default(),
            starts: WalkStarts::default(),
            added: 0,
            removed: 0,
            change: 0,
            batch: Vec::new(),
        })
    }

    /// [`Self::for_changes`] in the memory of another forecast, perhaps of another mesh, which is faster.
    pub fn for_changes_in(memory: Self, areas: Vec<ChangedArea>, limits: &Limits) -> Option<Self> {
        let new = Self::for_changes(areas, limits)?;
        if memory.coming.capacity().max(memory.restored.capacity()) > MOST_KEPT {
            return Some(new);
        }
        let Self { level_cap, areas, .. } = new;
        Some(Self { level_cap, areas, ..memory.emptied() })
    }

    /// Returns the forecast with nothing found, in the same memory.
    fn emptied(mut self) -> Self {
        (self.search, self.added, self.removed, self.change) = (None, 0, 0, 0);
        [&mut self.reached, &mut self.asked, &mut self.centres].into_iter().for_each(Bitset::clear);
        [&mut self.open, &mut self.batch].into_iter().for_each(Vec::clear);
        self.loose.clear();
        self.coming.clear();
        self.restored.clear();
        self.starts.clear();
        self
    }

    /// Returns the number of triangles that would be added, as counted so far.
    pub fn added(&self) -> usize {
        self.added
    }

    /// Returns the number of triangles that would be removed, as counted so far: zero until all added ones
    /// are counted.
    pub fn removed(&self) -> usize {
        self.removed
    }

    /// Returns by how many triangles the domain would grow, as counted so far; negative if it would shrink.
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
            } else if self.loose.finest_mut().is_some() {
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
        let asked = ask_all(&MeshQuestions { level_cap: self.level_cap }, &mut found, rule);
        if asked.is_ok() {
            self.open.extend(found.iter().filter(|asked| asked.exceeds()));
        }
        found.clear();
        self.batch = found;
        asked.map(|()| looked)
    }

    /// Notes what a change can have done to a triangle that touches its area.
    #[inline]
    fn look_at(&mut self, mesh: &Mesh, id: TriangleId, area: &ChangedArea, found: &mut Vec<AskedTriangle>) {
        let [asks, loosens] = area.concerns(mesh, mesh.corners(id), mesh.triangle(id).level());
        if asks && self.asked.insert(id.index()) {
            found.push(AskedTriangle {
                triangle: TreeTriangle::from_mesh(mesh, id),
                known: LevelsWithin::UNKNOWN,
            });
        }
        // Where a triangle around it was bisected, the newest vertex is looked at once that one is restored.
        if loosens
            && let Some(centre) = mesh.triangle(id).newest_vertex()
            && self.centres.insert(centre.index())
            && mesh.star_of(id).is_some()
        {
            let triangle = TreeTriangle::from_mesh(mesh, id);
            self.loose.level_mut(triangle.level()).push(Whole { triangle, restored: 0 });
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
        ask_all(&TreeQuestions { level_cap: self.level_cap }, &mut batch, rule).map_err(RefineError::Rule)?;
        for asked in batch.iter().filter(|asked| asked.exceeds()) {
            let &AskedTriangle { triangle, known } = asked;
            if triangle.level() >= self.level_cap {
                continue;
            }
            if triangle.level() >= mesh.lattice().deepest_level() {
                return Err(RefineError::too_fine(mesh.lattice(), triangle.apex()));
            }
            self.bisect(mesh, triangle, &gain);
            let children = triangle.children().map(|triangle| AskedTriangle { triangle, known });
            self.open
                .extend(children.iter().filter(|child| child.known.exceeds(child.level()) != Some(false)));
        }
        let looked = batch.len();
        batch.clear();
        self.batch = batch;
        Ok(looked)
    }

    /// Notes that a triangle is bisected, and those that must be to keep the mesh compatible: each is one
    /// level coarser than the one before.
    ///
    /// The triangle is an entry of the mesh, or part of one: no node of the mesh lies in the middle of its
    /// edges.
    fn bisect(&mut self, mesh: &Mesh, mut triangle: TreeTriangle, gain: impl Fn(&TreeTriangle) -> i64) {
        while self.coming.insert(triangle.midpoint()) {
            let across = triangle.across(mesh);
            self.added += 1 + usize::from(across.is_some());
            self.change += gain(&triangle) + across.as_ref().map_or(0, &gain);
            let half = across.filter(|across| !self.is_node(mesh, across.apex(), across));
            match half.and_then(|half| half.parent(mesh.lattice())) {
                Some(parent) => triangle = parent,
                None => break,
            }
        }
    }

    /// Looks at up to `most` triangles of the finest level, and notes that the newest vertices go that can.
    ///
    /// Whether a vertex can go depends on the vertices of the next finer level around it, and on none of its
    /// own: from the finest level down, once is enough.
    fn coarsen_on<R: SharedRule>(
        &mut self,
        mesh: &Mesh,
        rule: &R,
        gain: impl Fn(&TreeTriangle) -> i64,
        most: usize,
    ) -> Result<usize, R::Error> {
        let Some(finest) = self.loose.finest_mut() else { return Ok(0) };
        let batch = finest.split_off(finest.len().saturating_sub(most));
        let mut stars: Vec<LooseVertex> = batch.iter().filter_map(|whole| self.star(mesh, whole)).collect();
        ask_all(&ForecastParentQuestions { level_cap: self.level_cap }, &mut stars, rule)?;
        for parent in stars.iter().filter(|loose| !loose.is_needed).flat_map(LooseVertex::parents) {
            self.removed += 1;
            self.change -= gain(parent);
            self.restore(*parent);
        }
        Ok(batch.len())
    }

    /// Notes a triangle that is put back.
    fn restore(&mut self, triangle: TreeTriangle) {
        let level = self.loose.level_mut(triangle.level());
        let place = *self.restored.entry(triangle.apex()).or_insert(level.len());
        match level.get_mut(place) {
            Some(whole) => whole.restored += 1,
            None => level.push(Whole { triangle, restored: 1 }),
        }
    }

    /// Returns the parents around the newest vertex of a triangle, if no triangle around it is bisected.
    fn star(&mut self, mesh: &Mesh, whole: &Whole) -> Option<LooseVertex> {
        let parent = whole.triangle.parent(mesh.lattice())?;
        let parents = [Some(parent), parent.across(mesh)];
        let mut children = parents.iter().flatten().flat_map(TreeTriangle::children);
        let count = 2 * parents.iter().flatten().count();
        let is_whole = match whole.restored {
            // An entry of the mesh is bisected only if a node comes.
            0 => self.added == 0 || children.all(|child| !self.is_coming(mesh, &child)),
            all if all == count => true,
            some => some + children.filter(|child| self.is_entry(mesh, child)).count() == count,
        };
        is_whole.then_some(LooseVertex { parents, is_needed: false })
    }

    /// Returns whether a triangle is an entry of the mesh that no node cuts.
    fn is_entry(&mut self, mesh: &Mesh, triangle: &TreeTriangle) -> bool {
        let is_deepest = triangle.level() >= mesh.lattice().deepest_level();
        is_deepest || !self.is_coming(mesh, triangle) && !self.was_node(mesh, triangle.midpoint(), triangle)
    }

    /// Returns whether a node comes that cuts a triangle.
    fn is_coming(&self, mesh: &Mesh, triangle: &TreeTriangle) -> bool {
        triangle.level() < mesh.lattice().deepest_level() && self.coming.contains(&triangle.midpoint())
    }

    /// Returns whether a point of a triangle, which may lie on its rim, is a node, or comes.
    #[inline]
    fn is_node(&mut self, mesh: &Mesh, point: LatticePoint, of: &TreeTriangle) -> bool {
        self.coming.contains(&point) || self.was_node(mesh, point, of)
    }

    fn was_node(&mut self, mesh: &Mesh, point: LatticePoint, of: &TreeTriangle) -> bool {
        let coarse = of.coarse_entry(mesh).expect("triangles are made within the domain");
        let id = self.starts.walk(mesh, coarse, point);
        mesh.corners(id).contains(&point)
    }
}
