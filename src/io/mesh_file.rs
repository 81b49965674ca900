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

    /// Writes a mesh, and returns the names of the files written.
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
            Self::Node => return write_node_files(path, mesh, data),
        }
        Ok(vec![path.to_owned()])
    }
}

fn write_node_files(path: &Path, mesh: &Extract, data: &MeshData) -> io::Result<Vec<PathBuf>> {
    let [elements, neighbours, edges] = ["ele", "neigh", "edge"].map(|ending| path.with_extension(ending));
    write_file(path, |mut out| node::write(&mut out, mesh, data))?;
    write_file(&elements, |mut out| node::write_elements(&mut out, mesh))?;
    write_file(&neighbours, |mut out| node::write_neighbours(&mut out, mesh))?;
    write_file(&edges, |mut out| node::write_edges(&mut out, mesh))?;
    Ok(vec![path.to_owned(), elements, neighbours, edges])
}
