//! Geographic systems: longitudes and latitudes on any ellipsoid, from any meridian, in any unit, and their
//! shift to WGS 84.

use std::fmt;
use std::sync::OnceLock;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::Coordinates;
use super::ellipsoid::{A, F};
use crate::text::LengthUnit;

/// Systems of the EPSG register. The head of the file says what its columns are.
const TABLE: &str = include_str!("geographic.txt");

/// How far places may be off where the shift of a system is not known, in metres.
const UNKNOWN_SHIFT: f64 = 1000.0;
/// Steps of the inverse of a shift. Each leaves a share of 1e-4 or less of the error.
const INVERSE_STEPS: u32 = 4;
/// Steps from geocentric coordinates to a latitude.
const LATITUDE_STEPS: u32 = 6;
/// Largest difference of an ellipsoid from WGS 84: in the radius, in metres, and in 1/f. Texts
/// have the latter rounded.
const DIFFERENCES: [f64; 2] = [2.0, 1e-3];

/// Longitudes and latitudes of a geographic system other than WGS 84.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeographicSystem {
    /// Its code in the EPSG register, if it is from there.
    pub code: Option<u32>,
    /// The radius of its ellipsoid, in metres, and the reciprocal of its flattening; 0 for a sphere.
    pub ellipsoid: [f64; 2],
    /// The longitude of its prime meridian from Greenwich, in degrees.
    pub prime_meridian: f64,
    /// The unit of longitudes and latitudes, in degrees.
    pub unit: f64,
    /// The shift to WGS 84 of geocentric coordinates: three translations in metres, three rotations in
    /// seconds of arc as for position vectors, and parts per million. Without one, longitudes and latitudes
    /// count as those of WGS 84.
    pub shift: Option<[f64; 7]>,
    /// How far places may be off on WGS 84, in metres.
    pub accuracy: f64,
}

/// A row of the table.
struct Row {
    system: GeographicSystem,
    name: &'static str,
    /// The name in texts of ArcGIS.
    other_name: &'static str,
}

struct Table {
    /// Codes of systems that are close to WGS 84, from and to.
    close: Vec<[u32; 2]>,
    /// The others, by their codes.
    rows: Vec<Row>,
}

fn table() -> &'static Table {
    static PARSED: OnceLock<Table> = OnceLock::new();
    PARSED.get_or_init(|| {
        let mut table = Table { close: Vec::new(), rows: Vec::new() };
        for line in TABLE.lines().filter(|line| !line.starts_with('#')) {
            match line.strip_prefix("close\t") {
                Some(codes) => table.close.extend(codes.split(' ').filter_map(|codes| {
                    let (from, to) = codes.split_once('-').unwrap_or((codes, codes));
                    Some([from.parse().ok()?, to.parse().ok()?])
                })),
                None => table.rows.extend(row(line)),
            }
        }
        table
    })
}

fn row(line: &'static str) -> Option<Row> {
    let columns: Vec<&str> = line.split('\t').collect();
    let number = |at: usize| columns.get(at)?.parse::<f64>().ok();
    let shift = columns.get(7).and_then(|shift| numbers(shift.split(' ')));
    let system = GeographicSystem {
        code: Some(columns[0].parse().ok()?),
        ellipsoid: [number(3)?, number(4)?],
        prime_meridian: number(5)?,
        unit: number(6)?,
        shift,
        accuracy: number(8).unwrap_or(UNKNOWN_SHIFT),
    };
    Some(Row { system, name: columns[1], other_name: columns[2] })
}

