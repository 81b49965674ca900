//! Sparse rasters as bytes: tile after tile, in the order of their places. Equal rasters give equal bytes.
//!
//! A tile has its depth (one byte), a byte that is 1 if pixels follow and 0 for a place whose tile is
//! removed, its column and row (32 bits each, little-endian), and its pixels as [`super::pixels`] writes
//! them.

use std::collections::BTreeMap;
use std::io::{self, Read, Write};
use std::sync::Arc;

use super::super::Flaw;
use super::archive::Unpacking;
use super::pixels::{is_risk, read_floats, write_floats};
use meshbrush_core::layers::Quantity;
use meshbrush_core::raster::{PixelGrid, TILE, Tile, TilePlace, TiledRaster};

const PIXELS: usize = (TILE * TILE) as usize;

/// Tiles by their places; `None` where a tile is removed.
pub type ChangedTiles = BTreeMap<TilePlace, Option<Arc<Tile>>>;

/// Writes all tiles of a raster.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_raster(out: &mut dyn Write, raster: &TiledRaster) -> io::Result<()> {
    raster.tiles().try_for_each(|(place, tile)| write_tile(out, place, Some(tile)))
}

/// Writes the tiles that changed.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_changes(out: &mut dyn Write, tiles: &ChangedTiles) -> io::Result<()> {
    tiles.iter().try_for_each(|(&place, tile)| write_tile(out, place, tile.as_deref()))
}

/// Reads all tiles of a raster whose pixels of depth 0 lie on `grid`.
///
/// # Errors
/// Fails as [`read_changes`] does, and when a tile is removed or lies over no tile of the next smaller depth.
pub fn read_raster(input: &mut Unpacking, grid: PixelGrid, quantity: Quantity) -> Result<TiledRaster, Flaw> {
    let tiles = read_changes(input, quantity)?;
    let present = |(place, tile): (TilePlace, Option<Arc<Tile>>)| tile.map(|tile| (place, tile));
    if let Some((place, _)) = tiles.iter().find(|(_, tile)| tile.is_none()) {
        return Err(misplaced(*place));
    }
    TiledRaster::from_tiles(grid, quantity.blank(), tiles.into_iter().filter_map(present)).map_err(misplaced)
}

/// Reads tiles that changed.
///
/// # Errors
/// Fails when the bytes end too early, a tile is beyond the limits of [`TilePlace::is_valid`] or out of
/// order, or a value cannot be painted.
pub fn read_changes(input: &mut Unpacking, quantity: Quantity) -> Result<ChangedTiles, Flaw> {
    let mut tiles = ChangedTiles::new();
    while input.left() > 0 {
        let mut head = [0; 10];
        input.read_exact(&mut head).map_err(|_| Flaw::Damaged)?;
        let [depth, has_pixels, a, b, c, d, e, f, g, h] = head;
        let [x, y] = [[a, b, c, d], [e, f, g, h]].map(i32::from_le_bytes);
        let place = TilePlace { depth, x, y };
        let is_in_order = tiles.last_key_value().is_none_or(|(&last, _)| last < place);
        if !place.is_valid() || !is_in_order || has_pixels > 1 {
            return Err(misplaced(place));
        }
        let tile = if has_pixels == 1 { Some(Arc::new(read_tile(input, quantity)?)) } else { None };
        tiles.insert(place, tile);
    }
    Ok(tiles)
}

fn write_tile(out: &mut dyn Write, place: TilePlace, tile: Option<&Tile>) -> io::Result<()> {
    out.write_all(&[place.depth, u8::from(tile.is_some())])?;
    for n in [place.x, place.y] {
        out.write_all(&n.to_le_bytes())?;
    }
    tile.map_or(Ok(()), |tile| write_floats(out, tile.values()))
}

fn read_tile(input: &mut Unpacking, quantity: Quantity) -> Result<Tile, Flaw> {
    let values = match quantity {
        Quantity::Risk => read_floats(input, PIXELS, is_risk, "risk")?,
        Quantity::Diameter => read_floats(input, PIXELS, |diameter| diameter > 0.0, "diameter")?,
        Quantity::Error => read_floats(input, PIXELS, |error| error > 0.0 && error.is_finite(), "error")?,
    };
    Ok(Tile::from_values(&values).expect("as many values as asked for"))
}

