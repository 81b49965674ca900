//! Connected components by union-find.

/// Nodes in disjoint sets, which grow into the connected components of a graph as its edges are joined.
#[doc(alias = "union-find")]
pub(super) struct DisjointSets(Vec<usize>);

impl DisjointSets {
    /// Returns each node alone.
    pub(super) fn new(nodes: usize) -> Self {
        Self((0..nodes).collect())
    }

    /// Returns the representative of the set of a node.
    pub(super) fn root(&mut self, mut node: usize) -> usize {
        // Ends: the node above has a smaller number. Halves the path on the way.
        while self.0[node] != node {
            self.0[node] = self.0[self.0[node]];
            node = self.0[node];
        }
        node
    }

    /// Unites the sets of two nodes.
    pub(super) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}
