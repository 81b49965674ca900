//! What the neighbours of a block must know of it.

use super::skeleton::edge_shared_with;
use super::template::Template;
use crate::mesh::kernel::{Mesh, TriangleId};

/// Where the form of [`Template::form`] begins: above the depth.
const FORM: u32 = 4;
/// Where the edges across begin, two bits each.
const ACROSS: u32 = 6;
/// Where the bits begin that say which edges the block owns.
const OWNED: u32 = 12;

/// Depth, form and edges of a block in two bytes. They are known before the first block is written, because
/// the first triangle of a block takes the place of the block in the array.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape(u16);

impl Shape {
    /// Returns the shape of a triangle of the skeleton that is refined by `depth` levels.
    pub fn new(skeleton: &Mesh, block: TriangleId, depth: u32) -> Self {
        let triangle = skeleton.triangle(block);
        let mut bits = depth | (Template::form(triangle) as u32) << FORM;
        for (edge, across) in (0..).zip(triangle.raw_neighbours) {
            let owns = match across.triangle() {
                Some(across) => {
                    bits |= (edge_shared_with(skeleton, across, block) as u32) << (ACROSS + 2 * edge);
                    across > block
                }
                None => true,
            };
            bits |= u32::from(owns) << (OWNED + edge);
        }
        Self(bits as u16)
    }

    /// Returns the number of levels by which the block is refined.
    #[inline]
    pub fn depth(self) -> u32 {
        u32::from(self.0) & ((1 << FORM) - 1)
    }

    /// Returns whether the block is one triangle.
    #[inline]
    pub fn is_one(self) -> bool {
        self.depth() == 0
    }

    #[inline]
    pub fn template(self) -> &'static Template {
        Template::of_form(usize::from(self.0) >> FORM & 3, self.depth())
    }

    /// Returns which edge of the block across this edge it is.
    #[inline]
    pub fn edge_across(self, edge: usize) -> usize {
        usize::from(self.0) >> (ACROSS as usize + 2 * edge) & 3
    }

    /// Returns whether the nodes within an edge belong to this block: the one with the lower number.
    #[inline]
    pub fn owns(self, edge: usize) -> bool {
        self.0 >> (OWNED as usize + edge) & 1 == 1
    }
}
