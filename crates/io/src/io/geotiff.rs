//! `.tif`: GeoTIFF, a raster with its own placement.
//!
//! Strips and tiles of whole numbers and floating-point numbers are read, in BigTIFF too: uncompressed, or
//! with the compressions Deflate, LZW and PackBits. Of several bands the first is read, or the one whose
//! number follows the name, as in `FILE.tif#2`; of several pictures (overviews) the first. Samples become
//! values by the scale, the offset and the unit that GDAL writes. Pixels with the value of the tag
//! `GDAL_NODATA`, and those where a mask or a band of opacity is 0, have no value.

mod checks;
mod header;
mod mask;
mod place;
#[cfg(test)]
mod tests;

use std::io::{BufReader, ErrorKind, Read, Seek};
use std::path::Path;

use tiff::TiffError;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::{ExtraSamples, PlanarConfiguration, Tag};

use super::coordinate_system::CoordinateSystem;
use super::disk::File;
use super::error::PlacedFlaw;
use super::gdal_metadata::BandMetadata;
use super::raster_file::file_and_part;
use super::rows::reverse_rows;
use super::samples::{NoData, SampleType, SampleUnpacking};
use super::vertical::ValueUnit;
use super::{
    FileGrid, Flaw, GridPlace, Meter, RasterFormatSpec, ReadError, ReadRaster, ValueFacts, world_file,
};
use checks::{check_colors, check_packing, check_samples};
use header::{Colorless, Directories};
use mask::Mask;
use meshbrush_core::raster::{Raster, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::excerpt;
use place::{GeoKeys, Placement};

/// The format, for the list of all formats of rasters.
pub static RASTER: RasterFormatSpec =
    RasterFormatSpec { endings: &["tif", "tiff"], has_parts: true, read: ReadRaster::Grid(read_grid) };

/// The tag with what GDAL writes about bands.
const GDAL_METADATA: u16 = 42112;
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
    /// What the file says about its values.
    pub facts: ValueFacts,
}

/// Reads a raster and what the file says about its coordinates. The meter counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, is not a TIFF file of numbers, is cut off, is turned or mirrored, has
/// too many pixels for a raster, or a value beyond single precision; and when the work was cancelled. The
/// size is checked before memory is allocated.
pub fn read(path: &Path, meter: &Meter) -> Result<GeoTiff, ReadError> {
    read_pixels(path, None, meter).map(Pixels::into_geotiff)
}

/// Reads as [`read`] does, from any source of bytes.
///
/// # Errors
/// Fails as [`read`] does.
pub fn decode(source: impl Read + Seek) -> Result<GeoTiff, Flaw> {
    Pixels::decode(source, None, Beside::default()).map(Pixels::into_geotiff)
}

/// Reads a raster where it is said to be, or else where the file or the world file beside it says.
fn read_grid(path: &Path, place: &GridPlace, meter: &Meter) -> Result<FileGrid, ReadError> {
    let (path, band) = &file_and_part(path);
    let pixels = read_pixels(path, band.as_deref(), meter)?;
    let Pixels { size, values, placement, coordinate_system, facts, .. } = pixels;
    let own = place.over.or(placement.map(|placement| placement.bounds));
    let bounds = match own {
        Some(bounds) => bounds,
        None => world_file::bounds_beside(path, size)?
            .ok_or_else(|| PlacedFlaw::from(Flaw::Syntax(no_place())).in_file(path))?,
    };
    let grid =
        FileGrid { raster: Raster::from_values(bounds, size, values), system: coordinate_system, facts };
    Ok(if place.over.is_some() { grid } else { grid.in_degrees() })
}

fn read_pixels(path: &Path, band: Option<&str>, meter: &Meter) -> Result<Pixels, ReadError> {
    let mask = Mask::beside(path, meter)?;
    let decode = || -> Result<Pixels, PlacedFlaw> {
        let band = band.map(band_of).transpose()?;
        let file = File::open(path)?;
        meter.expect(file.length()?);
        let beside = Beside { metadata: BandMetadata::beside(path, band.unwrap_or(0)), mask };
        Ok(Pixels::decode(BufReader::with_capacity(1 << 16, meter.count(file)), band, beside)?)
    };
    decode().map_err(|flaw| flaw.in_file(path))
}

