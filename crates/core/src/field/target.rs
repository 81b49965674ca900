use glam::DVec2;

use crate::mesh::InvalidTarget;

/// Which points of a triangle its target diameter is the minimum over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefinementRule {
    /// The three vertices: Eq. (12) of \[Report\]. A stroke that passes between the nodes is missed.
    Vertex,
    /// The whole closed triangle. Implies Eq. (12), misses nothing, and can be undone locally.
    Area,
}

/// Returns a target diameter that a mesh can meet: a positive, finite length. Both arguments are in world
/// units.
///
/// # Errors
/// Fails with the point and the value, when no mesh can meet it.
#[inline]
pub fn checked_target(value: f64, at: DVec2) -> Result<f64, InvalidTarget> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(InvalidTarget { at, value }) }
}

/// Returns the nearest f32 that is not below `value`, so that rounding never requires one level more.
pub fn f32_not_below(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value { rounded.next_up() } else { rounded }
}
