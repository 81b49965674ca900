//! What kind of shape a mesh has: how many parts, how many holes; and what numbers its triangles have in
//! files.

use crate::mesh::extract::{Extract, Numbering, RankBits};
use crate::mesh::kernel::{Mesh, Progress};

/// The shape of a mesh's domain, as the triangles show it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topology {
    /// Nodes that some triangle of the domain has.
    pub nodes: usize,
    /// Parts that are joined by edges. Where only a corner joins two, they are two.
    pub parts: usize,
    /// Holes: places outside that the mesh closes in.
    pub holes: usize,
}

/// Finds the [`Topology`] and the [`Numbering`] of a mesh, in slices. The mesh must stay as it is meanwhile.
#[derive(Clone, Debug)]
pub struct Survey {
    by_edge: Forest,
    by_corner: Forest,
    belongs: RankBits,
    has_node: Vec<bool>,
    next: usize,
    boundary_edges: usize,
}

impl Survey {
    /// Nothing looked at yet.
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            by_edge: Forest::new(mesh.triangles.len()),
            by_corner: Forest::new(mesh.nodes.len()),
            belongs: RankBits::default(),
            has_node: vec![false; mesh.nodes.len()],
            next: 0,
            boundary_edges: 0,
        }
    }

    /// Looks at at most `visits` further triangles.
    pub fn advance(&mut self, mesh: &Mesh, visits: usize) -> Progress {
        let end = self.next.saturating_add(visits).min(mesh.triangles.len());
        for index in self.next..end {
            let triangle = &mesh.triangles[index];
            self.belongs.push(!triangle.is_outside());
            if triangle.is_outside() {
                continue;
            }
            for across in triangle.raw_neighbours {
                match across.triangle().filter(|&id| mesh.is_in_domain(id)) {
                    Some(id) => self.by_edge.join(index, id.index()),
                    None => self.boundary_edges += 1,
                }
            }
            let [a, b, c] = triangle.vertices.map(|v| v.index());
            self.by_corner.join(a, b);
            self.by_corner.join(a, c);
            for node in [a, b, c] {
                self.has_node[node] = true;
            }
        }
        self.next = end;
        if end == mesh.triangles.len() { Progress::Done } else { Progress::More }
    }

    /// The numbers in files, once done.
    pub fn numbering(&self) -> Numbering {
        Numbering { triangles: self.belongs.clone(), nodes: self.has_node.iter().copied().collect() }
    }

    /// The shape, once done.
    pub fn topology(&self, mesh: &Mesh) -> Topology {
        let belongs = |&index: &usize| !mesh.triangles[index].is_outside();
        let parts = (0..mesh.triangles.len()).filter(belongs).filter(|&n| self.by_edge.is_root(n)).count();
        let nodes = self.has_node.iter().filter(|&&has| has).count();
        let joined =
            (0..self.has_node.len()).filter(|&n| self.has_node[n] && self.by_corner.is_root(n)).count();
        // Euler: nodes − edges + triangles = parts − holes, where parts that share a corner count as one.
        // Each triangle has half of its edges, and the other half of those on the boundary.
        let triangles = mesh.triangle_count();
        let edges = (3 * triangles + self.boundary_edges) / 2;
        Topology { nodes, parts, holes: joined + edges - nodes - triangles }
    }
}

impl Mesh {
    /// Counts parts and holes in one go; [`Survey`] does it in slices.
    pub fn topology(&self) -> Topology {
        let mut survey = Survey::new(self);
        survey.advance(self, usize::MAX);
        survey.topology(self)
    }
}

impl Extract<'_> {
    /// Counts parts and holes in one go.
    pub fn topology(&self) -> Topology {
        let (nodes, triangles) = (self.nodes().len(), self.triangles().len());
        let (mut by_edge, mut by_corner) = (Forest::new(triangles), Forest::new(nodes));
        let mut boundary_edges = 0;
        for (index, triangle) in self.triangles().iter().enumerate() {
            for across in triangle.raw_neighbours {
                match across.triangle() {
                    Some(id) => by_edge.join(index, id.index()),
                    None => boundary_edges += 1,
                }
            }
            let [a, b, c] = triangle.vertices.map(|v| v.index());
            by_corner.join(a, b);
            by_corner.join(a, c);
        }
        let roots = |forest: &Forest, count: usize| (0..count).filter(|&n| forest.is_root(n)).count();
        let (parts, joined) = (roots(&by_edge, triangles), roots(&by_corner, nodes));
        let edges = (3 * triangles + boundary_edges) / 2;
        Topology { nodes, parts, holes: joined + edges - nodes - triangles }
    }
}