/// What is said about a band beside the file.
#[derive(Default)]
struct Beside {
    metadata: BandMetadata,
    mask: Option<Mask>,
}

/// Returns the place of the band with a number, counted from 1.
fn band_of(number: &str) -> Result<usize, Flaw> {
    let place = number.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
    place.ok_or_else(|| {
        let number = excerpt(40, number);
        Flaw::Syntax(format!(
            "“{number}” is not the number of a band: after the file, as in FILE.tif#2, they are 1, 2, …"
        ))
    })
}

/// Returns a decoder of a file whose directories were read.
fn open<R: Read + Seek>(source: R, directories: &Directories) -> Result<Decoder<Colorless<R>>, Flaw> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_CHUNK_BYTES as usize;
    limits.intermediate_buffer_size = MOST_CHUNK_BYTES as usize;
    Ok(Decoder::new(Colorless::new(source, directories))?.with_limits(limits))
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
    facts: ValueFacts,
}

impl Pixels {
    /// Reads the band with a place, or else the first one. `beside` is what is said about it beside the file.
    fn decode(mut source: impl Read + Seek, band: Option<usize>, beside: Beside) -> Result<Self, Flaw> {
        let directories = header::directories(&mut source)?;
        if band.is_none() {
            check_colors(directories.first.colors)?;
        }
        let mut decoder = open(source, &directories)?;
        let layout = Layout::read(&mut decoder, band.unwrap_or(0))?;
        let keys = GeoKeys::read(&mut decoder)?;
        let placement = place::read(&mut decoder, &keys, layout.size)?;
        let (vertical, metadata) =
            (keys.vertical(), band_metadata(&mut decoder, &layout)?.or(beside.metadata));
        let unit = ValueUnit::named(metadata.unit.as_deref().unwrap_or_default()).or(vertical.unit);
        let no_data = layout.no_data(&metadata)?;
        let mut unpacking = SampleUnpacking {
            marks: no_data.into_iter().collect(),
            has_declared: no_data.is_some(),
            scale: metadata.scale.unwrap_or(1.0),
            offset: metadata.offset.unwrap_or(0.0),
            unit,
            ..SampleUnpacking::plain(REMEDY)
        };
        let mut values = layout.values(&mut decoder, &mut unpacking)?;
        layout.hide_transparent(&mut decoder, &mut values)?;
        if let Some(mask) = directories.mask() {
            decoder.seek_to_image(mask)?;
            Mask::read(&mut decoder)?.apply(layout.size, &mut values)?;
        }
        if let Some(mask) = beside.mask {
            mask.apply(layout.size, &mut values)?;
        }
        if !placement.is_some_and(|placement| placement.is_south_up) {
            reverse_rows(&mut values, layout.size[0]);
        }
        let mut facts = ValueFacts { positive: vertical.positive, ..unpacking.facts() };
        facts.notes.extend(layout.other_bands().filter(|_| band.is_none()));
        let (size, coordinate_system) = (layout.size, keys.coordinate_system());
        Ok(Self { size, values, placement, coordinate_system, bands: layout.bands, facts })
    }

