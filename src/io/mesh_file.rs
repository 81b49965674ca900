use std::io;
use std::path::{Path, PathBuf};

use super::{MeshData, csv, msh, node, obj, sms, stl, vtu, write_file};
use crate::mesh::Extract;

/// A format that carries a mesh with its data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// VTK's unstructured grid.
    Vtu,
    /// Gmsh 4.1.
    Msh,
    /// Wavefront.
    Obj,
    /// Triangles alone.
    Stl,
    /// Triangle's four files: nodes, elements, neighbours and edges.
    Node,
    /// SMS.
    Sms,
    /// A row for each triangle.
    Csv,
}

impl MeshFormat {
    /// All formats, each with the ending that chooses it.
    pub const ALL: [(&'static str, Self); 7] = [
        ("vtu", Self::Vtu),
        ("msh", Self::Msh),
        ("obj", Self::Obj),
        ("stl", Self::Stl),
        ("node", Self::Node),
        ("2dm", Self::Sms),
        ("csv", Self::Csv),
    ];

    /// The format that an ending (without the dot, in lower case) chooses.
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == ending).map(|&(_, format)| format)
    }

    /// The files that are written where `path` is asked for, `path` first.
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        let beside: &[&str] = if self == Self::Node { &["ele", "neigh", "edge"] } else { &[] };
        std::iter::once(path.to_owned())
            .chain(beside.iter().map(|ending| path.with_extension(ending)))
            .collect()
    }

    /// Writes a mesh, and returns the names of the files written: [`Self::files`].
    ///
    /// # Errors
    /// When the file system says no. What was there before is then still there; of Triangle's four files, those not yet
    /// written.
    pub fn write(self, path: &Path, mesh: &Extract, data: &MeshData) -> io::Result<Vec<PathBuf>> {
        match self {
            Self::Vtu => write_file(path, |mut out| vtu::write(&mut out, mesh, data))?,
            Self::Msh => write_file(path, |mut out| msh::write(&mut out, mesh, data))?,
            Self::Obj => write_file(path, |mut out| obj::write(&mut out, mesh, data))?,
            Self::Stl => write_file(path, |mut out| stl::write(&mut out, mesh, data))?,
            Self::Sms => write_file(path, |mut out| sms::write(&mut out, mesh, data))?,
            Self::Csv => write_file(path, |mut out| csv::write(&mut out, mesh, data))?,
            Self::Node => {
                write_file(path, |mut out| node::write(&mut out, mesh, data))?;
                let beside = |ending| path.with_extension(ending);
                write_file(&beside("ele"), |mut out| node::write_elements(&mut out, mesh))?;
                write_file(&beside("neigh"), |mut out| node::write_neighbours(&mut out, mesh))?;
                write_file(&beside("edge"), |mut out| node::write_edges(&mut out, mesh))?;
            }
        }
        Ok(self.files(path))
    }
}
