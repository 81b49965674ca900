//! Flags that say which triangles of a mesh are drawn, and which are outside the domain.

#[cfg(feature = "gpu")]
use std::ops::Range;

#[cfg(feature = "gpu")]
use meshbrush_mesh::mesh::Triangle;
use meshbrush_mesh::mesh::{PatchPieces, TriangleId};

const BITS_PER_ENTRY: usize = 4;
const ENTRIES_PER_WORD: usize = u32::BITS as usize / BITS_PER_ENTRY;

/// The triangle is outside the domain.
#[cfg(feature = "gpu")]
const OUTSIDE: u32 = 1;
/// A patch replaces the triangle.
const REPLACED: u32 = 2;
/// The patch draws pieces in place of the triangle.
const HAS_PIECES: u32 = 4;

/// Four bits per triangle of a mesh, in the words that mesh.wgsl reads. All bits are zero for a triangle that
/// is drawn, and for an index at or beyond the end of the array.
///
/// The bits of a neighbour say whether an edge is on the boundary, also where the neighbour is in another
/// buffer.
#[derive(Clone, Debug, Default)]
pub(super) struct DrawFlags {
    words: Vec<u32>,
}

impl DrawFlags {
    /// Returns flags for `count` triangles, of which `pieces` replace some. Triangles outside the domain are
    /// not marked.
    pub(super) fn from_pieces(pieces: &PatchPieces, count: usize) -> Self {
        let mut flags = Self::default();
        flags.resize(count);
        pieces.replacements().for_each(|(id, range)| flags.replace(id, !range.is_empty()));
        flags
    }

    /// Keeps the flags of the first `count` triangles.
    pub(super) fn resize(&mut self, count: usize) {
        self.words.resize(count.div_ceil(ENTRIES_PER_WORD), 0);
        if let Some(last) = self.words.last_mut()
            && !count.is_multiple_of(ENTRIES_PER_WORD)
        {
            *last &= (1 << (count % ENTRIES_PER_WORD * BITS_PER_ENTRY)) - 1;
        }
    }

    /// Returns whether the triangle itself is drawn.
    #[inline]
    pub(super) fn is_drawn(&self, index: usize) -> bool {
        self.get(index) == 0
    }

    /// Returns whether nothing is drawn in the place of the triangle.
    #[inline]
    pub(super) fn is_vacant(&self, index: usize) -> bool {
        let flags = self.get(index);
        flags != 0 && flags & HAS_PIECES == 0
    }

    /// Marks a triangle that a patch replaces.
    #[inline]
    pub(super) fn replace(&mut self, id: TriangleId, has_pieces: bool) {
        let flags = if has_pieces { REPLACED | HAS_PIECES } else { REPLACED };
        self.set(id.index(), REPLACED | HAS_PIECES, flags);
    }
}

/// Functions that only the copy of a mesh on the GPU needs.
#[cfg(feature = "gpu")]
impl DrawFlags {
    pub(super) fn clear(&mut self) {
        self.words.clear();
    }

    pub(super) fn words(&self) -> &[u32] {
        &self.words
    }

    /// Returns the words with the flags of these triangles.
    pub(super) fn words_of(triangles: Range<usize>) -> Range<usize> {
        triangles.start / ENTRIES_PER_WORD..triangles.end.div_ceil(ENTRIES_PER_WORD)
    }

    /// Clears the marks that [`Self::replace`] set.
    #[inline]
    pub(super) fn restore(&mut self, id: TriangleId) {
        self.set(id.index(), REPLACED | HAS_PIECES, 0);
    }

    /// Marks which of these triangles are outside the domain.
    pub(super) fn classify(&mut self, range: Range<usize>, triangles: &[Triangle]) {
        for index in range {
            self.set(index, OUTSIDE, u32::from(triangles[index].is_outside()));
        }
    }
}

impl DrawFlags {
    #[inline]
    fn get(&self, index: usize) -> u32 {
        let shift = index % ENTRIES_PER_WORD * BITS_PER_ENTRY;
        self.words.get(index / ENTRIES_PER_WORD).map_or(0, |word| word >> shift & 0xf)
    }

    /// Sets the bits of `mask` to those of `flags`.
    #[inline]
    fn set(&mut self, index: usize, mask: u32, flags: u32) {
        let shift = index % ENTRIES_PER_WORD * BITS_PER_ENTRY;
        if let Some(word) = self.words.get_mut(index / ENTRIES_PER_WORD) {
            *word = *word & !(mask << shift) | flags << shift;
        }
    }
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;

    #[test]
    fn flags_of_neighbouring_entries_are_independent() {
        let mut flags = DrawFlags::default();
        flags.resize(20);
        flags.set(7, OUTSIDE, OUTSIDE);
        flags.set(8, REPLACED | HAS_PIECES, REPLACED | HAS_PIECES);
        let drawn = |flags: &DrawFlags| (0..24).filter(|&index| flags.is_drawn(index)).count();
        assert_eq!((drawn(&flags), flags.is_vacant(7), flags.is_vacant(8)), (22, true, false));
        flags.restore(TriangleId::from_index(7));
        flags.restore(TriangleId::from_index(8));
        assert_eq!((drawn(&flags), flags.is_vacant(7), flags.is_vacant(8)), (23, true, false));
        flags.set(100, OUTSIDE, OUTSIDE);
        assert!(flags.is_drawn(100), "behind the end");
    }

    #[test]
    fn a_mesh_that_shrinks_and_grows_again_has_no_old_flags() {
        let mut flags = DrawFlags::default();
        flags.resize(20);
        (0..20).for_each(|index| flags.set(index, OUTSIDE, OUTSIDE));
        flags.resize(11);
        flags.resize(20);
        assert_eq!(
            (0..20).filter(|&index| flags.is_drawn(index)).collect::<Vec<_>>(),
            Vec::from_iter(11..20)
        );
    }
}
