//! The area in which a layer can have a target diameter.

use super::{Combine, Mask, PaintLayers, Shapes};
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
    /// The diameter from which on it makes no difference to the mesh what is asked for, in world units.
    pub ceiling: f64,
    /// Whether h̄ is nowhere larger than where no layer asks for anything.
    pub is_ordered: bool,
    /// The outline of the domain, if the field has one.
    pub outline: Option<&'a Shapes>,
    /// The painted pixels.
    pub paint: &'a PaintLayers,
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
        if self.is_ordered && combine == Combine::Finest { self.ceiling } else { f64::INFINITY }
    }
}
