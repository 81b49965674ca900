//! A copy of a mesh in slices.

use super::{Mesh, Progress, memory};

/// Copies a mesh in slices. The mesh must not change in the meantime.
///
/// ```text
///  source  ████████████████████████
///  copy    ██████████░░░░░░░░░░░░░░   each slice appends entries to the arrays of triangles and nodes
/// ```
///
/// Memory is reserved in one step, which takes no time: it is used only as it is written.
#[derive(Clone, Debug)]
pub struct MeshCopy {
    copy: Mesh,
}

/// Number of entries of each array that are copied for one unit of the budget, which is about the time of a
/// visit to a triangle.
const ENTRIES_PER_UNIT: usize = 8;

impl MeshCopy {
    /// Creates a copy of `source`, still empty but for the index of coarse triangles.
    pub fn new(source: &Mesh) -> Self {
        let mut copy = Mesh {
            lattice: source.lattice,
            nodes: Vec::new(),
            triangles: Vec::new(),
            triangle_at: Vec::new(),
            counts: source.counts,
            coarse: source.coarse.clone(),
        };
        memory::make_room(&mut copy.nodes, source.nodes.len(), source.nodes.capacity());
        memory::make_room(&mut copy.triangles, source.triangles.len(), source.triangles.capacity());
        memory::make_room(&mut copy.triangle_at, source.triangle_at.len(), source.triangle_at.capacity());
        Self { copy }
    }

    /// One slice of work: about eight times `budget` triangles, and as many nodes.
    ///
    /// `source` must be the mesh that the work began with, unchanged.
    pub fn advance(&mut self, source: &Mesh, budget: usize) -> Progress {
        let entries = budget.max(1).saturating_mul(ENTRIES_PER_UNIT);
        append(&mut self.copy.nodes, &source.nodes, entries);
        append(&mut self.copy.triangles, &source.triangles, entries);
        append(&mut self.copy.triangle_at, &source.triangle_at, entries);
        // Triangles may be fewer than nodes only in a mesh of single triangles; both are compared.
        let whole = self.copy.triangles.len() == source.triangles.len()
            && self.copy.nodes.len() == source.nodes.len();
        if whole { Progress::Done } else { Progress::More }
    }

    /// Returns how many triangles are copied so far.
    pub fn triangles(&self) -> usize {
        self.copy.triangles.len()
    }

    /// Returns the copy.
    ///
    /// # Panics
    /// Panics when it is not whole: its counts would not be those of its triangles.
    pub fn finish(self) -> Mesh {
        let counted: usize = self.copy.counts.0.iter().map(|&n| n as usize).sum();
        assert_eq!(counted, self.copy.triangles.len(), "a copy is finished once `advance` returns `Done`");
        self.copy
    }
}

/// Appends the next entries of `source`, at most `entries` of them.
fn append<T: Copy>(copy: &mut Vec<T>, source: &[T], entries: usize) {
    let first = copy.len();
    let end = first.saturating_add(entries).min(source.len());
    copy.extend_from_slice(&source[first..end]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::Limits;

    #[test]
    fn a_copy_grows_by_slices_and_is_equal_once_whole() {
        let lattice = Lattice::covering(Rect::UNIT, 0.1, 1000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |node| node.x + node.y > 0.3, &Limits::default()).unwrap();
        mesh.refine(&Limits::default(), |element| element.diameter() > 0.01).unwrap();
        let mut copying = MeshCopy::new(&mesh);
        let (mut copied, mut slices) = (0, 0);
        while copying.advance(&mesh, 50) == Progress::More {
            assert!(copying.triangles() - copied <= 50 * ENTRIES_PER_UNIT);
            (copied, slices) = (copying.triangles(), slices + 1);
        }
        assert!(slices >= mesh.raw_triangle_count() / (50 * ENTRIES_PER_UNIT) - 1, "{slices}");
        let copy = copying.finish();
        assert!(copy.raw_triangles() == mesh.raw_triangles() && copy.raw_nodes() == mesh.raw_nodes());
        assert_eq!(copy.violations(), []);
    }
}
