//! The part of a picture that is drawn again, in bands of rows.

use std::ops::Range;

/// Rows of a band. Threads draw one band each at a time.
pub const BAND_ROWS: usize = 16;

/// A rectangle of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PxRect {
    /// Columns, counted from the left.
    pub columns: Range<u32>,
    /// Rows, counted from the top.
    pub rows: Range<u32>,
}

impl PxRect {
    /// Returns all pixels of a picture.
    pub fn whole([width, height]: [u32; 2]) -> Self {
        Self { columns: 0..width, rows: 0..height }
    }

    /// Returns the smallest rectangle that contains this one and another.
    pub fn with(&self, other: &Self) -> Self {
        let around = |a: &Range<u32>, b: &Range<u32>| a.start.min(b.start)..a.end.max(b.end);
        Self { columns: around(&self.columns, &other.columns), rows: around(&self.rows, &other.rows) }
    }
}

/// For each band of a picture, the columns that are drawn again.
#[derive(Clone, Debug)]
pub struct Damage {
    size: [u32; 2],
    columns: Vec<Range<u32>>,
}

impl Damage {
    /// Returns the empty part of a picture of this size, in pixels.
    pub fn nothing(size: [u32; 2]) -> Self {
        Self { size, columns: vec![0..0; (size[1] as usize).div_ceil(BAND_ROWS)] }
    }

    /// Returns all pixels of a picture of this size, in pixels.
    pub fn everything(size: [u32; 2]) -> Self {
        let mut damage = Self::nothing(size);
        damage.columns.fill(0..size[0]);
        damage
    }

    /// Adds a rectangle of pixels, which may extend beyond the picture.
    pub fn add(&mut self, columns: Range<i32>, rows: Range<i32>) {
        let [width, height] = self.size.map(|n| n as i32);
        let columns = columns.start.clamp(0, width) as u32..columns.end.clamp(0, width) as u32;
        let rows = rows.start.clamp(0, height) as usize..rows.end.clamp(0, height) as usize;
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        for band in &mut self.columns[rows.start / BAND_ROWS..rows.end.div_ceil(BAND_ROWS)] {
            *band = match Range::is_empty(band) {
                true => columns.clone(),
                false => band.start.min(columns.start)..band.end.max(columns.end),
            };
        }
    }

    /// Returns the columns of each band that are drawn again; the range is empty where none are.
    pub fn bands(&self) -> &[Range<u32>] {
        &self.columns
    }

    /// Returns the bands that a rectangle of pixels meets.
    pub fn bands_meeting(&self, columns: &Range<i32>, rows: &Range<i32>) -> impl Iterator<Item = usize> {
        let last = self.columns.len() as i32;
        let rows_of_band = BAND_ROWS as i32;
        let bands = rows.start.div_euclid(rows_of_band).clamp(0, last)
            ..(rows.end - 1).div_euclid(rows_of_band).saturating_add(1).clamp(0, last);
        bands.map(|band| band as usize).filter(|&band| {
            let damaged = &self.columns[band];
            columns.start < damaged.end as i32 && columns.end > damaged.start as i32
        })
    }

    /// Returns the smallest rectangle that contains everything to draw again, or `None` if that is nothing.
    pub fn bounds(&self) -> Option<PxRect> {
        let damaged = || self.columns.iter().enumerate().filter(|(_, columns)| !columns.is_empty());
        let row = |band: usize| ((band * BAND_ROWS) as u32).min(self.size[1]);
        let (first, last) = (damaged().next()?.0, damaged().next_back()?.0);
        let start = damaged().map(|(_, columns)| columns.start).min()?;
        let end = damaged().map(|(_, columns)| columns.end).max()?;
        Some(PxRect { columns: start..end, rows: row(first)..row(last + 1) })
    }
}
