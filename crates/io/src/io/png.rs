//! `.png`: greyscale images in, pictures out.

use std::io::{self, BufRead, BufReader, Seek, Write};
use std::path::Path;

use png::{
    BitDepth, ColorType, Compression, Decoder, DecodingError, Encoder, EncodingError, Filter, OutputInfo,
    PixelDimensions, Reader, Transformations, Unit,
};

use super::disk::File;
use super::error::PlacedFlaw;
use super::rows::reverse_rows;
use super::{Flaw, Meter, Provenance, RasterFormatSpec, ReadError, ReadRaster};
use meshbrush_core::document::Picture;
use meshbrush_core::raster::{Raster, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::Grouped;

/// The format, for the list of all formats of rasters.
pub static RASTER: RasterFormatSpec =
    RasterFormatSpec { endings: &["png"], has_parts: false, read: ReadRaster::Image(read_metered) };

/// The colour behind transparent pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Behind {
    /// Black: a fully transparent pixel has the value 0.
    Black,
    /// White: a fully transparent pixel has the value 1.
    White,
}

/// Reads an image as values from 0 (black) to 1 (white), over the given rectangle.
///
/// Grey and coloured images with 1 to 16 bits, palettes and transparency are read. A colour becomes its luma
/// (Rec. 709 weights on the stored values); grey values are used as stored, without gamma. The top row of the
/// image is the last row of the raster.
///
/// # Errors
/// Fails when the file cannot be read, is not a PNG image, is cut off, or has too many pixels for a raster.
/// The size is checked before memory is allocated.
pub fn read(path: &Path, bounds: Rect, behind: Behind) -> Result<Raster, ReadError> {
    read_metered(path, bounds, behind, &Meter::default())
}

/// Reads as [`read`] does, and counts the bytes of the file.
///
/// # Errors
/// Fails as [`read`] does, and when the work was cancelled.
pub fn read_metered(path: &Path, bounds: Rect, behind: Behind, meter: &Meter) -> Result<Raster, ReadError> {
    let decoded = File::open(path).map_err(PlacedFlaw::from).and_then(|file| {
        meter.expect(file.length()?);
        Ok(decode(BufReader::new(meter.count(file)), bounds, behind)?)
    });
    decoded.map_err(|flaw| flaw.in_file(path))
}

/// Reads as [`read`] does, from any source of bytes.
///
/// # Errors
/// Fails as [`read`] does.
pub fn decode(source: impl BufRead + Seek, bounds: Rect, behind: Behind) -> Result<Raster, Flaw> {
    let mut decoder = Decoder::new(source);
    // Palettes and low depths become 8 bits, a transparent colour an alpha channel.
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info()?;
    let size = [header.width, header.height];
    if !is_raster_size(size) {
        return Err(Flaw::Size { columns: size[0].into(), rows: size[1].into() });
    }
    let mut values = top_row_first(decoder, size, behind)?;
    reverse_rows(&mut values, size[0]);
    Ok(Raster::from_values(bounds, size, values))
}

/// Returns the values of an image of [columns, rows], the top row first. Memory grows with the rows in the
/// file.
fn top_row_first<R: BufRead + Seek>(
    decoder: Decoder<R>,
    size: [u32; 2],
    behind: Behind,
) -> Result<Vec<f32>, Flaw> {
    let mut values = Vec::new();
    let mut take = |row: &[u8], (color, depth)| {
        let pixels = row.chunks_exact(pixel_bytes(color, depth)).take(size[0] as usize);
        values.extend(pixels.map(|pixel| value_of_pixel(pixel, color, depth, behind)));
    };
    let mut reader = checked_reader(decoder)?;
    let format = reader.output_color_type();
    if reader.info().interlaced {
        // Every pass has pixels of many rows.
        let (bytes, frame) = whole_frame(reader, size)?;
        bytes.chunks_exact(frame.line_size).for_each(|row| take(row, format));
        return Ok(values);
    }
    check_frame(&reader, size)?;
    while let Some(row) = reader.next_row()? {
        take(row.data(), format);
    }
    Ok(values)
}

fn pixel_bytes(color: ColorType, depth: BitDepth) -> usize {
    color.samples() * if depth == BitDepth::Sixteen { 2 } else { 1 }
}

fn value_of_pixel(pixel: &[u8], color: ColorType, depth: BitDepth, behind: Behind) -> f32 {
    let sample = |i: usize| match depth {
        BitDepth::Sixteen => f64::from(u16::from_be_bytes([pixel[2 * i], pixel[2 * i + 1]])) / 65535.0,
        _ => f64::from(pixel[i]) / 255.0,
    };
    value(color, sample, behind) as f32
}