fn misplaced(place: TilePlace) -> Flaw {
    Flaw::Syntax(format!(
        "the paint has a tile of depth {} at column {}, row {} that is out of order, too far out, or without a coarser \
         tile below it: Meshbrush did not write this file.",
        place.depth, place.x, place.y
    ))
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::super::archive::{Archive, ArchiveWriter};
    use super::super::limits::Limits;
    use super::*;
    use crate::io::Meter;
    use meshbrush_core::paint::{Brush, DiameterChange, Medium, Stroke};
    use meshbrush_core::raster::ValueRanges;
    use meshbrush_mesh::geometry::Rect;

    const NAME: &str = "paint.tiles";

    fn packed(write: impl Fn(&mut dyn Write) -> io::Result<()>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut archive = ArchiveWriter::new(&mut bytes, Limits::PROJECT);
        archive.add(NAME, &Meter::default(), write).unwrap();
        archive.finish().unwrap();
        bytes
    }

    fn unpacked<T>(bytes: &[u8], read: impl Fn(&mut Unpacking) -> Result<T, Flaw>) -> Result<T, Flaw> {
        let archive = Archive::open(bytes, Limits::PROJECT)?;
        let mut input = archive.part(NAME).unwrap().unpack(&Meter::default());
        let result = read(&mut input)?;
        input.finish()?;
        Ok(result)
    }

    fn bounds() -> Rect {
        Rect::new(dvec2(-3.0, 2.0), dvec2(5.0, 8.0))
    }

    /// Returns a raster with tiles of several depths, on both sides of the grid's origin.
    fn painted(quantity: Quantity) -> TiledRaster {
        let medium = match quantity {
            Quantity::Risk => Medium::Risk(1.0),
            Quantity::Diameter => Medium::Diameter(0.02, DiameterChange::Finer),
            Quantity::Error => Medium::Error(2.5),
        };
        let grid = PixelGrid { origin: dvec2(0.0, 5.0), pixel: dvec2(0.01, 0.02) };
        let mut raster = TiledRaster::new(grid, quantity.blank());
        for (radius, at) in [(0.7, dvec2(-1.0, 4.0)), (0.1, dvec2(-1.5, 4.0)), (0.01, dvec2(0.0, 5.0))] {
            let brush = Brush { medium, radius, hardness: 0.3, strength: 0.7 };
            let mut stroke = Stroke::new(brush, 1.0, bounds());
            stroke.extend(&raster, at);
            while stroke.advance(&mut raster, usize::MAX).is_some() {}
            stroke.finish(&mut raster);
        }
        raster
    }

    #[test]
    fn rasters_of_any_depth_are_read_as_they_were_written() {
        for quantity in [Quantity::Risk, Quantity::Diameter, Quantity::Error] {
            let raster = painted(quantity);
            let places: Vec<TilePlace> = raster.tiles().map(|(place, _)| place).collect();
            assert!(places.iter().any(|place| place.x < 0) && places.iter().any(|place| place.depth >= 5));
            let bytes = packed(|out| write_raster(out, &raster));
            let read = unpacked(&bytes, |input| read_raster(input, *raster.grid(), quantity)).unwrap();
            assert!(read == raster);
            assert_eq!(packed(|out| write_raster(out, &read)), bytes);
        }
        let empty = TiledRaster::new(*painted(Quantity::Risk).grid(), 0.0);
        let bytes = packed(|out| write_raster(out, &empty));
        let read = unpacked(&bytes, |input| read_raster(input, *empty.grid(), Quantity::Risk)).unwrap();
        assert!(read == empty);
    }

    #[test]
    fn changes_are_read_as_they_were_written() {
        let raster = painted(Quantity::Risk);
        let mut changes: ChangedTiles =
            raster.tiles().map(|(place, tile)| (place, Some(tile.clone()))).collect();
        changes.values_mut().step_by(3).for_each(|tile| *tile = None);
        let bytes = packed(|out| write_changes(out, &changes));
        let read = unpacked(&bytes, |input| read_changes(input, Quantity::Risk)).unwrap();
        assert_eq!(read, changes);
        let error = unpacked(&bytes, |input| read_raster(input, *raster.grid(), Quantity::Risk)).unwrap_err();
        assert!(error.to_string().contains("column"), "a raster has no removed tiles: {error}");
    }

    #[test]
    fn tiles_that_cannot_be_are_reported_with_their_place_or_value() {
        let place = TilePlace { depth: 0, x: 7, y: -2 };
        let tile = Tile::filled(0.5);
        let far = TilePlace { y: i32::MIN, ..place };
        let write = |tiles: &[(TilePlace, f32)]| {
            let mut bytes = Vec::new();
            for (place, value) in tiles {
                write_tile(&mut bytes, *place, Some(&Tile::filled(*value))).unwrap();
            }
            packed(|out| out.write_all(&bytes))
        };
        let child = TilePlace { depth: 1, x: 14, y: -4 };
        let orphan = TilePlace { x: 16, ..child };
        let deep = TilePlace { depth: 41, x: 0, y: 0 };
        for (tiles, word) in [
            (vec![(place, 0.5), (place, 0.5)], "column 7, row -2"),
            (vec![(child, 0.5), (place, 0.5)], "column 7, row -2"),
            (vec![(place, 0.5), (orphan, 0.5)], "column 16, row -4"),
            (vec![(far, 0.5)], "row -2147483648"),
            (vec![(deep, 0.5)], "depth 41"),
            (vec![(place, 1.5)], "risk of 1.5"),
            (vec![(place, f32::NAN)], "risk of NaN"),
        ] {
            let grid = *painted(Quantity::Risk).grid();
            let error =
                unpacked(&write(&tiles), |input| read_raster(input, grid, Quantity::Risk)).unwrap_err();
            assert!(error.to_string().contains(word), "{error}");
        }
        let negative = unpacked(&write(&[(place, 0.0)]), |input| read_changes(input, Quantity::Diameter));
        assert!(negative.unwrap_err().to_string().contains("diameter of 0"));
        let mut bytes = Vec::new();
        write_tile(&mut bytes, place, Some(&tile)).unwrap();
        for length in [1, 9, 10, 500, bytes.len() - 1] {
            let short = packed(|out| out.write_all(&bytes[..length]));
            assert!(unpacked(&short, |input| read_changes(input, Quantity::Risk)).is_err(), "{length} bytes");
        }
    }
}
