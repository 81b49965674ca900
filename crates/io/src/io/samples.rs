//! The samples of rasters in files, which become values in single precision.

use super::Flaw;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Number, excerpt};

/// Returns a sample in single precision, as rasters have it; NaN has no value. `remedy` says what helps where
/// it is too large.
///
/// # Errors
/// Fails with a sentence when the sample is infinite, or too large.
pub(super) fn single(value: f64, remedy: &str) -> Result<f32, Flaw> {
    let single = value as f32;
    if single.is_finite() || value.is_nan() {
        return Ok(single);
    }
    let limit = f32::MAX;
    Err(Flaw::Syntax(format!(
        "the value {value:e} is too large: a raster has single precision, up to {limit:.1e}. {remedy}"
    )))
}

/// The number that stands for "no value" in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NoData(f64);

/// The type of the samples in a file, to which the number for "no value" is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SampleType {
    Integer,
    Single,
    Double,
}

impl NoData {
    /// Returns the number for "no value" among samples of a type. A number that ends just beyond single
    /// precision, as text often does, is the largest one.
    pub(super) fn rounded(number: f64, sample: SampleType) -> Self {
        Self(match sample {
            SampleType::Integer => number.round(),
            SampleType::Double => number,
            SampleType::Single if number.is_infinite() => number,
            SampleType::Single => f64::from((number as f32).clamp(f32::MIN, f32::MAX)),
        })
    }

    /// Parses the number, as GDAL writes it: also `nan` and `-inf`.
    ///
    /// # Errors
    /// Fails with a sentence when the text is no number.
    pub(super) fn parse(text: &str, sample: SampleType) -> Result<Self, Flaw> {
        let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
        let number = if text.trim_start_matches('-').eq_ignore_ascii_case("nan") {
            f64::NAN
        } else {
            text.parse().map_err(|_| Flaw::Syntax(no_number(text)))?
        };
        Ok(Self::rounded(number, sample))
    }

    /// Returns whether a sample has no value.
    pub(super) fn is(self, sample: f64) -> bool {
        sample == self.0
    }
}

fn no_number(text: &str) -> String {
    let text = excerpt(40, text);
    format!(
        "the file marks pixels without a value with “{text}”, which is not a number. Set it again, for example with \
         gdal_edit.py -a_nodata -9999."
    )
}

/// Returns the sentence for a rectangle that has no area, with the size of a pixel in world units.
pub(super) fn no_rectangle(width: f64, height: f64) -> Flaw {
    let [width, height] = [width, height].map(Number);
    Flaw::Syntax(format!(
        "with pixels of {width} × {height} the raster covers no rectangle with {}.",
        Rect::PROPER
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use SampleType::{Double, Integer, Single};

    #[test]
    fn the_number_for_no_value_is_rounded_to_the_type_of_samples() {
        let is = |text: &str, sample, value: f64| NoData::parse(text, sample).unwrap().is(value);
        let lowest = f64::from(f32::MIN);
        for text in ["-3.4028235e+38", "-3.40282346638528898e+38", "-3.4028234663852886e+38", "-3.40283e38"] {
            assert!(is(text, Single, lowest), "{text}");
        }
        assert!(is("0.1", Single, f64::from(0.1f32)) && !is("0.1", Double, f64::from(0.1f32)));
        assert!(is("-32768.0 \0", Integer, -32768.0) && is(" 254.99999 ", Integer, 255.0));
        assert!(
            !is("nan", Single, 0.0) && !is("-NaN", Double, f64::NAN) && is("-inf", Single, -f64::INFINITY)
        );
        for text in ["", "none", "1,5", "--1", &"9x".repeat(999)] {
            let sentence = NoData::parse(text, Single).unwrap_err().to_string();
            assert!(sentence.contains("is not a number") && sentence.len() < 300, "{sentence}");
        }
    }

    #[test]
    fn samples_beyond_single_precision_are_refused() {
        assert_eq!(single(1.0e-300, "").unwrap(), 0.0);
        assert!(single(f64::NAN, "").unwrap().is_nan());
        let sentence = single(1e39, "Scale it.").unwrap_err().to_string();
        assert!(sentence.contains("1e39") && sentence.ends_with("Scale it."), "{sentence}");
    }
}
