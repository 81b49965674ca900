/// Nodes in parts that hang together, by union and find.
pub(super) struct Parts(Vec<usize>);

impl Parts {
    /// Returns each node alone.
    pub(super) fn new(nodes: usize) -> Self {
        Self((0..nodes).collect())
    }

    /// Returns a node that stands for the part of another.
    pub(super) fn root(&mut self, mut node: usize) -> usize {
        // Ends: the node above has a smaller number.
        while self.0[node] != node {
            self.0[node] = self.0[self.0[node]];
            node = self.0[node];
        }
        node
    }

    /// Makes one part of those of two nodes.
    pub(super) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}
