//! Longitudes and latitudes as people write and type them.

use glam::{DVec2, dvec2};

use super::wrapped;

/// How an angle is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DegreeStyle {
    /// `5.508° W`
    #[default]
    Decimal,
    /// `5° 30.5′ W`
    Minutes,
}

/// One of two coordinates on the Earth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GeographicAxis {
    /// West or east.
    Longitude,
    /// South or north.
    Latitude,
}

impl DegreeStyle {
    /// Returns the text of an angle in degrees, with the digits that tell it apart from one that is `step`
    /// degrees away.
    pub fn text(self, axis: GeographicAxis, degrees: f64, step: f64) -> String {
        let degrees = if axis == GeographicAxis::Longitude { wrapped(degrees) } else { degrees };
        match self {
            Self::Decimal => {
                let decimals = decimals_for(step);
                let text = format!("{:.decimals$}", degrees.abs());
                format!("{text}°{}", letter(axis, degrees, text.parse().unwrap_or(0.0)))
            }
            Self::Minutes => {
                let decimals = decimals_for(60.0 * step);
                let unit = libm::exp10(decimals as f64);
                let minutes = (60.0 * degrees.abs() * unit).round() / unit;
                let (whole, rest) = ((minutes / 60.0).floor(), minutes % 60.0);
                let letter = letter(axis, degrees, minutes / 60.0);
                match decimals {
                    0 if rest == 0.0 => format!("{whole}°{letter}"),
                    0 => format!("{whole}° {rest:02}′{letter}"),
                    _ => format!("{whole}° {rest:0width$.decimals$}′{letter}", width = decimals + 3),
                }
            }
        }
    }
}

/// Returns the letter of the side of the equator or of the prime meridian, for an angle that is written as
/// `shown` degrees; none where both sides meet.
fn letter(axis: GeographicAxis, degrees: f64, shown: f64) -> &'static str {
    match axis {
        _ if shown == 0.0 => "",
        GeographicAxis::Longitude if shown == 180.0 => "",
        GeographicAxis::Longitude if degrees > 0.0 => " E",
        GeographicAxis::Longitude => " W",
        GeographicAxis::Latitude if degrees > 0.0 => " N",
        GeographicAxis::Latitude => " S",
    }
}

fn decimals_for(step: f64) -> usize {
    if step > 0.0 { (-libm::log10(step) - 1e-9).ceil().clamp(0.0, 9.0) as usize } else { 0 }
}

/// Reads a place on the Earth: two angles in degrees, or degrees, minutes and seconds, with the letters N, S,
/// E and W in any order, or longitude and latitude with signs of degrees. Returns longitude and latitude, in
/// degrees; `None` for any other text.
///
/// ```text
/// 50.2 N 5.5 W     5° 30′ W, 50° 12′ N     N50 12 36 W5 30 0     -5.5°, 50.2°
/// ```
pub fn geographic_from_text(text: &str) -> Option<DVec2> {
    let text = text.trim().to_uppercase();
    let [first, second] = halves(&text)?.map(angle);
    let (first, second) = (first?, second?);
    let (longitude, latitude) = match (first.axis, second.axis) {
        (Some(GeographicAxis::Latitude), Some(GeographicAxis::Longitude)) => (second, first),
        (Some(GeographicAxis::Longitude), Some(GeographicAxis::Latitude)) => (first, second),
        (None, None) if first.has_sign_of_degrees && second.has_sign_of_degrees => (first, second),
        // At 0° and 180° there is no side.
        (None, Some(GeographicAxis::Latitude)) if first.has_no_side() => (first, second),
        (None, Some(GeographicAxis::Longitude)) if first.has_no_side() => (second, first),
        (Some(GeographicAxis::Latitude), None) if second.has_no_side() => (second, first),
        (Some(GeographicAxis::Longitude), None) if second.has_no_side() => (first, second),
        _ => return None,
    };
    let is_on_earth = longitude.degrees.abs() <= 360.0 && latitude.degrees.abs() <= 90.0;
    is_on_earth.then_some(dvec2(longitude.degrees, latitude.degrees))
}

/// An angle as it was typed.
#[derive(Clone, Copy)]
struct TypedAngle {
    degrees: f64,
    /// `None` without a letter.
    axis: Option<GeographicAxis>,
    has_sign_of_degrees: bool,
}

