use super::MOST_TRIANGLES;

/// A node by its place in [`Mesh::nodes`](crate::mesh::Mesh::nodes), from zero.
///
/// Refinement keeps all ids. Coarsening fills gaps with the last node, never with a coarse one: those keep
/// their ids.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct NodeId(pub(in crate::mesh) u32);

impl NodeId {
    /// Returns the id of the node at `index` of the node array.
    ///
    /// # Panics
    /// Panics when the index is above [`MOST_TRIANGLES`]: there are no such ids.
    #[inline]
    pub const fn from_index(index: usize) -> Self {
        assert!(index <= MOST_TRIANGLES, "the index of a node is larger than any mesh");
        Self(index as u32)
    }

    /// Returns the place in the node array.
    #[inline]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A triangle by its place in [`Mesh::triangles`](crate::mesh::Mesh::triangles), from zero.
///
/// Refinement keeps the index of a bisected triangle for one of its children, and coarsening gives a parent
/// the lower index of its children's, so the entry with a coarse triangle's index is always one of that
/// triangle's descendants. Coarsening fills gaps with the last entry: beyond the coarse triangles an id says
/// nothing about the triangle that an update leaves there.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct TriangleId(pub(in crate::mesh) u32);

impl TriangleId {
    /// Returns the id of the triangle at `index` of the triangle array.
    ///
    /// # Panics
    /// Panics when the index is above [`MOST_TRIANGLES`]: there are no such ids.
    #[inline]
    pub const fn from_index(index: usize) -> Self {
        assert!(index <= MOST_TRIANGLES, "the index of a triangle is larger than any mesh");
        Self(index as u32)
    }

    /// Returns the place in the triangle array.
    #[inline]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// The neighbour across an edge: a triangle, or the boundary of the domain (β of the report).
#[repr(transparent)]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct Neighbour(u32);

impl Neighbour {
    /// The boundary of the domain: no triangle is across the edge.
    pub const BOUNDARY: Self = Self(u32::MAX);

    /// Returns the triangle across the edge, or `None` at the boundary.
    #[inline]
    pub const fn triangle(self) -> Option<TriangleId> {
        if self.0 == Self::BOUNDARY.0 { None } else { Some(TriangleId(self.0)) }
    }

    /// Returns the entry `places` places further on; only for triangles.
    #[inline]
    pub(super) const fn behind(self, places: u32) -> Self {
        Self(self.0.wrapping_add(places))
    }
}

impl From<TriangleId> for Neighbour {
    #[inline]
    fn from(id: TriangleId) -> Self {
        Self(id.0)
    }
}

impl std::fmt::Debug for Neighbour {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.triangle() {
            Some(id) => write!(f, "{}", id.0),
            None => f.write_str("boundary"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "larger than any mesh")]
    fn an_index_beyond_all_ids_is_refused() {
        TriangleId::from_index(1 << 32);
    }
}
