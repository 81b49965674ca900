//! Which triangles are bisected for a smaller error.

use super::bound::ErrorBound;
use super::fem_mesh::FemMesh;
use crate::geometry::NumberMap;
use crate::mesh::TriangleId;

impl ErrorBound {
    /// Returns the fewest triangles that have at least a share of the square of the bound \[Dorfler1996\],
    /// the worst first: bisected again and again, they have the best rate \[Stevenson2007\]. Of equal ones
    /// those come first that do on the space-filling curve, so that the order of the mesh's entries changes
    /// nothing.
    ///
    /// `sources` are the triangles of the mesh that those of the extract are, or replace
    /// ([`Mesh::sources_with`](crate::mesh::Mesh::sources_with)): of pieces along the outline, their triangle
    /// is marked.
    pub fn marked(&self, mesh: &FemMesh, sources: &[TriangleId], share: f64) -> Vec<TriangleId> {
        let mut place: NumberMap<usize, usize> = NumberMap::default();
        let mut parts: Vec<(f64, TriangleId)> = Vec::new();
        for (triangle, part) in self.of_triangles.iter().enumerate() {
            let source = sources[mesh.triangle_in_extract(triangle)];
            let n = *place.entry(source.index()).or_insert(parts.len());
            match parts.get_mut(n) {
                Some((sum, _)) => *sum += part * part,
                None => parts.push((part * part, source)),
            }
        }
        // Sorting keeps the order of equal ones.
        parts.sort_by(|a, b| b.0.total_cmp(&a.0));
        let total: f64 = parts.iter().map(|(part, _)| part).sum();
        let mut sum = 0.0;
        let is_needed = |(part, _): &&(f64, TriangleId)| {
            let is_needed = sum < share * total;
            sum += part;
            is_needed
        };
        parts.iter().take_while(is_needed).map(|(_, source)| *source).collect()
    }
}
