use std::ffi::OsString;
use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::atomic::{Draft, put_in_place, write_file_metered};
use super::format_spec::{FormatSpec, QuantityPlaces, SquareCells, ThirdCoordinate, TypicalSize, WriteMesh};
use super::formats::MESH_FORMATS;
use super::partition::{self, PartLines, PartitionFigures};
use super::{MeshData, Meter};
use meshbrush_mesh::mesh::Extract;

/// A file format for a mesh with its data: one of [`Self::all`], or its binary form.
#[derive(Clone, Copy)]
pub struct MeshFormat {
    spec: &'static FormatSpec,
    is_binary: bool,
}

impl MeshFormat {
    /// Returns whether a coastal solver finds its open boundary in the files of the format.
    pub fn has_open_boundary(self) -> bool {
        self.spec.has_open_boundary
    }

    /// Returns all formats.
    pub fn all() -> impl Iterator<Item = Self> {
        MESH_FORMATS.into_iter().map(|spec| Self { spec, is_binary: false })
    }

    /// Returns whether h̄ at the nodes is in its files; the others are written without reading it.
    pub fn has_targets(self) -> bool {
        self.spec.has_targets
    }

    /// Returns whether weirs are in its files, as cracks with crests.
    pub fn has_weirs(self) -> bool {
        self.spec.has_weirs
    }

    /// Returns whether its coordinates have to be lengths: degrees are refused.
    pub fn needs_lengths(self) -> bool {
        self.spec.needs_lengths
    }

    /// Returns whether its files can have quadrilaterals.
    pub fn holds_squares(self) -> bool {
        self.spec.squares != SquareCells::Impossible
    }

    /// Returns whether its solver wants them.
    pub fn wants_squares(self) -> bool {
        self.spec.squares == SquareCells::Usual
    }

    /// Returns what the third coordinate of its nodes is.
    pub fn third_coordinate(self) -> ThirdCoordinate {
        self.spec.third
    }

    /// Returns the binary form of a format that is text otherwise, if there is one: of `.msh`.
    pub fn binary(self) -> Option<Self> {
        self.spec.write_binary.is_some().then_some(Self { is_binary: true, ..self })
    }

