//! The topology of a mesh: the numbers of its parts and holes.

use super::forest::Forest;
use crate::mesh::extract::Extract;

/// The shape of a mesh's domain, as the triangles show it.
#[doc(alias = "connected components")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topology {
    /// Nodes that some triangle of the domain has.
    pub nodes: usize,
    /// Connected components: parts whose triangles are joined by edges. Two that only touch in a corner count
    /// as two.
    pub parts: usize,
    /// Holes: places outside that the mesh closes in.
    pub holes: usize,
}

impl Extract<'_> {
    /// Counts nodes, parts and holes.
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

#[cfg(test)]
mod tests {
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Mesh};

    /// Returns a square of 10 × 10 cells without what lies within `radius` (along either axis) of a place.
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

    #[test]
    fn parts_and_holes_are_counted() {
        let topology = |places: &[(DVec2, f64)]| {
            let Topology { nodes, parts, holes } = without(places).extract().topology();
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
}
