//! One block: a mesh of its own, and its numbers in the whole mesh.

use super::SharedRule;
use super::plan::Plan;
use super::seams::{SeamEdge, Seams};
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::kernel::memory::Piece;
use crate::mesh::kernel::{
    CoarseIndex, KindCounts, Limits, Mesh, Neighbour, NodeId, RefineError, Refiner, Triangle, TriangleId,
};

/// Some triangles of a mesh, the roots, refined by themselves.
///
/// *Inner* numbers are those in the block, *outer* ones those in the whole mesh. The first triangles are the
/// roots and the first nodes are theirs; they have outer numbers already. All others are the block's own.
#[derive(Clone, Debug)]
pub(super) struct Block {
    mesh: Mesh,
    refiner: Refiner,
    /// Outer numbers of the roots.
    roots: Vec<TriangleId>,
    /// Outer numbers of the nodes of the roots, ascending.
    root_nodes: Vec<NodeId>,
    /// Triangles by kind before the refinement.
    counts_before: KindCounts,
    /// Edges on seams, by seam and start.
    edges: Vec<SeamEdge>,
    /// Outer numbers of all nodes.
    outer_nodes: Vec<NodeId>,
    /// Inner numbers of the nodes that a block joined before has as well, ascending.
    shared: Vec<NodeId>,
    /// Outer number of the first own triangle.
    first_triangle: usize,
}

/// Memory of a block to begin with, in triangles: few need more.
const ROOM: usize = 1 << 16;

impl Block {
    pub fn new(lattice: &Lattice) -> Self {
        let mesh = Mesh {
            lattice: *lattice,
            nodes: Vec::with_capacity(ROOM),
            triangles: Vec::with_capacity(ROOM),
            triangle_at: Vec::with_capacity(ROOM),
            counts: KindCounts::default(),
            coarse: CoarseIndex::default(),
        };
        let refiner = Refiner::new(&mesh, Limits::default());
        let (roots, root_nodes, edges, outer_nodes) = Default::default();
        let counts_before = KindCounts::default();
        Self {
            mesh,
            refiner,
            roots,
            root_nodes,
            counts_before,
            edges,
            outer_nodes,
            shared: Vec::new(),
            first_triangle: 0,
        }
    }

    /// Takes the roots of a block from the mesh, in the memory of an earlier block.
    pub fn load(&mut self, whole: &Mesh, plan: &Plan, block: usize, seams: &Seams) {
        self.roots.clear();
        self.roots.extend_from_slice(plan.roots(block));
        self.root_nodes.clear();
        self.root_nodes.extend(self.roots.iter().flat_map(|&root| whole.triangle(root).vertices));
        self.root_nodes.sort_unstable();
        self.root_nodes.dedup();
        let mesh = &mut self.mesh;
        mesh.nodes.clear();
        mesh.nodes.extend(self.root_nodes.iter().map(|&node| whole.node(node)));
        mesh.triangle_at.clear();
        mesh.triangle_at.resize(mesh.nodes.len(), TriangleId(0));
        mesh.triangles.clear();
        mesh.counts = KindCounts::default();
        for (inner, &root) in self.roots.iter().enumerate() {
            let mut triangle = *whole.triangle(root);
            for vertex in &mut triangle.vertices {
                let place = self.root_nodes.binary_search(vertex).expect("the nodes of all roots are there");
                *vertex = NodeId::from_index(place);
                mesh.triangle_at[place] = TriangleId::from_index(inner);
            }
            for (edge, across) in triangle.raw_neighbours.iter_mut().enumerate() {
                if let Some(id) = across.triangle() {
                    *across = match plan.place_in(block, id) {
                        Some(place) => TriangleId::from_index(place).into(),
                        None => seams.mark(root, edge),
                    };
                }
            }
            mesh.counts.add(triangle.kind());
            mesh.triangles.push(triangle);
        }
        self.counts_before = mesh.counts;
    }

    pub fn refine(&mut self, limits: &Limits, rule: &impl SharedRule) -> Result<(), RefineError> {
        let mut exceeds = rule.exceeds();
        self.refiner.restart_with(&self.mesh, *limits);
        self.refiner.advance(
            &mut self.mesh,
            |element| Ok(exceeds(element.corners, element.triangle.level())),
            usize::MAX,
        )?;
        Ok(())
    }

    /// How many triangles the level cap left coarser than their target.
    pub fn capped(&self) -> usize {
        self.refiner.capped()
    }

