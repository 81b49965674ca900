//! Point location in a mesh with some of its triangles replaced.

use std::collections::BTreeSet;

use glam::DVec2;

use super::Location;
use crate::geometry::{LatticePoint, NumberMap, Side, side_of_line};
use crate::mesh::extract::{Extract, MeshPatch};
use crate::mesh::kernel::{Mesh, NodeId, Triangle, TriangleId};

/// Finds points in the triangles of an extract with a [`MeshPatch`].
///
/// Far from changed triangles the mesh finds them. The others are in squares of about their own size, so
/// that each is in at most four squares.
#[derive(Clone, Debug)]
pub struct PatchedLocator {
    /// Triangles of the extract at and around changes, by the size of their squares and the square.
    squares: NumberMap<(u32, [u32; 2]), Vec<TriangleId>>,
    /// The sizes that occur: binary logarithms of the sides, in lattice steps.
    sizes: BTreeSet<u32>,
}

impl PatchedLocator {
    /// Creates a locator for `extract`, which must be [`Mesh::extract_with`] of the patch.
    pub fn new(mesh: &Mesh, patch: &MeshPatch, extract: &Extract) -> Self {
        let mut at_change = vec![false; mesh.nodes.len()];
        for (id, _) in &patch.changed {
            mesh.triangle(*id).vertices.iter().for_each(|v| at_change[v.index()] = true);
        }
        let mut is_far = vec![false; extract.triangles().len()];
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            if let Some(place) = extract.place_of(TriangleId::from_index(index)) {
                is_far[place.index()] = !triangle.vertices.iter().any(|v| at_change[v.index()]);
            }
        }
        let mut locator = Self { squares: NumberMap::default(), sizes: BTreeSet::new() };
        for (number, triangle) in extract.triangles().iter().enumerate().filter(|(n, _)| !is_far[*n]) {
            locator.insert(extract, TriangleId::from_index(number), triangle);
        }
        locator
    }

    fn insert(&mut self, extract: &Extract, number: TriangleId, triangle: &Triangle) {
        let corners = triangle.vertices.map(|v| extract.node(v));
        let low = corners.into_iter().reduce(|a, b| LatticePoint::new(a.x.min(b.x), a.y.min(b.y)));
        let high = corners.into_iter().reduce(|a, b| LatticePoint::new(a.x.max(b.x), a.y.max(b.y)));
        let (Some(low), Some(high)) = (low, high) else { return };
        let size = (high.x - low.x).max(high.y - low.y).next_power_of_two().trailing_zeros();
        self.sizes.insert(size);
        for x in low.x >> size..=high.x >> size {
            for y in low.y >> size..=high.y >> size {
                self.squares.entry((size, [x, y])).or_default().push(number);
            }
        }
    }

    /// Finds the triangle of the extract that contains a point in world coordinates. `in_mesh` is the point's
    /// location in the mesh. Ids in the answer are ids of the extract; of several triangles, it has the one
    /// with the lowest id. `extract` must be the one that the locator was made for.
    pub fn locate(&self, extract: &Extract, point: DVec2, in_mesh: Location) -> Location {
        if matches!(in_mesh, Location::OutsideBounds | Location::Invalid) {
            return in_mesh;
        }
        let p = extract.lattice().lattice_from_world(point);
        let unchanged = in_mesh.triangle().and_then(|id| extract.place_of(id));
        let near = self.sizes.iter().flat_map(|&size| {
            let square = [p.x as u32 >> size, p.y as u32 >> size];
            self.squares.get(&(size, square)).into_iter().flatten().copied()
        });
        let found = near.chain(unchanged).filter_map(|number| Some((number, sides(extract, number, p)?)));
        let Some((triangle, sides)) = found.min_by_key(|(number, _)| *number) else {
            return Location::OutsideDomain;
        };
        let on = sides.map(|side| side == Side::On);
        match on.iter().filter(|&&on| on).count() {
            0 => Location::Inside { triangle },
            1 => Location::OnEdge { triangle, edge: on.iter().position(|&on| on).unwrap_or(0) },
            _ => Location::OnVertex { triangle, node: shared_end(extract, triangle, on) },
        }
    }
}

/// Returns the sides of a triangle's edges on which a point is; `None` if the point is outside the triangle.
fn sides(extract: &Extract, number: TriangleId, p: DVec2) -> Option<[Side; 3]> {
    let edges = extract.triangles()[number.index()].edge_nodes();
    let sides = edges.map(|(a, b)| side_of_line(extract.node(a), extract.node(b), p));
    (!sides.contains(&Side::Right)).then_some(sides)
}

/// Returns the node that two edges of a triangle share.
fn shared_end(extract: &Extract, number: TriangleId, on: [bool; 3]) -> NodeId {
    let first = (0..3).find(|&j| on[j] && on[(j + 1) % 3]).unwrap_or(0);
    extract.triangles()[number.index()].edge_nodes()[first].1
}
