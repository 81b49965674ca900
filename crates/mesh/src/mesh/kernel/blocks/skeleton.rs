//! The mesh of the blocks: each of its triangles is refined to one depth everywhere.
//!
//! ```text
//!   depth 2     o-----------o-----------o     halves a leg once
//!   depth 4     o-----o-----o-----o-----o     halves it twice
//! ```
//!
//! Where two blocks halve their common edge a different number of times, the one that halves it less is
//! bisected. Its children are blocks of one level less, or single triangles, and so on along the edge: what
//! does not border on it stays in large blocks.

use super::survey::{Slot, Slots, Wanted};
use super::template::halvings;
use crate::mesh::kernel::{LimitError, Limits, Mesh, Progress, TriangleId};

/// Bisections that turn a mesh into that of the blocks, in slices.
#[derive(Clone, Debug)]
pub(super) struct Skeleton {
    /// The planned treatment of each triangle.
    wanted: Vec<Slot>,
    slots: Slots,
    /// Triangles to look at.
    waiting: Vec<TriangleId>,
    chain: Vec<TriangleId>,
}

impl Skeleton {
    /// Creates the work on `mesh`. The slots say what is to become of its triangles.
    pub fn new(mesh: &Mesh, slots: Slots) -> Self {
        let count = mesh.raw_triangle_count();
        let waiting = (0..count).rev().map(TriangleId::from_index).collect();
        Self { wanted: slots[..count].to_vec(), slots, waiting, chain: Vec::new() }
    }

    /// Looks at about `visits` triangles.
    ///
    /// # Errors
    /// Fails when there are more blocks than the limits allow triangles.
    pub fn advance(
        &mut self,
        mesh: &mut Mesh,
        limits: &Limits,
        visits: usize,
    ) -> Result<Progress, LimitError> {
        // Ends: all bisections belong to the smallest mesh.
        for _ in 0..visits {
            let Some(id) = self.waiting.pop() else { return Ok(Progress::Done) };
            if let Some(bisected) = self.unsettled(mesh, id) {
                if bisected != id {
                    self.waiting.push(id);
                }
                self.bisect(mesh, bisected, limits)?;
            }
        }
        Ok(Progress::More)
    }

    /// Returns the triangle to be bisected: this one, or a neighbour that halves a common edge less.
    #[inline]
    fn unsettled(&self, mesh: &Mesh, id: TriangleId) -> Option<TriangleId> {
        let Wanted::Uniform(depth) = self.wanted[id.index()].wanted() else { return Some(id) };
        let neighbours = mesh.triangle(id).raw_neighbours;
        let across = neighbours.into_iter().enumerate().filter_map(|(edge, n)| Some((edge, n.triangle()?)));
        for (edge, across) in across {
            // One that is bisected anyway waits, too.
            let Wanted::Uniform(depth_across) = self.wanted[across.index()].wanted() else { continue };
            let edge_across = edge_shared_with(mesh, across, id);
            let (here, there) = (halvings(depth, edge), halvings(depth_across, edge_across));
            if here != there {
                return Some(if here < there { id } else { across });
            }
        }
        None
    }

    /// Bisects a triangle and what must be bisected with it.
    fn bisect(&mut self, mesh: &mut Mesh, id: TriangleId, limits: &Limits) -> Result<(), LimitError> {
        let Self { wanted, slots, waiting, chain } = self;
        mesh.room_for(id, Mesh::most_new_triangles(mesh.triangle(id).level()), limits)?;
        mesh.refine_triangle_with(id, chain, |_, parent| {
            let new = TriangleId::from_index(wanted.len());
            let [of_kept, of_new] = match wanted[parent.index()].wanted() {
                Wanted::Bisected(first) => [slots[first as usize], slots[first as usize + 1]],
                Wanted::Uniform(depth) => [Wanted::Uniform(depth.saturating_sub(1)).packed(); 2],
                Wanted::Open => unreachable!("the survey has asked about all triangles"),
            };
            wanted[parent.index()] = of_kept;
            wanted.push(of_new);
            waiting.extend([new, parent]);
        });
        Ok(())
    }

    /// Returns for each block the number of levels by which it is refined, once all are settled.
    pub fn finish(self) -> Vec<u8> {
        drop(self.slots);
        let depth = |slot: Slot| match slot.wanted() {
            Wanted::Uniform(depth) => depth as u8,
            Wanted::Open | Wanted::Bisected(_) => unreachable!("all triangles are settled"),
        };
        self.wanted.into_iter().map(depth).collect()
    }
}

/// Which edge of a triangle is shared with this neighbour.
#[inline]
pub(super) fn edge_shared_with(mesh: &Mesh, id: TriangleId, neighbour: TriangleId) -> usize {
    let [first, second, _] = mesh.triangle(id).raw_neighbours.map(|n| n == neighbour.into());
    if first {
        0
    } else if second {
        1
    } else {
        2
    }
}
