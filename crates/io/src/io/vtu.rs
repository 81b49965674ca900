//! `.vtu`: an unstructured grid for VTK and ParaView, as XML with appended binary data, compressed by zlib.
//!
//! z is the height of the surface, or 0 without one.
//!
//! Point data: `target_diameter` (h̄), the quantities, and `boundary`, the marker of the piece of the
//! boundary (the lower one where pieces meet), 0 elsewhere. Cell data: `level`, and `part`, the number of the
//! connected part, from 0 for the largest. ParaView, VTK, PyVista and meshio read it. Cells are triangles, or
//! quadrilaterals where squares are asked for.
//!
//! Field data: `boundary_names`, the names of the pieces in the order of their markers, a line for each, as
//! bytes of UTF-8; the line of a piece that has no edge in the mesh is empty. (VTK has arrays of strings, but
//! meshio refuses them.) A processing instruction `<?meshbrush …?>` describes the origin of the mesh; a
//! comment could not contain the `--` of a command.
//!
//! The header has the offset of each array, and so depends on the compressed sizes of the arrays before it.
//! Therefore every array is compressed twice, first to measure and then to write: that costs time, but only
//! one block is in memory, and the output may be a pipe.
//!
//! The arrays are stored in the reverse order of the header. meshio (up to 5.3.5) replaces the offsets in the
//! header one by one, in the order of the data, and looks the next array up by its old offset. A new offset
//! can be equal to an old one; the lookup takes the first in the header, which in this order is the right
//! one.

use std::io::{self, Write};

use super::blocks::{BLOCK, Blocks};
use super::format_spec::SquareCells;
use super::written_cells::WrittenCells;
use super::{FormatSpec, MeshData, Meter, QuantityPlaces, ThirdCoordinate, TypicalSize};
use meshbrush_mesh::mesh::Extract;

/// VTK's unstructured grid.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "ParaView and VTK, compressed: with h̄, levels and boundary",
    size: TypicalSize { bytes: 10.5, bytes_per_digit: 0.6 },
    has_targets: true,
    squares: SquareCells::Possible,
    third: ThirdCoordinate::Height,
    quantities: QuantityPlaces::All,
    ..FormatSpec::new("vtu", &["vtu"], |mut out, mesh, data, meter| {
        write_metered(&mut out, mesh, data, meter)
    })
};

/// Bytes of names in one line.
const BYTES_A_LINE: usize = 24;
/// VTK's numbers for a triangle and for a quadrilateral.
const VTK_TRIANGLE: u8 = 5;
const VTK_QUAD: u8 = 9;

type WriteBytes<'a> = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>;

/// One array of the file: its description in the header, and a function that writes its bytes.
struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    bytes: usize,
    write: WriteBytes<'a>,
    /// Bytes of each block after compression, once measured.
    compressed: Vec<u64>,
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
        Self { name, kind, components, bytes: values * N, write, compressed: Vec::new() }
    }

    /// Compresses the array to find the sizes of its blocks.
    fn measure(&mut self, meter: &Meter) -> io::Result<()> {
        let mut sizes = Vec::new();
        self.compress(meter, |block| {
            sizes.push(block.len() as u64);
            Ok(())
        })?;
        self.compressed = sizes;
        Ok(())
    }

    fn compress(&self, meter: &Meter, take: impl FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        let mut blocks = Blocks::new(meter, take);
        (self.write)(&mut blocks)?;
        blocks.finish()
    }

    /// Returns the table before the blocks: the number of blocks, the size of a block and of the last one (0
    /// if it is full) before compression, and the size of each block after compression.
    fn table(&self) -> impl Iterator<Item = u64> {
        let start = [self.compressed.len(), BLOCK, self.bytes % BLOCK].map(|n| n as u64);
        start.into_iter().chain(self.compressed.iter().copied())
    }

    /// Returns the bytes in the file, the table included.
    fn length(&self) -> u64 {
        (size_of::<u64>() * self.table().count()) as u64 + self.compressed.iter().sum::<u64>()
    }

    /// Writes the element of the header; `offset` is in bytes from the start of the appended data.
    fn describe(&self, out: &mut impl Write, offset: u64) -> io::Result<()> {
        let Self { name, kind, components, .. } = self;
        let components =
            if *components == 1 { String::new() } else { format!(" NumberOfComponents=\"{components}\"") };
        writeln!(
            out,
            "        <DataArray type=\"{kind}\" Name=\"{name}\"{components} format=\"appended\" offset=\"{offset}\"/>"
        )
    }

    fn append(&self, out: &mut impl Write, meter: &Meter) -> io::Result<()> {
        self.table().try_for_each(|size| out.write_all(&size.to_le_bytes()))?;
        self.compress(meter, |block| out.write_all(block))
    }
}

/// Writes the mesh as a VTK unstructured grid.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    write_metered(out, mesh, data, &Meter::default())
}

