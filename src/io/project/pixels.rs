//! Pixels as bytes: f32 by planes, so that what is alike in neighbouring numbers stands together and packs well.

use std::io::{self, Read, Write};

use super::super::Flaw;
use super::archive::Unpacking;
use crate::geometry::Rect;
use crate::paint::{TILE, TilePixels, TilePlace, Tiles, tile_area};
use crate::raster::Raster;

/// PaintRasters that a tile has something on.
const RISK: u8 = 1;
const DIAMETER: u8 = 2;

/// Most bytes that the tiles of layers with the given columns and rows take.
pub fn most_tile_bytes(size: [u32; 2]) -> u64 {
    let [columns, rows] = size.map(|side| u64::from(side.div_ceil(TILE)));
    columns * rows * (5 + 8 * u64::from(TILE * TILE))
}

/// Writes tiles: column, row, which layers, and the pixels of these. A layer that is blank there is left out.
///
/// # Errors
/// Those of `out`.
pub fn write_tiles(out: &mut dyn Write, tiles: &Tiles) -> io::Result<()> {
    for (&place, TilePixels { risk, diameter }) in tiles {
        let layers = RISK * u8::from(risk.iter().any(|&r| r != 0.0))
            + DIAMETER * u8::from(diameter.iter().any(|d| d.is_finite()));
        for n in place {
            out.write_all(&(n as u16).to_le_bytes())?;
        }
        out.write_all(&[layers])?;
        if layers & RISK != 0 {
            write_floats(out, risk)?;
        }
        if layers & DIAMETER != 0 {
            write_floats(out, diameter)?;
        }
    }
    Ok(())
}

/// Reads tiles of layers with the given columns and rows, to the end.
///
/// # Errors
/// When one lies beyond the layers or out of order, or has a value that cannot be painted.
pub fn read_tiles(input: &mut Unpacking, size: [u32; 2]) -> Result<Tiles, Flaw> {
    let tiles_along = size.map(|side| side.div_ceil(TILE));
    let mut tiles = Tiles::new();
    while !input.is_at_end() {
        let mut head = [0; 5];
        input.read_exact(&mut head).map_err(|_| Flaw::Damaged)?;
        let [a, b, c, d, layers] = head;
        let place: TilePlace = [[a, b], [c, d]].map(|n| u32::from(u16::from_le_bytes(n)));
        let in_order = tiles.last_key_value().is_none_or(|(&last, _)| last < place);
        if place[0] >= tiles_along[0] || place[1] >= tiles_along[1] || !in_order || layers > RISK + DIAMETER {
            return Err(Flaw::Syntax(format!(
                "the paint has a tile at column {}, row {} that does not belong there: the file was not written by Meshbrush.",
                place[0], place[1]
            )));
        }
        let count = tile_area(place, size).pixels().count();
        let mut layer = |bit, blank, sound: fn(f32) -> bool, name| {
            if layers & bit == 0 { Ok(vec![blank; count]) } else { read_floats(input, count, sound, name) }
        };
        let risk = layer(RISK, 0.0, is_risk, "risk")?.into();
        let diameter = layer(DIAMETER, f32::INFINITY, |d| d > 0.0, "diameter")?.into();
        tiles.insert(place, TilePixels { risk, diameter });
    }
    Ok(tiles)
}

/// Writes a raster row by row.
///
/// # Errors
/// Those of `out`.
pub fn write_raster(out: &mut dyn Write, raster: &Raster) -> io::Result<()> {
    raster.values().chunks_exact(raster.size()[0] as usize).try_for_each(|row| write_floats(out, row))
}

/// Reads a raster of risks.
///
/// # Errors
/// When the bytes end too early, or a value is no risk.
pub fn read_risks(input: &mut Unpacking, bounds: Rect, size: [u32; 2]) -> Result<Raster, Flaw> {
    let mut values = Vec::new();
    for _ in 0..size[1] {
        values.extend(read_floats(input, size[0] as usize, is_risk, "risk")?);
    }
    Ok(Raster::from_values(bounds, size, values))
}

fn is_risk(value: f32) -> bool {
    (0.0..=1.0).contains(&value)
}

/// Numbers as four runs of bytes, the most significant bytes first.
fn write_floats(out: &mut dyn Write, values: &[f32]) -> io::Result<()> {
    for plane in 0..4 {
        let bytes: Vec<u8> = values.iter().map(|value| value.to_be_bytes()[plane]).collect();
        out.write_all(&bytes)?;
    }
    Ok(())
}

fn read_floats(
    input: &mut Unpacking,
    count: usize,
    sound: fn(f32) -> bool,
    name: &str,
) -> Result<Vec<f32>, Flaw> {
    let mut bytes = vec![0; 4 * count];
    input.read_exact(&mut bytes).map_err(|_| Flaw::Damaged)?;
    let value = |i| f32::from_be_bytes([0, 1, 2, 3].map(|plane| bytes[plane * count + i]));
    let values: Vec<f32> = (0..count).map(value).collect();
    match values.iter().find(|&&value| !sound(value)) {
        Some(value) => Err(Flaw::Syntax(format!(
            "a {name} of {value} was never painted: the file was not written by Meshbrush."
        ))),
        None => Ok(values),
    }
}