/// Reads an image in colour, and counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read or is not a PNG image, when it has more than [`Picture::MOST_PIXELS`]
/// pixels, and when the work was cancelled.
pub fn read_picture(path: &Path, meter: &Meter) -> Result<Picture, ReadError> {
    let decoded = File::open(path).map_err(PlacedFlaw::from).and_then(|file| {
        meter.expect(file.length()?);
        Ok(decode_picture(BufReader::new(meter.count(file)))?)
    });
    decoded.map_err(|flaw| flaw.in_file(path))
}

/// Returns a reader of the samples, after a check that the decoder needs.
fn checked_reader<R: BufRead + Seek>(decoder: Decoder<R>) -> Result<Reader<R>, Flaw> {
    let reader = decoder.read_info()?;
    // The decoder relies on three bytes for each colour.
    if reader.info().palette.as_ref().is_some_and(|palette| palette.len() % 3 != 0) {
        return Err(Flaw::Png("its palette is not a list of colours".into()));
    }
    Ok(reader)
}

/// Checks that the first frame of an animation fills the image of [columns, rows].
fn check_frame<R: BufRead + Seek>(reader: &Reader<R>, size: [u32; 2]) -> Result<(), Flaw> {
    match reader.info().frame_control() {
        Some(frame) if [frame.width, frame.height] != size => {
            Err(Flaw::Png("its first frame does not fill the image".into()))
        }
        _ => Ok(()),
    }
}

/// Returns the samples of an image of [columns, rows], and their format.
fn whole_frame<R: BufRead + Seek>(
    mut reader: Reader<R>,
    size: [u32; 2],
) -> Result<(Vec<u8>, OutputInfo), Flaw> {
    check_frame(&reader, size)?;
    let mut bytes = vec![0; reader.output_buffer_size().ok_or(DecodingError::LimitsExceeded)?];
    let frame = reader.next_frame(&mut bytes)?;
    Ok((bytes, frame))
}

/// Reads as [`read_picture`] does, from any source of bytes.
///
/// # Errors
/// Fails as [`read_picture`] does.
pub fn decode_picture(source: impl BufRead + Seek) -> Result<Picture, Flaw> {
    let mut decoder = Decoder::new(source);
    decoder.set_transformations(Transformations::EXPAND | Transformations::ALPHA | Transformations::STRIP_16);
    let header = decoder.read_header_info()?;
    let size = [header.width, header.height];
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    if pixels == 0 || pixels > Picture::MOST_PIXELS {
        return Err(Flaw::Syntax(format!(
            "a background picture has at most {} pixels, and this one has {} × {}. Scale it first.",
            Grouped(Picture::MOST_PIXELS as usize),
            Grouped(size[0] as usize),
            Grouped(size[1] as usize)
        )));
    }
    let (mut bytes, frame) = whole_frame(checked_reader(decoder)?, size)?;
    bytes.truncate(frame.buffer_size());
    let rgba = match frame.color_type {
        ColorType::Rgba => bytes,
        ColorType::GrayscaleAlpha => bytes.chunks_exact(2).flat_map(|p| [p[0], p[0], p[0], p[1]]).collect(),
        other => return Err(Flaw::Png(format!("its colours are of the kind {other:?}"))),
    };
    Ok(Picture { size, rgba })
}

/// Returns the value of a pixel from its samples, each 0 to 1.
fn value(color: ColorType, sample: impl Fn(usize) -> f64, behind: Behind) -> f64 {
    let luma = || 0.2126 * sample(0) + 0.7152 * sample(1) + 0.0722 * sample(2);
    let ground = if behind == Behind::White { 1.0 } else { 0.0 };
    let over = |value: f64, opacity: f64| ground + (value - ground) * opacity;
    match color {
        ColorType::Grayscale | ColorType::Indexed => sample(0),
        ColorType::GrayscaleAlpha => over(sample(0), sample(1)),
        ColorType::Rgb => luma(),
        ColorType::Rgba => over(luma(), sample(3)),
    }
}

impl From<DecodingError> for Flaw {
    fn from(error: DecodingError) -> Self {
        match error {
            DecodingError::IoError(e) if e.kind() == io::ErrorKind::UnexpectedEof => Self::CutOff,
            DecodingError::IoError(e) => Self::Io(e),
            other => Self::Png(other.to_string().trim_end_matches('.').to_owned()),
        }
    }
}

