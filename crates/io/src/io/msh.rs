//! `.msh`: Gmsh 4.1, as text or in binary form, with the physical groups that solvers need.
//!
//! z is the height of the surface, or 0 without one. The triangles are the physical surface `domain` (1), and
//! so are quadrilaterals where squares are asked for; they follow the triangles. Each piece of the boundary
//! that has edges in the mesh, and each line, is a physical curve with the name and the marker of the piece,
//! with the domain on the left. h̄ and the quantities are node data; `level` and `part` (the number of the
//! connected part, from 0 for the largest) are element data. Tags count from one, triangles first: without
//! quadrilaterals the tag of a triangle is its id plus one.
//!
//! Both forms hold the same numbers. The binary one is quicker to write and to read, and not smaller. It is
//! little-endian on every machine.

use std::io::{self, Write};

use super::format_spec::SquareCells;
use super::written_cells::WrittenCells;
use super::{FormatSpec, MeshData, Number, QuantityPlaces, ThirdCoordinate, TypicalSize, write_rows};
use meshbrush_core::outline::LineEdge;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Extract, NodeId};

/// Gmsh 4.1.
pub static FORMAT: FormatSpec = FormatSpec {
    purpose: "Gmsh 4.1: with h̄ and the boundary as named groups",
    size: TypicalSize { bytes: 65.0, bytes_per_digit: 5.5 },
    has_targets: true,
    squares: SquareCells::Possible,
    third: ThirdCoordinate::Height,
    write_binary: Some(|out, mesh, data, meter| write_binary(&mut meter.count(out), mesh, data)),
    quantities: QuantityPlaces::All,
    ..FormatSpec::new("msh", &["msh"], |out, mesh, data, meter| write(&mut meter.count(out), mesh, data))
};

/// Gmsh's numbers for an element of two and of three nodes.
pub(super) const LINE: i32 = 1;
pub(super) const TRIANGLE: i32 = 2;
/// Gmsh's number for an element of four nodes.
const QUADRILATERAL: i32 = 3;
/// The tag of the surface and of its physical group.
pub(super) const SURFACE: i32 = 1;

/// Writes the mesh with its boundary as text.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    Writer { out, is_binary: false }.write(mesh, data)
}

/// Writes the mesh with its boundary in binary form.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_binary(out: &mut impl Write, mesh: &Extract, data: &MeshData) -> io::Result<()> {
    Writer { out, is_binary: true }.write(mesh, data)
}

/// A number of the file.
#[derive(Clone, Copy)]
enum MshNumber {
    Int(i32),
    Size(usize),
    Real(f64),
}

use MshNumber::{Int, Real, Size};

struct Writer<'a, W> {
    out: &'a mut W,
    is_binary: bool,
}

