use std::str::FromStr;

use glam::dvec2;

use super::{Coordinates, GeographicExtent, Parameters, Projection, ProjectionKind, ProjectionTextError};
use crate::text::Number;

/// How the projection of a domain is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProjectionChoice {
    /// By where the domain lies.
    Automatic,
    /// The plane where the domain is already, if that is known and in metres, or else by where it lies.
    OwnOrAutomatic,
    /// One of a family, with the parameters that suit the domain.
    Family(ProjectionKind),
    /// This one.
    Given(Projection),
}

/// Why a projection does not suit a domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectionError {
    /// A latitude is beyond the poles.
    #[error("A latitude of {}° cannot be projected: latitudes are from −90° to 90°.", Number(*.0))]
    Latitude(f64),
    /// The domain goes around the Earth.
    #[error(
        "A domain that goes all around the Earth cannot be projected to a plane without a cut, unless it is at one \
         pole. Divide it at a meridian."
    )]
    AllAround,
    /// The domain is too wide.
    #[error(
        "A {} projection shows 180° of longitude at most, and the domain has {}°. Choose merc, or a smaller domain.",
        kind.name(), Number(*.width)
    )]
    TooWide {
        /// The family of the projection.
        kind: ProjectionKind,
        /// Degrees of longitude.
        width: f64,
    },
    /// The domain contains both poles, or is not on one side of the equator.
    #[error("A {} projection shows one half of the Earth, and the domain is on both sides of the equator. Choose merc, \
         tmerc or auto.", .0.name())]
    BothHalves(ProjectionKind),
    /// Lengths in the plane would differ too much.
    #[error(
        "In a {} projection of this domain, lengths would be up to {} times as long in one place as in another, and {} \
         times is the limit. Choose another projection, or a smaller domain.",
        kind.name(), Number(*.ratio), MOST_RATIO
    )]
    TooLarge {
        /// The family of the projection.
        kind: ProjectionKind,
        /// The largest scale by the least one.
        ratio: f64,
    },
}

/// Why a known system is no plane for a mesh.
const NO_PLANE: &str = "it does not keep angles on the ellipsoid";
/// Why a code cannot be used.
const NOT_KNOWN: &str = "its code is not known here";

/// Largest ratio of two scales in an extent.
const MOST_RATIO: f64 = 4.0;
/// Points along each side of an extent at which the scale is computed.
const SAMPLES: u32 = 33;

impl ProjectionChoice {
    /// Returns a projection for an extent. Unless it is given, its scale is 1 or more in the extent: no
    /// length is longer on the Earth than in the plane.
    ///
    /// # Errors
    /// Fails where no projection of the family suits the extent.
    pub fn projection(self, extent: &GeographicExtent) -> Result<Projection, ProjectionError> {
        if let Some(latitude) = [extent.south, extent.north].into_iter().find(|v| !(-90.0..=90.0).contains(v))
        {
            return Err(ProjectionError::Latitude(latitude));
        }
        let projection = match self {
            Self::Given(projection) => projection,
            Self::Family(kind) => suited(kind, extent)?,
            Self::Automatic | Self::OwnOrAutomatic => suited(family_for(extent), extent)?,
        };
        let kind = projection.kind();
        if extent.width >= 360.0 && kind != ProjectionKind::PolarStereographic {
            return Err(ProjectionError::AllAround);
        }
        let is_limited = matches!(kind, ProjectionKind::TransverseMercator | ProjectionKind::Lambert);
        if is_limited && extent.width > 180.0 {
            return Err(ProjectionError::TooWide { kind, width: extent.width });
        }
        let [least, greatest] = projection.scale_range(extent);
        let ratio = greatest / least;
        if ratio > MOST_RATIO {
            return Err(ProjectionError::TooLarge { kind, ratio });
        }
        Ok(projection)
    }
}