/// Writes a picture of `size` pixels, four bytes each (red, green, blue, opacity), the top row first.
///
/// # Errors
/// Fails with the errors of `out`, and when the number of bytes does not match `size`.
pub fn write(out: &mut impl Write, size: [u32; 2], rgba: &[u8]) -> io::Result<()> {
    encode(Encoder::new(out, size[0], size[1]), ColorType::Rgba, rgba)
}

/// Metres of an inch.
const INCH: f64 = 0.0254;

/// Writes a picture as [`write()`] does, with texts that describe its origin. `dots_per_inch` says how large
/// its pixels are on paper, if that is known.
///
/// # Errors
/// Fails as [`write()`] does.
pub fn write_described(
    out: &mut impl Write,
    size: [u32; 2],
    rgba: &[u8],
    dots_per_inch: Option<f64>,
    provenance: &Provenance,
) -> io::Result<()> {
    let mut encoder = Encoder::new(out, size[0], size[1]);
    let per_metre = dots_per_inch.map(|dots| (dots / INCH).round() as u32);
    let density = |per_metre| PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter };
    encoder.set_pixel_dims(per_metre.map(density));
    for (key, text) in provenance.entries() {
        let keyword = match key {
            "program" => "Software",
            "command" => "Command",
            "document" => "Document",
            "fingerprint" => "Fingerprint",
            "unit" => "Unit",
            _ => "Coordinates",
        };
        let (keyword, text) = (keyword.to_owned(), text.to_owned());
        // Plain text chunks have Latin-1 only, and more programs show them.
        let added = match text.is_ascii() {
            true => encoder.add_text_chunk(keyword, text),
            false => encoder.add_itxt_chunk(keyword, text),
        };
        added.map_err(|error| io::Error::other(error.to_string()))?;
    }
    encode(encoder, ColorType::Rgba, rgba)
}

/// Writes an opaque picture as [`write()`] does, in a smaller file and more slowly.
///
/// # Errors
/// Fails as [`write()`] does.
pub fn write_small(out: &mut impl Write, size: [u32; 2], rgba: &[u8]) -> io::Result<()> {
    let mut encoder = Encoder::new(out, size[0], size[1]);
    encoder.set_compression(Compression::High);
    encoder.set_filter(Filter::NoFilter);
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    encode(encoder, ColorType::Rgb, &rgb)
}

