use super::{Neighbour, NodeId};

/// One entry 𝒯\[i\] ∈ ℤ⁸ of the report: 32 plain bytes, uploaded to the GPU as they are.
///
/// Order of the arrays:
/// - `vertices` as Maubach's method leaves them. The bisection edge joins the first vertex to the third at an
///   even level, and to the second at an odd level.
/// - `raw_neighbours` anticlockwise, the one across the bisection edge first.
///
/// Which triangle is the *sibling*, the other child of the same parent, does not always follow from the order
/// of the vertices: at level 1, the four triangles around a node fit both ways. The lattice decides, at every
/// level; the rule and its proof stand at the head of `coarsen.rs`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct Triangle {
    /// References to the three vertices, V(t).
    pub vertices: [NodeId; 3],
    /// References to the three neighbours, N(t), triangles outside a fitted domain among them; see
    /// [`Mesh::neighbours`](crate::mesh::Mesh::neighbours).
    pub raw_neighbours: [Neighbour; 3],
    orientation: u32,
    level_and_side: LevelAndSide,
}

/// The level of a triangle and its side of the boundary in one word: the level, plus
/// [`LevelAndSide::OUTSIDE`] where the triangle lies outside the domain.
///
/// Children are on their parent's side until they are classified themselves.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub(in crate::mesh) struct LevelAndSide(u32);

impl LevelAndSide {
    /// More than any level: the GPU's shader knows this number too.
    const OUTSIDE: u32 = 64;
    /// How many values there can be.
    pub(in crate::mesh) const COUNT: usize = 2 * Self::OUTSIDE as usize;

    #[inline]
    pub(in crate::mesh) const fn inside(level: u32) -> Self {
        Self(level)
    }

    #[inline]
    pub(in crate::mesh) const fn with_outside(self, outside: bool) -> Self {
        Self(self.level() | if outside { Self::OUTSIDE } else { 0 })
    }

    #[inline]
    pub(in crate::mesh) const fn level(self) -> u32 {
        self.0 % Self::OUTSIDE
    }

    #[inline]
    pub(in crate::mesh) const fn is_outside(self) -> bool {
        self.0 >= Self::OUTSIDE
    }

    /// Returns the level and side of the children.
    #[inline]
    pub(in crate::mesh) const fn finer(self) -> Self {
        Self(self.0 + 1)
    }

    /// Returns the level and side of descendants `levels` levels down.
    #[inline]
    pub(in crate::mesh) const fn finer_by(self, levels: u32) -> Self {
        Self(self.0 + levels)
    }

    /// Returns the level and side of the parent.
    #[inline]
    pub(in crate::mesh) const fn coarser(self) -> Self {
        Self(self.0 - 1)
    }

    /// Returns the index in a table of all values.
    #[inline]
    pub(in crate::mesh) const fn index(self) -> usize {
        self.0 as usize
    }
}

/// Which way the vertices of a triangle run around it, O(t).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// O(t) = 0.
    Clockwise,
    /// O(t) = 1.
    Anticlockwise,
}

impl Orientation {
    /// Returns the opposite orientation.
    #[inline]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Clockwise => Self::Anticlockwise,
            Self::Anticlockwise => Self::Clockwise,
        }
    }
}

impl Triangle {
    #[inline]
    pub(in crate::mesh) fn new(
        vertices: [NodeId; 3],
        neighbours: [Neighbour; 3],
        orientation: Orientation,
        level_and_side: LevelAndSide,
    ) -> Self {
        Self { vertices, raw_neighbours: neighbours, orientation: orientation as u32, level_and_side }
    }

    /// Returns this triangle with the vertices and neighbours that it has in another mesh.
    #[inline]
    pub(in crate::mesh) fn renumbered(
        &self,
        vertices: [NodeId; 3],
        neighbours: [Neighbour; 3],
        level_and_side: LevelAndSide,
    ) -> Self {
        Self { vertices, raw_neighbours: neighbours, level_and_side, ..*self }
    }