/// Returns the family whose scale varies least over an extent.
fn family_for(extent: &GeographicExtent) -> ProjectionKind {
    let GeographicExtent { width, south, north, pole, .. } = *extent;
    let middle = extent.middle_latitude();
    let is_tall = north - south > width * libm::cos(middle.to_radians());
    let is_on_equator = middle.abs() < 10.0 || (south < 0.0 && north > 0.0 && width > 60.0);
    if pole.is_some() || south.abs().max(north.abs()) > 80.0 {
        ProjectionKind::PolarStereographic
    } else if is_tall {
        ProjectionKind::TransverseMercator
    } else if is_on_equator {
        ProjectionKind::Mercator
    } else {
        ProjectionKind::Lambert
    }
}

/// Returns the projection of a family that touches the Earth in the extent: there its scale is 1, and
/// elsewhere more.
fn suited(kind: ProjectionKind, extent: &GeographicExtent) -> Result<Projection, ProjectionError> {
    let GeographicExtent { south, north, pole, .. } = *extent;
    let middle = extent.middle_latitude();
    let parameters = match kind {
        ProjectionKind::Mercator => {
            let is_on_equator = south <= 0.0 && north >= 0.0;
            let nearest = if is_on_equator { 0.0 } else { south.abs().min(north.abs()) };
            Parameters::Mercator { true_latitude: nearest.min(85.0) }
        }
        ProjectionKind::TransverseMercator => Parameters::TransverseMercator { scale: 1.0 },
        ProjectionKind::PolarStereographic => {
            let side = pole.unwrap_or(90.0_f64.copysign(middle));
            let is_round = pole.is_some();
            let farthest = if is_round { 90.0 } else { south.abs().max(north.abs()) };
            if (if side > 0.0 { south } else { -north }) < -10.0 {
                return Err(ProjectionError::BothHalves(kind));
            }
            Parameters::PolarStereographic { true_latitude: farthest.copysign(side) }
        }
        ProjectionKind::Lambert if middle.abs() < 1.0 => return Err(ProjectionError::BothHalves(kind)),
        ProjectionKind::Lambert => {
            let origin = middle.clamp(-89.0, 89.0);
            Parameters::Lambert { origin, parallels: [origin; 2] }
        }
    };
    Ok(Projection::new(extent.middle_longitude(), parameters))
}

impl Projection {
    /// Returns approximately the minimum and the maximum scale in an extent.
    pub fn scale_range(&self, extent: &GeographicExtent) -> [f64; 2] {
        let share = |n: u32| f64::from(n) / f64::from(SAMPLES - 1);
        let places = (0..SAMPLES * SAMPLES).map(|n| {
            let (east, up) = (share(n % SAMPLES), share(n / SAMPLES));
            let latitude = extent.south + up * (extent.north - extent.south);
            dvec2(extent.west + east * extent.width, latitude)
        });
        // Infinite where the projection has no place for a point.
        let scales =
            places.map(|at| self.scale_at(at)).map(|k| if k.is_finite() { k } else { f64::INFINITY });
        scales.fold([f64::INFINITY, 0.0], |[least, greatest], k| [f64::min(least, k), f64::max(greatest, k)])
    }
}

impl FromStr for ProjectionChoice {
    type Err = ProjectionTextError;

