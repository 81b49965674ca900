//! The search for the triangles that a change can concern.

use super::area::Area;
use super::questions::{Found, OfEntries};
use super::{Open, Updater};
use crate::geometry::LatticePoint;
use crate::mesh::kernel::{LevelsWithin, Mesh, RectSearch, SharedRule, TriangleId, ask_all};

/// An area is searched entry by entry of the array where it covers at least this share of the lattice, with
/// changes after each part.
const LARGE_SHARE: f64 = 1.0 / 8.0;

/// The search of an area.
#[derive(Clone, Debug)]
pub(super) struct Search {
    pub(super) area: Area,
    pub(super) way: Way,
}

#[derive(Clone, Debug)]
pub(super) enum Way {
    /// From neighbour to neighbour. Nothing may move meanwhile.
    Flood(RectSearch),
    /// Down the array, from its end. The entries before this one are left: what is appended or moved
    /// meanwhile comes to lie behind it, or was before it already.
    Scan(usize),
}

impl Search {
    fn new(mesh: &Mesh, area: Area) -> Self {
        let rect = area.changed.rect;
        let extent = mesh.lattice().extent();
        let share = |low: u32, high: u32, all: u32| f64::from(high - low) / f64::from(all.max(1));
        let covered = share(rect.min.x, rect.max.x, extent.x) * share(rect.min.y, rect.max.y, extent.y);
        let way = if covered < LARGE_SHARE {
            Way::Flood(RectSearch::new(mesh, rect))
        } else {
            Way::Scan(mesh.raw_triangle_count())
        };
        Self { area, way }
    }
}

impl Updater {
    /// Looks at up to `most` triangles of an area, and returns at how many it looked.
    pub(super) fn search_on<R: SharedRule>(
        &mut self,
        mesh: &Mesh,
        rule: &R,
        most: usize,
    ) -> Result<usize, R::Error> {
        let Some(mut search) = self.search.take().or_else(|| self.next_search(mesh)) else { return Ok(0) };
        let mut found = std::mem::take(&mut self.found);
        let Search { area, way } = &mut search;
        let (looked, is_done) = match way {
            Way::Flood(flood) => self.flood(mesh, area, flood, &mut found, most),
            Way::Scan(left) => self.scan(mesh, area, left, &mut found, most),
        };
        let asked = ask_all(&OfEntries { mesh }, &mut found, rule);
        if asked.is_ok() {
            found.iter().filter(|found| found.exceeds).for_each(|found| self.mark(mesh, found.id));
        }
        found.clear();
        self.found = found;
        if asked.is_err() || is_done {
            self.reached.clear();
        }
        match asked {
            // It is searched from the beginning once the rule is another one.
            Err(_) => self.areas.push(search.area),
            Ok(()) if !is_done => self.search = Some(search),
            Ok(()) => {}
        }
        asked.map(|()| looked)
    }

    /// Begins the search of another area: of one that touches those searched before, if the mesh has marks.
    fn next_search(&mut self, mesh: &Mesh) -> Option<Search> {
        if self.exceeding.count() == 0 && self.loose.count() == 0 {
            self.searched = None;
        }
        let last = self.areas.len().checked_sub(1);
        let area = self.areas.swap_remove(self.area_beside().or(last)?);
        let rect = area.changed.rect;
        self.searched = Some(self.searched.map_or(rect, |searched| searched.union(&rect)));
        Some(Search::new(mesh, area))
    }

    /// Finds up to `most` triangles. Returns how many places were looked at, and whether there are no more.
    fn flood(
        &mut self,
        mesh: &Mesh,
        area: &Area,
        flood: &mut RectSearch,
        found: &mut Vec<Found>,
        most: usize,
    ) -> (usize, bool) {
        for looked in 0..most {
            if let Some(id) = flood.found() {
                self.look(mesh, area, id, mesh.corners(id), found);
                flood.spread_from(mesh, id, &mut self.reached);
            } else if !flood.enter_next(mesh, &mut self.reached) {
                return (looked, true);
            }
        }
        (most, false)
    }

    /// Looks at the last `most` entries that are left. Returns how many, and whether these are all.
    fn scan(
        &mut self,
        mesh: &Mesh,
        area: &Area,
        left: &mut usize,
        found: &mut Vec<Found>,
        most: usize,
    ) -> (usize, bool) {
        // The array can have become shorter.
        let end = (*left).min(mesh.raw_triangle_count());
        *left = end.saturating_sub(most);
        for id in (*left..end).map(TriangleId::from_index) {
            let corners = mesh.corners(id);
            if area.changed.rect.touches(corners) {
                self.look(mesh, area, id, corners, found);
            }
        }
        (end - *left, *left == 0)
    }

    /// Notes what the change of an area can have done to a triangle that touches it.
    #[inline]
    fn look(
        &mut self,
        mesh: &Mesh,
        area: &Area,
        id: TriangleId,
        corners: [LatticePoint; 3],
        found: &mut Vec<Found>,
    ) {
        let level = mesh.triangle(id).level();
        let [asks, loosens] = area.changed.concerns(mesh, corners, level);
        if asks && level < self.limits.level_cap() {
            found.push(Found { id, exceeds: false });
        }
        if loosens {
            self.loose.insert(id.index());
        }
        if area.reports_all {
            self.log.triangle(id);
            self.log.step();
        }
    }

    /// Marks a triangle that exceeds its target.
    fn mark(&mut self, mesh: &Mesh, id: TriangleId) {
        if self.exceeding.insert(id.index()) {
            let level = mesh.triangle(id).level();
            self.note_open(Open { id, level, known: LevelsWithin::of_one(level, true) });
        }
    }

    /// Returns whether an entry is still to be looked at by the search of a large area.
    #[inline]
    pub(super) fn is_unsearched(&self, id: TriangleId) -> bool {
        matches!(self.search, Some(Search { way: Way::Scan(left), .. }) if id.index() < left)
    }
}