    fn into_geotiff(self) -> GeoTiff {
        let bounds = self.placement.map_or(Rect::UNIT, |placement| placement.bounds);
        GeoTiff {
            raster: Raster::from_values(bounds, self.size, self.values),
            is_placed: self.placement.is_some(),
            coordinate_system: self.coordinate_system,
            bands: self.bands,
            facts: self.facts,
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
    /// The band that is read, counted from 0, and the one with the opacity of pixels, if there is one.
    band: usize,
    opacity: Option<usize>,
    /// The number of samples from one pixel of a band to the next within a strip or tile: that of bands, or 1
    /// where each band has strips or tiles of its own.
    step: usize,
    /// The bytes of each strip or tile in the file; 0 for one that is not stored.
    stored: Vec<u64>,
    sample: SampleType,
    /// The text of the tag `GDAL_NODATA`.
    no_data: Option<String>,
}

impl Layout {
    fn read(decoder: &mut Decoder<impl Read + Seek>, band: usize) -> Result<Self, Flaw> {
        let (columns, rows) = decoder.dimensions()?;
        let size = [columns, rows];
        if !is_raster_size(size) {
            return Err(Flaw::Size { columns: columns.into(), rows: rows.into() });
        }
        check_packing(decoder)?;
        let color = decoder.colortype()?;
        let sample = check_samples(decoder, color.bit_depth())?;
        let bands: u16 = decoder.find_tag_unsigned(Tag::SamplesPerPixel)?.unwrap_or(1);
        if band >= usize::from(bands) {
            let number = band + 1;
            return Err(Flaw::Syntax(format!("it has no band {number}: it has {bands}.")));
        }
        let planar: Option<u16> = decoder.find_tag_unsigned(Tag::PlanarConfiguration)?;
        let is_planar = planar == Some(PlanarConfiguration::Planar.to_u16());
        let step = if is_planar { 1 } else { usize::from(bands) };
        let extra: Vec<u16> = decoder.find_tag_unsigned_vec(Tag::ExtraSamples)?.unwrap_or_default();
        let is_opacity = |&kind: &u16| {
            [ExtraSamples::AssociatedAlpha, ExtraSamples::UnassociatedAlpha]
                .map(|k| k.to_u16())
                .contains(&kind)
        };
        let first_extra = usize::from(bands).saturating_sub(extra.len());
        let opacity = extra.iter().position(is_opacity).map(|place| first_extra + place);
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
        let no_data = decoder.find_tag(Tag::GdalNodata)?.map(|text| text.into_string()).transpose()?;
        let opacity = opacity.filter(|&opacity| opacity != band && opacity < usize::from(bands));
        let chunk = [width, height];
        Ok(Self { size, chunk, bands, band, opacity, step, stored, sample, no_data })
    }

    /// Returns the number of pixels without a value, by the tag or else by what is said beside the file.
    fn no_data(&self, metadata: &BandMetadata) -> Result<Option<NoData>, Flaw> {
        let text = self.no_data.as_ref().or(metadata.no_data.as_ref());
        text.map(|text| NoData::parse(text, self.sample)).transpose()
    }

    /// Returns what a person should know about the bands that are not read.
    fn other_bands(&self) -> Option<String> {
        let bands = usize::from(self.bands) - usize::from(self.opacity.is_some());
        (bands > 1).then(|| {
            format!(
                "it has {bands} bands, and the first is read. Name another one after the file, as in FILE.tif#2."
            )
        })
    }

    /// Takes away the values of pixels whose opacity is 0.
    fn hide_transparent(
        &self,
        decoder: &mut Decoder<impl Read + Seek>,
        values: &mut [f32],
    ) -> Result<(), Flaw> {
        let Some(band) = self.opacity else { return Ok(()) };
        let chunk = self.chunk;
        let (stored, no_data) = (self.stored.clone(), None);
        let opacity = Self { band, opacity: None, stored, no_data, chunk, ..*self };
        let opacity = opacity.values(decoder, &mut SampleUnpacking::plain(REMEDY))?;
        let pairs = values.iter_mut().zip(opacity);
        pairs.filter(|(_, opacity)| *opacity == 0.0).for_each(|(value, _)| *value = f32::NAN);
        Ok(())
    }

    /// Returns the values of the band in the order of the file. Memory grows with the strips or tiles that
    /// were decoded.
    fn values(
        &self,
        decoder: &mut Decoder<impl Read + Seek>,
        unpacking: &mut SampleUnpacking,
    ) -> Result<Vec<f32>, Flaw> {
        let [columns, rows] = self.size;
        let [width, height] = self.chunk;
        let (across, down) = (columns.div_ceil(width), rows.div_ceil(height));
        let first = if self.step == 1 { self.band as u32 * across * down } else { 0 };
        // That of pixels in strips or tiles that are not stored.
        let unstored = if unpacking.marks.is_empty() { unpacking.clone().value(0.0)? } else { f32::NAN };
        let mut values = Vec::new();
        for (down, top) in (0..rows).step_by(height as usize).enumerate() {
            let band = (columns as usize) * (height.min(rows - top) as usize);
            let start = values.len();
            for (number, left) in (0..columns).step_by(width as usize).enumerate() {
                let index = first + down as u32 * across + number as u32;
                let chunk = self.is_stored(index).then(|| decoder.read_chunk(index)).transpose()?;
                values.resize(start + band, unstored);
                let place = &mut values[start..];
                if let Some(chunk) = chunk {
                    self.take(&chunk, place, [left, width.min(columns - left)], unpacking)?;
                }
            }
        }
        Ok(values)
    }

    fn is_stored(&self, chunk: u32) -> bool {
        self.stored.get(chunk as usize).is_none_or(|&bytes| bytes > 0)
    }

    /// Copies the band of a chunk into the rows of the picture, from a column on, so many columns.
    fn take(
        &self,
        chunk: &DecodingResult,
        rows: &mut [f32],
        columns: [u32; 2],
        unpacking: &mut SampleUnpacking,
    ) -> Result<(), Flaw> {
        match chunk {
            DecodingResult::U8(samples) => self.copy(samples, |s| s.into(), rows, columns, unpacking),
            DecodingResult::U16(samples) => self.copy(samples, |s| s.into(), rows, columns, unpacking),
            DecodingResult::U32(samples) => self.copy(samples, |s| s.into(), rows, columns, unpacking),
            DecodingResult::U64(samples) => self.copy(samples, |s| s as f64, rows, columns, unpacking),
            DecodingResult::I8(samples) => self.copy(samples, |s| s.into(), rows, columns, unpacking),
            DecodingResult::I16(samples) => self.copy(samples, |s| s.into(), rows, columns, unpacking),
            DecodingResult::I32(samples) => self.copy(samples, |s| s.into(), rows, columns, unpacking),
            DecodingResult::I64(samples) => self.copy(samples, |s| s as f64, rows, columns, unpacking),
            DecodingResult::F32(samples) => self.copy(samples, |s| s.into(), rows, columns, unpacking),
            DecodingResult::F64(samples) => self.copy(samples, |s| s, rows, columns, unpacking),
            DecodingResult::F16(_) => Err(Flaw::Tiff("it has floating-point numbers of 16 bits".into())),
        }
    }

    fn copy<T: Copy>(
        &self,
        samples: &[T],
        number: impl Fn(T) -> f64,
        rows: &mut [f32],
        columns: [u32; 2],
        unpacking: &mut SampleUnpacking,
    ) -> Result<(), Flaw> {
        let [left, width] = columns.map(|column| column as usize);
        let first = if self.step == 1 { 0 } else { self.band };
        let lines = samples.chunks_exact(width * self.step);
        for (row, line) in rows.chunks_exact_mut(self.size[0] as usize).zip(lines) {
            let samples = line.iter().skip(first).step_by(self.step);
            for (value, &sample) in row[left..left + width].iter_mut().zip(samples) {
                *value = unpacking.value(number(sample))?;
            }
        }
        Ok(())
    }
}

/// What helps where a value is too large.
const REMEDY: &str = "If it marks pixels without a value, say so in the file with gdal_edit.py -a_nodata.";

/// Returns what the tag of GDAL says about the band that is read.
fn band_metadata(decoder: &mut Decoder<impl Read + Seek>, layout: &Layout) -> Result<BandMetadata, Flaw> {
    let text = decoder.find_tag(Tag::Unknown(GDAL_METADATA))?.and_then(|text| text.into_string().ok());
    Ok(text.map_or_else(BandMetadata::default, |text| {
        BandMetadata::from_tag(text.trim_end_matches('\0'), layout.band)
    }))
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
