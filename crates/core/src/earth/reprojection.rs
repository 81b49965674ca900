use glam::{DVec2, dvec2};

use super::{Coordinates, Projection};
use crate::geometry::Rect;

/// Points along each side of a rectangle that is carried.
const POINTS_OF_SIDE: u32 = 64;

/// The way from coordinates to the plane of a projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reprojection {
    /// What the coordinates are.
    pub from: Coordinates,
    /// The projection of the plane.
    pub to: Projection,
}

impl Reprojection {
    /// Returns whether the coordinates are those of the plane.
    pub fn is_identity(&self) -> bool {
        self.from == Coordinates::Plane(self.to)
    }

    /// Returns the point of the plane, in metres, for coordinates.
    pub fn in_plane(&self, at: DVec2) -> DVec2 {
        match self.is_identity() {
            true => at,
            false => self.to.plane_from_geographic(self.from.to_geographic(at)),
        }
    }

    /// Returns the coordinates of a point of the plane. Longitudes are from −180 to 180.
    pub fn from_plane(&self, at: DVec2) -> DVec2 {
        match self.is_identity() {
            true => at,
            false => self.from.from_geographic(self.to.geographic_from_plane(at)),
        }
    }

    /// Returns a rectangle of coordinates that contains those of a rectangle in the plane, where both are in
    /// metres; `None` where it has points without coordinates.
    pub fn rectangle_from_plane(&self, area: Rect) -> Option<Rect> {
        if self.is_identity() {
            return Some(area);
        }
        // Coordinates of planes are harmonic in each other: they are greatest on the sides.
        let share = |n: u32| f64::from(n) / f64::from(POINTS_OF_SIDE);
        let size = area.size();
        let sides = (0..=POINTS_OF_SIDE).map(share).flat_map(|s| {
            [dvec2(s, 0.0), dvec2(s, 1.0), dvec2(0.0, s), dvec2(1.0, s)].map(|share| area.min + share * size)
        });
        let places = sides.map(|at| self.from_plane(at));
        let around = Rect::holding(places).filter(|around| around.size().is_finite())?;
        // The sides bulge between their points.
        let margin = around.size() / f64::from(POINTS_OF_SIDE);
        Some(Rect::new(around.min - margin, around.max + margin))
    }
}
