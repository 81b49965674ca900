//! `.svg`: the mesh as a vector drawing, small and exact.
//!
//! One path for each level and one for the edges, in whole numbers: lattice coordinates, divided by the power of two that all
//! nodes share. The drawing is exact at any magnification.

use std::io::{self, Write};

use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, NodeId};

/// How a mesh is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Style<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green, blue and opacity by level.
    pub level_colors: &'a [[u8; 4]; 64],
    /// Behind the mesh.
    pub background: [u8; 3],
    /// Colour of the edges; `None` leaves them out.
    pub edges: Option<[u8; 3]>,
}

/// Writes the drawing. Colours come from outside, so that files know no colour table.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut impl Write, mesh: &Mesh, style: &Style) -> io::Result<()> {
    let page = Page::of(mesh);
    let [width, height] = style.size;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\">",
        page.width, page.height
    )?;
    let triangles = mesh.triangles().len();
    writeln!(out, "<title>{triangles} triangles, {} nodes</title>", mesh.nodes().len())?;
    let background = hex(style.background);
    writeln!(out, "<rect width=\"{}\" height=\"{}\" fill=\"{background}\"/>", page.width, page.height)?;
    write_levels(out, mesh, &page, style)?;
    if let Some(color) = style.edges {
        write_edges(out, mesh, &page, color)?;
    }
    writeln!(out, "</svg>")
}

fn write_levels(out: &mut impl Write, mesh: &Mesh, page: &Page, style: &Style) -> io::Result<()> {
    let mut by_level = vec![Vec::new(); mesh.level_counts().len()];
    for triangle in mesh.triangles() {
        by_level[triangle.level() as usize].push(triangle.edge_nodes().map(|(from, _)| from));
    }
    for (level, triangles) in by_level.iter().enumerate().filter(|(_, triangles)| !triangles.is_empty()) {
        let [r, g, b, _] = style.level_colors[level.min(63)];
        write!(out, "<path id=\"level-{level}\" fill=\"{}\" d=\"", hex([r, g, b]))?;
        for corners in triangles {
            let [a, b, c] = corners.map(|node| page.place(mesh, node));
            write!(
                out,
                "M{} {}l{} {} {} {}z",
                a[0],
                a[1],
                b[0] - a[0],
                b[1] - a[1],
                c[0] - b[0],
                c[1] - b[1]
            )?;
        }
        writeln!(out, "\"/>")?;
    }
    Ok(())
}

/// All edges once. Their width is in pixels, whatever the magnification.
fn write_edges(out: &mut impl Write, mesh: &Mesh, page: &Page, color: [u8; 3]) -> io::Result<()> {
    write!(
        out,
        "<path id=\"edges\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.5\" stroke-linecap=\"round\" \
         vector-effect=\"non-scaling-stroke\" d=\"",
        hex(color)
    )?;
    for (from, to) in mesh.edges() {
        let (a, b) = (page.place(mesh, from), page.place(mesh, to));
        write!(out, "M{} {}l{} {}", a[0], a[1], b[0] - a[0], b[1] - a[1])?;
    }
    writeln!(out, "\"/>")
}

/// The lattice as a page: y grows downwards, and the unit is the coarsest that all nodes are multiples of.
struct Page {
    width: u32,
    height: u32,
    shift: u32,
}

impl Page {
    fn of(mesh: &Mesh) -> Self {
        let bits = mesh.nodes().iter().fold(0, |bits, node| bits | node.x | node.y);
        let LatticePoint { x, y } = mesh.lattice().extent();
        let shift = (bits | x | y).trailing_zeros();
        Self { width: x >> shift, height: y >> shift, shift }
    }

    fn place(&self, mesh: &Mesh, node: NodeId) -> [i64; 2] {
        let LatticePoint { x, y } = mesh.node(node);
        [i64::from(x >> self.shift), i64::from(self.height - (y >> self.shift))]
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
