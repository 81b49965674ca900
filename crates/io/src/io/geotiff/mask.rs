//! Masks: pictures with a sample of 0 where another picture has no value.

use std::io::{BufReader, Read, Seek};
use std::path::Path;

use tiff::decoder::{Decoder, DecodingResult};

use super::super::disk::{self, File};
use super::super::error::PlacedFlaw;
use super::super::{Flaw, Meter, ReadError};
use super::{header, open};

/// Which pixels of a picture have a value.
#[derive(Debug)]
pub(super) struct Mask {
    /// [columns, rows].
    size: [u32; 2],
    /// One for each pixel, the top row first.
    has_value: Vec<bool>,
}

impl Mask {
    /// Reads the mask in the file beside a picture (`.msk`), if there is one.
    ///
    /// # Errors
    /// Fails when it cannot be read.
    pub(super) fn beside(path: &Path, meter: &Meter) -> Result<Option<Self>, ReadError> {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(".msk");
        let beside = path.with_file_name(name);
        if !disk::is_file(&beside) {
            return Ok(None);
        }
        let read = || -> Result<Self, PlacedFlaw> {
            let mut source = BufReader::with_capacity(1 << 16, meter.count(File::open(&beside)?));
            let directories = header::directories(&mut source)?;
            Ok(Self::read(&mut open(source, &directories)?)?)
        };
        read().map(Some).map_err(|flaw| flaw.in_file(&beside))
    }

    /// Reads the current picture of a decoder as a mask.
    ///
    /// # Errors
    /// Fails when it cannot be read.
    pub(super) fn read(decoder: &mut Decoder<impl Read + Seek>) -> Result<Self, Flaw> {
        let (columns, rows) = decoder.dimensions()?;
        let (width, height) = decoder.chunk_dimensions();
        let color = decoder.colortype()?;
        let (bits, samples) = (usize::from(color.bit_depth()), usize::from(color.num_samples()));
        let mut has_value = vec![false; columns as usize * rows as usize];
        let mut chunk = 0;
        for top in (0..rows).step_by(height as usize) {
            for left in (0..columns).step_by(width as usize) {
                let DecodingResult::U8(bytes) = decoder.read_chunk(chunk)? else {
                    return Err(Flaw::Tiff(format!("the samples of its mask have {bits} bits")));
                };
                chunk += 1;
                let across = width.min(columns - left) as usize;
                let lines = bytes.chunks_exact((across * bits * samples).div_ceil(8));
                let places = has_value.chunks_exact_mut(columns as usize).skip(top as usize);
                for (line, row) in lines.zip(places) {
                    let bit = |x: usize| x * bits * samples;
                    let sample = |x: usize| line[bit(x) / 8] << (bit(x) % 8) >> (8 - bits);
                    (0..across).for_each(|x| row[left as usize + x] = sample(x) != 0);
                }
            }
        }
        Ok(Self { size: [columns, rows], has_value })
    }

    /// Takes away the values of a picture of [columns, rows] where the mask has 0. The top row comes first.
    ///
    /// # Errors
    /// Fails when the mask has another size.
    pub(super) fn apply(&self, size: [u32; 2], values: &mut [f32]) -> Result<(), Flaw> {
        if self.size != size {
            let [columns, rows] = self.size;
            let problem =
                format!("its mask has {columns} × {rows} pixels, and the picture {} × {}", size[0], size[1]);
            return Err(Flaw::Tiff(problem));
        }
        let pairs = values.iter_mut().zip(&self.has_value);
        pairs.filter(|(_, has_value)| !**has_value).for_each(|(value, _)| *value = f32::NAN);
        Ok(())
    }
}
