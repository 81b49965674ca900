//! What of a TIFF file is not read: colours, other compressions, other samples.

use std::io::{Read, Seek};

use tiff::decoder::Decoder;
use tiff::tags::{CompressionMethod, PhotometricInterpretation, SampleFormat, Tag};

use super::super::Flaw;
use super::super::samples::SampleType;

/// Refuses a picture whose first band is a part of colours, or a number of one.
pub(super) fn check_colors(colors: Option<u64>) -> Result<(), Flaw> {
    let colors = colors.and_then(|colors| u16::try_from(colors).ok());
    match colors.and_then(PhotometricInterpretation::from_u16) {
        Some(PhotometricInterpretation::RGBPalette) => Err(Flaw::Syntax(
            "its pixels are colours of a palette, not values. If their numbers are values, name the band after the \
             file, as in FILE.tif#1."
                .into(),
        )),
        Some(
            PhotometricInterpretation::RGB
            | PhotometricInterpretation::CMYK
            | PhotometricInterpretation::YCbCr
            | PhotometricInterpretation::CIELab
            | PhotometricInterpretation::IccLab
            | PhotometricInterpretation::ItuLab,
        ) => Err(Flaw::Syntax(
            "it is a picture in colours, and its bands are not heights or other values. If one of them has values, name \
             it after the file, as in FILE.tif#1."
                .into(),
        )),
        _ => Ok(()),
    }
}

/// Refuses compressions that are not read. Which ones the decoder knows depends on how it was
/// built.
pub(super) fn check_packing(decoder: &mut Decoder<impl Read + Seek>) -> Result<(), Flaw> {
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
    Ok(())
}

/// Returns the type of samples of some bits, if they are numbers that can be read.
pub(super) fn check_samples(decoder: &mut Decoder<impl Read + Seek>, bits: u8) -> Result<SampleType, Flaw> {
    let predictor = decoder.find_tag_unsigned::<u16>(Tag::Predictor)?.unwrap_or(1);
    let formats = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat)?;
    let format = formats.and_then(|formats| formats.first().copied()).unwrap_or(SampleFormat::Uint.to_u16());
    let (is_whole, is_float) = match SampleFormat::from_u16(format) {
        Some(SampleFormat::Uint | SampleFormat::Int) => (true, false),
        Some(SampleFormat::IEEEFP) => (false, true),
        _ => (false, false),
    };
    let sample = match bits {
        8 | 16 | 32 | 64 if is_whole => SampleType::Integer,
        32 if is_float => SampleType::Single,
        64 if is_float => SampleType::Double,
        bits => return Err(Flaw::Tiff(format!("its samples have {bits} bits in the format {format}"))),
    };
    if predictor == 3 && is_whole {
        return Err(Flaw::Tiff("its predictor is for floating-point numbers, and it has whole ones".into()));
    }
    Ok(sample)
}
