//! How many edits ago each triangle of a mesh came.

use std::sync::Arc;

use crate::mesh::{Changes, Mesh, Progress, TriangleId};

/// The edit that made each triangle of a mesh, while the mesh is updated in place.
///
/// A triangle that goes and comes back is new. A mesh that replaces another is as old as its first edit.
#[derive(Debug, Default)]
pub struct Ages {
    /// Identifies the triangle that an entry of the mesh had when it was last looked at.
    known: Vec<PositionKey>,
    /// The number of the edit that made it.
    born: Arc<Vec<u32>>,
    /// The number of the current edit.
    edit: u32,
    /// Whether all entries were looked at.
    is_complete: bool,
}

/// The sum of the corners of a triangle: no other triangle of the bisection forest has the same centroid.
type PositionKey = u64;

impl Ages {
    /// Counts another edit: triangles that come from now on belong to it.
    pub fn begin_edit(&mut self) {
        self.edit += 1;
    }

    /// Forgets all triangles: another mesh is shown.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Looks at up to `budget` triangles of a mesh for the first time. They count as made before the first
    /// edit.
    pub fn advance(&mut self, mesh: &Mesh, budget: usize) -> Progress {
        let (from, end) = (self.known.len(), mesh.raw_triangle_count());
        if !self.is_complete {
            let until = end.min(from + budget);
            self.known.extend((from..until).map(|entry| place(mesh, entry)));
            Arc::make_mut(&mut self.born).resize(until, 0);
            self.is_complete = until == end;
        }
        if self.is_complete { Progress::Done } else { Progress::More }
    }

    /// Takes in what an update changed in the mesh. Changes of a mesh that was not completely looked at are
    /// lost: [`Self::advance`] begins again.
    pub fn note(&mut self, changes: &Changes, mesh: &Mesh) {
        if !self.is_complete {
            self.known.clear();
            return;
        }
        let end = mesh.raw_triangle_count();
        let gone = self.gone(changes, mesh);
        self.known.resize(end, PositionKey::MAX);
        let born = Arc::make_mut(&mut self.born);
        born.resize(end, self.edit);
        for entry in changes.triangles.iter().cloned().flatten() {
            let place = place(mesh, entry);
            if self.known[entry] != place {
                self.known[entry] = place;
                let moved = gone.binary_search_by_key(&place, |&(place, _)| place);
                born[entry] = moved.map_or(self.edit, |found| gone[found].1);
            }
        }
    }

    /// Returns the triangles that are no longer in their entry, with the edits that made them, ordered by
    /// place. Gaps are filled with the last entries, so some of them are in another entry now.
    fn gone(&self, changes: &Changes, mesh: &Mesh) -> Vec<(PositionKey, u32)> {
        let (known, end) = (self.known.len(), mesh.raw_triangle_count());
        let changed = changes.triangles.iter().flat_map(|range| range.start..range.end.min(known));
        let replaced = changed.filter(|&entry| self.known[entry] != place(mesh, entry));
        let mut gone: Vec<(PositionKey, u32)> =
            replaced.chain(end..known).map(|entry| (self.known[entry], self.born[entry])).collect();
        gone.sort_unstable();
        gone
    }

    /// Returns the ages as they are, for another thread.
    pub fn snapshot(&self) -> AgesNow {
        AgesNow { born: self.born.clone(), edit: self.edit }
    }
}

/// The ages of triangles at one time.
#[derive(Clone, Debug)]
pub struct AgesNow {
    born: Arc<Vec<u32>>,
    edit: u32,
}

impl AgesNow {
    /// Returns how many edits ago a triangle came, 0 for the last one; `None` if it was there before the
    /// first.
    pub fn of(&self, id: TriangleId) -> Option<u32> {
        let born = *self.born.get(id.index())?;
        (born > 0).then(|| self.edit - born)
    }
}

fn place(mesh: &Mesh, entry: usize) -> PositionKey {
    let corners = mesh.triangle(TriangleId::from_index(entry)).vertices.map(|vertex| mesh.node(vertex));
    let [x, y] = corners.iter().fold([0u64; 2], |[x, y], at| [x + u64::from(at.x), y + u64::from(at.y)]);
    x << 32 | y
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use fastrand::Rng;
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::geometry::{Lattice, LatticePoint, LatticeRect, Rect};
    use crate::mesh::{Limits, Updater};

    /// Returns the corners of each triangle in the order of its entry.
    fn triangles(mesh: &Mesh) -> Vec<[LatticePoint; 3]> {
        let corners = |entry| {
            let mut corners =
                mesh.triangle(TriangleId::from_index(entry)).vertices.map(|vertex| mesh.node(vertex));
            corners.sort_unstable_by_key(|at| (at.x, at.y));
            corners
        };
        (0..mesh.raw_triangle_count()).map(corners).collect()
    }

    /// Referee: after each slice, the triangles are compared with those before by their corners.
    #[test]
    fn triangles_that_stay_keep_their_age_wherever_they_move() {
        let lattice = Lattice::covering(Rect::UNIT, 0.3, 1000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let (mut updater, mut random, mut ages) =
            (Updater::new(Limits::default()), Rng::with_seed(7), Ages::default());
        while ages.advance(&mesh, 5) == Progress::More {}
        let mut expected: HashMap<_, Option<u32>> =
            triangles(&mesh).into_iter().map(|triangle| (triangle, None)).collect();
        let mut kept = 0;
        for edit in 1..=60u32 {
            ages.begin_edit();
            let extent = lattice.extent().as_dvec2();
            let min = extent * dvec2(random.f64(), random.f64());
            let (max, level) = (min + 0.15 * extent, random.u32(0..9));
            updater.add(LatticeRect { min: LatticePoint::new(0, 0), max: lattice.extent() });
            let exceeds = |corners: [LatticePoint; 3], of_level: u32| {
                let corners = corners.map(LatticePoint::as_dvec2);
                let low = corners.into_iter().reduce(DVec2::min).unwrap();
                let high = corners.into_iter().reduce(DVec2::max).unwrap();
                let meets = low.cmple(max).all() && high.cmpge(min).all();
                meets && of_level < level
            };
            while updater.advance(&mut mesh, &|| exceeds, 40).unwrap() == Progress::More {
                if let Some(changes) = updater.take_changes() {
                    ages.note(&changes, &mesh);
                }
                // What went between two slices is new when it comes back.
                let now = triangles(&mesh);
                expected =
                    now.iter().map(|one| (*one, expected.get(one).copied().unwrap_or(Some(edit)))).collect();
            }
            if let Some(changes) = updater.take_changes() {
                ages.note(&changes, &mesh);
            }
            let now = triangles(&mesh);
            expected =
                now.iter().map(|one| (*one, expected.get(one).copied().unwrap_or(Some(edit)))).collect();
            let snapshot = ages.snapshot();
            for (entry, triangle) in now.iter().enumerate() {
                let born = snapshot.of(TriangleId::from_index(entry)).map(|age| edit - age);
                assert_eq!(born, expected[triangle], "edit {edit}, entry {entry}");
                kept += usize::from(born.is_some_and(|born| born < edit));
            }
        }
        assert!(kept > 500, "{kept}");
    }
}
