use crate::mesh::kernel::{Mesh, NodeId};

/// Which nodes are joined by an edge (Algorithm 13), as compressed sparse rows.
///
/// The report reserves 16 places for each node and deletes duplicates afterwards. Here each edge is met once,
/// by the triangle with the lower index, so that no duplicate arises.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adjacency {
    row_starts: Vec<u32>,
    neighbours: Vec<NodeId>,
}

impl Adjacency {
    /// Returns the nodes adjacent to `node`, at most eight, in no particular order.
    ///
    /// # Panics
    /// Panics when the id is not of the mesh that the rows were made from.
    pub fn of(&self, node: NodeId) -> &[NodeId] {
        let (start, end) = (self.row_starts[node.index()], self.row_starts[node.index() + 1]);
        &self.neighbours[start as usize..end as usize]
    }

    /// Returns the number of rows, one for each entry of [`Mesh::raw_nodes`].
    pub fn len(&self) -> usize {
        self.row_starts.len() - 1
    }

    /// Returns whether there is no row. Never true for the rows of a mesh.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of edges of the domain.
    pub fn edge_count(&self) -> usize {
        self.neighbours.len() / 2
    }
}

impl Mesh {
    /// Returns every edge of the domain once, as a pair of nodes.
    pub fn edges(&self) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        self.triangles().flat_map(move |(id, triangle)| {
            let own = move |j: &usize| {
                // The triangle with the lower index has the edge, unless it is outside the domain.
                let across = triangle.raw_neighbours[*j].triangle();
                across.is_none_or(|across| id < across || !self.is_in_domain(across))
            };
            let nodes = triangle.edge_nodes();
            (0..3).filter(own).map(move |j| nodes[j])
        })
    }

    /// Returns the adjacency rows (Algorithm 13), one for each entry of [`Mesh::raw_nodes`], in time
    /// proportional to the mesh. The rows of nodes that only triangles outside the domain have are empty.
    pub fn adjacency(&self) -> Adjacency {
        let mut row_starts = vec![0u32; self.nodes.len() + 1];
        for (a, b) in self.edges() {
            row_starts[a.index() + 1] += 1;
            row_starts[b.index() + 1] += 1;
        }
        for n in 1..row_starts.len() {
            row_starts[n] += row_starts[n - 1];
        }
        let mut next = row_starts.clone();
        let mut neighbours = vec![NodeId(0); row_starts[self.nodes.len()] as usize];
        let mut put = |row: NodeId, neighbour| {
            neighbours[next[row.index()] as usize] = neighbour;
            next[row.index()] += 1;
        };
        for (a, b) in self.edges() {
            put(a, b);
            put(b, a);
        }
        Adjacency { row_starts, neighbours }
    }
}
