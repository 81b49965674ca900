//! The pixels of a paint layer as bytes: the grid of its pixels of depth 0 (four 64-bit floats: the corner,
//! and the sides of a pixel), then its tiles.

use std::io::{self, Read, Write};
use std::sync::Arc;

use glam::DVec2;

use super::super::{Flaw, Meter};
use super::archive::{ArchivePart, Unpacking};
use super::tiled::{self, ChangedTiles};
use meshbrush_core::layers::Quantity;
use meshbrush_core::raster::{PixelGrid, TiledRaster, ValueRanges};
use meshbrush_mesh::text::Bytes;

/// Bytes of unpacked paint that a file of any size may have: 250 million pixels.
const ALWAYS_ALLOWED: u64 = 1_000_000_000;
/// Beyond that, the most unpacked bytes for a packed one. Strokes pack to a half or a tenth.
const MOST_RATIO: u64 = 40;

/// The bytes of paint that may be unpacked from a file, all layers together.
pub struct Allowance {
    total: u64,
    left: u64,
}

impl Allowance {
    /// Returns the allowance for a file with these parts of paint.
    pub fn for_parts<'p, 'a: 'p>(parts: impl Iterator<Item = &'p ArchivePart<'a>>) -> Self {
        let packed: u64 = parts.map(ArchivePart::packed_bytes).sum();
        let total = ALWAYS_ALLOWED.max(packed.saturating_mul(MOST_RATIO));
        Self { total, left: total }
    }

    /// Returns a reader that unpacks a part.
    ///
    /// # Errors
    /// Fails when it declares more bytes than are left.
    pub fn unpack<'a>(&mut self, part: &ArchivePart<'a>, meter: &Meter) -> Result<Unpacking<'a>, Flaw> {
        let size = part.declared_bytes();
        self.left = self.left.checked_sub(size).ok_or_else(|| {
            let limit = Bytes(self.total as usize);
            Flaw::Syntax(format!(
                "unpacked, the paint of all layers would take more than {limit}, the limit for a file of this size. \
                 Use another copy."
            ))
        })?;
        part.unpack(size, meter)
    }
}

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

/// Writes changes of a layer.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_changes(out: &mut dyn Write, raster: &TiledRaster, changes: &ChangedTiles) -> io::Result<()> {
    write_grid(out, raster.grid())?;
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
pub fn apply(raster: &mut TiledRaster, changes: ChangedTiles) {
    let (new, gone): (Vec<_>, Vec<_>) = changes.into_iter().partition(|(_, tile)| tile.is_some());
    // Parents appear before their children, and disappear after them.
    for (place, tile) in new.into_iter().chain(gone.into_iter().rev()) {
        raster.exchange(place, tile);
    }
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
    let is_valid = origin.is_finite() && pixel.is_finite() && pixel.cmpgt(DVec2::ZERO).all();
    is_valid.then_some(PixelGrid { origin, pixel }).ok_or(Flaw::Damaged)
}
