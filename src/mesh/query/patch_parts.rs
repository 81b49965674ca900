//! Removes parts of a mesh with replaced triangles. It has no pinches: its boundary never touches itself.

use std::cmp::Reverse;
use std::collections::HashMap;
use std::mem;

use glam::DVec2;

use super::cleaning::{KeptParts, Removed, RemovedPart};
use super::survey::Forest;
use crate::mesh::extract::{Extract, MeshPatch};
use crate::mesh::kernel::{Mesh, NodeId, TriangleId};

/// A part of an extract. Parts compare by their area, then by place.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Part {
    /// Twice the area, in squares of the lattice.
    doubled: u128,
    lowest: Reverse<[u64; 2]>,
    triangles: usize,
    /// The triangle at the lowest place.
    at: TriangleId,
}

impl MeshPatch {
    /// Removes the parts of the mesh with this patch that do not stay, by changing the patch.
    ///
    /// # Panics
    /// When the patch is of another mesh.
    pub fn keep_parts(&mut self, mesh: &Mesh, kept: KeptParts) -> Removed {
        let extract = mesh.extract_with(self);
        let roots = roots(&extract);
        let parts = parts(&extract, &roots);
        let Some(&largest) = parts.values().max() else { return Removed::default() };
        let whole: u128 = parts.values().map(|part| part.doubled).sum();
        let stays = |part: &Part| match kept {
            KeptParts::All => true,
            KeptParts::Largest => *part == largest,
            KeptParts::Share(share) => *part == largest || part.doubled as f64 >= share * whole as f64,
        };
        let is_removed: Vec<bool> = roots.iter().map(|root| !stays(&parts[root])).collect();
        let mut small: Vec<Part> = parts.into_values().filter(|part| !stays(part)).collect();
        small.sort_unstable_by_key(|part| Reverse(*part));
        let step = mesh.lattice().step();
        let removed = small.iter().map(|part| RemovedPart {
            place: corners_of(&extract, part.at).iter().sum::<DVec2>() / 3.0,
            triangles: part.triangles,
            area: 0.5 * part.doubled as f64 * step.x * step.y,
        });
        let parts: Vec<RemovedPart> = removed.collect();
        drop(extract);
        self.remove(mesh, &is_removed);
        let triangles = parts.iter().map(|part| part.triangles).sum();
        let area = parts.iter().map(|part| part.area).sum();
        Removed { parts, pinches: 0, triangles, area }
    }

    /// Removes triangles by their place in the extract: unchanged ones become changed ones without pieces.
    fn remove(&mut self, mesh: &Mesh, is_removed: &[bool]) {
        let old_pieces = mem::take(&mut self.pieces);
        let mut old_changed = mem::take(&mut self.changed).into_iter().peekable();
        let mut is_removed = is_removed.iter().copied();
        let mut next_is_removed = || is_removed.next().expect("one for each triangle of the extract");
        for (index, triangle) in mesh.raw_triangles().iter().enumerate() {
            let id = TriangleId::from_index(index);
            if let Some((_, pieces)) = old_changed.next_if(|(changed, _)| *changed == id) {
                let first = self.pieces.len();
                self.pieces.extend(old_pieces[pieces].iter().filter(|_| !next_is_removed()));
                self.changed.push((id, first..self.pieces.len()));
            } else if !triangle.is_outside() && next_is_removed() {
                self.changed.push((id, self.pieces.len()..self.pieces.len()));
            }
        }
    }
}

/// For each triangle the number of the one that stands for its part.
fn roots(extract: &Extract) -> Vec<usize> {
    let mut forest = Forest::new(extract.triangles().len());
    for (index, triangle) in extract.triangles().iter().enumerate() {
        let across = triangle.raw_neighbours.into_iter().filter_map(|across| across.triangle());
        across.for_each(|id| forest.join(index, id.index()));
    }
    (0..extract.triangles().len()).map(|index| forest.root(index)).collect()
}

fn parts(extract: &Extract, roots: &[usize]) -> HashMap<usize, Part> {
    let mut parts: HashMap<usize, Part> = HashMap::new();
    for (index, &root) in roots.iter().enumerate() {
        let corners = extract.cell(TriangleId::from_index(index)).corners.map(NodeId::from_index);
        let [a, b, c] = corners.map(|node| extract.node(node)).map(|p| [i128::from(p.x), i128::from(p.y)]);
        let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let lowest = Reverse([a[1] + b[1] + c[1], a[0] + b[0] + c[0]].map(|sum| sum as u64));
        let at = TriangleId::from_index(index);
        let part = parts.entry(root).or_insert(Part { doubled: 0, lowest, triangles: 0, at });
        part.doubled += doubled.unsigned_abs();
        part.triangles += 1;
        if lowest > part.lowest {
            (part.lowest, part.at) = (lowest, at);
        }
    }
    parts
}

fn corners_of(extract: &Extract, id: TriangleId) -> [DVec2; 3] {
    extract.cell(id).corners.map(|node| extract.world(NodeId::from_index(node)))
}
