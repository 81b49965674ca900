//! Places on the lattice as numbers.

use crate::geometry::LatticePoint;

/// A place on the lattice as one number: of a node, or three times the centroid of a triangle. No triangle
/// has the same centroid as one of its ancestors.
pub(crate) type PlaceKey = u64;

pub(super) fn node_place(point: LatticePoint) -> PlaceKey {
    u64::from(point.x) << 32 | u64::from(point.y)
}

/// Returns the node of a place.
pub(super) fn node_at(place: PlaceKey) -> LatticePoint {
    LatticePoint::new((place >> 32) as u32, place as u32)
}

pub(crate) fn triangle_place(corners: [LatticePoint; 3]) -> PlaceKey {
    let sum = |c: fn(&LatticePoint) -> u32| corners.iter().map(|p| u64::from(c(p))).sum::<u64>();
    sum(|p| p.x) << 32 | sum(|p| p.y)
}
