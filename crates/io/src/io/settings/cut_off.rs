//! Rings that are cut off a domain.

use glam::DVec2;

use super::SavedDomain;
use crate::io::KeyFault;
use crate::io::layers::{each, points};
use meshbrush_core::domain::{CutShape, Domain, Ring};

/// A ring in a text: longitudes and latitudes where the domain has a projection, or else world units.
pub type SavedRing = Vec<[f64; 2]>;

impl SavedDomain {
    /// Checks the rings that are cut off, on their own.
    pub(super) fn check_cut_off(&self) -> Result<(), KeyFault> {
        each("cut_off", &self.cut_off, |ring| points(ring, 3, "a ring to cut off")).map(|_| ())
    }

    /// Returns a domain without what the rings of the text enclose. They are taken away one after another, so
    /// that further ones leave the outline after the first ones as it is, bit for bit.
    ///
    /// # Errors
    /// Fails when the domain has no outline, or a ring takes nothing or all of it away.
    pub fn cut(&self, domain: Domain) -> Result<Domain, KeyFault> {
        self.cut_off.iter().enumerate().try_fold(domain, |domain, (number, saved)| {
            let fault = |sentence: &str| KeyFault::here(sentence).within(number).within("cut_off");
            let ring = ring_in(&domain, saved).ok_or_else(|| fault(NOT_IN_PLANE))?;
            let before = domain.as_region().ok_or_else(|| fault(BY_FORMULA))?.area();
            let cut = domain.reshaped(&CutShape::Ring(ring), false).ok_or_else(|| fault(BY_FORMULA))?;
            match cut.region().map_or(0.0, |region| region.area()) {
                0.0 => Err(fault(NOTHING_LEFT)),
                area if area == before => Err(fault(NOTHING_CUT)),
                _ => Ok(cut),
            }
        })
    }
}

/// Returns a ring of a text in world units; `None` where the plane of the domain does not have its places.
fn ring_in(domain: &Domain, saved: &SavedRing) -> Option<Ring> {
    let place = |&at: &[f64; 2]| match &domain.projection {
        Some(projection) => projection.plane_from_geographic(at.into()),
        None => DVec2::from(at),
    };
    let ring: Ring = saved.iter().map(place).collect();
    ring.iter().all(|at| at.is_finite()).then_some(ring)
}

/// Returns a ring in world units as a text has it, with ten digits: fractions of a millimetre.
pub fn written_ring(domain: &Domain, ring: &Ring) -> SavedRing {
    let rounded = |value: f64| format!("{value:.9e}").parse().unwrap_or(value);
    let place = |&at: &DVec2| match &domain.projection {
        Some(projection) => projection.geographic_from_plane(at),
        None => at,
    };
    ring.iter().map(|at| place(at).to_array().map(rounded)).collect()
}

const BY_FORMULA: &str =
    "nothing can be cut off a domain that a formula gives, which has no outline: change the formula.";
const NOT_IN_PLANE: &str = "a place of this ring is not in the plane of the domain: where the domain has a projection, rings are \
                            longitudes and latitudes, in degrees.";
const NOTHING_CUT: &str = "this ring does not meet the domain, or what is left of it. Rings are longitudes and latitudes where the \
                           domain has a projection, and in its own coordinates elsewhere.";
const NOTHING_LEFT: &str = "nothing would be left of the domain without what this ring encloses.";
