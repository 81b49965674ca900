//! Removes the nodes that are no longer needed.

use std::ops::Range;

use super::Updater;
use super::questions::{LooseStar, StarParentQuestions};
use crate::mesh::kernel::coarsen::Star;
use crate::mesh::kernel::{Bitset, Mesh, NodeId, SharedRule, TriangleId, ask_all};

/// Entries that nothing refers to any more.
#[derive(Clone, Debug, Default)]
pub(super) struct Freed {
    triangles: Vec<TriangleId>,
    nodes: Vec<NodeId>,
}

impl Updater {
    /// Looks at up to `most` triangles whose newest vertex may be free to go, and removes the nodes that are.
    /// Returns how many triangles it looked at.
    pub(super) fn coarsen_on<R: SharedRule>(
        &mut self,
        mesh: &mut Mesh,
        rule: &R,
        most: usize,
    ) -> Result<usize, R::Error> {
        // Entries will move: the marks move with them.
        self.forget();
        let (looked, mut stars) = self.take_stars(mesh, most);
        if let Err(error) =
            ask_all(&StarParentQuestions { mesh, level_cap: self.limits.level_cap() }, &mut stars, rule)
        {
            for child in stars.iter().flat_map(|loose| loose.star.children()) {
                self.loose.insert(child.index());
            }
            self.stars = emptied(stars);
            return Err(error);
        }
        for loose in stars.iter().filter(|loose| !loose.is_needed) {
            self.merge(mesh, &loose.star);
        }
        self.remove_freed(mesh);
        self.stars = emptied(stars);
        Ok(looked)
    }

    /// Takes marks until it has looked at `most` triangles. Returns how many it looked at, and each star
    /// found once.
    fn take_stars(&mut self, mesh: &Mesh, most: usize) -> (usize, Vec<LooseStar>) {
        let mut stars = std::mem::take(&mut self.stars);
        for looked in 0..most {
            let Some(last) = self.loose.last() else { return (looked, stars) };
            match mesh.star_of(TriangleId::from_index(last)) {
                None => {
                    self.loose.remove(last);
                }
                Some(star) => {
                    // They have the same newest vertex: one question answers for all of them.
                    star.children().for_each(|child| {
                        self.loose.remove(child.index());
                    });
                    stars.push(LooseStar { star, is_needed: false });
                }
            }
        }
        (most, stars)
    }

    /// Puts the parents of a star back. No triangle has two stars, so that others stay what they are; the
    /// entries that become free are removed after all of them.
    fn merge(&mut self, mesh: &mut Mesh, star: &Star) {
        let parents = mesh.parents(star);
        mesh.merge(star, &parents, &mut self.log);
        for parent in star.places() {
            self.exceeding.remove(parent.index());
            self.loose.insert(parent.index());
        }
        self.freed.triangles.extend(star.freed());
        self.freed.nodes.push(star.centre());
    }

    /// Removes the entries that became free.
    fn remove_freed(&mut self, mesh: &mut Mesh) {
        let Self { freed, reached, exceeding, loose, log, starts, .. } = self;
        if !freed.triangles.is_empty() {
            starts.clear();
        }
        let triangles = ranges(reached, freed.triangles.drain(..).map(TriangleId::index));
        mesh.remove_triangles(&triangles, log, |from, to| {
            exceeding.moved(from, to);
            loose.moved(from, to);
        });
        exceeding.truncate(mesh.raw_triangle_count());
        loose.truncate(mesh.raw_triangle_count());
        let nodes = ranges(reached, freed.nodes.drain(..).map(NodeId::index));
        mesh.remove_nodes(&nodes, log);
    }
}

/// Returns some places as ascending ranges that do not touch, by means of an empty set.
fn ranges(set: &mut Bitset, places: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    places.for_each(|place| {
        set.insert(place);
    });
    set.take_ranges()
}

fn emptied<T>(mut list: Vec<T>) -> Vec<T> {
    list.clear();
    list
}
