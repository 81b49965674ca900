//! `.nc`, `.grd`: NetCDF, a raster with its own placement, in the classic forms and in NetCDF-4.
//!
//! A grid is a variable over two coordinate variables, which are the centres of its pixels. Only the part
//! that a window needs is read, so a grid of the whole Earth opens as fast as a small one. Values are
//! unpacked (`scale_factor`, `add_offset`), and those that mean nothing (`_FillValue`, `missing_value`,
//! beyond `valid_range`, what NetCDF puts where nothing was written) become NaN.

mod axis;
mod classic;
mod contents;
mod grid;
mod hdf;
mod packing;
#[cfg(test)]
mod tests;
mod window;

use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use glam::{DVec2, dvec2};

use super::coordinate_system::CoordinateSystem;
use super::disk::File;
use super::error::PlacedFlaw;
use super::raster_file::file_and_part;
use super::{FileGrid, Flaw, GridPlace, Meter, RasterFormatSpec, ReadError, ReadRaster, ValueFacts};
use contents::{Source, StoredType};
use grid::Grid;
use meshbrush_core::raster::{LONGEST_SIDE, MOST_PIXELS, Raster, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Grouped, Number};
use packing::SamplePacking;
use window::Span;

/// The format, for the list of all formats of rasters.
pub static RASTER: RasterFormatSpec = RasterFormatSpec {
    endings: &["nc", "grd", "nc4", "cdf"],
    has_parts: true,
    read: ReadRaster::Grid(read_grid),
};

/// The first bytes of an HDF5 file.
const HDF5_MAGIC: &[u8; 4] = b"\x89HDF";
/// Samples that are read at once, or one row where it has more.
const BLOCK: u64 = 1 << 22;

/// Reads a grid, or the part of it that is wanted, with one pixel more on each side. Longitudes repeat after
/// 360 degrees: the raster lies where the window is. The meter counts bytes of samples. After the path of the
/// file, `#` and the name of a variable may follow.
///
/// # Errors
/// Fails when the file cannot be read, is not NetCDF, is cut off, has no grid or several among which none has
/// a well-known name, has coordinates that are not evenly spaced, has no pixel in the window, too many pixels
/// for a raster, or a value beyond single precision; and when the work was cancelled.
pub fn read_grid(path: &Path, place: &GridPlace, meter: &Meter) -> Result<FileGrid, ReadError> {
    let (file, variable) = file_and_part(path);
    let read = || -> Result<FileGrid, PlacedFlaw> {
        let source = File::open(&file)?;
        Ok(decode(source, variable.as_deref(), place, meter)?)
    };
    let grid = read().map_err(|flaw| flaw.in_file(path))?;
    let grid = FileGrid { system: grid.system.or_else(|| CoordinateSystem::beside(&file)), ..grid };
    Ok(if place.over.is_some() { grid } else { grid.in_degrees() })
}

/// Reads as [`read_grid`] does, from any source of bytes; the variable with a name, if there is one.
///
/// # Errors
/// Fails as [`read_grid`] does.
pub fn decode(
    source: impl Read + Seek + Send + 'static,
    name: Option<&str>,
    place: &GridPlace,
    meter: &Meter,
) -> Result<FileGrid, Flaw> {
    meter.check()?;
    let mut source = open(source)?;
    let grid = Grid::choose(source.variables(), name)?;
    let system = grid.system(source.variables());
    let window = place.window.filter(|_| place.over.is_none());
    let area = window.and_then(|window| grid.area(&window, system.as_ref()));
    let spans = spans(&mut *source, &grid, area)?;
    let (values, facts) = values(&mut *source, &grid, &spans, meter)?;
    let bounds = place.over.unwrap_or_else(|| Rect::new(corner(&spans, 0), corner(&spans, 1)));
    if !bounds.is_proper() {
        let problem = "its pixels are too small or too far from zero";
        return Err(Flaw::Syntax(format!("{problem}: they cover no rectangle with {}.", Rect::PROPER)));
    }
    Ok(FileGrid { raster: Raster::from_values(bounds, size(&spans), values), system, facts })
}

fn corner([x, y]: &[Span; 2], end: usize) -> DVec2 {
    dvec2(x.bounds[end], y.bounds[end])
}

fn open(mut source: impl Read + Seek + Send + 'static) -> Result<Box<dyn Source>, Flaw> {
    let mut start = Vec::new();
    source.by_ref().take(HDF5_MAGIC.len() as u64).read_to_end(&mut start)?;
    source.seek(SeekFrom::Start(0))?;
    if start == HDF5_MAGIC {
        Ok(Box::new(hdf::Hdf::open(source)?))
    } else if start.starts_with(classic::MAGIC) {
        Ok(Box::new(classic::Classic::open(source)?))
    } else {
        let problem = "this is not a NetCDF file: it begins with other bytes";
        Err(Flaw::Syntax(format!("{problem}. Export it again as NetCDF.")))
    }
}