/// Returns seven numbers.
fn numbers<'a>(words: impl Iterator<Item = &'a str>) -> Option<[f64; 7]> {
    let numbers: Option<Vec<f64>> = words.map(|word| word.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// Returns the system of a code of the EPSG register; that of WGS 84 for those within a few metres of it.
pub(super) fn of_code(code: u32) -> Option<Coordinates> {
    if table().close.iter().any(|&[from, to]| (from..=to).contains(&code)) {
        return Some(Coordinates::Geographic);
    }
    let row = table().rows.iter().find(|row| row.system.code == Some(code));
    row.map(|row| Coordinates::OnDatum(row.system))
}

/// Returns a name without what differs between programs.
fn key(name: &str) -> String {
    let name = name.strip_prefix("GCS_").unwrap_or(name);
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

impl GeographicSystem {
    /// Returns the system with a name of the EPSG register or of ArcGIS, where it is not close to WGS 84.
    pub fn named(name: &str) -> Option<Self> {
        let name = key(name);
        let has = |row: &&Row| [row.name, row.other_name].iter().any(|own| key(own) == name);
        table().rows.iter().find(has).map(|row| row.system)
    }

    /// Returns a system whose shift is not known, on an ellipsoid with this radius in metres and reciprocal
    /// flattening, from Greenwich, in degrees.
    pub fn on_ellipsoid(ellipsoid: [f64; 2]) -> Self {
        let is_near = |(found, known, most): (f64, f64, f64)| (found - known).abs() <= most;
        let wgs_84 = [A, 1.0 / F];
        let is_close = (0..2).all(|n| is_near((ellipsoid[n], wgs_84[n], DIFFERENCES[n])));
        let accuracy = if is_close { 5.0 } else { UNKNOWN_SHIFT };
        Self { code: None, ellipsoid, prime_meridian: 0.0, unit: 1.0, shift: None, accuracy }
    }

    /// Returns these as coordinates: plain longitudes and latitudes where the system is close to WGS 84.
    pub fn coordinates(self) -> Coordinates {
        let is_plain = self.prime_meridian == 0.0 && self.is_in_degrees();
        let is_close = self.shift.is_none_or(|shift| shift == [0.0; 7])
            && Self::on_ellipsoid(self.ellipsoid).accuracy < UNKNOWN_SHIFT;
        if is_plain && is_close { Coordinates::Geographic } else { Coordinates::OnDatum(self) }
    }

    /// Returns whether longitudes and latitudes are in degrees.
    pub fn is_in_degrees(&self) -> bool {
        (self.unit - 1.0).abs() < 1e-9
    }

    /// Returns the unit of longitudes and latitudes, if it has a name.
    pub fn length_unit(&self) -> LengthUnit {
        if self.is_in_degrees() { LengthUnit::Degree } else { LengthUnit::None }
    }

    /// Returns whether only the order of magnitude of the error of places is known.
    pub fn is_uncertain(&self) -> bool {
        self.accuracy >= UNKNOWN_SHIFT
    }

    /// Returns the system in degrees from Greenwich, and the factor and the summands that lead there from its
    /// own longitudes and latitudes.
    pub fn in_degrees(self) -> (Self, f64, DVec2) {
        let plain = Self { code: None, prime_meridian: 0.0, unit: 1.0, ..self };
        let unit = if self.is_in_degrees() { 1.0 } else { self.unit };
        (plain, unit, dvec2(self.prime_meridian, 0.0))
    }

    /// Returns longitude and latitude on WGS 84, in degrees.
    pub(super) fn to_wgs_84(self, at: DVec2) -> DVec2 {
        let (_, unit, meridian) = self.in_degrees();
        self.shifted(unit * at + meridian)
    }

    /// Returns what has this longitude and latitude on WGS 84.
    pub(super) fn of_wgs_84(self, at: DVec2) -> DVec2 {
        let (_, unit, meridian) = self.in_degrees();
        let mut own = at;
        for _ in 0..INVERSE_STEPS {
            own += at - self.shifted(own);
        }
        (own - meridian) / unit
    }

    /// Returns longitude and latitude on WGS 84 of those on the ellipsoid, all in degrees.
    fn shifted(&self, at: DVec2) -> DVec2 {
        let Some([x, y, z, turn_x, turn_y, turn_z, scale]) = self.shift else { return at };
        let [radius, reciprocal] = self.ellipsoid;
        let flattening = if reciprocal == 0.0 { 0.0 } else { 1.0 / reciprocal };
        let from = geocentric(at, radius, flattening);
        let turn = dvec3(turn_x, turn_y, turn_z) * (std::f64::consts::PI / (180.0 * 3600.0));
        let turned = from + turn.cross(from);
        let moved = geographic((1.0 + 1e-6 * scale) * turned + dvec3(x, y, z));
        // Continuous across the antimeridian.
        dvec2(at.x + super::wrapped(moved.x - at.x), moved.y)
    }
}

/// Returns the place of a longitude and latitude at height 0, in metres from the centre of the ellipsoid.
fn geocentric(at: DVec2, radius: f64, flattening: f64) -> DVec3 {
    let ((sine, cosine), (east, north)) = (libm::sincos(at.y.to_radians()), libm::sincos(at.x.to_radians()));
    let squared = flattening * (2.0 - flattening);
    let normal = radius / (1.0 - squared * sine * sine).sqrt();
    dvec3(normal * cosine * north, normal * cosine * east, normal * (1.0 - squared) * sine)
}

/// Returns the longitude and latitude on WGS 84 of a place near its surface.
fn geographic(at: DVec3) -> DVec2 {
    let squared = F * (2.0 - F);
    let distance = libm::hypot(at.x, at.y);
    let mut latitude = libm::atan2(at.z, distance * (1.0 - squared));
    for _ in 0..LATITUDE_STEPS {
        let sine = libm::sin(latitude);
        let normal = A / (1.0 - squared * sine * sine).sqrt();
        latitude = libm::atan2(at.z + squared * normal * sine, distance);
    }
    dvec2(libm::atan2(at.y, at.x).to_degrees(), latitude.to_degrees())
}

impl fmt::Display for GeographicSystem {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Some(code) = self.code {
            return write!(f, "EPSG:{code}");
        }
        let [radius, reciprocal] = self.ellipsoid;
        write!(f, "+proj=longlat +a={radius} +rf={reciprocal}")?;
        if self.prime_meridian != 0.0 {
            write!(f, " +pm={}", self.prime_meridian)?;
        }
        if let Some(shift) = self.shift {
            write!(f, " +towgs84={}", shift.map(|number| number.to_string()).join(","))?;
        }
        Ok(())
    }
}

/// Ellipsoids by their names in PROJ: the radius in metres, and the reciprocal of the flattening.
const ELLIPSOIDS: [(&str, [f64; 2]); 14] = [
    ("WGS84", [A, 1.0 / F]),
    ("GRS80", [6_378_137.0, 298.257_222_101]),
    ("intl", [6_378_388.0, 297.0]),
    ("bessel", [6_377_397.155, 299.152_812_8]),
    ("clrk66", [6_378_206.4, 294.978_698_213_898_2]),
    ("clrk80", [6_378_249.145, 293.4663]),
    ("clrk80ign", [6_378_249.2, 293.466_021_293_626_9]),
    ("airy", [6_377_563.396, 299.324_975_315_035_1]),
    ("mod_airy", [6_377_340.189, 299.324_937_466_632_6]),
    ("krass", [6_378_245.0, 298.3]),
    ("aust_SA", [6_378_160.0, 298.25]),
    ("GRS67", [6_378_160.0, 298.247_167_427]),
    ("WGS72", [6_378_135.0, 298.26]),
    ("evrst30", [6_377_276.345, 300.8017]),
];
/// Prime meridians by their names in PROJ, in degrees.
const MERIDIANS: [(&str, f64); 9] = [
    ("greenwich", 0.0),
    ("paris", 2.337_229_166_666_667),
    ("rome", 12.452_333_333_333_333),
    ("ferro", -17.666_666_666_666_668),
    ("madrid", -3.687_938_888_888_889),
    ("bern", 7.439_583_333_333_333),
    ("lisbon", -9.131_906_111_111_112),
    ("jakarta", 106.807_719_444_444_44),
    ("oslo", 10.722_916_666_666_667),
];

/// Returns what a text of PROJ with `+proj=longlat` describes; `None` for others, and for words that are not
/// known.
pub(super) fn of_proj(text: &str) -> Option<Coordinates> {
    let mut system = GeographicSystem::on_ellipsoid([A, 1.0 / F]);
    let mut is_geographic = false;
    for word in text.split_whitespace() {
        let (key, value) = word.trim_start_matches('+').split_once('=').unwrap_or((word, ""));
        let named = |table: &[(&str, f64)]| table.iter().find(|(name, _)| *name == value).map(|&(_, n)| n);
        match key {
            "proj" => is_geographic = matches!(value, "longlat" | "latlong" | "lonlat" | "latlon"),
            "datum" if value == "WGS84" || value == "NAD83" => {}
            "ellps" => system.ellipsoid = ELLIPSOIDS.iter().find(|(name, _)| *name == value)?.1,
            "a" => system.ellipsoid[0] = value.parse().ok()?,
            "rf" => system.ellipsoid[1] = value.parse().ok()?,
            "pm" => system.prime_meridian = named(&MERIDIANS).or_else(|| value.parse().ok())?,
            "towgs84" => {
                let zeros = std::iter::repeat_n("0", 7_usize.saturating_sub(value.split(',').count()));
                system.shift = Some(numbers(value.split(',').chain(zeros))?);
            }
            "+no_defs" | "no_defs" | "type" => {}
            _ => return None,
        }
    }
    let is_possible = is_geographic
        && (1e6..1e8).contains(&system.ellipsoid[0])
        && (system.ellipsoid[1] == 0.0 || (50.0..1e9).contains(&system.ellipsoid[1]))
        && system.prime_meridian.abs() <= 360.0
        && system.shift.is_none_or(|shift| shift.iter().all(|number| number.abs() < 1e5));
    let accuracy = GeographicSystem::on_ellipsoid(system.ellipsoid).accuracy;
    let accuracy = if system.shift.is_some() { 10.0 } else { accuracy };
    is_possible.then(|| GeographicSystem { accuracy, ..system }.coordinates())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of PROJ 9 with the parameters of the table, for a place in each system.
    #[test]
    fn places_are_those_of_proj() {
        for (code, own, wgs_84) in KNOWN {
            let system = of_code(code).unwrap();
            let at = system.to_geographic(own.into());
            assert!(at.distance(wgs_84.into()) < 2e-9, "{code}: {at}");
            assert!(system.from_geographic(at).distance(own.into()) < 1e-10, "{code}");
            assert_eq!(system.to_string().parse(), Ok(system), "{code}");
        }
    }

    const KNOWN: [(u32, [f64; 2], [f64; 2]); 8] = [
        (4807, [0.5, 54.0], [2.786527406235, 48.599935016781]),
        (4806, [0.25, 41.9], [12.702154584700, 41.900644312892]),
        (4301, [139.7, 35.7], [139.696770959386, 35.703234968378]),
        (4230, [2.0, 48.0], [1.998728293171, 47.999058299749]),
        (4277, [-3.0, 55.0], [-3.001408018411, 55.000058062211]),
        (4312, [16.4, 48.2], [16.398792542071, 48.199501307852]),
        (4267, [-100.0, 50.0], [-100.000520040068, 50.000032642943]),
        (4818, [32.1, 50.1], [14.432310126477, 50.099291969625]),
    ];

    #[test]
    fn systems_near_wgs_84_are_longitudes_and_latitudes() {
        for code in [4326, 4258, 4269, 4979, 7844, 4283, 4490, 4612, 6668, 6318, 4674, 4167, 9057] {
            assert_eq!(of_code(code), Some(Coordinates::Geographic), "{code}");
        }
        for code in [4230, 4301, 4806, 4807, 4267, 4901] {
            assert!(matches!(of_code(code), Some(Coordinates::OnDatum(_))), "{code}");
        }
        assert_eq!(of_code(32633), None);
        assert!(table().rows.len() > 400 && table().rows.is_sorted_by_key(|row| row.system.code));
    }

    #[test]
    fn texts_of_proj_describe_systems() {
        let parsed = |text: &str| of_proj(text);
        assert_eq!(parsed("+proj=longlat +datum=WGS84 +no_defs"), Some(Coordinates::Geographic));
        assert_eq!(
            parsed("+proj=longlat +ellps=GRS80 +towgs84=0,0,0 +type=crs"),
            Some(Coordinates::Geographic)
        );
        let paris = "+proj=longlat +ellps=clrk80ign +pm=paris +towgs84=-168,-60,320,0,0,0,0 +no_defs";
        let at = parsed(paris).unwrap().to_geographic(dvec2(0.0, 48.8));
        let known = of_code(4275).unwrap().to_geographic(dvec2(2.337_229_166_666_667, 48.8));
        assert!(at.distance(known) < 1e-12, "{at}");
        let text = parsed(paris).unwrap().to_string();
        assert_eq!(parsed(&text), parsed(paris), "{text}");
        for text in ["+proj=utm +zone=33", "+proj=longlat +ellps=moon", "+proj=longlat +a=1", "longlat", ""] {
            assert_eq!(parsed(text), None, "{text}");
        }
    }

    #[test]
    fn names_of_programs_are_known() {
        let code = |name| GeographicSystem::named(name).and_then(|system| system.code);
        assert_eq!(code("NTF (Paris)"), Some(4807));
        assert_eq!(code("GCS_NTF_Paris"), Some(4807));
        assert_eq!(code("GCS_European_1950"), Some(4230));
        assert_eq!([code("WGS 84"), code("GCS_ETRS_1989"), code("")], [None; 3]);
    }
}
