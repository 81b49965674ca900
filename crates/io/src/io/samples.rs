//! The samples of rasters in files, which become values in single precision.

use super::Flaw;
use super::vertical::{ValueFacts, ValueUnit};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Grouped, Number, excerpt};

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

/// Numbers of great size that programs write where there is no value: the largest one of single precision,
/// the fill of NetCDF, those of climate models, of GMT and of Surfer.
const HUGE_FILLS: [f64; 6] = [3.402_823_5e38, 9.969_21e36, 1e20, 1e30, 1e36, 1.701_41e38];
/// How far a sample may be from one of [`HUGE_FILLS`], as a share of it.
const HUGE_TOLERANCE: f64 = 1e-5;
/// The ends of whole numbers of 16 bits, which mark pixels without a value where a file names no number.
const SHORT_FILLS: [f64; 2] = [-32_768.0, -32_767.0];
/// Numbers that often mark pixels without a value, and may be values.
const COMMON_MARKS: [f64; 10] =
    [-32_768.0, -9_999.0, -99_999.0, -999.0, -999_999.0, 9_999.0, 99_999.0, 999_999.0, 32_767.0, 65_535.0];
/// How far a common mark must be from the next sample to be pointed out, as a share of the range of all
/// others.
const LEAST_GAP: f64 = 0.25;

/// How the samples of a file become values.
#[derive(Clone, Debug)]
pub(super) struct SampleUnpacking {
    /// Samples that are no value.
    pub(super) marks: Vec<NoData>,
    /// Whether the file declares some of them.
    pub(super) has_declared: bool,
    /// The least and the greatest sample that is a value.
    pub(super) valid: [f64; 2],
    /// What samples are multiplied by, before `offset` is added.
    pub(super) scale: f64,
    pub(super) offset: f64,
    /// The unit of values before they become metres.
    pub(super) unit: ValueUnit,
    /// What helps where a value is too large.
    pub(super) remedy: &'static str,
    pub(super) undeclared: Undeclared,
}

/// Numbers for "no value" that a file does not declare.
#[derive(Clone, Copy, Debug)]
pub(super) struct Undeclared {
    /// The first one that was found, and how many there are of any.
    found: Option<f64>,
    count: usize,
    /// The least sample and the next one, and the greatest and the one before.
    low: [f64; 2],
    high: [f64; 2],
}

impl SampleUnpacking {
    /// Returns what takes samples for values.
    pub(super) fn plain(remedy: &'static str) -> Self {
        Self {
            marks: Vec::new(),
            has_declared: false,
            valid: [f64::NEG_INFINITY, f64::INFINITY],
            scale: 1.0,
            offset: 0.0,
            unit: ValueUnit::Unstated,
            remedy,
            undeclared: Undeclared {
                found: None,
                count: 0,
                low: [f64::INFINITY; 2],
                high: [f64::NEG_INFINITY; 2],
            },
        }
    }

    /// Returns the value of a sample, in metres where the file has another unit of length; NaN where it is
    /// none.
    ///
    /// # Errors
    /// Fails with a sentence when the value is infinite, or too large.
    pub(super) fn value(&mut self, sample: f64) -> Result<f32, Flaw> {
        let [least, greatest] = self.valid;
        if self.marks.iter().any(|mark| mark.is(sample)) || sample < least || sample > greatest {
            return Ok(f32::NAN);
        }
        if is_undeclared_fill(sample, self.has_declared) {
            self.undeclared.found.get_or_insert(sample);
            self.undeclared.count += 1;
            return Ok(f32::NAN);
        }
        self.undeclared.see(sample);
        single((sample * self.scale + self.offset) * self.unit.metres(), self.remedy)
    }

    /// Returns what a person should know about the values that were read, beside the direction in which they
    /// grow.
    pub(super) fn facts(self) -> ValueFacts {
        let notes = self.unit.note().into_iter().chain(self.undeclared.note());
        ValueFacts { notes: notes.collect(), unit: self.unit, ..ValueFacts::default() }
    }
}

fn is_undeclared_fill(sample: f64, has_declared: bool) -> bool {
    let size = sample.abs();
    let is_huge = size >= 1e19 && HUGE_FILLS.iter().any(|fill| (size - fill).abs() <= HUGE_TOLERANCE * fill);
    is_huge || (!has_declared && SHORT_FILLS.contains(&sample))
}

impl Undeclared {
    fn see(&mut self, sample: f64) {
        let [least, next] = self.low;
        if sample < next && sample != least {
            self.low = if sample < least { [sample, least] } else { [least, sample] };
        }
        let [greatest, before] = self.high;
        if sample > before && sample != greatest {
            self.high = if sample > greatest { [sample, greatest] } else { [greatest, sample] };
        }
    }

    /// Returns a common mark that is far from all other samples.
    fn outlier(&self) -> Option<f64> {
        let ([least, next], [greatest, before]) = (self.low, self.high);
        let is_far = |mark: f64, gap: f64, range: f64| {
            COMMON_MARKS.contains(&mark) && gap.is_finite() && gap > LEAST_GAP * range
        };
        if is_far(least, next - least, greatest - next) {
            Some(least)
        } else {
            is_far(greatest, greatest - before, before - least).then_some(greatest)
        }
    }

    fn note(&self) -> Option<String> {
        if let Some(found) = self.found {
            let (count, found) = (Grouped(self.count), Number(found));
            return Some(format!(
                "{count} pixels have a number such as {found}, which the file does not declare and which marks pixels \
                 without a value in many files: they have no value here."
            ));
        }
        let mark = Number(self.outlier()?);
        Some(format!(
            "some pixels have the value {mark}, which is far from all others and counts as a value. If it marks pixels \
             without a value, declare it in the file."
        ))
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
