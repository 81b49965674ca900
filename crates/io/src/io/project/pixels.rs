//! Pixels as bytes: f32 in four planes. Neighbouring numbers often have equal high bytes, and equal bytes in
//! a row pack well.

use std::io::{self, Read, Write};

use super::super::Flaw;
use super::archive::Unpacking;
use super::old_tiles::{TILE, TilePixels, TilePlace, Tiles, tile_area};
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;

/// The rasters on which a tile has paint, as bits of one byte.
const RISK: u8 = 1;
const DIAMETER: u8 = 2;

/// Returns the most bytes of the tiles of rasters with `size` = [columns, rows].
pub fn most_tile_bytes(size: [u32; 2]) -> u64 {
    let [columns, rows] = size.map(|side| u64::from(side.div_ceil(TILE)));
    columns * rows * (5 + 8 * u64::from(TILE * TILE))
}

/// Reads all tiles of rasters with `size` = [columns, rows].
///
/// # Errors
/// Fails when a tile lies outside the rasters or is out of order, or has a value that cannot be painted.
pub fn read_tiles(input: &mut Unpacking, size: [u32; 2]) -> Result<Tiles, Flaw> {
    let tiles_along = size.map(|side| side.div_ceil(TILE));
    let mut tiles = Tiles::new();
    while !input.is_at_end() {
        let mut head = [0; 5];
        input.read_exact(&mut head).map_err(|_| Flaw::Damaged)?;
        let [a, b, c, d, painted] = head;
        let place: TilePlace = [[a, b], [c, d]].map(|n| u32::from(u16::from_le_bytes(n)));
        let in_order = tiles.last_key_value().is_none_or(|(&last, _)| last < place);
        if place[0] >= tiles_along[0] || place[1] >= tiles_along[1] || !in_order || painted > RISK + DIAMETER
        {
            return Err(Flaw::Syntax(format!(
                "the paint has a tile at column {}, row {} that is outside or out of order: Meshbrush did not write this file.",
                place[0], place[1]
            )));
        }
        let count = tile_area(place, size).pixels().count();
        let mut pixels = |bit, blank, is_valid: fn(f32) -> bool, name| {
            if painted & bit == 0 {
                Ok(vec![blank; count])
            } else {
                read_floats(input, count, is_valid, name)
            }
        };
        let risk = pixels(RISK, 0.0, is_risk, "risk")?.into();
        let diameter = pixels(DIAMETER, f32::INFINITY, |d| d > 0.0, "diameter")?.into();
        tiles.insert(place, TilePixels { risk, diameter });
    }
    Ok(tiles)
}

/// Writes a raster row by row from the lowest.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_raster(out: &mut dyn Write, raster: &Raster) -> io::Result<()> {
    raster.values().chunks_exact(raster.size()[0] as usize).try_for_each(|row| write_floats(out, row))
}

/// Reads a raster of risks; places without a value are NaN.
///
/// # Errors
/// Fails when the bytes end too early, or a value is not between 0 and 1.
pub fn read_risks(input: &mut Unpacking, bounds: Rect, size: [u32; 2]) -> Result<Raster, Flaw> {
    read_raster(input, bounds, size, |value| value.is_nan() || is_risk(value), "risk")
}

/// Reads a raster of target diameters; where it asks for nothing they are infinite or NaN.
///
/// # Errors
/// Fails when the bytes end too early, or a value is not positive.
pub fn read_diameters(input: &mut Unpacking, bounds: Rect, size: [u32; 2]) -> Result<Raster, Flaw> {
    read_raster(input, bounds, size, |value| value.is_nan() || value > 0.0, "target diameter")
}

/// Reads a raster of any values; NaN where it has none.
///
/// # Errors
/// Fails when the bytes end too early.
pub fn read_values(input: &mut Unpacking, bounds: Rect, size: [u32; 2]) -> Result<Raster, Flaw> {
    read_raster(input, bounds, size, |_| true, "value")
}

fn read_raster(
    input: &mut Unpacking,
    bounds: Rect,
    size: [u32; 2],
    is_valid: fn(f32) -> bool,
    what: &'static str,
) -> Result<Raster, Flaw> {
    let mut values = Vec::new();
    for _ in 0..size[1] {
        values.extend(read_floats(input, size[0] as usize, is_valid, what)?);
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