    /// Returns the format of a file name extension, in lower case and without the dot.
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::all().find(|format| format.may_end_in(ending))
    }

    /// Returns the format with a name, or else with a file name extension, in lower case.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|format| format.name() == name).or_else(|| Self::from_ending(name))
    }

    /// The name of the format: its default extension, or another word, as `fvcom` and `ugrid`.
    pub fn name(self) -> &'static str {
        self.spec.name
    }

    /// The default file name extension, in lower case and without the dot.
    pub fn ending(self) -> &'static str {
        self.spec.endings[0]
    }

    /// The file name extensions that choose this format, the default one first.
    pub fn endings(self) -> impl Iterator<Item = &'static str> {
        self.spec.endings.iter().copied().filter(move |ending| Self::from_ending(ending) == Some(self))
    }

    /// Returns whether files of this format may have an extension, which may choose another format.
    pub fn may_end_in(self, ending: &str) -> bool {
        self.spec.endings.contains(&ending)
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

    /// Returns the files that an export to `path` writes. The first is `path`, or for a format whose files
    /// differ in more than their extensions, the one beside it that is named as the format wants.
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        let first =
            if self.spec.tail.is_empty() { path.to_owned() } else { self.sibling(path, self.spec.tail) };
        let beside = self.spec.beside.iter().map(|(ending, _)| self.sibling(path, ending));
        std::iter::once(first).chain(beside).collect()
    }

    /// Returns which quantities have a place in its files.
    pub fn quantities(self) -> QuantityPlaces {
        self.spec.quantities
    }

    /// Returns the file beside an export to `path` that is written where there are quantities other than the
    /// depth and the surface, if the format has one.
    pub fn attributes_file(self, path: &Path) -> Option<PathBuf> {
        self.spec.attributes.map(|(ending, _)| self.sibling(path, ending))
    }

    /// Returns the files beside an export to `path` that are written where the mesh has edges along lines of
    /// the document.
    pub fn line_files(self, path: &Path) -> Vec<PathBuf> {
        self.spec.beside_lines.iter().map(|(ending, _)| after_stem(path, ending)).collect()
    }

    /// Returns the files with the lines and their writers, where there are any.
    fn lines(self, path: &Path, data: &MeshData) -> impl Iterator<Item = (PathBuf, WriteMesh)> + use<> {
        let writers = if data.lines.is_empty() { &[] } else { self.spec.beside_lines };
        self.line_files(path).into_iter().zip(writers.iter().map(|(_, write)| *write))
    }

    /// Returns the file of the attributes and its writer, where there are any.
    fn attributes(self, path: &Path, data: &MeshData) -> Option<(PathBuf, WriteMesh)> {
        let (_, write) = self.spec.attributes.filter(|_| data.attributes().next().is_some())?;
        Some((self.attributes_file(path)?, write))
    }

    /// Returns the path with another extension, or with another tail in place of the tail of the format.
    fn sibling(self, path: &Path, ending: &str) -> PathBuf {
        if self.spec.tail.is_empty() {
            return path.with_extension(ending);
        }
        let stem = path.file_stem().unwrap_or_default();
        let own = self.spec.tail.split('.').next().unwrap_or_default();
        let shorter = stem.to_str().and_then(|stem| stem.strip_suffix(own));
        let mut name = shorter.map_or_else(|| stem.to_owned(), OsString::from);
        name.push(ending);
        path.with_file_name(name)
    }

    fn writer(self) -> WriteMesh {
        match self.spec.write_binary {
            Some(write) if self.is_binary => write,
            _ => self.spec.write,
        }
    }

    /// Writes a mesh, and returns the paths of the files: [`Self::files`], [`Self::attributes_file`] where
    /// there are attributes, and [`Self::line_files`] where there are lines. The meter knows the number of
    /// bytes in all only for `.vtu`, `.stl` and `.nc`.
    ///
    /// # Errors
    /// Fails with the errors of the file system, when the format cannot hold the mesh, and when the work was
    /// cancelled. The old files are then untouched, except for those of a format of several files if the file
    /// system fails between two of them.
    pub fn write(
        self,
        path: &Path,
        mesh: &Extract,
        data: &MeshData,
        meter: &Meter,
    ) -> io::Result<Vec<PathBuf>> {
        let writers = std::iter::once(self.writer()).chain(self.spec.beside.iter().map(|(_, write)| *write));
        let attributes = self.attributes(path, data);
        let files: Vec<(PathBuf, WriteMesh)> = self
            .files(path)
            .into_iter()
            .zip(writers)
            .chain(attributes)
            .chain(self.lines(path, data))
            .collect();
        let draft = |(file, write): &(PathBuf, WriteMesh)| {
            Draft::write(file, meter, |out| write(out, mesh, data, meter))
        };
        // None replaces an old file before all are written: they would not match each other.
        let drafts = files.iter().map(draft).collect::<io::Result<Vec<_>>>()?;
        put_in_place(drafts, meter)?;
        Ok(files.into_iter().map(|(file, _)| file).collect())
    }

    /// Returns the file with the part of each cell, beside an export to `path`: the one in which the solver
    /// looks for it, or one that is named as METIS does.
    pub fn parts_file(self, path: &Path, parts: u32) -> PathBuf {
        if let Some(name) = self.spec.parts_file {
            return path.with_file_name(name);
        }
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".part.{parts}"));
        path.with_file_name(name)
    }

    /// Writes the part of each cell to [`Self::parts_file`], and returns it, and how even the parts are.
    ///
    /// # Errors
    /// Fails with the errors of the file system, where there are more parts than cells, and when the work was
    /// cancelled.
    pub fn write_parts(
        self,
        path: &Path,
        mesh: &Extract,
        data: &MeshData,
        parts: u32,
        meter: &Meter,
    ) -> io::Result<(PathBuf, PartitionFigures)> {
        let file = self.parts_file(path, parts);
        let lines =
            if self.spec.parts_file.is_some() { PartLines::NumbersAndParts } else { PartLines::Parts };
        let mut figures = None;
        write_file_metered(&file, meter, |out| {
            let mut out = meter.count(out);
            figures = Some(partition::write(&mut out, mesh, data, self.spec.squares, lines, parts)?);
            Ok(())
        })?;
        let figures = figures.ok_or_else(|| io::Error::other("the parts were not written"))?;
        Ok((file, figures))
    }

    /// Returns how many bytes the files of a mesh have, all together, without writing one.
    ///
    /// # Errors
    /// Fails when the format cannot hold the mesh, and when the work was cancelled.
    pub fn exact_bytes(self, mesh: &Extract, data: &MeshData, meter: &Meter) -> io::Result<u64> {
        let mut count = ByteCount(0);
        let writers = std::iter::once(self.writer()).chain(self.spec.beside.iter().map(|(_, write)| *write));
        let path = Path::new("mesh");
        let further = self.attributes(path, data).into_iter().chain(self.lines(path, data));
        for write in writers.chain(further.map(|(_, write)| write)) {
            write(&mut meter.count(&mut count), mesh, data, meter)?;
        }
        Ok(count.0)
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

/// Returns the path with this in place of the extension.
fn after_stem(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(ending);
    path.with_file_name(name)
}

/// Counts bytes, and keeps none.
struct ByteCount(u64);

impl Write for ByteCount {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl fmt::Debug for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "MeshFormat({}{})", self.name(), if self.is_binary { ", binary" } else { "" })
    }
}

impl PartialEq for MeshFormat {
    fn eq(&self, other: &Self) -> bool {
        (self.name(), self.is_binary) == (other.name(), other.is_binary)
    }
}

impl Eq for MeshFormat {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_grow_with_the_triangles_and_their_digits() {
        for format in MeshFormat::all() {
            let sizes =
                [1, 1_000, 1_000_000, 100_000_000].map(|count| format.approximate_bytes(count) as f64);
            assert!((1.0..400.0).contains(&sizes[0]), "{}: {sizes:?}", format.ending());
            assert!(sizes[1] >= 1e3 * sizes[0] && sizes[2] >= 10e6, "{}: {sizes:?}", format.ending());
            assert!(sizes[3] >= 100.0 * sizes[2] && sizes[3] < 400e8, "{}: {sizes:?}", format.ending());
        }
    }
}
