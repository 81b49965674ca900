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

use std::collections::HashMap;
use std::convert::Infallible;

use crate::geometry::{LatticePoint, LatticeRect};
use crate::mesh::kernel::{
    Bitset, Limits, Mesh, Progress, RectSearch, RefineError, TreeTriangle, TriangleId, WalkEnd,
};

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
/// let mut forecast = Forecast::new(&mesh, square, &Limits::default());
/// let exceeds = |corners, level| level < 2 && square.touches(corners);
/// assert_eq!(forecast.advance(&mesh, exceeds, |_, _| true, usize::MAX)?, Progress::Done);
///
/// let before = mesh.raw_triangle_count() as i64;
/// mesh.refine(&Limits::default(), |element| exceeds(element.corners, element.triangle.level()))?;
/// assert_eq!(before + forecast.change(), mesh.raw_triangle_count() as i64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Forecast {
    max_level: u32,
    search: RectSearch,
    searching: bool,
    /// Triangles found by the search.
    reached: Bitset,
    /// Triangles that may exceed their target.
    asked: Vec<TreeTriangle>,
    /// Entries whose newest vertex can perhaps be removed, to be examined when all triangles are satisfied.
    loose: Vec<TriangleId>,
    /// Triangles that coarsening would restore and whose newest vertex can perhaps be removed.
    put_back: Vec<TreeTriangle>,
    chain: Vec<TreeTriangle>,
    fates: HashMap<LatticePoint, Fate>,
    /// For each coarse triangle, by number, the end of the last walk in it, where the next walk begins.
    near: HashMap<usize, TriangleId>,
    added: usize,
    removed: usize,
    change: i64,
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
    pub fn new(mesh: &Mesh, area: LatticeRect, limits: &Limits) -> Self {
        Self {
            max_level: limits.level_cap(),
            search: RectSearch::new(mesh, area),
            searching: true,
            reached: Bitset::default(),
            asked: Vec::new(),
            loose: Vec::new(),
            put_back: Vec::new(),
            chain: Vec::new(),
            fates: HashMap::new(),
            near: HashMap::new(),
            added: 0,
            removed: 0,
            change: 0,
        }
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
    /// `exceeds` is the new rule, by corners and level. It must be monotone, and equal to the former rule
    /// outside the area. `is_in_domain` returns whether a triangle, by corners and level, lies in the domain.
    ///
    /// # Errors
    /// Fails when a target is finer than the lattice. The triangle budget is not checked; that is up to the
    /// caller.
    pub fn advance(
        &mut self,
        mesh: &Mesh,
        exceeds: impl Fn([LatticePoint; 3], u32) -> bool,
        is_in_domain: impl Fn([LatticePoint; 3], u32) -> bool,
        visits: usize,
    ) -> Result<Progress, RefineError<Infallible>> {
        let gain = |triangle: &TreeTriangle| gain(triangle, &is_in_domain);
        let max_level = self.max_level;
        let exceeds = |triangle: &TreeTriangle| {
            triangle.level() < max_level && exceeds(triangle.corners(), triangle.level())
        };
        let deepest = mesh.lattice().deepest_level();
        // Ends: as the update does, see the head of `update.rs`.
        for _ in 0..visits {
            if let Some(triangle) = self.asked.pop() {
                if !exceeds(&triangle) {
                    continue;
                }
                if triangle.level() >= deepest {
                    return Err(RefineError::too_fine(mesh.lattice(), triangle.apex()));
                }
                self.bisect(mesh, triangle, gain);
                self.asked.extend(triangle.children());
            } else if self.searching {
                self.search_on(mesh);
            } else if let Some(triangle) = self.put_back.pop() {
                self.loosen(mesh, &triangle, exceeds, gain);
            } else if let Some(id) = self.loose.pop() {
                self.loosen(mesh, &TreeTriangle::of(mesh, id), exceeds, gain);
            } else {
                return Ok(Progress::Done);
            }
        }
        Ok(Progress::More)
    }

    /// One step of the search: a triangle or half a coarse cell.
    fn search_on(&mut self, mesh: &Mesh) {
        if let Some(id) = self.search.found() {
            self.search.spread_from(mesh, id, &mut self.reached);
            self.asked.push(TreeTriangle::of(mesh, id));
            // Where a triangle around it was bisected, the newest vertex is looked at once that one is put
            // back.
            if mesh.star_of(id).is_some() {
                self.loose.push(id);
            }
        } else {
            self.searching = self.search.enter_next(mesh, &mut self.reached);
        }
    }

    /// Notes that a triangle is bisected, and before it those that must be to keep the mesh compatible. Each
    /// of the chain is one level above the one before.
    fn bisect(&mut self, mesh: &Mesh, triangle: TreeTriangle, gain: impl Fn(&TreeTriangle) -> i64) {
        self.chain.push(triangle);
        while let Some(&triangle) = self.chain.last() {
            let midpoint = triangle.midpoint();
            if self.is_node(mesh, midpoint, &triangle) {
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

    /// Notes that the newest vertex of a triangle goes, if it can.
    fn loosen(
        &mut self,
        mesh: &Mesh,
        triangle: &TreeTriangle,
        exceeds: impl Fn(&TreeTriangle) -> bool,
        gain: impl Fn(&TreeTriangle) -> i64,
    ) {
        if self.fates.contains_key(&triangle.apex()) {
            return;
        }
        let Some(parent) = triangle.parent(mesh.lattice()) else { return };
        let parents = [Some(parent), parent.across(mesh)];
        let parents = || parents.iter().flatten();
        if parents().any(|parent| parent.children().iter().any(|child| self.is_bisected(mesh, child))) {
            return;
        }
        let fate = if parents().any(exceeds) { Fate::Stays } else { Fate::Goes };
        self.fates.insert(triangle.apex(), fate);
        if fate == Fate::Goes {
            self.removed += parents().count();
            self.change -= parents().map(gain).sum::<i64>();
            self.put_back.extend(parents());
        }
    }

    fn is_bisected(&mut self, mesh: &Mesh, triangle: &TreeTriangle) -> bool {
        triangle.level() < mesh.lattice().deepest_level() && self.is_node(mesh, triangle.midpoint(), triangle)
    }

    /// Returns whether a point of a triangle, which may lie on its rim, is a node as far as counted.
    fn is_node(&mut self, mesh: &Mesh, point: LatticePoint, of: &TreeTriangle) -> bool {
        match self.fates.get(&point) {
            Some(Fate::Comes | Fate::Stays) => true,
            Some(Fate::Goes) => false,
            None => self.was_node(mesh, point, of),
        }
    }

    fn was_node(&mut self, mesh: &Mesh, point: LatticePoint, of: &TreeTriangle) -> bool {
        let (number, entry) = of.coarse_entry(mesh).expect("triangles are made within the domain");
        let near = self.near.entry(number).or_insert(entry);
        let WalkEnd::Found(id, _) = mesh.walk(*near, point.as_dvec2()) else {
            unreachable!("the walk stays in the coarse triangle that it starts in");
        };
        *near = id;
        mesh.corners(id).contains(&point)
    }
}