/// Returns the pixels that are read along x and y: not more than a raster has.
fn spans(source: &mut dyn Source, grid: &Grid, window: Option<Rect>) -> Result<[Span; 2], Flaw> {
    let x = axis::read(source, grid.x.coordinates)?;
    let y = axis::read(source, grid.y.coordinates)?;
    let spans = match window {
        None => [x.whole(), y.whole()],
        Some(Rect { min, max }) => {
            let most = LONGEST_SIDE.into();
            let along_x = x.within([min.x, max.x], grid.is_geographic(), most);
            let along_y = y.within([min.y, max.y], false, most);
            match (along_x, along_y) {
                (Some(along_x), Some(along_y)) => [along_x, along_y],
                _ => return Err(apart(x.bounds(), y.bounds(), [min.x, max.x, min.y, max.y])),
            }
        }
    };
    if is_raster_size(size(&spans)) { Ok(spans) } else { Err(too_large(&spans, window.is_some())) }
}

fn apart(x: [f64; 2], y: [f64; 2], window: [f64; 4]) -> Flaw {
    let ([west, east], [south, north]) = (x.map(Number), y.map(Number));
    let [left, right, low, high] = window.map(Number);
    Flaw::Syntax(format!(
        "it covers nothing of the domain: it lies from {west} to {east} in x and from {south} to {north} in y, and the \
         domain from {left} to {right} and from {low} to {high}. Use a file that covers the domain."
    ))
}

fn size(spans: &[Span; 2]) -> [u32; 2] {
    [&spans[0], &spans[1]].map(|span| u32::try_from(span.count).unwrap_or(u32::MAX))
}

fn too_large([x, y]: &[Span; 2], is_window: bool) -> Flaw {
    let [columns, rows] = [x.count, y.count].map(|count| Grouped(count as usize));
    let (longest, most) = (Grouped(LONGEST_SIDE as usize), Grouped(MOST_PIXELS as usize));
    let (what, help) = match is_window {
        true => ("of the grid in the domain", "Use a coarser grid, or a smaller domain"),
        false => {
            ("of the grid", "Choose a domain first, so that only the part in it is read, or cut the grid")
        }
    };
    Flaw::Syntax(format!(
        "{columns} × {rows} pixels {what} cannot be read: a raster has at most {longest} along each side, and {most} in \
         all. {help}."
    ))
}

/// Reads the values of the pixels, the lowest row first, and what is to be known about them. Memory grows
/// with what was read.
fn values(
    source: &mut dyn Source,
    grid: &Grid,
    spans: &[Span; 2],
    meter: &Meter,
) -> Result<(Vec<f32>, ValueFacts), Flaw> {
    let [x, y] = spans;
    let variable = &source.variables()[grid.variable];
    let (mut packing, rank) = (SamplePacking::of(variable), variable.dimensions.len());
    let sample = variable.sample.map_or(1, StoredType::bytes) as u64;
    let width: u64 = x.pieces.iter().map(|piece| piece.file.end - piece.file.start).sum();
    meter.expect(width * y.count * sample);
    let columns = x.count as usize;
    let mut values = Vec::new();
    for bottom in (0..y.count).step_by((BLOCK / width).max(1) as usize) {
        let count = (BLOCK / width).max(1).min(y.count - bottom);
        let start = values.len();
        values.resize(start + count as usize * columns, f32::NAN);
        for piece in &x.pieces {
            let block = PixelBlock { grid, rank, columns: piece.file.clone(), rows: y.rows(bottom, count) };
            let samples = block.read(source)?;
            let rows = values[start..].chunks_exact_mut(columns);
            for (row, place) in rows.enumerate() {
                let place = &mut place[piece.at as usize..][..block.size()[0]];
                for (column, value) in place.iter_mut().enumerate() {
                    *value = packing.value(samples[block.index(column, row, [x, y])])?;
                }
            }
        }
        meter.add(width * count * sample)?;
    }
    Ok((values, packing.facts()))
}

/// Pixels that are read at once: their numbers in the file.
struct PixelBlock<'a> {
    grid: &'a Grid,
    /// The number of dimensions of the grid.
    rank: usize,
    columns: Range<u64>,
    rows: Range<u64>,
}

impl PixelBlock<'_> {
    fn read(&self, source: &mut dyn Source) -> Result<Vec<f64>, Flaw> {
        let (mut corner, mut extent) = (vec![0; self.rank], vec![1; self.rank]);
        for (side, range) in [(self.grid.x, &self.columns), (self.grid.y, &self.rows)] {
            corner[side.dimension] = range.start;
            extent[side.dimension] = range.end - range.start;
        }
        source.block(self.grid.variable, &corner, &extent)
    }

    /// [columns, rows].
    fn size(&self) -> [usize; 2] {
        [&self.columns, &self.rows].map(|range| (range.end - range.start) as usize)
    }

    /// Returns where a pixel of the raster is in the block.
    fn index(&self, column: usize, row: usize, [x, y]: [&Span; 2]) -> usize {
        let [columns, rows] = self.size();
        let column = if x.is_reversed { columns - 1 - column } else { column };
        let row = if y.is_reversed { rows - 1 - row } else { row };
        match self.grid.y.dimension < self.grid.x.dimension {
            true => row * columns + column,
            false => column * rows + row,
        }
    }
}