    /// Reads `auto`, `metres`, the word of a family, `EPSG:32633`, or a projection as PROJ writes it.
    fn from_str(text: &str) -> Result<Self, ProjectionTextError> {
        let family = || ProjectionKind::ALL.into_iter().find(|kind| kind.word() == text);
        match text {
            "auto" => Ok(Self::Automatic),
            "metres" => Ok(Self::OwnOrAutomatic),
            _ if text.to_lowercase().starts_with("epsg:") => {
                match text.parse().map(|known: Coordinates| known.projection()) {
                    Ok(Some(projection)) => Ok(Self::Given(projection)),
                    Ok(None) => Err(ProjectionTextError::new(text, NO_PLANE.into())),
                    Err(_) => Err(ProjectionTextError::new(text, NOT_KNOWN.into())),
                }
            }
            _ => family().map_or_else(|| text.parse().map(Self::Given), |kind| Ok(Self::Family(kind))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extent(west: f64, width: f64, [south, north]: [f64; 2]) -> GeographicExtent {
        GeographicExtent { west, width, south, north, pole: None }
    }

    #[test]
    fn the_family_follows_from_where_the_domain_lies() {
        use ProjectionKind::{Lambert, Mercator, PolarStereographic, TransverseMercator};
        for (name, place, kind, most) in [
            ("Baltic", extent(9.0, 21.0, [53.0, 66.0]), TransverseMercator, 1.01),
            ("Mediterranean", extent(-6.0, 42.0, [30.0, 46.0]), Lambert, 1.011),
            ("Chile", extent(-76.0, 9.0, [-56.0, -17.0]), TransverseMercator, 1.006),
            ("Indonesia", extent(95.0, 46.0, [-11.0, 6.0]), Mercator, 1.02),
            ("Pacific", extent(160.0, 40.0, [-30.0, -5.0]), Lambert, 1.03),
            ("Svalbard", extent(10.0, 20.0, [76.0, 81.0]), PolarStereographic, 1.02),
            (
                "Arctic",
                GeographicExtent { pole: Some(90.0), ..extent(-180.0, 360.0, [60.0, 90.0]) },
                PolarStereographic,
                1.08,
            ),
        ] {
            let projection = ProjectionChoice::Automatic.projection(&place).unwrap();
            assert_eq!(projection.kind(), kind, "{name}");
            let [least, greatest] = projection.scale_range(&place);
            assert!(least > 1.0 - 1e-9 && greatest < most, "{name}: {least} to {greatest}");
        }
    }

    #[test]
    fn every_family_that_is_chosen_keeps_lengths_on_the_earth_below_those_in_the_plane() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut suited = [0; 4];
        for _ in 0..400 {
            let south = -85.0 + 160.0 * random.f64();
            let north = south + 0.1 + random.f64() * (84.9 - south).max(0.0);
            let place = extent(wrapped_west(&mut random), 0.1 + 90.0 * random.f64(), [south, north]);
            for (kind, count) in ProjectionKind::ALL.into_iter().zip(&mut suited) {
                let Ok(projection) = ProjectionChoice::Family(kind).projection(&place) else { continue };
                assert!(projection.scale_range(&place)[0] > 1.0 - 1e-9, "{projection} in {place:?}");
                *count += 1;
            }
        }
        assert!(suited.iter().all(|&count| count > 40), "{suited:?}");
    }

    fn wrapped_west(random: &mut fastrand::Rng) -> f64 {
        360.0 * random.f64() - 180.0
    }

    #[test]
    fn what_cannot_be_meshed_is_refused() {
        let globe = extent(-180.0, 360.0, [-75.0, 75.0]);
        assert_eq!(ProjectionChoice::Automatic.projection(&globe), Err(ProjectionError::AllAround));
        let wide = extent(-150.0, 300.0, [40.0, 60.0]);
        let family = |kind| ProjectionChoice::Family(kind).projection(&wide).unwrap_err().to_string();
        assert!(family(ProjectionKind::TransverseMercator).contains("180°"));
        let tall = extent(0.0, 10.0, [0.0, 84.0]);
        let error = ProjectionChoice::Family(ProjectionKind::Mercator).projection(&tall).unwrap_err();
        assert!(error.to_string().contains("times"), "{error}");
        let both =
            ProjectionChoice::Family(ProjectionKind::Lambert).projection(&extent(0.0, 5.0, [-3.0, 3.0]));
        assert_eq!(both, Err(ProjectionError::BothHalves(ProjectionKind::Lambert)));
        let far = extent(0.0, 5.0, [0.0, 91.0]);
        assert_eq!(ProjectionChoice::Automatic.projection(&far), Err(ProjectionError::Latitude(91.0)));
    }
}