impl TypedAngle {
    fn has_no_side(&self) -> bool {
        self.has_sign_of_degrees && (self.degrees == 0.0 || self.degrees == 180.0)
    }
}

const LETTERS: [char; 4] = ['N', 'S', 'E', 'W'];

/// Returns the texts of two angles: separated by a comma or a semicolon, or by the letter that ends the first
/// one or begins the second.
fn halves(text: &str) -> Option<[&str; 2]> {
    if let Some((first, second)) = text.split_once([',', ';']) {
        return Some([first, second]);
    }
    let letters: Vec<usize> = text.match_indices(LETTERS).map(|(place, _)| place).collect();
    let middle = match letters[..] {
        [0, second] => second,
        [first, _] => first + 1,
        // The number before the second sign of degrees begins the second one.
        [] | [_] => {
            let (second, _) = text.match_indices('°').nth(1)?;
            text[..second].rfind(char::is_whitespace)?
        }
        _ => return None,
    };
    Some([&text[..middle], &text[middle..]])
}

/// Reads an angle of degrees, minutes and seconds. Only the last of them may have decimals.
fn angle(text: &str) -> Option<TypedAngle> {
    let letters: Vec<char> = text.chars().filter(|letter| LETTERS.contains(letter)).collect();
    let letter = match letters[..] {
        [] => None,
        [letter] => Some(letter),
        _ => return None,
    };
    let has_sign_of_degrees = text.contains('°');
    let number = text.trim().trim_matches(LETTERS).trim();
    let is_negative = number.starts_with(['-', '−']);
    let signs = ['°', '′', '\'', '’', '″', '"', '”'];
    let parts =
        number.trim_start_matches(['-', '−', '+']).split(|c: char| c.is_whitespace() || signs.contains(&c));
    let parts: Vec<f64> = parts.filter(|part| !part.is_empty()).map(unsigned).collect::<Option<_>>()?;
    let degrees = match parts[..] {
        [degrees] => degrees,
        [degrees, minutes] if is_whole(degrees) && minutes < 60.0 => degrees + minutes / 60.0,
        [degrees, minutes, seconds]
            if is_whole(degrees) && is_whole(minutes) && minutes < 60.0 && seconds < 60.0 =>
        {
            degrees + minutes / 60.0 + seconds / 3600.0
        }
        _ => return None,
    };
    let (axis, is_other_side) = match letter {
        None => (None, is_negative),
        // A letter says the side already.
        Some(_) if is_negative => return None,
        Some(letter) => {
            let axis = if letter == 'N' || letter == 'S' {
                GeographicAxis::Latitude
            } else {
                GeographicAxis::Longitude
            };
            (Some(axis), letter == 'S' || letter == 'W')
        }
    };
    let degrees = if is_other_side { -degrees } else { degrees };
    Some(TypedAngle { degrees, axis, has_sign_of_degrees })
}

fn unsigned(text: &str) -> Option<f64> {
    let is_plain = text.chars().all(|c| c.is_ascii_digit() || c == '.');
    text.parse().ok().filter(|_| is_plain)
}

