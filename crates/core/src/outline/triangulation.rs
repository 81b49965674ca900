//! Triangles as indices, with their neighbours.

/// No triangle, or no node.
pub(super) const NONE: u32 = u32::MAX;

/// Triangles and their neighbours.
#[derive(Clone, Debug, Default)]
pub(super) struct Triangulation {
    /// Nodes, anticlockwise.
    pub(super) corners: Vec<[u32; 3]>,
    /// Triangles across the edges, the i-th opposite the i-th corner, or [`NONE`].
    pub(super) across: Vec<[u32; 3]>,
    /// For each node, one of its triangles, or [`NONE`].
    pub(super) at: Vec<u32>,
}

impl Triangulation {
    pub(super) fn new(nodes: usize, corners: Vec<[u32; 3]>, across: Vec<[u32; 3]>) -> Self {
        let mut at = vec![NONE; nodes];
        for (t, corners) in corners.iter().enumerate().rev() {
            for &v in corners {
                at[v as usize] = t as u32;
            }
        }
        Self { corners, across, at }
    }

    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Returns the position of a node among the corners of a triangle that has it.
    pub(super) fn place(&self, triangle: u32, node: u32) -> usize {
        let [a, b, _] = self.corners[triangle as usize];
        if a == node { 0 } else { 1 + usize::from(b != node) }
    }

    /// Returns the corners of a triangle, beginning with the corner at position `i`.
    pub(super) fn starting_at(&self, triangle: u32, i: usize) -> [u32; 3] {
        let corners = self.corners[triangle as usize];
        [corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]]
    }

    /// Writes the triangles around a node into `star`, anticlockwise, each with the node's position in it. If
    /// the triangles do not close around the node, the first one has no neighbour in clockwise direction.
    pub(super) fn star(&self, node: u32, star: &mut Vec<(u32, usize)>) {
        star.clear();
        let start = self.at[node as usize];
        if start == NONE {
            return;
        }
        let mut first = start;
        loop {
            let before = self.across[first as usize][(self.place(first, node) + 2) % 3];
            if before == NONE || before == start {
                break;
            }
            first = before;
        }
        let first = if self.across[first as usize][(self.place(first, node) + 2) % 3] == NONE {
            first
        } else {
            start
        };
        let mut triangle = first;
        loop {
            let i = self.place(triangle, node);
            star.push((triangle, i));
            triangle = self.across[triangle as usize][(i + 1) % 3];
            if triangle == NONE || triangle == first {
                return;
            }
        }
    }

    /// Replaces the edge opposite the i-th corner of a triangle by the other diagonal of the quadrilateral of
    /// the two triangles beside it.
    ///
    /// ```text
    ///      c                 c
    ///     /|\               / \
    ///    / | \             / u \
    ///   a t|u d    -->    a-----d
    ///    \ | /             \ t /
    ///     \|/               \ /
    ///      b                 b
    /// ```
    pub(super) fn flip(&mut self, t: u32, i: usize) {
        let u = self.across[t as usize][i];
        let [a, b, c] = self.starting_at(t, i);
        let j = 3 - self.place(u, b) - self.place(u, c);
        let d = self.corners[u as usize][j];
        let across = self.across[t as usize];
        let (ca, ab) = (across[(i + 1) % 3], across[(i + 2) % 3]);
        let across = self.across[u as usize];
        let (bd, dc) = (across[(j + 1) % 3], across[(j + 2) % 3]);
        (self.corners[t as usize], self.across[t as usize]) = ([a, b, d], [bd, u, ab]);
        (self.corners[u as usize], self.across[u as usize]) = ([a, d, c], [dc, ca, t]);
        self.reconnect(bd, u, t);
        self.reconnect(ca, t, u);
        for (node, triangle) in [(a, t), (b, t), (c, u), (d, u)] {
            self.at[node as usize] = triangle;
        }
    }

    /// Makes `new` the neighbour of `triangle` in place of `old`.
    fn reconnect(&mut self, triangle: u32, old: u32, new: u32) {
        if let Some(across) = self.across.get_mut(triangle as usize) {
            across.iter_mut().filter(|n| **n == old).for_each(|n| *n = new);
        }
    }
}
