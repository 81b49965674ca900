use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::atomic::{Draft, put_in_place};
use super::{Counted, MeshData, Meter, csv, msh, node, obj, sms, stl, vtu, write_file_metered};
use crate::mesh::Extract;

/// A file format for a mesh with its data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshFormat {
    /// VTK's unstructured grid.
    Vtu,
    /// Gmsh 4.1.
    Msh,
    /// Wavefront.
    Obj,
    /// Triangles without shared nodes.
    Stl,
    /// Triangle's four files: nodes, elements, neighbours and edges.
    Node,
    /// SMS.
    Sms,
    /// A table with a row for each triangle.
    Csv,
}

impl MeshFormat {
    /// All formats with their file name extensions, in lower case and without the dot.
    pub const ALL: [(&'static str, Self); 7] = [
        ("vtu", Self::Vtu),
        ("msh", Self::Msh),
        ("obj", Self::Obj),
        ("stl", Self::Stl),
        ("node", Self::Node),
        ("2dm", Self::Sms),
        ("csv", Self::Csv),
    ];

    /// The format of an extension, in lower case and without the dot.
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == ending).map(|&(_, format)| format)
    }

    /// The files that an export to `path` writes, `path` first.
    pub fn files(self, path: &Path) -> Vec<PathBuf> {
        let beside: &[&str] = if self == Self::Node { &["ele", "neigh", "edge"] } else { &[] };
        std::iter::once(path.to_owned())
            .chain(beside.iter().map(|ending| path.with_extension(ending)))
            .collect()
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
        let file = |write: &dyn Fn(&mut Counted<&mut dyn Write>) -> io::Result<()>| {
            write_file_metered(path, meter, |out| write(&mut meter.count(out)))
        };
        match self {
            Self::Vtu => {
                write_file_metered(path, meter, |mut out| vtu::write_metered(&mut out, mesh, data, meter))?
            }
            Self::Msh => file(&|out| msh::write(out, mesh, data))?,
            Self::Obj => file(&|out| obj::write(out, mesh, data))?,
            Self::Stl => {
                meter.expect(stl::bytes(mesh));
                file(&|out| stl::write(out, mesh, data))?;
            }
            Self::Sms => file(&|out| sms::write(out, mesh, data))?,
            Self::Csv => file(&|out| csv::write(out, mesh, data))?,
            Self::Node => write_node_files(&self.files(path), mesh, data, meter)?,
        }
        Ok(self.files(path))
    }
}

/// Writes Triangle's four files. None replaces an old file before all are written: they would not match each
/// other.
fn write_node_files(files: &[PathBuf], mesh: &Extract, data: &MeshData, meter: &Meter) -> io::Result<()> {
    let [nodes, elements, neighbours, edges] = files else {
        unreachable!("`.node` comes with three other files")
    };
    let drafts = [
        Draft::write(nodes, meter, |out| node::write(&mut meter.count(out), mesh, data))?,
        Draft::write(elements, meter, |out| node::write_elements(&mut meter.count(out), mesh))?,
        Draft::write(neighbours, meter, |out| node::write_neighbours(&mut meter.count(out), mesh))?,
        Draft::write(edges, meter, |out| node::write_edges(&mut meter.count(out), mesh))?,
    ];
    put_in_place(drafts, meter)
}