    /// Returns how many bisections made this triangle from a coarse one, L(t).
    #[doc(alias = "generation")]
    #[doc(alias = "depth")]
    #[inline]
    pub const fn level(&self) -> u32 {
        self.level_and_side.level()
    }

    /// Returns whether the triangle lies outside the domain
    /// ([`Mesh::classify`](crate::mesh::Mesh::classify)) and is kept only so that its neighbours stay
    /// conforming.
    #[inline]
    pub const fn is_outside(&self) -> bool {
        self.level_and_side.is_outside()
    }

    #[inline]
    pub(in crate::mesh) const fn level_and_side(&self) -> LevelAndSide {
        self.level_and_side
    }

    #[inline]
    pub(in crate::mesh) fn set_outside(&mut self, outside: bool) {
        self.level_and_side = self.level_and_side.with_outside(outside);
    }

    /// Which way [`Self::vertices`] run, O(t).
    #[inline]
    pub const fn orientation(&self) -> Orientation {
        if self.orientation == 0 { Orientation::Clockwise } else { Orientation::Anticlockwise }
    }

    /// Returns the place of the second end of the bisection edge among the vertices; the first end is at 0.
    ///
    /// This is k of the report, counted from zero: 2 at even levels, 1 at odd levels.
    #[inline]
    pub const fn bisection_end(&self) -> usize {
        2 - (self.level_and_side.0 & 1) as usize
    }

    /// Returns the ends of the bisection edge, the longest one.
    #[doc(alias = "refinement edge")]
    #[doc(alias = "hypotenuse")]
    #[inline]
    pub const fn bisection_edge(&self) -> [NodeId; 2] {
        [self.vertices[0], self.vertices[self.bisection_end()]]
    }

    /// Returns the vertex opposite the bisection edge, where the right angle is.
    #[inline]
    pub const fn apex(&self) -> NodeId {
        self.vertices[3 - self.bisection_end()]
    }

    /// Returns the vertex that the bisection that made this triangle created; `None` for a coarse triangle.
    ///
    /// It is the apex: bisection puts the midpoint opposite the children's bisection edges.
    #[doc(alias = "peak")]
    #[inline]
    pub const fn newest_vertex(&self) -> Option<NodeId> {
        if self.level() == 0 { None } else { Some(self.apex()) }
    }

    /// Returns the edges as pairs of places among the vertices, each (from, to), anticlockwise around the
    /// triangle and beginning with the bisection edge: edge j is shared with neighbour j (ℰ of the report,
    /// from right to left).
    #[inline]
    pub const fn edges(&self) -> [(usize, usize); 3] {
        match (self.bisection_end(), self.orientation()) {
            (1, Orientation::Clockwise) => [(1, 0), (0, 2), (2, 1)],
            (1, Orientation::Anticlockwise) => [(0, 1), (1, 2), (2, 0)],
            (_, Orientation::Clockwise) => [(0, 2), (2, 1), (1, 0)],
            (_, Orientation::Anticlockwise) => [(2, 0), (0, 1), (1, 2)],
        }
    }

    /// [`Self::edges`] as pairs of nodes.
    #[inline]
    pub const fn edge_nodes(&self) -> [(NodeId, NodeId); 3] {
        let [a, b, c] = self.edges();
        let v = &self.vertices;
        [(v[a.0], v[a.1]), (v[b.0], v[b.1]), (v[c.0], v[c.1])]
    }

    /// Returns whether k and O *match*: k = 1 with O = 0, or k = 2 with O = 1. The one bit that every case of
    /// Algorithms 8, 9, 19 and 21 to 25 depends on.
    #[inline]
    pub(in crate::mesh) const fn matched(&self) -> bool {
        self.bisection_end() as u32 == 1 + self.orientation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_thirty_two_bytes_and_a_node_eight() {
        assert_eq!(size_of::<Triangle>(), 32);
        assert_eq!(size_of::<crate::geometry::LatticePoint>(), 8);
    }
}
