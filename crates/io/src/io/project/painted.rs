//! The pixels of a paint layer as bytes: the grid of its pixels of depth 0 (four 64-bit floats: the corner,
//! and the sides of a pixel), then its tiles.

use std::io::{self, Read, Write};
use std::sync::Arc;

use glam::DVec2;

use super::super::Flaw;
use super::archive::Unpacking;
use super::tiled::{self, ChangedTiles};
use meshbrush_core::layers::Quantity;
use meshbrush_core::raster::{PixelGrid, TiledRaster, ValueRanges};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::Number;

/// Writes all pixels of a layer.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut dyn Write, raster: &TiledRaster) -> io::Result<()> {
    write_grid(out, raster.grid())?;
    tiled::write_raster(out, raster)
}

/// Reads all pixels of a layer.
///
/// # Errors
/// Fails when they are damaged, or have a value that cannot be painted.
pub fn read(input: &mut Unpacking, quantity: Quantity) -> Result<TiledRaster, Flaw> {
    let grid = read_grid(input)?;
    tiled::read_raster(input, grid, quantity)
}

/// Returns the tiles in which a raster differs from an earlier state.
pub fn changes(before: Option<&TiledRaster>, after: &TiledRaster) -> ChangedTiles {
    let mut changes = ChangedTiles::new();
    for (place, tile) in after.tiles() {
        let earlier = before.and_then(|before| before.tile(place));
        if earlier.is_none_or(|earlier| !Arc::ptr_eq(earlier, tile)) {
            changes.insert(place, Some(tile.clone()));
        }
    }
    for (place, _) in before.into_iter().flat_map(TiledRaster::tiles) {
        if after.tile(place).is_none() {
            changes.insert(place, None);
        }
    }
    changes
}

/// Writes changes of a layer whose pixels of depth 0 lie on `grid`.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_changes(out: &mut dyn Write, grid: &PixelGrid, changes: &ChangedTiles) -> io::Result<()> {
    write_grid(out, grid)?;
    tiled::write_changes(out, changes)
}

/// Reads changes of a layer, and the grid of its pixels.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_changes(input: &mut Unpacking, quantity: Quantity) -> Result<(PixelGrid, ChangedTiles), Flaw> {
    Ok((read_grid(input)?, tiled::read_changes(input, quantity)?))
}

/// Makes changes of a layer.
///
/// # Errors
/// Fails when a new tile would have no parent, or a removed one has children. Some changes may then be made.
pub fn apply(raster: &mut TiledRaster, changes: ChangedTiles) -> Result<(), Flaw> {
    let (new, gone): (Vec<_>, Vec<_>) = changes.into_iter().partition(|(_, tile)| tile.is_some());
    // Parents appear before their children, and disappear after them.
    for (place, tile) in new.into_iter().chain(gone.into_iter().rev()) {
        let is_there = |place| raster.tile(place).is_some();
        let is_possible = match &tile {
            Some(_) => place.parent().is_none_or(is_there),
            None => !place.children().into_iter().any(is_there),
        };
        if !is_possible {
            return Err(Flaw::Damaged);
        }
        raster.exchange(place, tile);
    }
    Ok(())
}

fn write_grid(out: &mut dyn Write, grid: &PixelGrid) -> io::Result<()> {
    let numbers = [grid.origin.x, grid.origin.y, grid.pixel.x, grid.pixel.y];
    numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
}

fn read_grid(input: &mut Unpacking) -> Result<PixelGrid, Flaw> {
    let mut number = || -> Result<f64, Flaw> {
        let mut bytes = [0; 8];
        input.read_exact(&mut bytes).map_err(|_| Flaw::Damaged)?;
        Ok(f64::from_le_bytes(bytes))
    };
    let (origin, pixel) = (DVec2::new(number()?, number()?), DVec2::new(number()?, number()?));
    let grid = PixelGrid { origin, pixel };
    if grid.is_proper() {
        return Ok(grid);
    }
    let [x, y, width, height] = [origin.x, origin.y, pixel.x, pixel.y].map(Number);
    Err(Flaw::Syntax(format!(
        "pixels of {width} × {height} from {x}, {y} on cannot be painted: they cover no rectangle with {}. Use another copy.",
        Rect::PROPER
    )))
}
