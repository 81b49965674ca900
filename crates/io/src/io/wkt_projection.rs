//! The projection that well-known text describes by its parameters, as `.prj` files do that name no code.

use super::coordinate_system::Element;
use meshbrush_core::earth::Projection;

/// Names of methods, without blanks and in lower case, and the word of PROJ. Old text has its own names for
/// the same, and some names have a version at their end.
const METHODS: [(&str, &str); 7] = [
    ("transversemercator", "tmerc"),
    ("gausskruger", "tmerc"),
    ("mercator", "merc"),
    ("lambertconformalconic", "lcc"),
    ("lambertconicconformal", "lcc"),
    ("polarstereographic", "stere"),
    ("stereographic", "stere"),
];

/// Names of parameters, written as those of methods, and the key of PROJ.
const PARAMETERS: [(&str, &str); 20] = [
    ("centralmeridian", "lon_0"),
    ("longitudeofcenter", "lon_0"),
    ("longitudeoforigin", "lon_0"),
    ("straightverticallongitudefrompole", "lon_0"),
    ("longitudeofnaturalorigin", "lon_0"),
    ("longitudeoffalseorigin", "lon_0"),
    ("latitudeoforigin", "lat_0"),
    ("latitudeofnaturalorigin", "lat_0"),
    ("latitudeoffalseorigin", "lat_0"),
    ("standardparallel1", "lat_1"),
    ("latitudeof1ststandardparallel", "lat_1"),
    ("standardparallel2", "lat_2"),
    ("latitudeof2ndstandardparallel", "lat_2"),
    ("latitudeofstandardparallel", "lat_1"),
    ("scalefactor", "k_0"),
    ("scalefactoratnaturalorigin", "k_0"),
    ("falseeasting", "x_0"),
    ("eastingatfalseorigin", "x_0"),
    ("falsenorthing", "y_0"),
    ("northingatfalseorigin", "y_0"),
];

/// Largest difference of an ellipsoid from WGS 84: in the radius, in metres, and in 1/f. GRS 80 differs by 0
/// and 1.5e-6.
const DIFFERENCES: [f64; 2] = [0.5, 1e-4];

/// Returns the projection that the elements of a projected system describe; `None` for other methods and
/// ellipsoids.
pub(super) fn projection(elements: &[&Element]) -> Option<Projection> {
    let named = |keywords: &[&str]| {
        let is = |element: &&&Element| {
            keywords.iter().any(|keyword| element.keyword.eq_ignore_ascii_case(keyword))
        };
        elements.iter().find(is).copied()
    };
    let numbers = |element: &Element| -> Vec<f64> {
        element.values.iter().skip(1).map_while(|value| value.parse().ok()).collect()
    };
    let ellipsoid = numbers(named(&["SPHEROID", "ELLIPSOID"])?);
    let is_close = |(found, (known, most)): (&f64, (f64, f64))| (found - known).abs() <= most;
    let wgs_84 = [6_378_137.0, 298.257_223_563].into_iter().zip(DIFFERENCES);
    let is_wgs_84 = ellipsoid.len() >= 2 && ellipsoid.iter().zip(wgs_84).all(is_close);
    let meridian = named(&["PRIMEM", "PRIMEMERIDIAN"]).and_then(|element| numbers(element).first().copied());
    if !is_wgs_84 || meridian.unwrap_or(0.0) != 0.0 {
        return None;
    }
    let method = key(named(&["PROJECTION", "METHOD"])?.values.first()?);
    let kind = METHODS.iter().find(|(name, _)| method.starts_with(name)).map(|(_, word)| *word)?;
    let mut given = Vec::new();
    for parameter in elements.iter().filter(|element| element.keyword.eq_ignore_ascii_case("PARAMETER")) {
        let (name, value) = (key(parameter.values.first()?), *numbers(parameter).first()?);
        let (_, word) = PARAMETERS.iter().find(|(known, _)| *known == name)?;
        given.push((*word, value));
    }
    proj_text(kind, &given).and_then(|text| text.parse().ok())
}

