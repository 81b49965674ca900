//! TIFF files of any layout, written byte by byte.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// A TIFF file to be written. `samples` has all bands of a pixel, pixel by pixel from the upper left.
#[derive(Clone)]
pub(super) struct File {
    pub(super) is_big: bool,
    pub(super) is_big_endian: bool,
    pub(super) size: [usize; 2],
    /// Bits, and the format: 1 unsigned, 2 signed, 3 floating-point.
    pub(super) sample: (usize, u16),
    pub(super) bands: usize,
    pub(super) is_planar: bool,
    /// [columns, rows] of tiles, or the rows of strips.
    pub(super) tiles: Option<[usize; 2]>,
    pub(super) rows_per_strip: usize,
    pub(super) is_deflated: bool,
    pub(super) predictor: u16,
    pub(super) samples: Vec<f64>,
    pub(super) tags: Vec<(u16, Value)>,
}

#[derive(Clone)]
pub(super) enum Value {
    Shorts(Vec<u16>),
    Longs(Vec<u32>),
    Doubles(Vec<f64>),
    Text(&'static str),
}

pub(super) const COLUMNS: usize = 7;
pub(super) const ROWS: usize = 5;

impl File {
    pub(super) fn of(sample: (usize, u16), samples: Vec<f64>) -> Self {
        Self {
            is_big: false,
            is_big_endian: false,
            size: [COLUMNS, ROWS],
            sample,
            bands: samples.len() / (COLUMNS * ROWS),
            is_planar: false,
            tiles: None,
            rows_per_strip: 2,
            is_deflated: false,
            predictor: 1,
            samples,
            tags: Vec::new(),
        }
    }

    pub(super) fn with(mut self, tag: u16, value: Value) -> Self {
        self.tags.push((tag, value));
        self
    }

    /// A file at x from 10 to 17 and y from 15 to 20.
    pub(super) fn placed(self) -> Self {
        let tie = Value::Doubles(vec![0.0, 0.0, 0.0, 10.0, 20.0, 0.0]);
        self.with(33550, Value::Doubles(vec![1.0, 1.0, 0.0])).with(33922, tie)
    }

    fn number(&self, value: u64, bytes: usize) -> Vec<u8> {
        match self.is_big_endian {
            true => value.to_be_bytes()[8 - bytes..].to_vec(),
            false => value.to_le_bytes()[..bytes].to_vec(),
        }
    }

    fn pattern(&self, sample: f64) -> u64 {
        match self.sample {
            (32, 3) => (sample as f32).to_bits().into(),
            (64, 3) => sample.to_bits(),
            (bits, _) => (sample as i64 as u64) & (u64::MAX >> (64 - bits)),
        }
    }

    /// Returns the bytes of a row of one chunk, with the predictor applied.
    fn row(&self, samples: &[f64], stride: usize) -> Vec<u8> {
        let bytes = self.sample.0 / 8;
        let patterns: Vec<u64> = samples.iter().map(|&sample| self.pattern(sample)).collect();
        let before = |i: usize| if i < stride { 0 } else { patterns[i - stride] };
        match self.predictor {
            2 => {
                let differences = patterns.iter().enumerate().map(|(i, p)| p.wrapping_sub(before(i)));
                differences.flat_map(|difference| self.number(difference, bytes)).collect()
            }
            3 => {
                let planes =
                    (0..bytes).rev().flat_map(|k| patterns.iter().map(move |p| (p >> (8 * k)) as u8));
                let planes: Vec<u8> = planes.collect();
                let before = |i: usize| if i < stride { 0 } else { planes[i - stride] };
                planes.iter().enumerate().map(|(i, byte)| byte.wrapping_sub(before(i))).collect()
            }
            _ => patterns.iter().flat_map(|&pattern| self.number(pattern, bytes)).collect(),
        }
    }

