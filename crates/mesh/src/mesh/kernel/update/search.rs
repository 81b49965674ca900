//! The search for the triangles that a change can concern.

use super::area::Area;
use super::questions::{EntryQuestions, FoundEntry};
use super::scan::{Concern, Scan};
use super::{OpenTriangle, Updater};
use crate::geometry::LatticeRect;
use crate::mesh::kernel::{LevelsWithin, Mesh, RectSearch, SharedRule, TriangleId, ask_all};

/// Areas are searched entry by entry of the array where they cover at least this share of the lattice.
const LARGE_SHARE: f64 = 1.0 / 8.0;

/// A search for the triangles that changes concern.
#[derive(Clone, Debug)]
pub(super) enum Search {
    /// In one area, from neighbour to neighbour. Nothing may move meanwhile.
    Flood(Area, RectSearch),
    /// In all areas that there were, down the array.
    Scan(Scan),
}

impl Search {
    fn into_areas(self) -> Vec<Area> {
        match self {
            Self::Flood(area, _) => vec![area],
            Self::Scan(scan) => scan.into_areas(),
        }
    }
}

/// Returns the share of the lattice that a rectangle covers.
fn share_of(mesh: &Mesh, rect: &LatticeRect) -> f64 {
    let extent = mesh.lattice().extent();
    let share = |low: u32, high: u32, all: u32| f64::from(high - low) / f64::from(all.max(1));
    share(rect.min.x, rect.max.x, extent.x) * share(rect.min.y, rect.max.y, extent.y)
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
        let (looked, is_done) = match &mut search {
            Search::Flood(area, flood) => self.flood(mesh, area, flood, &mut found, most),
            Search::Scan(scan) => self.scan(mesh, scan, &mut found, most),
        };
        let asked = ask_all(&EntryQuestions { mesh }, &mut found, rule);
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
            Err(_) => self.areas.extend(search.into_areas()),
            Ok(()) if !is_done => self.search = Some(search),
            Ok(()) => {}
        }
        asked.map(|()| looked)
    }

    /// Begins another search: of all areas, if they are large together; otherwise of one, which touches those
    /// searched before if the mesh has marks.
    fn next_search(&mut self, mesh: &Mesh) -> Option<Search> {
        if self.exceeding.count() == 0 && self.loose.count() == 0 {
            self.searched = None;
        }
        let last = self.areas.len().checked_sub(1)?;
        let covered: f64 = self.areas.iter().map(|area| share_of(mesh, &area.changed.rect)).sum();
        let search = if covered >= LARGE_SHARE {
            let areas = std::mem::take(&mut self.areas);
            areas.iter().for_each(|area| self.note_searched(area.changed.rect));
            Search::Scan(Scan::new(mesh, areas))
        } else {
            let area = self.areas.swap_remove(self.area_beside().unwrap_or(last));
            self.note_searched(area.changed.rect);
            Search::Flood(area, RectSearch::new(mesh, area.changed.rect, area.levels(mesh)))
        };
        Some(search)
    }

    fn note_searched(&mut self, rect: LatticeRect) {
        self.searched = Some(self.searched.map_or(rect, |searched| searched.union(&rect)));
    }

    /// Finds up to `most` triangles. Returns how many places were looked at, and whether there are no more.
    fn flood(
        &mut self,
        mesh: &Mesh,
        area: &Area,
        flood: &mut RectSearch,
        found: &mut Vec<FoundEntry>,
        most: usize,
    ) -> (usize, bool) {
        for looked in 0..most {
            if let Some(id) = flood.found() {
                let level = mesh.triangle(id).level();
                if flood.has_level(level) {
                    self.note(mesh, id, area.concern(mesh, mesh.corners(id), level), found);
                }
                flood.spread_from(mesh, id, &mut self.reached);
            } else if !flood.enter_next(mesh, &mut self.reached, &mut self.starts) {
                return (looked, true);
            }
        }
        (most, false)
    }

    /// Looks at the last `most` entries that are left. Returns how many, and whether these are all.
    fn scan(
        &mut self,
        mesh: &Mesh,
        scan: &mut Scan,
        found: &mut Vec<FoundEntry>,
        most: usize,
    ) -> (usize, bool) {
        if scan.has_part() {
            scan.begin_part();
        }
        let entries = scan.take(mesh, most);
        let looked = entries.len();
        for id in entries.map(TriangleId::from_index) {
            let level = mesh.triangle(id).level();
            if scan.has_level(level) {
                let concern = scan.concern(mesh, mesh.corners(id), level);
                self.note(mesh, id, concern, found);
            }
        }
        (looked, scan.is_done())
    }

    /// Notes what changes can have done to a triangle.
    #[inline]
    fn note(&mut self, mesh: &Mesh, id: TriangleId, concern: Concern, found: &mut Vec<FoundEntry>) {
        if concern.asks && mesh.triangle(id).level() < self.limits.level_cap() {
            found.push(FoundEntry { id, exceeds: false });
        }
        if concern.loosens {
            self.loose.insert(id.index());
        }
        if concern.is_reported {
            self.log.triangle(id);
            self.log.step();
        }
    }

    /// Marks a triangle that exceeds its target.
    fn mark(&mut self, mesh: &Mesh, id: TriangleId) {
        if self.exceeding.insert(id.index()) {
            let level = mesh.triangle(id).level();
            self.note_open(OpenTriangle { id, level, known: LevelsWithin::single(level, true) });
        }
    }

    /// Returns whether an entry is still to be looked at by the search of a large area.
    #[inline]
    pub(super) fn is_unsearched(&self, id: TriangleId) -> bool {
        matches!(&self.search, Some(Search::Scan(scan)) if scan.is_left(id.index()))
    }
}