fn encode<W: Write>(mut encoder: Encoder<'_, W>, color: ColorType, bytes: &[u8]) -> io::Result<()> {
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    let write = || {
        let mut writer = encoder.write_header()?;
        writer.write_image_data(bytes)?;
        writer.finish()
    };
    write().map_err(|error| match error {
        EncodingError::IoError(e) => e,
        other => io::Error::other(other.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn encoded(color: ColorType, depth: BitDepth, size: [u32; 2], data: &[u8]) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, size[0], size[1]);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![255, 255, 255, 0, 0, 0, 51, 51, 51]);
            encoder.set_trns(vec![255, 255, 0]);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        file
    }

    fn values(file: &[u8], behind: Behind) -> Vec<f32> {
        decode(Cursor::new(file), Rect::UNIT, behind).unwrap().values().to_vec()
    }

    /// Returns a greyscale picture whose rows come in seven passes, from every eighth pixel to all of them.
    fn interlaced(size: [u32; 2], value: impl Fn(u32, u32) -> u8) -> Vec<u8> {
        const PASSES: [[u32; 4]; 7] = [
            [0, 0, 8, 8],
            [4, 0, 8, 8],
            [0, 4, 4, 8],
            [2, 0, 4, 4],
            [0, 2, 2, 4],
            [1, 0, 2, 2],
            [0, 1, 1, 2],
        ];
        let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        for [first, top, along, down] in PASSES.into_iter().filter(|[first, ..]| *first < size[0]) {
            for y in (top..size[1]).step_by(down as usize) {
                packed.write_all(&[0]).unwrap();
                (first..size[0])
                    .step_by(along as usize)
                    .for_each(|x| packed.write_all(&[value(x, y)]).unwrap());
            }
        }
        let header = [&size[0].to_be_bytes()[..], &size[1].to_be_bytes(), &[8, 0, 0, 0, 1]].concat();
        let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
        for (name, data) in [(b"IHDR", header), (b"IDAT", packed.finish().unwrap()), (b"IEND", Vec::new())] {
            let body = [&name[..], &data].concat();
            file.extend((data.len() as u32).to_be_bytes());
            file.extend(&body);
            file.extend(crc32fast::hash(&body).to_be_bytes());
        }
        file
    }

    #[test]
    fn interlaced_pictures_are_read_like_others() {
        for size in [[1, 1], [3, 2], [8, 8], [13, 21]] {
            let value = |x: u32, y: u32| (7 * x + 31 * y) as u8;
            let pixels = |y| (0..size[0]).map(move |x| value(x, y));
            let rows: Vec<u8> = (0..size[1]).flat_map(pixels).collect();
            let plain = encoded(ColorType::Grayscale, BitDepth::Eight, size, &rows);
            let read = values(&interlaced(size, value), Behind::Black);
            assert_eq!(read, values(&plain, Behind::Black), "{size:?}");
            assert_eq!(read.len(), rows.len());
        }
    }

    #[test]
    fn every_pixel_format_becomes_a_value_from_0_to_1() {
        use BitDepth::{Eight, One, Sixteen, Two};
        use ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};
        let black =
            |color, depth, size, data: &[u8]| values(&encoded(color, depth, size, data), Behind::Black);
        assert_eq!(black(Grayscale, Eight, [3, 1], &[0, 51, 255]), [0.0, 0.2, 1.0]);
        assert_eq!(black(Grayscale, Sixteen, [2, 1], &[0x33, 0x33, 0xff, 0xff]), [0.2, 1.0]);
        assert_eq!(black(Grayscale, One, [3, 1], &[0b1010_0000]), [1.0, 0.0, 1.0]);
        assert_eq!(black(Rgb, Eight, [2, 1], &[51, 51, 51, 0, 255, 0]), [0.2, 0.7152]);
        assert_eq!(black(Indexed, Two, [3, 1], &[0b0001_1000]), [1.0, 0.0, 0.0]);
        assert_eq!(black(Rgba, Eight, [2, 1], &[255, 255, 255, 51, 255, 255, 255, 0]), [0.2, 0.0]);
        let clear = encoded(GrayscaleAlpha, Eight, [3, 1], &[0, 0, 0, 255, 255, 255]);
        assert_eq!(values(&clear, Behind::White), [1.0, 0.0, 1.0]);
    }

    #[test]
    fn the_top_row_of_the_image_is_the_last_of_the_raster() {
        let file = encoded(ColorType::Grayscale, BitDepth::Eight, [1, 3], &[255, 51, 0]);
        assert_eq!(values(&file, Behind::Black), [0.0, 0.2, 1.0]);
    }

    #[test]
    fn every_cut_is_an_error() {
        let file = encoded(ColorType::Rgb, BitDepth::Eight, [8, 8], &[77; 192]);
        // Without the last 12 bytes, the end marker, the picture is still complete.
        for length in 0..file.len() - 12 {
            let cut = decode(Cursor::new(&file[..length]), Rect::UNIT, Behind::Black);
            assert!(cut.is_err(), "cut at {length}");
        }
    }

    #[test]
    fn an_image_that_is_too_large_is_refused_by_its_header() {
        let mut file = encoded(ColorType::Rgba, BitDepth::Sixteen, [1, 1], &[0; 8]);
        file[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 1, 0x86, 0xa0]);
        let crc = crc32(&file[12..29]);
        file[29..33].copy_from_slice(&crc.to_be_bytes());
        let refused = decode(Cursor::new(&file), Rect::UNIT, Behind::Black).unwrap_err();
        assert!(matches!(refused, Flaw::Size { columns: 100_000, rows: 100_000 }), "{refused}");
    }

    #[test]
    fn a_palette_that_ends_within_a_color_is_refused() {
        let mut file = encoded(ColorType::Indexed, BitDepth::Two, [3, 1], &[0b0001_1000]);
        // Of nine bytes of colours the last one is removed.
        let at = file.windows(4).position(|name| name == b"PLTE").unwrap();
        file[at - 1] = 8;
        let crc = crc32(&file[at..at + 12]);
        file.splice(at + 12..at + 17, crc.to_be_bytes());
        let refused = decode(Cursor::new(&file), Rect::UNIT, Behind::Black).unwrap_err();
        assert!(refused.to_string().contains("palette"), "{refused}");
    }

    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0u32, |crc, &byte| {
            (0..8).fold(
                crc ^ u32::from(byte),
                |crc, _| {
                    if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 }
                },
            )
        })
    }
}