/// Returns a projection as PROJ writes it.
fn proj_text(kind: &str, given: &[(&'static str, f64)]) -> Option<String> {
    let get = |key: &str| given.iter().find(|(known, _)| *known == key).map(|&(_, value)| value);
    let mut words: Vec<(&str, f64)> = given.to_vec();
    let scale = get("k_0").unwrap_or(1.0);
    match kind {
        "tmerc" => {}
        // The other families state where they are true to scale by a latitude.
        _ if scale != 1.0 => return None,
        "merc" => {
            let true_latitude = get("lat_1").or(get("lat_0")).unwrap_or(0.0);
            words = replaced(&words, &[("lat_ts", true_latitude)]);
        }
        "stere" => {
            let latitude = get("lat_1").or(get("lat_0")).filter(|latitude| *latitude != 0.0)?;
            words = replaced(&words, &[("lat_0", 90.0_f64.copysign(latitude)), ("lat_ts", latitude)]);
        }
        _ => words.retain(|(key, _)| *key != "k_0"),
    }
    let words = words.iter().map(|(key, value)| format!(" +{key}={value}"));
    Some(format!("+proj={kind}{}", words.collect::<String>()))
}

/// Returns words without latitudes and scales, and with others in their place.
fn replaced<'a>(words: &[(&'a str, f64)], by: &[(&'a str, f64)]) -> Vec<(&'a str, f64)> {
    let kept = words.iter().filter(|(key, _)| !key.starts_with("lat") && *key != "k_0");
    kept.chain(by).copied().collect()
}

/// Returns a name without what differs between programs.
fn key(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::super::CoordinateSystem;
    use meshbrush_core::earth::Coordinates;

    /// Codes, and the text of other programs for them without the code: as ArcGIS writes it, and GDAL, and in
    /// the second version of the format.
    const KNOWN: &str = include_str!("wkt_projection/known.txt");

    #[test]
    fn parameters_describe_the_projection_of_a_code() {
        for line in KNOWN.lines() {
            let (code, text) = line.split_once('\t').unwrap();
            let expected = Coordinates::of_epsg(code.parse().unwrap()).unwrap().projection().unwrap();
            let system = CoordinateSystem::from_wkt(text).unwrap();
            assert_eq!(system.epsg, None, "{text}");
            let found = system.on_earth.unwrap_or_else(|| panic!("{text}")).projection().unwrap();
            for at in [[12.0, 55.0], [16.5, 60.25], [178.0, -40.0]].map(|[x, y]| dvec2(x, y)) {
                let places = [found, expected].map(|projection| projection.plane_from_geographic(at));
                assert!(places[0].distance(places[1]) < 1e-6 || !places[1].is_finite(), "{text}: {at}");
            }
        }
    }

    #[test]
    fn other_methods_and_ellipsoids_are_not_known() {
        let known = KNOWN.lines().next().unwrap().split_once('\t').unwrap().1;
        assert!(CoordinateSystem::from_wkt(known).unwrap().on_earth.is_some());
        for (from, to) in [
            ("Transverse_Mercator", "Cassini"),
            ("298.257223563", "299.1528128"),
            ("6378137.0", "6377397.155"),
            ("PRIMEM[\"Greenwich\",0.0]", "PRIMEM[\"Paris\",2.5969213]"),
            ("Scale_Factor", "Azimuth"),
            ("False_Easting\",500000.0", "False_Easting\",1e99"),
            ("Meter", "Foot"),
        ] {
            assert!(known.contains(from), "{from}");
            let other = known.replace(from, to).replace("UNIT[\"Foot\",1.0]", "UNIT[\"Foot\",0.3048]");
            assert_eq!(CoordinateSystem::from_wkt(&other).unwrap().on_earth, None, "{other}");
        }
    }
}