/// Disjoint sets of numbers.
#[derive(Clone, Debug)]
pub(super) struct Forest {
    /// Roots point to themselves, and never to a higher number.
    parents: Vec<u32>,
}

impl Forest {
    pub(super) fn new(count: usize) -> Self {
        Self { parents: (0..count as u32).collect() }
    }

    fn is_root(&self, n: usize) -> bool {
        self.parents[n] as usize == n
    }

    pub(super) fn root(&mut self, mut n: usize) -> usize {
        while !self.is_root(n) {
            // Halves the way for the next time.
            self.parents[n] = self.parents[self.parents[n] as usize];
            n = self.parents[n] as usize;
        }
        n
    }

    pub(super) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = a.min(b) as u32;
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, NodeId, TriangleId};

    /// A square of 10 × 10 cells without what lies within `radius` (along either axis) of a place.
    fn without(places: &[(DVec2, f64)]) -> Mesh {
        let mut mesh = Mesh::coarse_grid(
            &Lattice::covering(Rect::UNIT, 0.1, 1_000_000).unwrap(),
            |_| true,
            &Limits::default(),
        )
        .unwrap();
        let all = 0..mesh.raw_triangle_count();
        mesh.classify(all, |element| {
            let centroid = element.world_corners().iter().sum::<DVec2>() / 3.0;
            places.iter().any(|(place, radius)| (centroid - *place).abs().max_element() < *radius)
        });
        mesh
    }

    /// In one go.
    fn numbering(mesh: &Mesh) -> Numbering {
        let mut survey = Survey::new(mesh);
        survey.advance(mesh, usize::MAX);
        survey.numbering()
    }

    #[test]
    fn parts_and_holes_are_counted() {
        let topology = |places: &[(DVec2, f64)]| {
            let Topology { nodes, parts, holes } = without(places).topology();
            (nodes, parts, holes)
        };
        assert_eq!(topology(&[]), (121, 1, 0));
        assert_eq!(topology(&[(dvec2(0.5, 0.5), 0.1)]), (120, 1, 1));
        // Two holes that touch at a corner are two; one at the rim is none.
        assert_eq!(topology(&[(dvec2(0.3, 0.3), 0.1), (dvec2(0.5, 0.5), 0.1)]), (119, 1, 2));
        assert_eq!(topology(&[(dvec2(0.0, 0.5), 0.1)]).1, 1);
        assert_eq!(topology(&[(dvec2(0.0, 0.5), 0.1)]).2, 0);
        // A wall through the middle makes two parts.
        let wall: Vec<_> = (0..=5).map(|k| (dvec2(0.5, 0.2 * f64::from(k)), 0.1)).collect();
        assert_eq!((topology(&wall).1, topology(&wall).2), (2, 0));
        // Nothing left.
        assert_eq!(topology(&[(dvec2(0.5, 0.5), 2.0)]), (0, 0, 0));
    }

    #[test]
    fn slices_do_not_matter() {
        let mesh = without(&[(dvec2(0.5, 0.5), 0.2)]);
        let mut survey = Survey::new(&mesh);
        while survey.advance(&mesh, 7) == Progress::More {}
        assert_eq!(survey.topology(&mesh), mesh.topology());
        let (sliced, whole) = (survey.numbering(), numbering(&mesh));
        let ids = || (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
        assert!(ids().all(|id| sliced.triangle(id) == whole.triangle(id)));
    }

    #[test]
    fn numbers_are_those_of_the_extract() {
        for places in
            [vec![], vec![(dvec2(0.5, 0.5), 0.2)], vec![(dvec2(0.1, 0.1), 0.2), (dvec2(0.9, 0.5), 0.1)]]
        {
            let mesh = without(&places);
            let (numbering, extract) = (numbering(&mesh), mesh.extract());
            for id in (0..mesh.raw_triangle_count()).map(TriangleId::from_index) {
                assert_eq!(numbering.triangle(id), extract.place_of(id), "{id:?}");
            }
            let ids = (0..mesh.raw_nodes().len()).map(NodeId::from_index);
            let numbered: Vec<_> = ids.filter_map(|id| Some((numbering.node(id)?, mesh.node(id)))).collect();
            let listed = extract.nodes().iter().enumerate().map(|(n, &node)| (NodeId::from_index(n), node));
            assert!(listed.eq(numbered), "nodes without {places:?}");
        }
    }
}
