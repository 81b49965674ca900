//! How the diameters of a layer change by an edit of its settings.

use super::Combine;
use super::extent::ExtentContext;
use crate::geometry::Rect;
use crate::mesh::TargetChange::{self, Any, Coarser, Finer};

/// The edit of the settings of a layer that stays visible, and is combined as before.
#[derive(Clone, Copy, Debug)]
pub struct LayerEdit<'a> {
    /// How it is combined with the layers below.
    pub combine: Combine,
    /// What decides where the layer asks for something now.
    pub new: &'a ExtentContext<'a>,
    /// What decided it before.
    pub old: &'a ExtentContext<'a>,
    /// Whether the outlines differ.
    pub has_new_outline: bool,
    /// Rectangles in world units that hold every edge that only one of the two outlines has, if they are
    /// known.
    pub outline_areas: Option<&'a [Rect]>,
}

/// How the diameters of a layer change by an edit of its settings.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueChange {
    /// They stay.
    Nothing,
    /// They change in one direction, wherever the layer asks for something before or after.
    Anywhere(TargetChange),
    /// They change in some rectangles only, in steps with a direction each. In a floor or a replacement the
    /// directions do not count.
    Within(Vec<(Vec<Rect>, TargetChange)>),
}

impl ValueChange {
    /// Returns a change in some direction, if there is one.
    pub fn of(direction: Option<TargetChange>) -> Self {
        direction.map_or(Self::Nothing, Self::Anywhere)
    }
}

/// Returns the direction of a change of numbers with which h̄ grows; `None` where none differs.
pub fn direction<const N: usize>(new: [f64; N], old: [f64; N]) -> Option<TargetChange> {
    let all = |holds: fn(&f64, &f64) -> bool| new.iter().zip(&old).all(|(new, old)| holds(new, old));
    if all(|new, old| new == old) {
        None
    } else if all(|new, old| new <= old) {
        Some(Finer)
    } else if all(|new, old| new >= old) {
        Some(Coarser)
    } else {
        Some(Any)
    }
}
