//! A node of a mesh, and the nodes that it has to do with.

use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, NodeId, TreeTriangle};

/// A node, its neighbourhood and its place in the hierarchy of nodes.
///
/// ```text
///    p0 ------ m ------ p1       m came into being in the middle between its parent nodes p0 and p1; nodes
///        \   / | \   /           that come between m and another corner depend on it: they cannot be there
///          d   |   d             without m
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct NodeFacts {
    /// The position of the node.
    pub at: LatticePoint,
    /// The nodes that share an edge with it (Algorithm 13), anticlockwise.
    pub adjacent: Vec<NodeId>,
    /// Local triangulation diameter h(x), in world units: the distance to the farthest adjacent node.
    pub diameter: f64,
    /// The ends of the edge that was bisected here; `None` of a coarse node.
    pub parents: Option<[LatticePoint; 2]>,
    /// The nodes of the mesh whose bisection needed this node, and no other node of their own level.
    pub dependents: Vec<LatticePoint>,
}

impl NodeFacts {
    /// Returns the facts about a node of a mesh.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    pub fn new(mesh: &Mesh, node: NodeId) -> Self {
        let at = mesh.node(node);
        let adjacent = adjacent(mesh, node);
        let here = mesh.world(node);
        let diameter = adjacent.iter().map(|&other| mesh.world(other).distance(here)).fold(0.0, f64::max);
        let maker = maker(mesh, node);
        let parents = maker.map(|parent| {
            let [_, from, to] = parent.corners();
            [from, to]
        });
        let dependents = maker.map_or_else(Vec::new, |parent| dependents(mesh, &parent));
        Self { at, adjacent, diameter, parents, dependents }
    }
}

fn adjacent(mesh: &Mesh, node: NodeId) -> Vec<NodeId> {
    let mut adjacent = Vec::new();
    for id in mesh.triangles_around(node) {
        for vertex in mesh.triangle(id).vertices {
            if vertex != node && !adjacent.contains(&vertex) {
                adjacent.push(vertex);
            }
        }
    }
    adjacent
}

/// Returns a triangle whose bisection made the node.
fn maker(mesh: &Mesh, node: NodeId) -> Option<TreeTriangle> {
    let (at, lattice) = (mesh.node(node), mesh.lattice());
    let leaf = TreeTriangle::from_mesh(mesh, mesh.triangles_around(node).next()?);
    let mut line = leaf.ancestors(lattice);
    line.push(leaf);
    // The first triangle with this corner, from the coarse one down, has it as its apex: it is half of the
    // maker. A coarse node is a corner of the coarse triangle.
    let first = line.into_iter().find(|triangle| triangle.corners().contains(&at))?;
    first.parent(lattice)
}

/// Returns the nodes in the middle of the halves of the triangle and of the one across, if they exist.
fn dependents(mesh: &Mesh, parent: &TreeTriangle) -> Vec<LatticePoint> {
    let pair = [Some(*parent), parent.across(mesh)];
    let halves = pair.iter().flatten().flat_map(TreeTriangle::children);
    let mut dependents: Vec<_> =
        halves.filter(|half| mesh.is_bisected(half)).map(|half| half.midpoint()).collect();
    dependents.dedup();
    dependents
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::Limits;

    #[test]
    fn adjacent_nodes_parents_and_dependents_are_those_of_the_mesh() {
        let lattice = Lattice::covering(Rect::UNIT, 0.3, 1000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let coarse = mesh.nodes().count();
        mesh.refine(&Limits::default(), |element| {
            let near = element.world_corners().iter().any(|x| x.distance(glam::dvec2(0.4, 0.3)) < 0.15);
            element.triangle.level() < if near { 7 } else { 2 }
        })
        .unwrap();
        let adjacency = mesh.adjacency();
        let mut with_dependents = 0;
        for (node, at) in mesh.nodes() {
            let facts = NodeFacts::new(&mesh, node);
            let mut adjacent = facts.adjacent.clone();
            adjacent.sort();
            let mut row = adjacency.of(node).to_vec();
            row.sort();
            assert_eq!(adjacent, row, "{node:?}");
            assert_eq!(facts.parents.is_none(), node.index() < coarse);
            if let Some([from, to]) = facts.parents {
                assert_eq!(from.midpoint(to), at);
            }
            with_dependents += usize::from(!facts.dependents.is_empty());
            for dependent in &facts.dependents {
                let (other, _) = mesh.nodes().find(|(_, place)| place == dependent).unwrap();
                assert!(other > node, "it was made later");
            }
        }
        assert!(with_dependents > 10, "{with_dependents}");
    }
}
