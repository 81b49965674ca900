use super::{LengthUnit, excerpt, typed};

/// Units of area, in square metres.
const UNITS: [(&str, f64); 7] =
    [("km²", 1e6), ("km2", 1e6), ("km^2", 1e6), ("m²", 1.0), ("m2", 1.0), ("m^2", 1.0), ("ha", 1e4)];

/// Returns the area that a user typed, as in `2 km²`, `5 ha` or `4000`, in the square of a unit of length:
/// square kilometres for kilometres, otherwise square metres.
///
/// # Errors
/// Fails with a sentence that says what was not understood.
pub fn area(text: &str, unit: LengthUnit) -> Result<f64, String> {
    let with_unit = UNITS.iter().find_map(|(word, factor)| Some((text.trim().strip_suffix(word)?, factor)));
    let Some((number, factor)) = with_unit else {
        return typed::number(text, "").map_err(|_| {
            format!(
                "“{}” is no area: write a number, or one in m², ha or km², as in \"2 km²\".",
                excerpt(40, text)
            )
        });
    };
    let square_metres = typed::number(number, "")? * factor;
    Ok(if unit == LengthUnit::Kilometre { square_metres / 1e6 } else { square_metres })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_are_written_as_people_like() {
        for (text, square_metres) in [
            ("4000", 4000.0),
            ("2 km²", 2e6),
            ("0.5km2", 5e5),
            ("1 km^2", 1e6),
            ("5 ha", 5e4),
            ("300 m²", 300.0),
            ("1,200 m2", 1200.0),
            ("-1 m^2", -1.0),
        ] {
            assert_eq!(area(text, LengthUnit::Metre), Ok(square_metres), "{text}");
        }
        assert_eq!(area("3 km²", LengthUnit::Kilometre), Ok(3.0));
        assert_eq!(area("3", LengthUnit::Kilometre), Ok(3.0), "a plain number stays");
        for text in ["", "km²", "2 km", "2 apples", "two ha"] {
            assert!(area(text, LengthUnit::Metre).is_err(), "{text}");
        }
    }
}
