//! What samples mean: numbers that are no value, and packed values.

use super::super::Flaw;
use super::super::samples::{NoData, single};
use super::axis::packing;
use super::contents::{Sample, Variable};

/// Most numbers for "no value" of a variable.
const MOST_MARKS: usize = 16;

/// How samples become values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Packing {
    marks: Vec<NoData>,
    /// The least and the greatest sample that is a value.
    valid: [f64; 2],
    scale: f64,
    offset: f64,
    /// What is added to negative samples that are meant without a sign; 0 where they have one.
    wrap: f64,
}

impl Packing {
    pub(super) fn of(variable: &Variable) -> Self {
        let (scale, offset) = packing(variable);
        let sample = variable.sample.unwrap_or(Sample::F64);
        let is_unsigned = variable.text("_Unsigned").is_some_and(|text| text.eq_ignore_ascii_case("true"));
        let wrap = match sample {
            Sample::I8 | Sample::I16 | Sample::I32 if is_unsigned => 256f64.powi(sample.bytes() as i32),
            _ => 0.0,
        };
        let number = |number: f64| if number < 0.0 { number + wrap } else { number };
        let (fill, missing) = (variable.numbers("_FillValue"), variable.numbers("missing_value"));
        let default = if fill.is_empty() { sample.default_fill() } else { None };
        let marks = fill.iter().chain(missing).copied().chain(default).take(MOST_MARKS);
        let marks = marks.map(|mark| NoData::rounded(number(mark), sample.sample_type())).collect();
        let mut valid = [f64::NEG_INFINITY, f64::INFINITY];
        // Files disagree whether the valid range of packed values is packed too.
        if (scale, offset) == (1.0, 0.0) {
            if let [least, greatest] = variable.numbers("valid_range")[..] {
                valid = [number(least), number(greatest)];
            }
            let end = |name: &str| variable.numbers(name).first().map(|&end| number(end));
            valid = [end("valid_min").unwrap_or(valid[0]), end("valid_max").unwrap_or(valid[1])];
        }
        // Files that state no range write one that holds nothing.
        if valid[0] >= valid[1] || valid.iter().any(|end| end.is_nan()) {
            valid = [f64::NEG_INFINITY, f64::INFINITY];
        }
        Self { marks, valid, scale, offset, wrap }
    }

    /// Returns the value of a sample; NaN where it is none.
    ///
    /// # Errors
    /// Fails with a sentence when the value is infinite, or too large.
    pub(super) fn value(&self, sample: f64) -> Result<f32, Flaw> {
        let sample = if sample < 0.0 { sample + self.wrap } else { sample };
        let [least, greatest] = self.valid;
        if self.marks.iter().any(|mark| mark.is(sample)) || sample < least || sample > greatest {
            return Ok(f32::NAN);
        }
        let remedy = "If it marks pixels without a value, say so in the file with the attribute _FillValue.";
        single(sample * self.scale + self.offset, remedy)
    }
}