    /// Returns the chunks in the order of the file; of tiles, the pixels beyond the picture are 99.
    fn chunks(&self) -> Vec<Vec<u8>> {
        let [columns, rows] = self.size;
        let [width, height] = self.tiles.unwrap_or([columns, self.rows_per_strip]);
        let planes: Vec<Vec<usize>> = match self.is_planar {
            true => (0..self.bands).map(|band| vec![band]).collect(),
            false => vec![(0..self.bands).collect()],
        };
        let at = |x: usize, y: usize, band: usize| match x < columns && y < rows {
            true => self.samples[(y * columns + x) * self.bands + band],
            false => 99.0,
        };
        let mut chunks = Vec::new();
        for bands in &planes {
            for top in (0..rows).step_by(height) {
                for left in (0..columns).step_by(width) {
                    let bottom = if self.tiles.is_some() { top + height } else { rows.min(top + height) };
                    let of_row = |y| {
                        let line = (left..left + width).flat_map(|x| bands.iter().map(move |&b| at(x, y, b)));
                        self.row(&line.collect::<Vec<_>>(), bands.len())
                    };
                    let raw: Vec<u8> = (top..bottom).flat_map(of_row).collect();
                    chunks.push(if self.is_deflated { deflated(&raw) } else { raw });
                }
            }
        }
        chunks
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let chunks = self.chunks();
        let header = if self.is_big { 16 } else { 8 };
        let mut data = Vec::new();
        let mut offsets = Vec::new();
        for chunk in &chunks {
            offsets.push((header + data.len()) as u32);
            data.extend(chunk);
        }
        let counts = chunks.iter().map(|chunk| chunk.len() as u32).collect();
        let short = |value: usize| Value::Shorts(vec![value as u16]);
        let mut tags = vec![
            (256, short(self.size[0])),
            (257, Value::Longs(vec![self.size[1] as u32])),
            (258, Value::Shorts(vec![self.sample.0 as u16; self.bands])),
            (259, short(if self.is_deflated { 8 } else { 1 })),
            (262, short(1)),
            (277, short(self.bands)),
            (284, short(if self.is_planar { 2 } else { 1 })),
            (317, short(self.predictor.into())),
            (339, Value::Shorts(vec![self.sample.1; self.bands])),
        ];
        match self.tiles {
            Some([width, height]) => tags.extend([
                (322, short(width)),
                (323, short(height)),
                (324, Value::Longs(offsets)),
                (325, Value::Longs(counts)),
            ]),
            None => tags.extend([
                (273, Value::Longs(offsets)),
                (278, short(self.rows_per_strip)),
                (279, Value::Longs(counts)),
            ]),
        }
        for (tag, value) in &self.tags {
            tags.retain(|(other, _)| other != tag);
            tags.push((*tag, value.clone()));
        }
        tags.sort_by_key(|(tag, _)| *tag);
        self.assembled(data, &tags)
    }

    fn assembled(&self, mut data: Vec<u8>, tags: &[(u16, Value)]) -> Vec<u8> {
        let (header, word) = if self.is_big { (16, 8) } else { (8, 4) };
        let mut entries = Vec::new();
        for (tag, value) in tags {
            let (kind, count, mut bytes) = match value {
                Value::Shorts(list) => {
                    (3, list.len(), list.iter().flat_map(|&v| self.number(v.into(), 2)).collect())
                }
                Value::Longs(list) => {
                    (4, list.len(), list.iter().flat_map(|&v| self.number(v.into(), 4)).collect())
                }
                Value::Doubles(list) => {
                    (12, list.len(), list.iter().flat_map(|v| self.number(v.to_bits(), 8)).collect())
                }
                Value::Text(text) => (2, text.len() + 1, [text.as_bytes(), b"\0"].concat()),
            };
            entries.extend([
                self.number((*tag).into(), 2),
                self.number(kind, 2),
                self.number(count as u64, word),
            ]);
            if bytes.len() > word {
                let at = (header + data.len()) as u64;
                data.extend(std::mem::replace(&mut bytes, self.number(at, word)));
            }
            bytes.resize(word, 0);
            entries.push(bytes);
        }
        let directory = (header + data.len()) as u64;
        let order: &[u8] = if self.is_big_endian { b"MM" } else { b"II" };
        let start = match self.is_big {
            true => [self.number(43, 2), self.number(8, 2), self.number(0, 2)].concat(),
            false => self.number(42, 2),
        };
        let count = self.number(tags.len() as u64, if self.is_big { 8 } else { 2 });
        let end = self.number(0, word);
        [order, &start, &self.number(directory, word), &data, &count, &entries.concat(), &end].concat()
    }
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}
