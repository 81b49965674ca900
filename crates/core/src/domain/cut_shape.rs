//! Shapes that are added to a domain or removed from it.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, dvec2};

use super::{Domain, DomainShape, Ring};

/// A shape to add to a domain or to remove from it, in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum CutShape {
    /// The points within `radius` of a polyline; a single point makes a disc.
    Stroke {
        /// The centre of the brush, point by point.
        path: Vec<DVec2>,
        /// The radius of the brush.
        radius: f64,
    },
    /// The points that a ring encloses an odd number of times.
    Ring(Ring),
}

/// Corners of a disc. The polygon deviates from the circle by a 500th of the radius at most.
const DISC_CORNERS: usize = 48;

impl CutShape {
    /// Appends `next`, if both are strokes with the same radius and `next` begins where this one ends.
    /// Returns whether it was appended.
    pub fn join(&mut self, next: &Self) -> bool {
        match (self, next) {
            (Self::Stroke { path, radius }, Self::Stroke { path: next_path, radius: next_radius })
                if radius == next_radius && path.last() == next_path.first() =>
            {
                path.extend_from_slice(&next_path[1..]);
                true
            }
            _ => false,
        }
    }

    /// Returns rings whose union is the shape. The rings of a stroke run anticlockwise; a [`Self::Ring`]
    /// keeps its direction.
    pub fn rings(&self) -> Vec<Ring> {
        match self {
            Self::Ring(ring) => vec![ring.clone()],
            Self::Stroke { path, radius } if path.len() == 1 => vec![capsule(path[0], path[0], *radius)],
            Self::Stroke { path, radius } => {
                path.windows(2).map(|ends| capsule(ends[0], ends[1], *radius)).collect()
            }
        }
    }
}

/// Returns the points within `radius` of a segment, anticlockwise.
fn capsule(from: DVec2, to: DVec2, radius: f64) -> Ring {
    let along = (to - from).normalize_or(DVec2::X);
    let half = DISC_CORNERS / 2;
    let point = |centre: DVec2, k: usize| {
        let angle = TAU * k as f64 / DISC_CORNERS as f64;
        // From the right-hand side of the direction around the end.
        centre + radius * along.rotate(dvec2(libm::sin(angle), -libm::cos(angle)))
    };
    (0..=half).map(|k| point(to, k)).chain((half..=DISC_CORNERS).map(|k| point(from, k))).collect()
}

impl Domain {
    /// Returns the domain with a shape added or removed, within its bounds; `None` for a domain given by a
    /// formula, which has no outline to edit.
    pub fn reshaped(&self, cut_shape: &CutShape, adds: bool) -> Option<Self> {
        let (region, rings) = (self.as_region()?, cut_shape.rings());
        let region = if adds { region.with(&rings) } else { region.without(&rings) };
        Some(Self { shape: DomainShape::Region(Arc::new(region)), ..self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::signed_area;
    use crate::geometry::Rect;

    #[test]
    fn a_stroke_is_as_wide_as_its_brush() {
        let disc = &CutShape::Stroke { path: vec![DVec2::ONE], radius: 2.0 }.rings()[0];
        assert!((signed_area(disc) / (2.0 * TAU) - 1.0).abs() < 5e-3);
        assert!(disc.iter().all(|p| (p.distance(DVec2::ONE) - 2.0).abs() < 1e-12));
        for end in [dvec2(5.0, 1.0), dvec2(1.0, -3.0), dvec2(-2.0, 5.0)] {
            let ring = &CutShape::Stroke { path: vec![DVec2::ONE, end], radius: 0.5 }.rings()[0];
            let expected = DVec2::ONE.distance(end) + 0.125 * TAU;
            assert!((signed_area(ring) / expected - 1.0).abs() < 5e-3, "anticlockwise, and of that area");
        }
    }

    #[test]
    fn a_domain_is_brushed_out_and_in_again() {
        let whole = Domain::rectangle(Rect::UNIT);
        let path = vec![dvec2(0.2, 0.5), dvec2(0.5, 0.6), dvec2(0.8, 0.5)];
        let stroke = CutShape::Stroke { path, radius: 0.05 };
        let cut = whole.reshaped(&stroke, false).unwrap();
        let region = cut.region().unwrap();
        assert_eq!(region.hole_count(), 1);
        assert!((region.area() - (1.0 - 0.0715)).abs() < 1e-3, "{}", region.area());
        let whole_again = cut.reshaped(&stroke, true).unwrap();
        assert_eq!(whole_again.region().unwrap().area(), 1.0);
    }
}
