use super::RasterReading;
use meshbrush_core::raster::RasterPyramid;
use meshbrush_mesh::text::Number;

/// Checks the values of a raster: risks are from 0 to 1, and target diameters positive. Pixels without a
/// value are NaN, and ask for nothing.
///
/// # Errors
/// With the first value that is not valid, and its place.
pub fn check_values(raster: &RasterPyramid, reading: &RasterReading) -> Result<(), String> {
    type Check = fn(f32) -> bool;
    let (what, rule, is_valid): (_, _, Check) = match reading {
        RasterReading::Risk => {
            ("risk", "it must lie from 0 to 1. Scale the values first", |value| (0.0..=1.0).contains(&value))
        }
        RasterReading::Diameter => ("target diameter", "it must be positive", |value| value > 0.0),
        RasterReading::Curve(_) => return Ok(()),
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
