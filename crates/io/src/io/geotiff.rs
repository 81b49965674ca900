//! `.tif`: GeoTIFF, a raster with its own placement.
//!
//! Strips and tiles of whole numbers and floating-point numbers are read, in BigTIFF too: uncompressed, or
//! with the compressions Deflate, LZW and PackBits. Of several bands the first is read, and of several
//! pictures (overviews) too. Pixels with the value of the tag `GDAL_NODATA` have no value.

mod header;
mod place;
#[cfg(test)]
mod tests;

use std::io::{BufReader, ErrorKind, Read, Seek};
use std::path::Path;

use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::{CompressionMethod, PhotometricInterpretation, PlanarConfiguration, SampleFormat, Tag};
use tiff::{ColorType, TiffError};

use super::coordinate_system::CoordinateSystem;
use super::disk::File;
use super::error::PlacedFlaw;
use super::rows::reverse_rows;
use super::samples::{NoData, SampleType, single};
use super::{FileGrid, Flaw, GridPlace, Meter, RasterFormatSpec, ReadError, ReadRaster, world_file};
use meshbrush_core::raster::{Raster, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::excerpt;
use place::{Keys, Placement};

/// The format, for the list of all formats of rasters.
pub static RASTER: RasterFormatSpec =
    RasterFormatSpec { endings: &["tif", "tiff"], read: ReadRaster::Grid(read_grid) };

/// Most bytes of a strip or a tile after decompression.
const MOST_CHUNK_BYTES: u64 = 1 << 30;

/// A GeoTIFF.
#[derive(Clone, Debug, PartialEq)]
pub struct GeoTiff {
    /// The values of the first band; NaN where there is none. Where the file does not say its place, it is
    /// the unit square.
    pub raster: Raster,
    /// Whether the file says where it lies.
    pub is_placed: bool,
    /// What the file says about the coordinates.
    pub coordinate_system: Option<CoordinateSystem>,
    /// The number of bands.
    pub bands: u16,
}

/// Reads a raster and what the file says about its coordinates. The meter counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, is not a TIFF file of numbers, is cut off, is turned or mirrored, has
/// too many pixels for a raster, or a value beyond single precision; and when the work was cancelled. The
/// size is checked before memory is allocated.
pub fn read(path: &Path, meter: &Meter) -> Result<GeoTiff, ReadError> {
    read_pixels(path, meter).map(Pixels::into_geotiff)
}

/// Reads as [`read`] does, from any source of bytes.
///
/// # Errors
/// Fails as [`read`] does.
pub fn decode(source: impl Read + Seek) -> Result<GeoTiff, Flaw> {
    Pixels::decode(source).map(Pixels::into_geotiff)
}

/// Reads a raster where it is said to be, or else where the file or the world file beside it says.
fn read_grid(path: &Path, place: &GridPlace, meter: &Meter) -> Result<FileGrid, ReadError> {
    let Pixels { size, values, placement, coordinate_system, .. } = read_pixels(path, meter)?;
    let own = place.over.or(placement.map(|placement| placement.bounds));
    let bounds = match own {
        Some(bounds) => bounds,
        None => world_file::bounds_beside(path, size)?
            .ok_or_else(|| PlacedFlaw::from(Flaw::Syntax(no_place())).in_file(path))?,
    };
    Ok(FileGrid { raster: Raster::from_values(bounds, size, values), system: coordinate_system })
}

fn read_pixels(path: &Path, meter: &Meter) -> Result<Pixels, ReadError> {
    let decoded = File::open(path).map_err(PlacedFlaw::from).and_then(|file| {
        meter.expect(file.length()?);
        Ok(Pixels::decode(BufReader::with_capacity(1 << 16, meter.count(file)))?)
    });
    decoded.map_err(|flaw| flaw.in_file(path))
}

fn no_place() -> String {
    "the file does not say where it lies. Put a world file beside it (.tfw), or write its place into it, for example \
     with gdal_edit.py -a_ullr."
        .into()
}

/// What is read from a file.
struct Pixels {
    size: [u32; 2],
    /// The lowest row first.
    values: Vec<f32>,
    placement: Option<Placement>,
    coordinate_system: Option<CoordinateSystem>,
    bands: u16,
}

impl Pixels {
    fn decode(mut source: impl Read + Seek) -> Result<Self, Flaw> {
        header::check(&mut source)?;
        let mut limits = Limits::default();
        limits.decoding_buffer_size = MOST_CHUNK_BYTES as usize;
        limits.intermediate_buffer_size = MOST_CHUNK_BYTES as usize;
        let mut decoder = Decoder::new(source)?.with_limits(limits);
        let layout = Layout::read(&mut decoder)?;
        let keys = Keys::read(&mut decoder)?;
        let placement = place::read(&mut decoder, &keys, layout.size)?;
        let mut values = layout.values(&mut decoder)?;
        if !placement.is_some_and(|placement| placement.is_south_up) {
            reverse_rows(&mut values, layout.size[0]);
        }
        let coordinate_system = keys.coordinate_system();
        Ok(Self { size: layout.size, values, placement, coordinate_system, bands: layout.bands })
    }

    fn into_geotiff(self) -> GeoTiff {
        let bounds = self.placement.map_or(Rect::UNIT, |placement| placement.bounds);
        GeoTiff {
            raster: Raster::from_values(bounds, self.size, self.values),
            is_placed: self.placement.is_some(),
            coordinate_system: self.coordinate_system,
            bands: self.bands,
        }
    }
}

/// How the pixels of a picture are stored.
struct Layout {
    /// [columns, rows].
    size: [u32; 2],
    /// [columns, rows] of a strip or tile; those at the right and lower edge of the picture can be smaller.
    chunk: [u32; 2],
    bands: u16,
    /// The number of samples from one pixel of the first band to the next within a strip or tile.
    step: usize,
    /// The bytes of each strip or tile of the first band in the file; 0 for one that is not stored.
    stored: Vec<u64>,
    no_data: Option<NoData>,
}

impl Layout {
    fn read(decoder: &mut Decoder<impl Read + Seek>) -> Result<Self, Flaw> {
        let (columns, rows) = decoder.dimensions()?;
        let size = [columns, rows];
        if !is_raster_size(size) {
            return Err(Flaw::Size { columns: columns.into(), rows: rows.into() });
        }
        check_packing(decoder)?;
        let color = decoder.colortype()?;
        let (samples, sample) = check_samples(decoder, color)?;
        let bands: u16 = decoder.find_tag_unsigned(Tag::SamplesPerPixel)?.unwrap_or(1);
        let planar: Option<u16> = decoder.find_tag_unsigned(Tag::PlanarConfiguration)?;
        let step = if planar == Some(PlanarConfiguration::Planar.to_u16()) { 1 } else { samples };
        let (width, height) = decoder.chunk_dimensions();
        let bytes = u64::from(width) * u64::from(height.min(rows));
        let bytes = u128::from(bytes) * u128::from(bands) * u128::from(color.bit_depth().div_ceil(8));
        if bytes > MOST_CHUNK_BYTES.into() {
            return Err(Flaw::Tiff(too_large()));
        }
        let counts = match decoder.get_chunk_type() {
            ChunkType::Strip => Tag::StripByteCounts,
            ChunkType::Tile => Tag::TileByteCounts,
        };
        let stored = decoder.find_tag_unsigned_vec(counts)?.unwrap_or_default();
        let no_data = match decoder.find_tag(Tag::GdalNodata)? {
            Some(text) => Some(NoData::parse(&text.into_string()?, sample)?),
            None => None,
        };
        Ok(Self { size, chunk: [width, height], bands, step, stored, no_data })
    }

    /// Returns the values of the first band in the order of the file. Memory grows with the strips or tiles
    /// that were decoded.
    fn values(&self, decoder: &mut Decoder<impl Read + Seek>) -> Result<Vec<f32>, Flaw> {
        let [columns, rows] = self.size;
        let [width, height] = self.chunk;
        let across = columns.div_ceil(width);
        let mut values = Vec::new();
        for (down, top) in (0..rows).step_by(height as usize).enumerate() {
            let band = (columns as usize) * (height.min(rows - top) as usize);
            let start = values.len();
            for (number, left) in (0..columns).step_by(width as usize).enumerate() {
                let index = down as u32 * across + number as u32;
                let chunk = self.is_stored(index).then(|| decoder.read_chunk(index)).transpose()?;
                values.resize(start + band, self.unstored());
                let place = &mut values[start..];
                if let Some(chunk) = chunk {
                    self.take(&chunk, place, left, width.min(columns - left))?;
                }
            }
        }
        Ok(values)
    }

    fn is_stored(&self, chunk: u32) -> bool {
        self.stored.get(chunk as usize).is_none_or(|&bytes| bytes > 0)
    }

    /// The value of pixels in strips or tiles that are not stored.
    fn unstored(&self) -> f32 {
        if self.no_data.is_some() { f32::NAN } else { 0.0 }
    }

    /// Copies the first band of a chunk of `width` columns into the rows of the picture, from column `left`.
    fn take(&self, chunk: &DecodingResult, rows: &mut [f32], left: u32, width: u32) -> Result<(), Flaw> {
        match chunk {
            DecodingResult::U8(samples) => self.copy(samples, |s| s.into(), rows, left, width),
            DecodingResult::U16(samples) => self.copy(samples, |s| s.into(), rows, left, width),
            DecodingResult::U32(samples) => self.copy(samples, |s| s.into(), rows, left, width),
            DecodingResult::U64(samples) => self.copy(samples, |s| s as f64, rows, left, width),
            DecodingResult::I8(samples) => self.copy(samples, |s| s.into(), rows, left, width),
            DecodingResult::I16(samples) => self.copy(samples, |s| s.into(), rows, left, width),
            DecodingResult::I32(samples) => self.copy(samples, |s| s.into(), rows, left, width),
            DecodingResult::I64(samples) => self.copy(samples, |s| s as f64, rows, left, width),
            DecodingResult::F32(samples) => self.copy(samples, |s| s.into(), rows, left, width),
            DecodingResult::F64(samples) => self.copy(samples, |s| s, rows, left, width),
            DecodingResult::F16(_) => Err(Flaw::Tiff("it has floating-point numbers of 16 bits".into())),
        }
    }

    fn copy<T: Copy>(
        &self,
        samples: &[T],
        number: impl Fn(T) -> f64,
        rows: &mut [f32],
        left: u32,
        width: u32,
    ) -> Result<(), Flaw> {
        let (left, width) = (left as usize, width as usize);
        let lines = samples.chunks_exact(width * self.step);
        for (row, line) in rows.chunks_exact_mut(self.size[0] as usize).zip(lines) {
            for (value, &sample) in row[left..left + width].iter_mut().zip(line.iter().step_by(self.step)) {
                *value = self.value(number(sample))?;
            }
        }
        Ok(())
    }

    fn value(&self, sample: f64) -> Result<f32, Flaw> {
        if self.no_data.is_some_and(|no_data| no_data.is(sample)) {
            return Ok(f32::NAN);
        }
        single(sample, "If it marks pixels without a value, say so in the file with gdal_edit.py -a_nodata.")
    }
}

/// Refuses compressions and colours that are not read. Which ones the decoder knows depends on how it was
/// built.
fn check_packing(decoder: &mut Decoder<impl Read + Seek>) -> Result<(), Flaw> {
    let compression = decoder.find_tag_unsigned(Tag::Compression)?;
    let compression: u16 = compression.unwrap_or(CompressionMethod::None.to_u16());
    let known = [
        CompressionMethod::None,
        CompressionMethod::LZW,
        CompressionMethod::Deflate,
        CompressionMethod::OldDeflate,
        CompressionMethod::PackBits,
    ];
    if !known.iter().any(|method| method.to_u16() == compression) {
        let problem = format!("its compression has the number {compression}");
        return Err(Flaw::Tiff(format!("{problem}; only Deflate, LZW and PackBits are read")));
    }
    let colors: Option<u16> = decoder.find_tag_unsigned(Tag::PhotometricInterpretation)?;
    if colors == Some(PhotometricInterpretation::RGBPalette.to_u16()) {
        return Err(Flaw::Tiff("its pixels are colours of a palette, not numbers".into()));
    }
    Ok(())
}

/// Returns the number of samples of a pixel as they are decoded, and their type, if they are numbers that
/// can be read.
fn check_samples(
    decoder: &mut Decoder<impl Read + Seek>,
    color: ColorType,
) -> Result<(usize, SampleType), Flaw> {
    let mut tag = |tag| decoder.find_tag_unsigned::<u16>(tag);
    let samples = color.num_samples();
    let (stored, predictor) = (tag(Tag::SamplesPerPixel)?.unwrap_or(1), tag(Tag::Predictor)?.unwrap_or(1));
    if samples != stored && predictor != 1 {
        return Err(Flaw::Tiff("it has bands beside its colours, and a predictor".into()));
    }
    let formats = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat)?;
    let format = formats.and_then(|formats| formats.first().copied()).unwrap_or(SampleFormat::Uint.to_u16());
    let (is_whole, is_float) = match SampleFormat::from_u16(format) {
        Some(SampleFormat::Uint | SampleFormat::Int) => (true, false),
        Some(SampleFormat::IEEEFP) => (false, true),
        _ => (false, false),
    };
    let sample = match color.bit_depth() {
        8 | 16 | 32 | 64 if is_whole => SampleType::Integer,
        32 if is_float => SampleType::Single,
        64 if is_float => SampleType::Double,
        bits => return Err(Flaw::Tiff(format!("its samples have {bits} bits in the format {format}"))),
    };
    if predictor == 3 && is_whole {
        return Err(Flaw::Tiff("its predictor is for floating-point numbers, and it has whole ones".into()));
    }
    Ok((usize::from(samples), sample))
}

fn too_large() -> String {
    "its strips or tiles are too large for memory; store it in tiles".into()
}

impl From<TiffError> for Flaw {
    fn from(error: TiffError) -> Self {
        match error {
            TiffError::IoError(e) if e.kind() == ErrorKind::UnexpectedEof => Self::CutOff,
            // How decompressors report a file that is cut off.
            TiffError::IoError(e) if matches!(e.kind(), ErrorKind::InvalidData | ErrorKind::InvalidInput) => {
                Self::Tiff(format!("its compressed data are damaged: {e}"))
            }
            TiffError::IoError(e) => Self::Io(e),
            TiffError::LimitsExceeded | TiffError::IntSizeError => Self::Tiff(too_large()),
            // Some list every number of a tag.
            other => Self::Tiff(excerpt(120, other.to_string().trim_end_matches('.'))),
        }
    }
}