fn is_whole(number: f64) -> bool {
    number.fract() == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use GeographicAxis::{Latitude, Longitude};

    #[test]
    fn angles_are_written_with_the_digits_of_a_step() {
        for (style, axis, degrees, step, text) in [
            (DegreeStyle::Decimal, Longitude, -5.5083, 0.001, "5.508° W"),
            (DegreeStyle::Decimal, Latitude, 50.0, 1.0, "50° N"),
            (DegreeStyle::Decimal, Longitude, 190.5, 0.1, "169.5° W"),
            (DegreeStyle::Decimal, Longitude, -0.0004, 0.001, "0.000°"),
            (DegreeStyle::Minutes, Longitude, -5.5083, 0.001, "5° 30.50′ W"),
            (DegreeStyle::Minutes, Latitude, -50.999_999, 0.01, "51° 00.0′ S"),
            (DegreeStyle::Minutes, Latitude, 12.5, 0.5, "12° 30′ N"),
            (DegreeStyle::Minutes, Longitude, 180.0, 1.0, "180°"),
        ] {
            assert_eq!(style.text(axis, degrees, step), text);
        }
    }

    fn label(minutes: f64, step: f64, is_meridian: bool) -> String {
        let axis = if is_meridian { Longitude } else { Latitude };
        DegreeStyle::Minutes.text(axis, minutes / 60.0, step / 60.0)
    }

    #[test]
    fn labels_have_degrees_minutes_and_a_direction() {
        for (minutes, step, is_meridian, text) in [
            (-300.0, 60.0, true, "5° W"),
            (330.0, 30.0, true, "5° 30′ E"),
            (-0.0, 60.0, true, "0°"),
            (-10_800.0, 600.0, true, "180°"),
            (11_100.0, 300.0, true, "175° W"),
            (2945.0, 5.0, false, "49° 05′ N"),
            (-2945.2, 0.2, false, "49° 05.2′ S"),
            (2999.95, 0.05, false, "49° 59.95′ N"),
        ] {
            assert_eq!(label(minutes, step, is_meridian), text);
        }
    }

    #[test]
    fn labels_say_the_degrees_of_their_line() {
        let mut random = fastrand::Rng::with_seed(35);
        let steps = [600.0, 300.0, 60.0, 30.0, 10.0, 5.0, 1.0, 0.5, 0.2, 0.05, 0.01];
        for _ in 0..3_000 {
            let (step, is_meridian) = (steps[random.usize(..steps.len())], random.bool());
            let most = if is_meridian { 43_200.0 } else { 5_400.0 };
            let minutes = step * (most / step * (2.0 * random.f64() - 1.0)).round();
            let text = label(minutes, step, is_meridian);
            let (number, letter) =
                text.split_at(text.find(|c: char| c.is_ascii_uppercase()).unwrap_or(text.len()));
            let mut parts = number.split(['°', '′']).map(|part| part.trim().parse::<f64>().unwrap_or(0.0));
            let [degrees, rest] = [(); 2].map(|()| parts.next().unwrap_or(0.0));
            assert!((0.0..60.0).contains(&rest), "{minutes}: {text}");
            let said = (60.0 * degrees + rest) * if ["W", "S"].contains(&letter) { -1.0 } else { 1.0 };
            // Meridians meet again after a turn.
            let off = if is_meridian { (said - minutes) / 21_600.0 } else { (said - minutes) / 1e9 };
            assert!((off - off.round()).abs() < 1e-9, "{minutes}: {text}");
            assert!(
                said.abs() <= 10_800.0 && ["", "E", "W"].contains(&letter) == (is_meridian || said == 0.0),
                "{text}"
            );
        }
    }

    #[test]
    fn places_are_read_however_their_angles_are_typed() {
        let west = dvec2(-5.5, 50.2);
        for text in [
            "50.2 N 5.5 W",
            "50.2N, 5.5W",
            "5° 30′ W, 50° 12′ N",
            "N50 12 0 W5 30",
            "50°12'00\"n 5°30'w",
            "-5.5°, 50.2°",
            "−5.5° 50.2°",
            "−5° 30′ 50° 12′",
            "5.5° w 50.2° n",
        ] {
            let place = geographic_from_text(text).unwrap_or_else(|| panic!("{text}"));
            assert!((place - west).abs().max_element() < 1e-12, "{text}: {place}");
        }
        for text in [
            "",
            "N",
            "50.2 N",
            "50.2 N 5.5 N",
            "5, 6",
            "5 N 6",
            "5 61 N 6 W",
            "5.5 30 N 6 W",
            "91 N 1 E",
            "-5 N 3 E",
            "x N 3 E",
            "1,5 N, 2 W",
            "NaN N 1 E",
        ] {
            assert_eq!(geographic_from_text(text), None, "{text}");
        }
    }

    /// What is shown can be typed.
    #[test]
    fn a_text_is_read_as_the_place_that_it_shows() {
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..10_000 {
            let at = dvec2(random.f64() * 360.0 - 180.0, random.f64() * 180.0 - 90.0);
            let step = libm::exp10(1.0 - random.f64() * 7.0);
            for style in [DegreeStyle::Decimal, DegreeStyle::Minutes] {
                let text = [style.text(Longitude, at.x, step), style.text(Latitude, at.y, step)].join(" ");
                let read = geographic_from_text(&text).unwrap_or_else(|| panic!("{text} of {at}"));
                // 180° is on both sides.
                let off = dvec2(wrapped(read.x - at.x), read.y - at.y);
                assert!(off.abs().max_element() <= step, "{text} of {at}");
            }
        }
    }
}
