use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::atomic::{Draft, put_in_place};
use super::{MESH_FORMATS, MeshData, Meter};
use meshbrush_mesh::mesh::Extract;

/// A file format for a mesh with its data: one of [`Self::all`], or its binary form.
#[derive(Clone, Copy)]
pub struct MeshFormat {
    spec: &'static FormatSpec,
    is_binary: bool,
}

/// A file format, as its module describes it.
pub struct FormatSpec {
    /// The file name extension, in lower case and without the dot.
    pub ending: &'static str,
    /// The programs that read the format, and its contents, in a few words for a list of formats.
    pub purpose: &'static str,
    /// How long its files are.
    pub size: TypicalSize,
    /// The further files of the format: extensions and writers.
    pub beside: &'static [(&'static str, WriteMesh)],
    /// Writes a mesh.
    pub write: WriteMesh,
    /// Writes a mesh in binary form, if the format has a form of either kind.
    pub write_binary: Option<WriteMesh>,
}

/// How long the files of a format are, all together, as measured on graded meshes and coasts.
#[derive(Clone, Copy, Debug)]
pub struct TypicalSize {
    /// Bytes for each triangle of a mesh of 10,000 triangles.
    pub bytes: f64,
    /// Further bytes for each triangle of a mesh ten times as large: its numbers have one more digit.
    pub bytes_per_digit: f64,
}

/// Writes a mesh and its data, and updates the meter.
pub type WriteMesh = fn(&mut dyn Write, &Extract, &MeshData, &Meter) -> io::Result<()>;

impl MeshFormat {
    /// Returns all formats.
    pub fn all() -> impl Iterator<Item = Self> {
        MESH_FORMATS.into_iter().map(|spec| Self { spec, is_binary: false })
    }

    /// Returns the binary form of a format that is text otherwise, if there is one: of `.msh`.
    pub fn binary(self) -> Option<Self> {
        self.spec.write_binary.is_some().then_some(Self { is_binary: true, ..self })
    }

    /// Returns the format of a file name extension, in lower case and without the dot.
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::all().find(|format| format.ending() == ending)
    }

    /// The file name extension, in lower case and without the dot.
    pub fn ending(self) -> &'static str {
        self.spec.ending
    }

    /// Returns the programs that read the format, and its contents, in a few words.
    pub fn purpose(self) -> &'static str {
        self.spec.purpose
    }

    /// Returns about how many bytes the files of a mesh have, all together; the text is up to a third longer
    /// or shorter where coordinates are.
    pub fn approximate_bytes(self, triangles: usize) -> u64 {
        let TypicalSize { bytes, bytes_per_digit } = self.spec.size;
        let further_digits = libm::log10(triangles.max(1) as f64) - 4.0;
        (triangles as f64 * (bytes + bytes_per_digit * further_digits).max(1.0)) as u64
    }

    /// Returns the files that an export to `path` writes, `path` first.
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        let beside = self.spec.beside.iter().map(|(ending, _)| path.with_extension(ending));
        std::iter::once(path.to_owned()).chain(beside).collect()
    }

    fn writer(self) -> WriteMesh {
        match self.spec.write_binary {
            Some(write) if self.is_binary => write,
            _ => self.spec.write,
        }
    }

    /// Writes a mesh, and returns the paths of the files: [`Self::files`]. The meter knows the number of
    /// bytes in all only for `.vtu` and `.stl`.
    ///
    /// # Errors
    /// Fails with the errors of the file system, and when the work was cancelled. The old files are then
    /// untouched, except for Triangle's four files if the file system fails between two of them.
    pub fn write(
        self,
        path: &Path,
        mesh: &Extract,
        data: &MeshData,
        meter: &Meter,
    ) -> io::Result<Vec<PathBuf>> {
        let files = self.files(path);
        let writers = std::iter::once(self.writer()).chain(self.spec.beside.iter().map(|(_, write)| *write));
        let draft = |(file, write): (&PathBuf, WriteMesh)| {
            Draft::write(file, meter, |out| write(out, mesh, data, meter))
        };
        // None replaces an old file before all are written: they would not match each other.
        let drafts = files.iter().zip(writers).map(draft).collect::<io::Result<Vec<_>>>()?;
        put_in_place(drafts, meter)?;
        Ok(files)
    }

    /// Writes a mesh to a stream; `None` for a format of several files.
    ///
    /// # Errors
    /// Fails with the errors of the stream, and when the work was cancelled.
    pub fn write_to(
        self,
        out: &mut dyn Write,
        mesh: &Extract,
        data: &MeshData,
        meter: &Meter,
    ) -> Option<io::Result<()>> {
        self.spec.beside.is_empty().then(|| self.writer()(out, mesh, data, meter))
    }
}

impl fmt::Debug for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MeshFormat(.{}{})", self.ending(), if self.is_binary { ", binary" } else { "" })
    }
}

impl PartialEq for MeshFormat {
    fn eq(&self, other: &Self) -> bool {
        (self.ending(), self.is_binary) == (other.ending(), other.is_binary)
    }
}

impl Eq for MeshFormat {}