/// Writes as [`write()`] does, and counts the bytes of the arrays before compression, once in each of the two
/// passes.
///
/// # Errors
/// Fails as [`write()`] does, and when the work was cancelled.
pub fn write_metered(out: &mut impl Write, mesh: &Extract, data: &MeshData, meter: &Meter) -> io::Result<()> {
    let markers = data.boundary.node_markers(mesh);
    let cells = WrittenCells::new(mesh, data, FORMAT.squares);
    let mut sections = [
        ("PointData", point_data(data, &markers)),
        ("CellData", vec![levels(&cells), parts(&cells, data)]),
        ("Points", vec![points(mesh, data)]),
        ("Cells", topology(&cells)),
    ];
    let bytes: usize = sections.iter().flat_map(|(_, arrays)| arrays).map(|array| array.bytes).sum();
    meter.expect(2 * bytes as u64);
    sections.iter_mut().flat_map(|(_, arrays)| arrays).try_for_each(|array| array.measure(meter))?;
    write_header(out, [mesh.nodes().len(), cells.count()], data, &sections)?;
    sections.iter().flat_map(|(_, arrays)| arrays).rev().try_for_each(|array| array.append(out, meter))?;
    writeln!(out, "\n  </AppendedData>\n</VTKFile>")
}

fn write_header(
    out: &mut impl Write,
    [nodes, cells]: [usize; 2],
    data: &MeshData,
    sections: &[(&str, Vec<Array<'_>>)],
) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(out, "<?meshbrush")?;
    // What would end the instruction is taken apart.
    data.provenance.lines().try_for_each(|line| writeln!(out, "{}", line.replace("?>", "? >")))?;
    writeln!(out, "?>")?;
    writeln!(
        out,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">"
    )?;
    writeln!(out, "  <UnstructuredGrid>")?;
    write_names(out, data)?;
    writeln!(out, "    <Piece NumberOfPoints=\"{nodes}\" NumberOfCells=\"{cells}\">")?;
    let mut offset: u64 = sections.iter().flat_map(|(_, arrays)| arrays).map(Array::length).sum();
    for (section, arrays) in sections {
        writeln!(out, "      <{section}>")?;
        for array in arrays {
            offset -= array.length();
            array.describe(out, offset)?;
        }
        writeln!(out, "      </{section}>")?;
    }
    writeln!(out, "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">")?;
    write!(out, "_")
}

fn write_names(out: &mut impl Write, data: &MeshData) -> io::Result<()> {
    let mut names = vec![""; data.boundary.pieces().list().len()];
    for id in data.boundary.present() {
        names[id] = &data.boundary.pieces().list()[id].name;
    }
    let bytes = names.join("\n").into_bytes();
    writeln!(out, "    <FieldData>")?;
    let count = bytes.len();
    write!(
        out,
        "      <DataArray type=\"UInt8\" Name=\"boundary_names\" NumberOfTuples=\"{count}\" format=\"ascii\">"
    )?;
    for line in bytes.chunks(BYTES_A_LINE) {
        writeln!(out)?;
        line.iter().try_for_each(|byte| write!(out, "{byte} "))?;
    }
    writeln!(out, "\n      </DataArray>\n    </FieldData>")
}

fn point_data<'a>(data: &'a MeshData<'a>, markers: &'a [u32]) -> Vec<Array<'a>> {
    let array = |(name, values): (&'a str, &'a [f64])| {
        Array::new(name, "Float64", 1, values.len(), move || values.iter().map(|v| v.to_le_bytes()))
    };
    let boundary = || markers.iter().map(|marker| marker.to_le_bytes());
    let mut arrays: Vec<Array> = data.node_values().map(array).collect();
    arrays.push(Array::new("boundary", "UInt32", 1, markers.len(), boundary));
    arrays
}

fn levels<'a>(cells: &'a WrittenCells<'a>) -> Array<'a> {
    let levels = || (0..cells.count()).map(|cell| [cells.level(cell) as u8]);
    Array::new("level", "UInt8", 1, cells.count(), levels)
}

fn parts<'a>(cells: &'a WrittenCells<'a>, data: &'a MeshData<'a>) -> Array<'a> {
    let parts = || (0..cells.count()).map(|cell| data.parts[cells.triangles(cell)[0]].to_le_bytes());
    Array::new("part", "UInt32", 1, cells.count(), parts)
}

fn points<'a>(mesh: &'a Extract, data: &'a MeshData<'a>) -> Array<'a> {
    let coordinates = || {
        let nodes = mesh.world_nodes().enumerate();
        nodes.flat_map(|(node, p)| [p.x, p.y, data.height(node)]).map(f64::to_le_bytes)
    };
    Array::new("Points", "Float64", 3, 3 * mesh.nodes().len(), coordinates)
}

fn topology<'a>(cells: &'a WrittenCells<'a>) -> Vec<Array<'a>> {
    let count = cells.count();
    let nodes_of = |cell: usize| {
        let (corners, fourth) = cells.corners(cell);
        corners.into_iter().chain(fourth)
    };
    let corners = move || (0..count).flat_map(nodes_of).map(|node| (node as i64).to_le_bytes());
    let ends = || {
        let add = |end: &mut i64, cell: usize| {
            *end += if cells.corners(cell).1.is_some() { 4 } else { 3 };
            Some(end.to_le_bytes())
        };
        (0..cells.count()).scan(0, add)
    };
    let kind = |cell: usize| [if cells.corners(cell).1.is_some() { VTK_QUAD } else { VTK_TRIANGLE }];
    vec![
        Array::new("connectivity", "Int64", 1, 3 * count + cells.joined_count(), corners),
        Array::new("offsets", "Int64", 1, count, ends),
        Array::new("types", "UInt8", 1, count, move || (0..count).map(kind)),
    ]
}
