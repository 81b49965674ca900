//! Exports a mesh: with its data, or as a picture of the whole mesh.

use std::io;
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::look::Look;
use meshbrush_io::io::{MeshData, MeshFormat, Meter, Provenance, ThirdCoordinate, png, write_file_metered};
use meshbrush_mesh::mesh::{Extract, Mesh};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ExportFormat {
    /// The mesh with its data.
    Mesh(MeshFormat),
    /// A vector picture.
    Svg,
    /// A pixel picture.
    Png,
}

/// The error for a file name whose ending belongs to no format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: the ending chooses the format; use one of{}", .0.display(), with_dots())]
pub struct UnknownEnding(pub PathBuf);

fn with_dots() -> String {
    ExportFormat::endings().map(|ending| format!(" .{ending}")).collect()
}

impl ExportFormat {
    /// Returns the format that the ending of a file name chooses; upper and lower case are the same.
    ///
    /// # Errors
    /// Fails when the ending is none of [`Self::endings`].
    pub fn from_path(path: &Path) -> Result<Self, UnknownEnding> {
        Self::from_ending(&ending_of(path)).ok_or_else(|| UnknownEnding(path.to_owned()))
    }

    /// Returns the format that an ending chooses, in lower case and without the dot.
    pub fn from_ending(ending: &str) -> Option<Self> {
        match ending {
            "svg" => Some(Self::Svg),
            "png" => Some(Self::Png),
            ending => MeshFormat::from_ending(ending).map(Self::Mesh),
        }
    }

    /// Returns the format with a name, [`Self::name`], or else with an ending, without the dot; upper and
    /// lower case are the same.
    pub fn named(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        Self::all().find(|format| format.name() == name).or_else(|| MeshFormat::named(&name).map(Self::Mesh))
    }

    /// Returns whether a file with this name may be one of this format: its ending is one of the format's
    /// endings, which may choose another format by itself, or that of no format.
    pub fn fits(self, path: &Path) -> bool {
        let own = match self {
            Self::Mesh(format) => format.may_end_in(&ending_of(path)),
            Self::Svg | Self::Png => Self::from_path(path) == Ok(self),
        };
        own || Self::from_path(path).is_err()
    }

    /// Returns the binary form of this format, or `None` if it has no separate one.
    pub fn binary(self) -> Option<Self> {
        match self {
            Self::Mesh(format) => format.binary().map(Self::Mesh),
            Self::Svg | Self::Png => None,
        }
    }

    /// Returns all formats; formats of meshes come first.
    pub fn all() -> impl Iterator<Item = Self> {
        MeshFormat::all().map(Self::Mesh).chain([Self::Svg, Self::Png])
    }

