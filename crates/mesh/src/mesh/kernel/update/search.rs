//! The search for the triangles that a change can concern.

use super::area::Area;
use super::questions::{Found, InArea};
use super::{Open, Updater};
use crate::mesh::kernel::{LevelsWithin, Mesh, RectSearch, SharedRule, TriangleId, ask_all};

/// An area is searched entry by entry of the array where it covers at least this share of the lattice: on all
/// threads, and with changes after each part.
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
        let next = || self.areas.pop().map(|area| Search::new(mesh, area));
        let Some(mut search) = self.search.take().or_else(next) else { return Ok(0) };
        let mut found = std::mem::take(&mut self.found);
        let (looked, is_done) = match &mut search.way {
            Way::Flood(flood) => self.flood(mesh, flood, &mut found, most),
            Way::Scan(left) => scan(mesh, left, &mut found, most),
        };
        let kind = InArea { mesh, area: &search.area.changed, level_cap: self.limits.level_cap() };
        let asked = ask_all(&kind, &mut found, rule);
        if asked.is_ok() {
            found.iter().for_each(|found| self.note(mesh, found, search.area.reports_all));
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

    /// Finds up to `most` triangles. Returns how many places were looked at, and whether there are no more.
    fn flood(
        &mut self,
        mesh: &Mesh,
        flood: &mut RectSearch,
        found: &mut Vec<Found>,
        most: usize,
    ) -> (usize, bool) {
        for looked in 0..most {
            if let Some(id) = flood.found() {
                found.push(Found::new(id));
                flood.spread_from(mesh, id, &mut self.reached);
            } else if !flood.enter_next(mesh, &mut self.reached) {
                return (looked, true);
            }
        }
        (most, false)
    }

    fn note(&mut self, mesh: &Mesh, found: &Found, reports_all: bool) {
        let Found { id, touches, exceeds, is_loose } = *found;
        if exceeds && self.exceeding.insert(id.index()) {
            let level = mesh.triangle(id).level();
            self.note_open(Open { id, level, known: LevelsWithin::of_one(level, true) });
        }
        if is_loose {
            self.loose.insert(id.index());
        }
        if touches && reports_all {
            self.log.triangle(id);
            self.log.step();
        }
    }

    /// Returns whether an entry is still to be looked at by the search of a large area.
    #[inline]
    pub(super) fn is_unsearched(&self, id: TriangleId) -> bool {
        matches!(self.search, Some(Search { way: Way::Scan(left), .. }) if id.index() < left)
    }
}

/// Takes the last entries that are left. Returns how many, and whether these are all.
fn scan(mesh: &Mesh, left: &mut usize, found: &mut Vec<Found>, most: usize) -> (usize, bool) {
    // The array can have become shorter.
    let end = (*left).min(mesh.raw_triangle_count());
    *left = end.saturating_sub(most);
    found.extend((*left..end).map(|index| Found::new(TriangleId::from_index(index))));
    (end - *left, *left == 0)
}
