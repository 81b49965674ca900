//! The ellipsoid WGS 84, and what conformal projections need of a latitude on it.

/// Half the equatorial axis, in metres.
pub(super) const A: f64 = 6_378_137.0;
/// Flattening.
pub(super) const F: f64 = 1.0 / 298.257_223_563;
/// Eccentricity squared.
const E2: f64 = F * (2.0 - F);

/// A latitude, as projections use it.
///
/// τ′ is the tangent of the conformal latitude χ, Eqs. (7) to (9) of \[Karney2011\]: the sphere with χ in
/// place of φ has the same angles as the ellipsoid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Latitude {
    /// cos φ
    pub(super) cosine: f64,
    /// τ = tan φ
    pub(super) tangent: f64,
    /// τ′ = tan χ
    pub(super) conformal: f64,
    /// √(1 − e² sin² φ)
    pub(super) flattened: f64,
}

/// The eccentricity e.
pub(super) fn eccentricity() -> f64 {
    E2.sqrt()
}

impl Latitude {
    pub(super) fn from_degrees(latitude: f64) -> Self {
        let (sine, cosine) = libm::sincos(latitude.to_radians());
        let tangent = libm::tan(latitude.to_radians());
        let flattened = (1.0 - E2 * sine * sine).sqrt();
        Self { cosine, tangent, conformal: conformal_tangent(tangent), flattened }
    }

    /// The radius of the parallel in equatorial radii, m(φ) = cos φ / √(1 − e² sin² φ).
    pub(super) fn parallel(self) -> f64 {
        self.cosine / self.flattened
    }

    /// The radii, in metres, of a small arc of the meridian and of the parallel.
    pub(super) fn radii(self) -> [f64; 2] {
        let cubed = self.flattened * self.flattened * self.flattened;
        [A * (1.0 - E2) / cubed, A * self.parallel()]
    }

    /// The tangent of half the conformal colatitude, t(φ) = tan(π/4 − χ/2): 0 at the north pole.
    pub(super) fn colatitude(self) -> f64 {
        let secant = libm::hypot(1.0, self.conformal);
        // Both are equal; each is exact for one sign.
        if self.conformal > 0.0 { 1.0 / (self.conformal + secant) } else { secant - self.conformal }
    }
}

/// Returns τ′ from τ.
fn conformal_tangent(tangent: f64) -> f64 {
    let (e, secant) = (eccentricity(), libm::hypot(1.0, tangent));
    let sigma = libm::sinh(e * libm::atanh(e * tangent / secant));
    tangent * libm::hypot(1.0, sigma) - sigma * secant
}

/// Returns the latitude in degrees from τ′, by Newton's method, Eqs. (19) to (21) of \[Karney2011\].
pub(super) fn degrees_from_conformal(conformal: f64) -> f64 {
    let mut tangent = conformal / (1.0 - E2);
    if !tangent.is_finite() {
        return 90.0_f64.copysign(conformal);
    }
    // Two steps are enough for double precision; the others are a safeguard.
    for _ in 0..5 {
        let error = conformal - conformal_tangent(tangent);
        let slope = (1.0 - E2) * libm::hypot(1.0, conformal_tangent(tangent)) * libm::hypot(1.0, tangent)
            / (1.0 + (1.0 - E2) * tangent * tangent);
        let step = error / slope;
        if !step.is_finite() || step.abs() <= 1e-16 * tangent.abs() {
            break;
        }
        tangent += step;
    }
    libm::atan(tangent).to_degrees()
}
