//! `.vtu`: an unstructured grid for VTK and ParaView, as XML with raw binary data appended.
//!
//! Point data: `target_diameter` (h̄) and the quantities; cell data: `level`. ParaView, VTK, PyVista and meshio read it.

use std::io::{self, Write};

use super::MeshData;
use crate::mesh::Extract;

/// VTK's number for a triangle.
const VTK_TRIANGLE: u8 = 5;

type WriteBytes<'a> = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>;

/// One array of the file: how the header describes it, and how its bytes are written.
struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    bytes: usize,
    write: WriteBytes<'a>,
}

impl<'a> Array<'a> {
    fn new<const N: usize, I: Iterator<Item = [u8; N]>>(
        name: &'a str,
        kind: &'static str,
        components: usize,
        values: usize,
        items: impl Fn() -> I + 'a,
    ) -> Self {
        let write = Box::new(move |out: &mut dyn Write| items().try_for_each(|item| out.write_all(&item)));
        Self { name, kind, components, bytes: values * N, write }
    }

    /// The element of the header; `offset` is in bytes from the start of the appended data.
    fn describe(&self, out: &mut impl Write, offset: usize) -> io::Result<()> {
        let Self { name, kind, components, .. } = self;
        let components =
            if *components == 1 { String::new() } else { format!(" NumberOfComponents=\"{components}\"") };
        writeln!(
            out,
            "        <DataArray type=\"{kind}\" Name=\"{name}\"{components} format=\"appended\" offset=\"{offset}\"/>"
        )
    }
}

/// Writes the mesh as a VTK unstructured grid.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    let sections = [
        ("PointData", point_data(data)),
        ("CellData", vec![levels(mesh)]),
        ("Points", vec![points(mesh)]),
        ("Cells", topology(mesh)),
    ];
    let (nodes, triangles) = (mesh.nodes().len(), mesh.triangles().len());
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
    )?;
    writeln!(out, "  <UnstructuredGrid>")?;
    writeln!(out, "    <Piece NumberOfPoints=\"{nodes}\" NumberOfCells=\"{triangles}\">")?;
    let mut offset = 0;
    for (section, arrays) in &sections {
        writeln!(out, "      <{section}>")?;
        for array in arrays {
            array.describe(out, offset)?;
            offset += size_of::<u64>() + array.bytes;
        }
        writeln!(out, "      </{section}>")?;
    }
    writeln!(out, "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">")?;
    write!(out, "_")?;
    for array in sections.iter().flat_map(|(_, arrays)| arrays) {
        out.write_all(&(array.bytes as u64).to_le_bytes())?;
        (array.write)(out)?;
    }
    writeln!(out, "\n  </AppendedData>\n</VTKFile>")
}

fn point_data<'a>(data: &'a MeshData<'a>) -> Vec<Array<'a>> {
    let array = |(name, values): (&'a str, &'a [f64])| {
        Array::new(name, "Float64", 1, values.len(), move || values.iter().map(|v| v.to_le_bytes()))
    };
    data.node_values().map(array).collect()
}

fn levels<'a>(mesh: &'a Extract) -> Array<'a> {
    Array::new("level", "UInt8", 1, mesh.triangles().len(), || {
        mesh.triangles().iter().map(|t| [t.level() as u8])
    })
}

fn points<'a>(mesh: &'a Extract) -> Array<'a> {
    Array::new("Points", "Float64", 3, 3 * mesh.nodes().len(), || {
        mesh.world_nodes().flat_map(|p| [p.x, p.y, 0.0]).map(f64::to_le_bytes)
    })
}

fn topology<'a>(mesh: &'a Extract) -> Vec<Array<'a>> {
    let count = mesh.triangles().len();
    vec![
        Array::new("connectivity", "Int64", 1, 3 * count, || {
            mesh.cells().flat_map(|cell| cell.corners).map(|node| (node as i64).to_le_bytes())
        }),
        Array::new("offsets", "Int64", 1, count, move || (1..=count as i64).map(|n| (3 * n).to_le_bytes())),
        Array::new("types", "UInt8", 1, count, move || std::iter::repeat_n([VTK_TRIANGLE], count)),
    ]
}
