//! Pixels as bytes: f32 in four planes. Neighbouring numbers often have equal high bytes, and equal bytes in
//! a row pack well.

use std::io::{self, Read, Write};

use super::super::Flaw;
use super::archive::Unpacking;
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;

/// Writes a raster row by row from the lowest.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_raster(out: &mut dyn Write, raster: &Raster) -> io::Result<()> {
    raster.values().chunks_exact(raster.size()[0] as usize).try_for_each(|row| write_floats(out, row))
}

/// Reads a raster of any values; NaN where it has none.
///
/// # Errors
/// Fails when the bytes end too early.
pub fn read_values(input: &mut Unpacking, bounds: Rect, size: [u32; 2]) -> Result<Raster, Flaw> {
    let mut values = Vec::new();
    for _ in 0..size[1] {
        values.extend(read_floats(input, size[0] as usize, |_| true, "value")?);
    }
    Ok(Raster::from_values(bounds, size, values))
}

pub(super) fn is_risk(value: f32) -> bool {
    (0.0..=1.0).contains(&value)
}

/// Writes numbers as four planes of bytes, the most significant bytes first.
pub(super) fn write_floats(out: &mut dyn Write, values: &[f32]) -> io::Result<()> {
    for plane in 0..4 {
        let bytes: Vec<u8> = values.iter().map(|value| value.to_be_bytes()[plane]).collect();
        out.write_all(&bytes)?;
    }
    Ok(())
}

pub(super) fn read_floats(
    input: &mut Unpacking,
    count: usize,
    is_valid: fn(f32) -> bool,
    name: &str,
) -> Result<Vec<f32>, Flaw> {
    let mut bytes = vec![0; 4 * count];
    input.read_exact(&mut bytes).map_err(|_| Flaw::Damaged)?;
    let value = |i| f32::from_be_bytes([0, 1, 2, 3].map(|plane| bytes[plane * count + i]));
    let values: Vec<f32> = (0..count).map(value).collect();
    match values.iter().find(|&&value| !is_valid(value)) {
        Some(value) => Err(Flaw::Syntax(format!(
            "a {name} of {value} cannot be painted: Meshbrush did not write this file."
        ))),
        None => Ok(values),
    }
}
