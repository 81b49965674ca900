//! The transverse Mercator projection, by Krüger's series to the sixth order in the third flattening:
//! \[Karney2011\], Eqs. (10) to (12), (23) to (25), (35) and (36). Within 35° of the central meridian its
//! error is below a nanometre.

use glam::{DVec2, dvec2};

use super::ellipsoid::{A, F, Latitude, degrees_from_conformal};

/// Coefficients of powers of n, for each multiple of the angle.
type KruegerSeries = [[f64; 6]; 6];

/// From the conformal sphere to the ellipsoid, Eq. (35).
const ALPHA: KruegerSeries = [
    [0.5, -2.0 / 3.0, 5.0 / 16.0, 41.0 / 180.0, -127.0 / 288.0, 7_891.0 / 37_800.0],
    [0.0, 13.0 / 48.0, -3.0 / 5.0, 557.0 / 1_440.0, 281.0 / 630.0, -1_983_433.0 / 1_935_360.0],
    [0.0, 0.0, 61.0 / 240.0, -103.0 / 140.0, 15_061.0 / 26_880.0, 167_603.0 / 181_440.0],
    [0.0, 0.0, 0.0, 49_561.0 / 161_280.0, -179.0 / 168.0, 6_601_661.0 / 7_257_600.0],
    [0.0, 0.0, 0.0, 0.0, 34_729.0 / 80_640.0, -3_418_889.0 / 1_995_840.0],
    [0.0, 0.0, 0.0, 0.0, 0.0, 212_378_941.0 / 319_334_400.0],
];

/// The way back, Eq. (36).
const BETA: KruegerSeries = [
    [0.5, -2.0 / 3.0, 37.0 / 96.0, -1.0 / 360.0, -81.0 / 512.0, 96_199.0 / 604_800.0],
    [0.0, 1.0 / 48.0, 1.0 / 15.0, -437.0 / 1_440.0, 46.0 / 105.0, -1_118_711.0 / 3_870_720.0],
    [0.0, 0.0, 17.0 / 480.0, -37.0 / 840.0, -209.0 / 4_480.0, 5_569.0 / 90_720.0],
    [0.0, 0.0, 0.0, 4_397.0 / 161_280.0, -11.0 / 504.0, -830_251.0 / 7_257_600.0],
    [0.0, 0.0, 0.0, 0.0, 4_583.0 / 161_280.0, -108_847.0 / 3_991_680.0],
    [0.0, 0.0, 0.0, 0.0, 0.0, 20_648_693.0 / 638_668_800.0],
];

/// The third flattening n.
const N: f64 = F / (2.0 - F);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transverse {
    /// Scale on the central meridian.
    scale: f64,
    /// The scale times the radius of the sphere with a meridian of the same length, in metres.
    radius: f64,
    alpha: [f64; 6],
    beta: [f64; 6],
}

impl Transverse {
    /// `scale` is that on the central meridian.
    pub(super) fn new(scale: f64) -> Self {
        let n2 = N * N;
        let radius = A / (1.0 + N) * (1.0 + n2 / 4.0 + n2 * n2 / 64.0 + n2 * n2 * n2 / 256.0);
        Self { scale, radius: scale * radius, alpha: summed(&ALPHA), beta: summed(&BETA) }
    }

    /// Returns the point in the plane, in metres, and the scale there. `east` is the longitude from the
    /// central one; both in degrees.
    pub(super) fn forward(&self, east: f64, latitude: f64) -> (DVec2, f64) {
        let latitude = Latitude::from_degrees(latitude);
        let (sine, cosine) = libm::sincos(east.to_radians());
        let across = libm::hypot(latitude.conformal, cosine);
        let (xi, eta) = (libm::atan2(latitude.conformal, cosine), libm::asinh(sine / across));
        let ([xi, eta], [p, q]) = with_series(&self.alpha, 1.0, xi, eta);
        let secant = libm::hypot(1.0, latitude.tangent);
        let scale = self.radius / A * libm::hypot(p, q) * latitude.flattened * secant / across;
        (self.radius * dvec2(eta, xi), scale)
    }

    /// Returns longitude from the central one and latitude, in degrees.
    pub(super) fn inverse(&self, at: DVec2) -> DVec2 {
        let [eta, xi] = (at / self.radius).to_array();
        let ([xi, eta], _) = with_series(&self.beta, -1.0, xi, eta);
        let (sine, cosine) = libm::sincos(xi);
        let across = libm::sinh(eta);
        let east = libm::atan2(across, cosine);
        dvec2(east.to_degrees(), degrees_from_conformal(sine / libm::hypot(across, cosine)))
    }
}

/// Returns the coefficients for the flattening of the Earth.
fn summed(series: &KruegerSeries) -> [f64; 6] {
    series.map(|row| row.into_iter().rev().fold(0.0, |sum, coefficient| N * (sum + coefficient)))
}

/// Adds a series to ξ and η with a sign, and returns its derivatives p and q too.
fn with_series(coefficients: &[f64; 6], sign: f64, xi: f64, eta: f64) -> ([f64; 2], [f64; 2]) {
    let (mut sum, mut slopes) = ([xi, eta], [1.0, 0.0]);
    for (number, coefficient) in coefficients.iter().enumerate().rev() {
        let multiple = 2.0 * (number + 1) as f64;
        let (sine, cosine) = libm::sincos(multiple * xi);
        let (rise, level) = (libm::sinh(multiple * eta), libm::cosh(multiple * eta));
        sum[0] += sign * coefficient * sine * level;
        sum[1] += sign * coefficient * cosine * rise;
        slopes[0] += sign * coefficient * multiple * cosine * level;
        slopes[1] += sign * coefficient * multiple * sine * rise;
    }
    (sum, slopes)
}