impl<W: Write> Writer<'_, W> {
    fn write(mut self, mesh: &Extract, data: &MeshData) -> io::Result<()> {
        let curves = Curve::all(mesh, data);
        self.write_head(data)?;
        write_names(self.out, &curves)?;
        self.write_entities(mesh, data, &curves)?;
        self.write_nodes(mesh, data)?;
        let cells = CellsByCorners::new(mesh, data);
        self.write_elements(&cells, &curves)?;
        self.write_node_views(data)?;
        self.write_element_views(mesh, data, &cells, &curves)
    }

    /// Values of nodes.
    fn write_node_views(&mut self, data: &MeshData) -> io::Result<()> {
        data.node_values().try_for_each(|(name, values)| {
            self.write_values("NodeData", name, values.len(), |node| values[node])
        })
    }

    /// Values of elements, the cells before the edges of curves.
    fn write_element_views(
        &mut self,
        mesh: &Extract,
        data: &MeshData,
        cells: &CellsByCorners<'_>,
        curves: &[Curve<'_>],
    ) -> io::Result<()> {
        // meshio requires element data for all elements or none, so a boundary edge gets the data of its
        // triangle.
        let lines: Vec<usize> =
            curves.iter().flat_map(|curve| &curve.edges).map(|edge| edge.triangle).collect();
        let of_cells = cells.order.len();
        let level = |element: usize| match element.checked_sub(of_cells) {
            None => f64::from(cells.written.level(cells.order[element])),
            Some(line) => f64::from(mesh.triangles()[lines[line]].level()),
        };
        self.write_values("ElementData", "level", of_cells + lines.len(), level)?;
        let part = |element: usize| match element.checked_sub(of_cells) {
            None => f64::from(data.parts[cells.written.triangles(cells.order[element])[0]]),
            Some(line) => f64::from(data.parts[lines[line]]),
        };
        self.write_values("ElementData", "part", of_cells + lines.len(), part)
    }

    fn write_head(&mut self, data: &MeshData) -> io::Result<()> {
        let bytes = size_of::<u64>();
        writeln!(self.out, "$MeshFormat\n4.1 {} {bytes}", u8::from(self.is_binary))?;
        if self.is_binary {
            self.row(&[Int(1)])?; // tells readers the order of bytes
            writeln!(self.out)?;
        }
        writeln!(self.out, "$EndMeshFormat\n$Comments")?;
        data.provenance.lines().try_for_each(|line| writeln!(self.out, "{line}"))?;
        writeln!(self.out, "$EndComments")
    }

    /// A curve for each piece, and the surface that they bound: tag, bounds, physical group, boundary.
    fn write_entities(&mut self, mesh: &Extract, data: &MeshData, curves: &[Curve<'_>]) -> io::Result<()> {
        writeln!(self.out, "$Entities")?;
        self.row(&[Size(0), Size(curves.len()), Size(1), Size(0)])?;
        for curve in curves {
            let group = [Size(1), Int(curve.tag()), Size(0)];
            self.row(&[&[Int(curve.tag())], &box_values(&curve.bounds, curve.heights)[..], &group].concat())?;
        }
        let around = curves.iter().filter(|curve| curve.is_of_boundary);
        let boundary: Vec<MshNumber> = around.map(|curve| Int(curve.tag())).collect();
        let group = [Size(1), Int(SURFACE), Size(boundary.len())];
        // In degrees the nodes are elsewhere than the lattice.
        let bounds = Rect::holding(mesh.world_nodes()).unwrap_or_else(|| mesh.lattice().bounds());
        let bounds = box_values(&bounds, height_range(data, 0..mesh.nodes().len()));
        self.row(&[&[Int(SURFACE)], &bounds[..], &group, &boundary].concat())?;
        self.end("Entities")
    }

    fn write_nodes(&mut self, mesh: &Extract, data: &MeshData) -> io::Result<()> {
        let count = mesh.nodes().len();
        writeln!(self.out, "$Nodes")?;
        self.row(&[Size(1), Size(count), Size(1), Size(count)])?;
        self.row(&[Int(2), Int(SURFACE), Int(0), Size(count)])?;
        self.rows(count, |node| [Size(node + 1)])?;
        self.rows(count, |node| {
            let p = mesh.world(NodeId::from_index(node));
            [Real(p.x), Real(p.y), Real(data.height(node))]
        })?;
        self.end("Nodes")
    }

    fn write_elements(&mut self, cells: &CellsByCorners<'_>, curves: &[Curve<'_>]) -> io::Result<()> {
        let CellsByCorners { written, order, triangles } = cells;
        let (triangles, of_cells) = (*triangles, order.len());
        let all = of_cells + curves.iter().map(|curve| curve.edges.len()).sum::<usize>();
        let surfaces = [triangles, of_cells - triangles].iter().filter(|count| **count > 0).count();
        writeln!(self.out, "$Elements")?;
        self.row(&[Size(curves.len() + surfaces), Size(all), Size(1), Size(all)])?;
        if triangles > 0 {
            self.row(&[Int(2), Int(SURFACE), Int(TRIANGLE), Size(triangles)])?;
        }
        self.rows(triangles, |id| {
            let ([a, b, c], _) = written.corners(order[id]);
            [Size(id + 1), Size(a + 1), Size(b + 1), Size(c + 1)]
        })?;
        if of_cells > triangles {
            self.row(&[Int(2), Int(SURFACE), Int(QUADRILATERAL), Size(of_cells - triangles)])?;
        }
        self.rows(of_cells - triangles, |number| {
            let id = triangles + number;
            let ([a, b, c], fourth) = written.corners(order[id]);
            [Size(id + 1), Size(a + 1), Size(b + 1), Size(c + 1), Size(fourth.unwrap_or(c) + 1)]
        })?;
        let mut tag = of_cells;
        for curve in curves {
            self.row(&[Int(1), Int(curve.tag()), Int(LINE), Size(curve.edges.len())])?;
            for edge in &curve.edges {
                tag += 1;
                let [from, to] = edge.ends.map(|node| Size(node + 1));
                self.row(&[Size(tag), from, to])?;
            }
        }
        self.end("Elements")
    }

    /// A view of Gmsh: one number for each node or element.
    fn write_values(
        &mut self,
        section: &str,
        name: &str,
        count: usize,
        value: impl Fn(usize) -> f64 + Sync,
    ) -> io::Result<()> {
        // One string (the name), one real number (the time), three whole numbers (step, components, count).
        // They are text in both forms.
        writeln!(self.out, "${section}\n1\n\"{name}\"\n1\n0\n3\n0\n1\n{count}")?;
        self.rows(count, |number| [Int(number as i32 + 1), Real(value(number))])?;
        self.end(section)
    }

    fn row(&mut self, values: &[MshNumber]) -> io::Result<()> {
        write_row(self.out, values, self.is_binary)
    }

    /// Many rows, by their numbers from 0.
    fn rows<const N: usize>(
        &mut self,
        count: usize,
        values: impl Fn(usize) -> [MshNumber; N] + Sync,
    ) -> io::Result<()> {
        let is_binary = self.is_binary;
        write_rows(self.out, count, |out, number| write_row(out, &values(number), is_binary))
    }

    fn end(&mut self, section: &str) -> io::Result<()> {
        let line_break = if self.is_binary { "\n" } else { "" };
        writeln!(self.out, "{line_break}$End{section}")
    }
}

