//! What samples mean: numbers that are no value, packed values, their unit and direction.

use super::super::Flaw;
use super::super::samples::{NoData, SampleUnpacking};
use super::super::vertical::{ValueFacts, ValueUnit, direction};
use super::axis::packing;
use super::contents::{ReadVariable, StoredType};
use meshbrush_core::layers::PositiveDepth;

/// Most numbers for "no value" of a variable.
const MOST_MARKS: usize = 16;
/// What helps where a value is too large.
const REMEDY: &str = "If it marks pixels without a value, say so in the file with the attribute _FillValue.";
const EVERYTHING: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// How samples become values.
#[derive(Clone, Debug)]
pub(super) struct SamplePacking {
    unpacking: SampleUnpacking,
    /// What is added to negative samples that are meant without a sign; 0 where they have one.
    wrap: f64,
    positive: Option<PositiveDepth>,
}

impl SamplePacking {
    pub(super) fn of(variable: &ReadVariable) -> Self {
        let (scale, offset) = packing(variable);
        let sample = variable.sample.unwrap_or(StoredType::F64);
        let is_unsigned = variable.text("_Unsigned").is_some_and(|text| text.eq_ignore_ascii_case("true"));
        let wrap = match sample {
            StoredType::I8 | StoredType::I16 | StoredType::I32 if is_unsigned => {
                256f64.powi(sample.bytes() as i32)
            }
            _ => 0.0,
        };
        let number = |number: f64| if number < 0.0 { number + wrap } else { number };
        let (fill, missing) = (variable.numbers("_FillValue"), variable.numbers("missing_value"));
        let default = if fill.is_empty() { sample.default_fill() } else { None };
        let marks = fill.iter().chain(missing).copied().chain(default).take(MOST_MARKS);
        let marks = marks.map(|mark| NoData::rounded(number(mark), sample.sample_type())).collect();
        let valid = valid_samples(variable, number);
        let unit = ValueUnit::named(variable.text("units").unwrap_or_default());
        let has_declared = !fill.is_empty() || !missing.is_empty();
        let unpacking = SampleUnpacking {
            marks,
            has_declared,
            valid,
            scale,
            offset,
            unit,
            ..SampleUnpacking::plain(REMEDY)
        };
        let positive = direction(variable.text("positive"), variable.text("standard_name"));
        Self { unpacking, wrap, positive }
    }

    /// Returns the value of a sample; NaN where it is none.
    ///
    /// # Errors
    /// Fails with a sentence when the value is infinite, or too large.
    pub(super) fn value(&mut self, sample: f64) -> Result<f32, Flaw> {
        self.unpacking.value(if sample < 0.0 { sample + self.wrap } else { sample })
    }

    /// Returns what a person should know about the values that were read.
    pub(super) fn facts(self) -> ValueFacts {
        ValueFacts { positive: self.positive, ..self.unpacking.facts() }
    }
}

/// Returns the least and the greatest sample that is a value. `number` is what a sample in the file stands
/// for.
///
/// Ends of the type of the samples are packed, as the samples are. Floating-point ends of packed whole
/// numbers are values, as the NetCDF User Guide has it.
fn valid_samples(variable: &ReadVariable, number: impl Fn(f64) -> f64) -> [f64; 2] {
    let (scale, offset) = packing(variable);
    let end = |name: &str| variable.numbers(name).first().copied();
    let range = match variable.numbers("valid_range")[..] {
        [least, greatest] => [least, greatest],
        _ => EVERYTHING,
    };
    let ends = [end("valid_min").unwrap_or(range[0]), end("valid_max").unwrap_or(range[1])];
    let types = ["valid_range", "valid_min", "valid_max"].map(|name| variable.type_of_numbers(name));
    let are_values = variable.sample.is_some_and(StoredType::is_whole)
        && (scale, offset) != (1.0, 0.0)
        && !types.into_iter().flatten().any(StoredType::is_whole);
    let [least, greatest] = match are_values {
        true => ends.map(|end| (end - offset) / scale),
        false => ends.map(number),
    };
    let is_turned = are_values && scale < 0.0;
    let valid = if is_turned { [greatest, least] } else { [least, greatest] };
    // Files that state no range write one that holds nothing.
    if valid[0] < valid[1] { valid } else { EVERYTHING }
}