    pub fn triangle_count(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// How many triangles the block appends to the mesh.
    pub fn own_triangles(&self) -> usize {
        self.mesh.triangles.len() - self.roots.len()
    }

    /// How many nodes the block appends to the mesh.
    pub fn own_nodes(&self) -> usize {
        self.mesh.nodes.len() - self.root_nodes.len() - self.shared.len()
    }

    /// Finds the edges on seams.
    pub fn find_edges(&mut self, seams: &Seams) {
        self.edges.clear();
        for (index, triangle) in self.mesh.triangles.iter().enumerate() {
            if Neighbour::has_mark(triangle.raw_neighbours) {
                let id = TriangleId::from_index(index);
                self.edges.extend((0..3).filter_map(|edge| seams.edge(&self.mesh, id, edge)));
            }
        }
        self.edges.sort_unstable_by_key(|edge| (edge.seam, edge.start));
    }

    /// Gives the block its outer numbers, behind so many triangles and nodes of the mesh. Nodes on a seam
    /// are those of the block that was joined before, where that has them.
    pub fn join(&mut self, seams: &mut Seams, triangles: usize, nodes: usize) {
        self.first_triangle = triangles;
        self.shared.clear();
        self.outer_nodes.clear();
        self.outer_nodes.extend_from_slice(&self.root_nodes);
        self.outer_nodes.resize(self.mesh.nodes.len(), NodeId(0));
        let mut edges = std::mem::take(&mut self.edges);
        for edge in &mut edges {
            edge.triangle = self.outer_triangle(edge.triangle);
        }
        for of_seam in edges.chunk_by(|a, b| a.seam == b.seam) {
            seams.match_sides(of_seam, |inner, outer| {
                self.outer_nodes[inner.index()] = outer;
                self.shared.push(inner);
            });
        }
        self.shared.sort_unstable();
        self.number_own_nodes(nodes);
        for edge in &mut edges {
            edge.start_node = self.outer_nodes[edge.start_node.index()];
        }
        for of_seam in edges.chunk_by(|a, b| a.seam == b.seam) {
            seams.keep_first_side(of_seam);
        }
        self.edges = edges;
    }

    /// Numbers the nodes that are neither of roots nor shared.
    fn number_own_nodes(&mut self, mut next: usize) {
        let mut first = self.root_nodes.len();
        for end in self.shared.iter().map(|node| node.index()).chain([self.mesh.nodes.len()]) {
            for (node, outer) in self.outer_nodes[first..end].iter_mut().zip(next..) {
                *node = NodeId::from_index(outer);
            }
            next += end - first;
            first = end + 1;
        }
    }

    #[inline]
    fn outer_triangle(&self, inner: TriangleId) -> TriangleId {
        match self.roots.get(inner.index()) {
            Some(&root) => root,
            None => TriangleId::from_index(inner.index() - self.roots.len() + self.first_triangle),
        }
    }

    /// A triangle in outer numbers. Marks stay.
    #[inline]
    fn outer(&self, triangle: &Triangle) -> Triangle {
        let outer_neighbour = |across: Neighbour| match across.triangle() {
            Some(id) => self.outer_triangle(id).into(),
            None => across,
        };
        let ([a, b, c], [m, n, o]) = (triangle.vertices, triangle.raw_neighbours);
        let mut outer = *triangle;
        outer.vertices = [self.outer_node(a), self.outer_node(b), self.outer_node(c)];
        outer.raw_neighbours = [outer_neighbour(m), outer_neighbour(n), outer_neighbour(o)];
        outer
    }

    #[inline]
    fn outer_node(&self, inner: NodeId) -> NodeId {
        self.outer_nodes[inner.index()]
    }

    pub fn write_triangles(&self, piece: &mut Piece<Triangle>) {
        piece.extend(self.mesh.triangles[self.roots.len()..].iter().map(|triangle| self.outer(triangle)));
    }

    pub fn write_nodes(&self, nodes: &mut Piece<LatticePoint>, triangle_at: &mut Piece<TriangleId>) {
        let mut first = self.root_nodes.len();
        for end in self.shared.iter().map(|node| node.index()).chain([self.mesh.nodes.len()]) {
            nodes.extend(self.mesh.nodes[first..end].iter().copied());
            triangle_at.extend(self.mesh.triangle_at[first..end].iter().map(|&id| self.outer_triangle(id)));
            first = end + 1;
        }
    }

    /// What became of the roots, in outer numbers.
    pub fn roots(&self) -> impl Iterator<Item = (TriangleId, Triangle)> + '_ {
        self.roots.iter().zip(&self.mesh.triangles).map(|(&root, triangle)| (root, self.outer(triangle)))
    }

    /// The nodes of the roots, and a triangle around each, in outer numbers.
    pub fn root_nodes(&self) -> impl Iterator<Item = (NodeId, TriangleId)> + '_ {
        let triangle_at = self.mesh.triangle_at.iter().map(|&id| self.outer_triangle(id));
        self.root_nodes.iter().copied().zip(triangle_at)
    }

    /// Counts the triangles of the block in place of its roots.
    pub fn count(&self, counts: &mut KindCounts) {
        counts.replace(&self.counts_before, &self.mesh.counts);
    }
}
