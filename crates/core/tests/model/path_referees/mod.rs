//! A referee for paths: the quadrature of a radial cost. It shares no code with what it checks.

use glam::DVec2;
use meshbrush_core::path::{CostDensity, CostRange};
use meshbrush_mesh::geometry::Rect;

/// The cost a + Σ bᵢ e^(−(r/wᵢ)²), which depends on the distance r from the origin only.
#[derive(Clone, Debug)]
pub struct Radial {
    pub floor: f64,
    /// [b, w] each; b may be negative as long as the cost is positive.
    pub bumps: Vec<[f64; 2]>,
}

impl Radial {
    pub fn random(random: &mut fastrand::Rng) -> Self {
        let bump = |random: &mut fastrand::Rng| [3.0 * random.f64(), 0.3 + random.f64()];
        Self { floor: 0.3 + random.f64(), bumps: (0..random.usize(1..4)).map(|_| bump(random)).collect() }
    }

    pub fn at_radius(&self, r: f64) -> f64 {
        self.floor + self.bumps.iter().map(|[b, w]| b * (-(r / w) * (r / w)).exp()).sum::<f64>()
    }

    /// Returns the least cost between two places, by Clairaut's relation: along a geodesic, c(r) · r · sin of
    /// the angle to the radius is a constant k. The paths considered go out or in, or in to a least radius
    /// and out again; the angle between the places decides k.
    pub fn exact(&self, p: DVec2, q: DVec2) -> f64 {
        let (r1, r2) = (p.length().min(q.length()), p.length().max(q.length()));
        let angle = p.angle_to(q).abs();
        let momentum = |r: f64| r * self.at_radius(r);
        // r c(r) must grow for a unique answer: the caller draws again otherwise.
        let largest = momentum(r1);
        let direct = self.swept(largest, r1, r2);
        if angle <= direct {
            let k = bisect(0.0, largest, |k| self.swept(k, r1, r2) < angle);
            return self.cost_of(k, r1, r2);
        }
        let turn = |k: f64| bisect(1e-9, r1, |r| momentum(r) < k);
        let around = |k: f64| {
            let least = turn(k);
            self.swept(k, least, r1) + self.swept(k, least, r2)
        };
        let k = bisect(0.0, largest, |k| around(k) > angle);
        let least = turn(k);
        self.cost_of(k, least, r1) + self.cost_of(k, least, r2)
    }

    /// Returns whether r c(r) grows everywhere up to a radius: then there is one geodesic of each kind.
    pub fn is_simple(&self, radius: f64) -> bool {
        let momentum = |n: u32| {
            let r = radius * f64::from(n) / 2000.0;
            r * self.at_radius(r)
        };
        (1..2000).all(|n| momentum(n + 1) > momentum(n))
    }

    /// Returns the angle swept between two radii: ∫ k / (r √(c²r² − k²)) dr.
    fn swept(&self, k: f64, from: f64, to: f64) -> f64 {
        self.integral(k, from, to, |r, root| k / (r * root))
    }

    /// Returns the cost between two radii: ∫ c² r / √(c²r² − k²) dr.
    fn cost_of(&self, k: f64, from: f64, to: f64) -> f64 {
        self.integral(k, from, to, |r, root| self.at_radius(r).powi(2) * r / root)
    }

    /// With r = from + (to − from) t², which removes the root at the least radius; Simpson's rule.
    fn integral(&self, k: f64, from: f64, to: f64, f: impl Fn(f64, f64) -> f64) -> f64 {
        const STEPS: u32 = 4000;
        let at = |n: f64| {
            let t = n / f64::from(STEPS);
            let r = from + (to - from) * t * t;
            let squared = (r * self.at_radius(r)).powi(2) - k * k;
            // Near the turning point, c²r² − k² is about its slope times the way from there.
            if squared <= 0.0 { 0.0 } else { f(r, squared.sqrt()) * 2.0 * t * (to - from) }
        };
        // The open rule of midpoints, extrapolated.
        let midpoints = |steps: u32| {
            let width = f64::from(STEPS) / f64::from(steps);
            (0..steps).map(|n| at((f64::from(n) + 0.5) * width)).sum::<f64>() / f64::from(steps)
        };
        (4.0 * midpoints(STEPS) - midpoints(STEPS / 2)) / 3.0
    }
}

/// Returns where a condition that holds below ends.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

impl CostDensity for Radial {
    fn at(&self, point: DVec2) -> f64 {
        self.at_radius(point.length())
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let nearest = DVec2::ZERO.clamp(rectangle.min, rectangle.max).length();
        let farthest = rectangle.min.abs().max(rectangle.max.abs()).length();
        // Each bump falls with the distance.
        CostRange {
            least: self.at_radius(farthest) * (1.0 - 1e-14),
            greatest: self.at_radius(nearest) * (1.0 + 1e-14),
        }
    }
}
