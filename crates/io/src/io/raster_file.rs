use std::fmt;
use std::path::{Path, PathBuf};

use super::format_spec::{RasterFormatSpec, ReadRaster};
use super::formats::RASTER_FORMATS;

/// A file format of rasters: one of [`Self::all`].
#[derive(Clone, Copy)]
pub struct RasterFormat(&'static RasterFormatSpec);

/// What follows the name of a file before the name of a variable or the number of a band in it.
const BEFORE_PART: char = '#';

/// Returns the file that a path means, and the variable or band in it that follows its name, as in
/// `a.nc#depth` and `a.tif#2`.
pub(super) fn file_and_part(path: &Path) -> (PathBuf, Option<String>) {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let named = name.rsplit_once(BEFORE_PART).filter(|_| !super::exists(path)).and_then(|(file, part)| {
        let ending = Path::new(file).extension()?;
        let has = |format: &&RasterFormatSpec| {
            format.has_parts && format.endings.iter().any(|known| ending.eq_ignore_ascii_case(known))
        };
        let is_known = RASTER_FORMATS.iter().any(has);
        is_known.then(|| (path.with_file_name(file), Some(part.to_owned())))
    });
    named.unwrap_or_else(|| (path.to_owned(), None))
}

impl RasterFormat {
    /// Returns all formats.
    pub fn all() -> impl Iterator<Item = Self> {
        RASTER_FORMATS.into_iter().map(Self)
    }

    /// Returns the format that the ending of a file name says.
    ///
    /// # Errors
    /// Fails with a sentence when it is the ending of no raster.
    pub fn from_path(path: &Path) -> Result<Self, String> {
        let (path, _) = file_and_part(path);
        let ending = path.extension().unwrap_or_default();
        let has = |format: &Self| format.endings().iter().any(|known| ending.eq_ignore_ascii_case(known));
        Self::all().find(has).ok_or_else(|| {
            let endings = Self::all().flat_map(|format| format.endings()).map(|ending| format!(".{ending}"));
            let mut endings: Vec<String> = endings.collect();
            let last = endings.pop().unwrap_or_default();
            format!("a raster ends in {} or {last}.", endings.join(", "))
        })
    }

    /// The default file name extension, in lower case and without the dot.
    pub fn ending(self) -> &'static str {
        self.0.endings[0]
    }

    /// All file name extensions, in lower case and without the dot.
    pub fn endings(self) -> &'static [&'static str] {
        self.0.endings
    }

    /// Returns whether a file has any values. The others are images, with values from 0 to 1.
    pub fn is_grid(self) -> bool {
        !matches!(self.0.read, ReadRaster::Image(_))
    }

    /// Returns whether a file says itself which rectangle it covers.
    pub fn has_place(self) -> bool {
        matches!(self.0.read, ReadRaster::Grid(_))
    }

    /// Returns what reads its files.
    pub(super) fn read(self) -> ReadRaster {
        self.0.read
    }
}

impl fmt::Debug for RasterFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RasterFormat(.{})", self.ending())
    }
}

impl PartialEq for RasterFormat {
    fn eq(&self, other: &Self) -> bool {
        self.ending() == other.ending()
    }
}
