//! What the values of a raster are, and the rule for them.

use super::RasterPyramid;
use crate::text::Number;

/// The kind of the values of a raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RasterValues {
    /// Risks, from 0 to 1. Transparent pixels of a picture are black: no risk.
    Risk,
    /// Target diameters in world units. Grey lies between the ends of the transfer curve, black is smallest.
    Diameter,
    /// The largest errors from surfaces, in their unit.
    Error,
    /// Any numbers, which a curve or a band interprets.
    Any,
}

/// Checks the values of a raster: risks are from 0 to 1, and target diameters and errors positive. Pixels
/// without a value are NaN, and ask for nothing.
///
/// # Errors
/// Fails with the first value that is not valid, row by row from the lowest, and its place.
pub fn check_values(raster: &RasterPyramid, values: RasterValues) -> Result<(), String> {
    type Check = fn(f32) -> bool;
    let (what, rule, is_valid): (_, _, Check) = match values {
        RasterValues::Risk => {
            ("risk", "it must lie from 0 to 1. Scale the values first", |value| (0.0..=1.0).contains(&value))
        }
        RasterValues::Diameter => ("target diameter", "it must be positive", |value| value > 0.0),
        RasterValues::Error => ("error", "it must be positive", |value| value > 0.0),
        RasterValues::Any => return Ok(()),
    };
    let Some(range) = raster.whole().range else { return Ok(()) };
    if is_valid(range.least) && is_valid(range.greatest) {
        return Ok(());
    }
    let raster = raster.raster();
    let is_wrong = |value: f32| !value.is_nan() && !is_valid(value);
    let wrong = raster.all().pixels().find(|&(x, y)| is_wrong(raster.get(x, y)));
    let Some((x, y)) = wrong else { return Ok(()) };
    let (value, at) = (raster.get(x, y), raster.pixel_center(x, y));
    let [value, x, y] = [f64::from(value), at.x, at.y].map(Number);
    Err(format!("the {what} is {value} at x = {x}, y = {y}; {rule}."))
}
