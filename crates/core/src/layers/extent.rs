//! The area in which a layer can have a target diameter.

use super::{Combine, Layer, Mask, PaintLayers, SizeFieldSpec};
use crate::geometry::{Rect, z_order};

/// A part of the plane, in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum Extent {
    /// All of it.
    Everywhere,
    /// These closed rectangles, which may overlap; the list may be empty.
    Within(Vec<Rect>),
}

/// The data besides the layer that decide its extent.
#[derive(Clone, Copy, Debug)]
pub struct ExtentContext<'a> {
    /// The size field that the layer belongs to.
    pub spec: &'a SizeFieldSpec,
    /// The painted pixels.
    pub paint: &'a PaintLayers,
    /// The diameter of a coarse triangle in world units: nothing coarser than this matters to a mesh.
    pub longest: f64,
    /// How many times longer than on the Earth a length counts in the plane; 1 without a projection.
    pub greatest_scale: f64,
}

/// Most rectangles of an extent; more are joined, those that are near to each other first.
const MOST_RECTS: usize = 64;

impl Extent {
    /// No part of the plane.
    pub const NOTHING: Self = Self::Within(Vec::new());

    /// Returns a part of the plane with these rectangles, of which many are joined.
    pub fn of(rects: impl IntoIterator<Item = Rect>) -> Self {
        Self::Within(joined(rects.into_iter().collect(), MOST_RECTS))
    }

    /// Returns the rectangles of the part of the plane in `bounds`.
    pub fn rects_within(self, bounds: Rect) -> Vec<Rect> {
        match self {
            Self::Everywhere => vec![bounds],
            Self::Within(rects) => rects,
        }
    }

    /// Returns the part that lies in the bounds of a mask, if there is one.
    pub fn within_mask(self, mask: Option<&Mask>) -> Self {
        let Some(mask) = mask else { return self };
        match self {
            Self::Everywhere => Self::Within(vec![mask.bounds()]),
            Self::Within(rects) => {
                let bounds = mask.bounds();
                Self::Within(rects.iter().filter_map(|rect| rect.intersection(&bounds)).collect())
            }
        }
    }
}

/// Joins near rectangles until there are at most `most`.
pub fn joined(mut rects: Vec<Rect>, most: usize) -> Vec<Rect> {
    let bounds = rects.iter().copied().reduce(|a, b| a.union(&b));
    let Some(bounds) = bounds.filter(|_| rects.len() > most) else { return rects };
    rects.sort_by_key(|rect| z_order(rect.center(), &bounds));
    let groups = rects.chunks(rects.len().div_ceil(most));
    groups.filter_map(|group| group.iter().copied().reduce(|a, b| a.union(&b))).collect()
}

impl ExtentContext<'_> {
    /// Returns a diameter from which on it makes no difference to the mesh what a layer asks for that is
    /// combined in this way, in world units. Infinite where no such layer may be left out.
    pub fn ceiling_of(&self, combine: Combine) -> f64 {
        let ceiling = self.spec.transfer.h_max.min(self.longest);
        let can_be_left_out = combine == Combine::Finest && self.spec.unasked >= ceiling;
        if can_be_left_out { ceiling } else { f64::INFINITY }
    }
}

impl Layer {
    /// Returns where the layer, if it is visible, can ask for something that matters to the mesh.
    pub(super) fn extent(&self, context: &ExtentContext) -> Extent {
        let of_kind = || self.kind.extent(self, context);
        let extent = if self.is_of_errors() { Extent::NOTHING } else { of_kind() };
        extent.within_mask(self.mask.as_ref())
    }
}
