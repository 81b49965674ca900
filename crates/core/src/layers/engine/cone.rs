//! Directions near one direction.

use glam::DVec2;

use crate::geometry::Rect;

/// All vectors, of any length, whose direction differs from a unit vector by at most a spread: as the
/// gradients of a function that only grows away from a point, in a rectangle at some distance from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// A unit vector.
    toward: DVec2,
    /// The largest length of the difference of unit vectors, below 1.
    spread: f64,
}

/// Bound of the effect of rounding on a direction.
const ROUNDING: f64 = 1e-9;

impl Cone {
    /// Returns the directions from a point to the points of a rectangle, if they are near each other.
    ///
    /// Within the radius r of a vector of the length d, unit vectors change by at most 2 r / (2 d − r).
    pub fn from_point(point: DVec2, rect: &Rect) -> Option<Self> {
        let (away, radius) = (rect.center() - point, 0.5 * rect.size().length());
        let distance = away.length();
        let spread = 2.0 * radius / (2.0 * distance - radius);
        (distance > 1.5 * radius).then(|| Self { toward: away / distance, spread: spread + ROUNDING })
    }

    /// Returns the unit vector in the middle.
    pub fn toward(self) -> DVec2 {
        self.toward
    }

    /// Returns the largest length of the difference between a unit vector of the cone and the one in the
    /// middle.
    pub fn spread(self) -> f64 {
        self.spread
    }

    /// Returns the opposite directions.
    pub fn opposite(self) -> Self {
        Self { toward: -self.toward, ..self }
    }

    /// Returns a cone that holds two, and the sums of vectors of both; `None` if it would be too wide.
    pub fn with(self, other: Self) -> Option<Self> {
        let toward = (self.toward + other.toward).try_normalize()?;
        let spread = |cone: Self| cone.toward.distance(toward) + cone.spread + ROUNDING;
        let spread = spread(self).max(spread(other));
        (spread < 1.0).then_some(Self { toward, spread })
    }

    /// Returns whether a step along `direction` goes along each vector of the cone, or at right angles to it.
    pub fn rises_along(&self, direction: DVec2) -> bool {
        direction.dot(self.toward) >= self.spread * direction.length()
    }

    /// Returns the direction of a step near to `direction` that does not go against any vector of the cone.
    pub fn turned(&self, direction: DVec2) -> DVec2 {
        if self.rises_along(direction) {
            return direction;
        }
        let across = direction - direction.dot(self.toward) * self.toward;
        let spread = self.spread + ROUNDING;
        across + self.toward * (across.length() * spread / (1.0 - spread * spread).max(0.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn near(random: &mut fastrand::Rng) -> DVec2 {
        dvec2(random.f64() - 0.5, random.f64() - 0.5)
    }

    #[test]
    fn a_cone_is_little_wider_than_its_rectangle_is_seen() {
        let mut random = fastrand::Rng::with_seed(6);
        for _ in 0..300 {
            let away = 3.0 * DVec2::from_angle(std::f64::consts::TAU * random.f64());
            let rect = Rect::around(away, 0.02 + 0.4 * random.f64());
            let cone = Cone::from_point(DVec2::ZERO, &rect).unwrap();
            let corners = [rect.min, rect.max, dvec2(rect.min.x, rect.max.y), dvec2(rect.max.x, rect.min.y)];
            let widest =
                corners.map(|p| p.normalize().distance(cone.toward())).into_iter().fold(0.0, f64::max);
            assert!(widest <= cone.spread() && cone.spread() < 1.8 * widest, "{widest} {cone:?}");
        }
    }

    #[test]
    fn a_turned_step_goes_as_far_across() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..300 {
            let rect = Rect::around(near(&mut random), 0.01);
            let Some(cone) = Cone::from_point(near(&mut random), &rect) else { continue };
            let wanted = near(&mut random);
            let across = |step: DVec2| cone.toward().perp_dot(step);
            assert!((across(cone.turned(wanted)) - across(wanted)).abs() < 1e-12);
            assert!(cone.rises_along(cone.turned(wanted)));
        }
    }

    #[test]
    fn steps_that_a_cone_permits_go_along_all_of_its_vectors() {
        let mut random = fastrand::Rng::with_seed(5);
        let (mut cones, mut turned) = (0, 0);
        for _ in 0..4_000 {
            let points = [near(&mut random), near(&mut random)];
            let min = near(&mut random);
            let rect = Rect::new(min, min + 0.3 * random.f64() * (near(&mut random) + 0.5));
            let [Some(a), Some(b)] = points.map(|point| Cone::from_point(point, &rect)) else { continue };
            let Some(both) = a.with(b) else { continue };
            let wanted = near(&mut random);
            let direction = both.turned(wanted);
            if !both.rises_along(direction) {
                continue;
            }
            cones += 1;
            turned += usize::from(direction != wanted);
            for _ in 0..20 {
                let inside = rect.min + rect.size() * dvec2(random.f64(), random.f64());
                let vectors = points.map(|point| inside - point);
                let sum = random.f64() * vectors[0] + random.f64() * vectors[1];
                for vector in [vectors[0], vectors[1], sum] {
                    assert!(vector.dot(direction) >= -1e-12, "{vector} {direction}");
                    assert!(vector.dot(both.opposite().turned(-wanted)) <= 1e-12);
                }
            }
        }
        assert!(cones > 500 && turned > 200, "{cones} {turned}");
    }
}