/// The cells, triangles before quadrilaterals: each kind is a block of its own.
struct CellsByCorners<'a> {
    written: WrittenCells<'a>,
    order: Vec<usize>,
    /// How many of them are triangles.
    triangles: usize,
}

impl<'a> CellsByCorners<'a> {
    fn new(mesh: &'a Extract<'a>, data: &MeshData<'a>) -> Self {
        let written = WrittenCells::new(mesh, data, FORMAT.squares);
        let all = 0..written.count();
        let (three, four): (Vec<usize>, Vec<usize>) =
            all.partition(|&cell| written.corners(cell).1.is_none());
        let triangles = three.len();
        Self { written, order: [three, four].concat(), triangles }
    }
}

/// Writes the names of the physical groups.
pub(super) fn write_names(out: &mut impl Write, curves: &[Curve<'_>]) -> io::Result<()> {
    writeln!(out, "$PhysicalNames\n{}", curves.len() + 1)?;
    for curve in curves {
        let name = curve.name;
        writeln!(out, "1 {} \"{name}\"", curve.tag())?;
    }
    writeln!(out, "2 {SURFACE} \"domain\"\n$EndPhysicalNames")
}

/// Writes values of nodes as text: their sections are the same in Gmsh 2.2.
pub(super) fn write_text_views(out: &mut impl Write, data: &MeshData) -> io::Result<()> {
    Writer { out, is_binary: false }.write_node_views(data)
}

/// A line of text, or the bytes of the numbers.
fn write_row(out: &mut impl Write, values: &[MshNumber], is_binary: bool) -> io::Result<()> {
    if is_binary {
        return values.iter().try_for_each(|value| match value {
            Int(n) => out.write_all(&n.to_le_bytes()),
            Size(n) => out.write_all(&(*n as u64).to_le_bytes()),
            Real(x) => out.write_all(&x.to_le_bytes()),
        });
    }
    for (n, value) in values.iter().enumerate() {
        let blank = if n == 0 { "" } else { " " };
        match value {
            Int(n) => write!(out, "{blank}{n}")?,
            Size(n) => write!(out, "{blank}{n}")?,
            Real(x) => write!(out, "{blank}{}", Number(*x))?,
        }
    }
    writeln!(out)
}

/// The edges of a piece of the boundary, or those along a line.
pub(super) struct Curve<'a> {
    /// From 0; pieces of the boundary come first.
    number: usize,
    name: &'a str,
    /// Its edges; those of the boundary with the domain on the left.
    pub(super) edges: Vec<LineEdge>,
    /// Whether it bounds the surface.
    is_of_boundary: bool,
    bounds: Rect,
    /// The least and the greatest height.
    heights: [f64; 2],
}

impl<'a> Curve<'a> {
    /// Returns the curves of all pieces and lines that have edges in the mesh, by number.
    pub(super) fn all(mesh: &Extract, data: &MeshData<'a>) -> Vec<Self> {
        let pieces = data.boundary.pieces().list();
        let mut edges = vec![Vec::new(); pieces.len()];
        for (edge, &piece) in mesh.boundary_edges().zip(data.boundary.piece_of_edge()) {
            edges[piece as usize].push(LineEdge { ends: edge.ends, triangle: edge.triangle });
        }
        let of_boundary = pieces.iter().zip(edges).map(|(piece, edges)| (&*piece.name, edges, true));
        let of_lines = data.lines.iter().map(|line| (&*line.name, line.edges.clone(), false));
        let curve = |(number, (name, edges, is_of_boundary)): (usize, (&'a str, Vec<LineEdge>, bool))| {
            let nodes = edges.iter().flat_map(|edge| edge.ends);
            let heights = height_range(data, nodes.clone());
            let points = nodes.map(|node| mesh.world(NodeId::from_index(node)));
            let bounds = Rect::holding(points)?;
            Some(Self { number, name, edges, is_of_boundary, bounds, heights })
        };
        of_boundary.chain(of_lines).enumerate().filter_map(curve).collect()
    }

    /// Returns the tag of the curve and of its physical group.
    pub(super) fn tag(&self) -> i32 {
        self.number as i32 + 1
    }
}

/// Returns the least and the greatest height of some nodes.
fn height_range(data: &MeshData, nodes: impl Iterator<Item = usize>) -> [f64; 2] {
    let heights = nodes.map(|node| data.height(node));
    heights.map(|height| [height; 2]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default()
}

/// Returns the lower and the upper corner of a box.
fn box_values(bounds: &Rect, [lowest, highest]: [f64; 2]) -> [MshNumber; 6] {
    let Rect { min, max } = bounds;
    [Real(min.x), Real(min.y), Real(lowest), Real(max.x), Real(max.y), Real(highest)]
}
