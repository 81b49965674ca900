//! Finds the unit of the coordinates in a file from the file's own description.

use glam::DVec2;

use meshbrush_core::domain::Ring;
use meshbrush_mesh::text::LengthUnit;

/// Codes of geographic coordinate systems: WGS 84, ETRS89, NAD83, NAD27, WGS 84 with heights.
const GEOGRAPHIC: [u32; 5] = [4326, 4258, 4269, 4267, 4979];
/// Codes of coordinate systems in metres: Web Mercator under two codes, and Europe's equal-area and conformal
/// systems. The UTM zones are ranges, see [`is_in_metres`].
const METRIC: [u32; 4] = [3857, 900_913, 3035, 3034];

/// Returns the unit of coordinates in a coordinate system `crs`, which is named as in
/// `urn:ogc:def:crs:EPSG::4326`, `EPSG:4326` or `urn:ogc:def:crs:OGC:1.3:CRS84`.
///
/// Without a name, coordinates are degrees if all are longitudes and latitudes, as in RFC 7946. A system that
/// is not listed here may be in feet: there is no unit then.
pub fn unit(crs: Option<&str>, corners: impl IntoIterator<Item = DVec2>) -> LengthUnit {
    let Some(crs) = crs else {
        let fits = corners.into_iter().all(|corner| corner.x.abs() <= 180.0 && corner.y.abs() <= 90.0);
        return if fits { LengthUnit::Degree } else { LengthUnit::None };
    };
    let crs = crs.to_uppercase();
    let code = crs.rsplit(':').next().and_then(|code| code.parse().ok());
    match code {
        _ if crs.ends_with("CRS84") => LengthUnit::Degree,
        Some(code) if crs.contains("EPSG") && GEOGRAPHIC.contains(&code) => LengthUnit::Degree,
        Some(code) if crs.contains("EPSG") && is_in_metres(code) => LengthUnit::Metre,
        _ => LengthUnit::None,
    }
}

/// Returns whether rings have edges along the longitudes 180° and −180° whose latitudes overlap.
pub(super) fn meet_at_antimeridian<'a>(rings: impl Iterator<Item = &'a Ring> + Clone) -> bool {
    let [east, west] = [180.0, -180.0].map(|longitude| {
        let edges = rings.clone().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let along = edges.filter(|(a, b)| a.x == longitude && b.x == longitude && a.y != b.y);
        let mut latitudes: Vec<[f64; 2]> = along.map(|(a, b)| [a.y.min(b.y), a.y.max(b.y)]).collect();
        latitudes.sort_by(|a, b| a[0].total_cmp(&b[0]));
        latitudes
    });
    let (mut e, mut w) = (0, 0);
    // Of two ranges apart, the lower one meets none of the other side that come later.
    while let (Some(a), Some(b)) = (east.get(e), west.get(w)) {
        if a[0] < b[1] && b[0] < a[1] {
            return true;
        }
        if a[1] <= b[0] { e += 1 } else { w += 1 }
    }
    false
}

/// Returns whether an EPSG code belongs to a known system in metres.
fn is_in_metres(code: u32) -> bool {
    let utm = [32601..=32660, 32701..=32760, 25828..=25838, 26901..=26923];
    METRIC.contains(&code) || utm.iter().any(|zones| zones.contains(&code))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn a_named_coordinate_system_decides_the_unit() {
        let far = dvec2(500_000.0, 4_000_000.0);
        for (crs, unit_of_crs) in [
            ("urn:ogc:def:crs:OGC:1.3:CRS84", LengthUnit::Degree),
            ("urn:ogc:def:crs:EPSG::4326", LengthUnit::Degree),
            ("EPSG:32635", LengthUnit::Metre),
            ("urn:ogc:def:crs:EPSG::25832", LengthUnit::Metre),
            ("EPSG:2263", LengthUnit::None),
            ("a local grid", LengthUnit::None),
        ] {
            assert_eq!(unit(Some(crs), [far]), unit_of_crs, "{crs}");
        }
    }

    #[test]
    fn without_a_coordinate_system_longitudes_and_latitudes_are_degrees() {
        assert_eq!(unit(None, [dvec2(-180.0, -90.0), dvec2(180.0, 90.0)]), LengthUnit::Degree);
        assert_eq!(unit(None, [dvec2(23.0, 38.0), dvec2(23.0, 91.0)]), LengthUnit::None);
        assert_eq!(unit(None, [dvec2(181.0, 0.0)]), LengthUnit::None);
    }

    #[test]
    fn polygons_that_are_cut_at_the_antimeridian_are_recognised() {
        let rectangle = |west: f64, east: f64, south: f64, north: f64| -> Ring {
            vec![dvec2(west, south), dvec2(east, south), dvec2(east, north), dvec2(west, north)]
        };
        let meet = |rings: &[Ring]| meet_at_antimeridian(rings.iter());
        let east = rectangle(177.0, 180.0, -18.0, -16.0);
        assert!(meet(&[east.clone(), rectangle(-180.0, -178.0, -17.0, -10.0)]));
        assert!(meet(&[rectangle(-180.0, -178.0, 50.0, 60.0), rectangle(-180.0, 180.0, -5.0, 5.0)]));
        // One side only, other latitudes, or a corner.
        assert!(!meet(std::slice::from_ref(&east)) && !meet(&[]));
        assert!(!meet(&[east.clone(), rectangle(-180.0, -178.0, -16.0, -10.0)]));
        assert!(!meet(&[east, vec![dvec2(-180.0, -17.0), dvec2(-178.0, -18.0), dvec2(-178.0, -16.0)]]));
    }
}
