use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::{Counted, MESH_FORMATS, MeshData, Meter, write_file_metered};
use crate::mesh::Extract;

/// A file format for a mesh with its data: one of [`Self::all`].
#[derive(Clone, Copy)]
pub struct MeshFormat(&'static FormatSpec);

/// A file format, as its module describes it.
pub struct FormatSpec {
    /// The file name extension, in lower case and without the dot.
    pub ending: &'static str,
    /// The extensions of the files beside it.
    pub beside: &'static [&'static str],
    /// Writes a mesh to the path, and the files beside it.
    pub write: fn(&Path, &Extract, &MeshData, &Meter) -> io::Result<()>,
}

impl MeshFormat {
    /// All formats.
    pub fn all() -> impl Iterator<Item = Self> {
        MESH_FORMATS.into_iter().map(Self)
    }

    /// The format of a file name extension, in lower case and without the dot.
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::all().find(|format| format.ending() == ending)
    }

    /// The file name extension, in lower case and without the dot.
    pub fn ending(self) -> &'static str {
        self.0.ending
    }

    /// The files that an export to `path` writes, `path` first.
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        let beside = self.0.beside.iter().map(|ending| path.with_extension(ending));
        std::iter::once(path.to_owned()).chain(beside).collect()
    }

    /// Writes a mesh, and returns the paths of the files: [`Self::files`]. The meter knows the number of
    /// bytes in all only for `.vtu` and `.stl`.
    ///
    /// # Errors
    /// Errors of the file system, and when the work was cancelled. The old files are then untouched, except
    /// for Triangle's four files if the file system fails between two of them.
    pub fn write(
        self,
        path: &Path,
        mesh: &Extract,
        data: &MeshData,
        meter: &Meter,
    ) -> io::Result<Vec<PathBuf>> {
        (self.0.write)(path, mesh, data, meter)?;
        Ok(self.files(path))
    }
}

impl fmt::Debug for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MeshFormat(.{})", self.ending())
    }
}

impl PartialEq for MeshFormat {
    fn eq(&self, other: &Self) -> bool {
        self.ending() == other.ending()
    }
}

impl Eq for MeshFormat {}

/// Writes a file by `write`; the meter counts its bytes.
pub fn write_counted(
    path: &Path,
    meter: &Meter,
    write: impl FnOnce(&mut Counted<&mut dyn Write>) -> io::Result<()>,
) -> io::Result<()> {
    write_file_metered(path, meter, |out| write(&mut meter.count(out)))
}