    /// Returns the name of this format: its default ending, or another word, as `fvcom` and `ugrid`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.name(),
            Self::Svg | Self::Png => self.ending(),
        }
    }

    /// Returns the default ending of file names of this format, without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.ending(),
            Self::Svg => "svg",
            Self::Png => "png",
        }
    }

    /// Returns a few words on the contents of the format and the programs that read it.
    pub fn purpose(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.purpose(),
            Self::Svg => "A vector picture of the whole mesh in the present colours",
            Self::Png => "A picture of the whole mesh in the present colours",
        }
    }

    /// Returns the approximate size of the export of a mesh in bytes, over all its files; `None` for a
    /// picture, whose size depends on its contents.
    pub fn approximate_bytes(self, triangles: usize) -> Option<u64> {
        match self {
            Self::Mesh(format) => Some(format.approximate_bytes(triangles)),
            Self::Svg | Self::Png => None,
        }
    }

    /// Returns all endings that choose a format, without their dots.
    pub fn endings() -> impl Iterator<Item = &'static str> {
        MeshFormat::all().flat_map(MeshFormat::endings).chain([Self::Svg, Self::Png].map(Self::ending))
    }

    /// Returns the names of all formats.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::all().map(Self::name)
    }

    /// Returns whether the format contains data at the nodes.
    pub fn wants_node_data(self) -> bool {
        matches!(self, Self::Mesh(_))
    }

    /// Returns whether h̄ at the nodes is in its files.
    pub fn has_targets(self) -> bool {
        matches!(self, Self::Mesh(format) if format.has_targets())
    }

    /// Returns whether a coastal solver finds its open boundary in its files.
    pub fn has_open_boundary(self) -> bool {
        matches!(self, Self::Mesh(format) if format.has_open_boundary())
    }

    /// Returns the format of files with the mesh itself; `None` for pictures.
    pub fn mesh(self) -> Option<MeshFormat> {
        match self {
            Self::Mesh(format) => Some(format),
            Self::Svg | Self::Png => None,
        }
    }

    /// Returns whether its coordinates have to be lengths: degrees are refused.
    pub fn needs_lengths(self) -> bool {
        matches!(self, Self::Mesh(format) if format.needs_lengths())
    }

    /// Returns whether its files can have quadrilaterals.
    pub fn holds_squares(self) -> bool {
        matches!(self, Self::Mesh(format) if format.holds_squares())
    }

    /// Returns whether its solver wants them: they are in its files unless triangles are asked for.
    pub fn wants_squares(self) -> bool {
        matches!(self, Self::Mesh(format) if format.wants_squares())
    }

    /// Returns what the third coordinate of nodes in its files is.
    pub fn third_coordinate(self) -> ThirdCoordinate {
        match self {
            Self::Mesh(format) => format.third_coordinate(),
            Self::Svg | Self::Png => ThirdCoordinate::None,
        }
    }

    /// Returns all files that an export to `path` writes. The first is `path`, or for FVCOM the one beside it
    /// that ends in `_grd.dat`.
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        match self {
            Self::Mesh(format) => format.files(path),
            Self::Svg | Self::Png => vec![path.to_owned()],
        }
    }

    /// Returns the files that an export to `path` writes of a mesh of a document with lines, or of one
    /// without them: those of [`Self::files`], and the files of the lines beside them.
    pub fn files_of(self, path: &Path, has_lines: bool) -> Vec<PathBuf> {
        let of_lines = match self {
            Self::Mesh(format) if has_lines => format.line_files(path),
            _ => Vec::new(),
        };
        [self.files(path), of_lines].concat()
    }

    /// Writes the file, or all files of a format that has several, and returns their names. `extract` must be
    /// the extract of `mesh`, and `data` the data of its nodes; a picture needs only the provenance.
    ///
    /// # Errors
    /// Fails when a file cannot be written, the format cannot hold the mesh, or the meter was cancelled.
    /// Existing files are then unchanged.
    pub fn write(
        self,
        path: &Path,
        mesh: &Mesh,
        extract: &Extract,
        data: &MeshData,
        look: &Look,
        meter: &Meter,
    ) -> io::Result<Vec<PathBuf>> {
        if let Self::Mesh(format) = self {
            return format.write(path, extract, data, meter);
        }
        write_file_metered(path, meter, |out| self.write_to(out, mesh, extract, data, look, meter))?;
        Ok(vec![path.to_owned()])
    }

    /// Writes to a stream in place of the file of [`Self::write`].
    ///
    /// # Errors
    /// Fails when the format has several files, when the stream fails, and when the meter was cancelled.
    pub fn write_to(
        self,
        out: &mut dyn io::Write,
        mesh: &Mesh,
        extract: &Extract,
        data: &MeshData,
        look: &Look,
        meter: &Meter,
    ) -> io::Result<()> {
        match self {
            Self::Mesh(format) => {
                let several = || io::Error::other("the format has several files");
                format.write_to(out, extract, data, meter).ok_or_else(several)?
            }
            Self::Svg if look.space.is_some() => Err(io::Error::other(NO_SVG_IN_SPACE)),
            Self::Svg | Self::Png => {
                self.write_picture(out, (mesh, extract), &[], look, data.provenance, meter)
            }
        }
    }
}

impl ExportFormat {
    /// Writes a picture of a mesh with a path over it, in world units.
    ///
    /// # Errors
    /// Fails when this is not a picture format, when the stream fails, and when the meter was cancelled.
    pub fn write_path_to(
        self,
        out: &mut dyn io::Write,
        (mesh, extract): (&Mesh, &Extract),
        path: &[DVec2],
        look: &Look,
        provenance: &Provenance,
        meter: &Meter,
    ) -> io::Result<()> {
        match self {
            Self::Mesh(_) => Err(io::Error::other("the format is no picture")),
            Self::Svg | Self::Png if look.space.is_some() => {
                Err(io::Error::other("pictures of paths show the plan; leave out the view in space"))
            }
            Self::Svg | Self::Png => self.write_picture(out, (mesh, extract), path, look, provenance, meter),
        }
    }

    fn write_picture(
        self,
        out: &mut dyn io::Write,
        (mesh, extract): (&Mesh, &Extract),
        path: &[DVec2],
        look: &Look,
        provenance: &Provenance,
        meter: &Meter,
    ) -> io::Result<()> {
        if self == Self::Svg {
            return look.write_svg(&mut meter.count(out), (mesh, extract), path, provenance);
        }
        let picture = look.draw_with_path(mesh, extract, path).map_err(io::Error::other)?;
        meter.check()?;
        let dots_per_inch = look.size.on_paper.map(|paper| paper.dots_per_inch);
        let (size, rgba) = (picture.size, &picture.rgba);
        png::write_described(&mut meter.count(out), size, rgba, dots_per_inch, provenance)
    }
}

/// Why an `.svg` shows no view in space.
pub const NO_SVG_IN_SPACE: &str =
    "a view in space is drawn pixel by pixel, and .svg holds no pixels; write a .png, or the plan";

fn ending_of(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}
