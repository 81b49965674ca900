//! `.svg`: the mesh as an exact vector drawing in a small file.
//!
//! One path for the triangles of each level, or of each colour, and one for their edges. Coordinates are
//! whole numbers relative to the previous point: lattice coordinates divided by the largest power of two that
//! divides all nodes of the path, which takes few digits and is exact at any magnification. Edges get thinner
//! with their triangles, so that a dense region shows the colour of its level and not black.

use std::io::{self, Write};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::DVec2;

use super::Provenance;
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Extract, NodeId, Triangle, bisection_edge_length};
use meshbrush_mesh::text::xml_text;

/// Where the mesh is on a page with other shapes, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SvgMap {
    /// The upper left corner of the domain.
    pub at: DVec2,
    /// Pixels of a world unit.
    pub px_per_world: f64,
}

/// A shape beside the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct SvgShape {
    /// Its path, as in the attribute `d`, in pixels.
    pub path: String,
    /// How it is drawn.
    pub paint: ShapePaint,
    /// What it says, if it is a text.
    pub title: Option<String>,
}

/// How a shape is drawn. Colours are red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShapePaint {
    /// Filled.
    Fill([u8; 3]),
    /// As a line of a width in pixels.
    Stroke([u8; 3], f64),
}

/// What triangles are filled with. Colours are red, green, blue and opacity.
#[derive(Clone, Copy, Debug)]
pub enum SvgFills<'a> {
    /// The colours of levels.
    Levels(&'a [[u8; 4]; 64]),
    /// The colours of triangles, one for each.
    Triangles(&'a [[u8; 4]]),
    /// A picture of the whole mesh, as the bytes of a `.png`.
    Picture(&'a [u8]),
}

/// Size and colours of the drawing.
#[derive(Clone, Copy, Debug)]
pub struct SvgStyle<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// A length that a pixel has on paper and its unit, as in `(0.1, "mm")`, if that is known.
    pub unit: Option<(f64, &'static str)>,
    /// Where the mesh is on the page; without it, the mesh fills the page.
    pub map: Option<SvgMap>,
    /// What triangles are filled with.
    pub fills: SvgFills<'a>,
    /// Red, green and blue behind the mesh; nothing without it.
    pub background: Option<[u8; 3]>,
    /// Whether edges are drawn, in black with an opacity of one half.
    pub edges: bool,
    /// A line over the mesh, in world units; none without points.
    pub path: &'a [DVec2],
    /// Red, green and blue of that line, and of the wider line below it.
    pub path_colors: [[u8; 3]; 2],
    /// Lines over everything, in pixels from the upper left corner.
    pub marks: &'a [Vec<DVec2>],
    /// Red, green and blue of these lines, and of the wider lines below them.
    pub mark_colors: [[u8; 3]; 2],
    /// Shapes over everything, in pixels, where [`Self::map`] says where the mesh is.
    pub shapes: &'a [SvgShape],
}

/// Writes the drawing. The colours come from the caller: `io` does not depend on the colour tables.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(
    out: &mut impl Write,
    mesh: &Extract,
    style: &SvgStyle,
    provenance: &Provenance,
) -> io::Result<()> {
    let page = Page::of(mesh, style);
    let view = match style.map {
        Some(_) => style.size,
        None => [page.width, page.height],
    };
    let [width, height] = style.size.map(|side| style.side(side));
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\">",
        view[0], view[1]
    )?;
    let triangles = mesh.triangles().len();
    writeln!(out, "<title>{triangles} triangles, {} nodes</title>", mesh.nodes().len())?;
    write!(out, "<desc>")?;
    provenance.lines().try_for_each(|line| writeln!(out, "{}", xml_text(&line)))?;
    writeln!(out, "</desc>")?;
    if let Some([r, g, b]) = style.background {
        writeln!(
            out,
            "<rect width=\"{}\" height=\"{}\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>",
            view[0], view[1]
        )?;
    }
    if let Some(SvgMap { at, .. }) = style.map {
        let scale = 1.0 / page.units_per_px;
        writeln!(out, "<g id=\"map\" transform=\"translate({} {}) scale({scale})\">", at.x, at.y)?;
    }
    match style.fills {
        SvgFills::Levels(colors) => write_levels(out, mesh, &page, colors)?,
        SvgFills::Triangles(colors) => write_colors(out, mesh, &page, colors)?,
        SvgFills::Picture(file) => write_picture(out, &page, file)?,
    }
    if style.edges {
        write_edges(out, mesh, &page)?;
    }
    write_path(out, mesh, &page, style)?;
    if style.map.is_some() {
        writeln!(out, "</g>")?;
        style.shapes.iter().try_for_each(|shape| write_shape(out, shape))?;
    }
    write_marks(out, &page, style)?;
    writeln!(out, "</svg>")
}

impl SvgStyle<'_> {
    /// Returns a side in pixels as an attribute.
    fn side(&self, pixels: u32) -> String {
        let Some((length, unit)) = self.unit else { return pixels.to_string() };
        let length = (1000.0 * length * f64::from(pixels)).round() / 1000.0;
        format!("{length}{unit}")
    }
}

fn write_shape(out: &mut impl Write, SvgShape { path, paint, title }: &SvgShape) -> io::Result<()> {
    if let Some(title) = title {
        write!(out, "<g><title>{}</title>", xml_text(title))?;
    }
    match paint {
        ShapePaint::Fill([r, g, b]) => write!(out, "<path fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"{path}\"/>")?,
        ShapePaint::Stroke([r, g, b], width) => write!(
            out,
            "<path fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" stroke-width=\"{width:.2}\" d=\"{path}\"/>"
        )?,
    }
    writeln!(out, "{}", if title.is_some() { "</g>" } else { "" })
}

/// Widths of the line and of the one below it, in pixels.
const PATH_WIDTHS: [f64; 2] = [4.0, 8.0];

fn write_path(out: &mut impl Write, mesh: &Extract, page: &Page, style: &SvgStyle) -> io::Result<()> {
    if style.path.is_empty() {
        return Ok(());
    }
    let unit = f64::from(1u32 << page.shift);
    let place = |&point: &DVec2| {
        let at = mesh.lattice().lattice_from_world(point) / unit;
        DVec2::new(at.x, f64::from(page.height) - at.y)
    };
    let points: Vec<DVec2> = style.path.iter().map(place).collect();
    for n in [1, 0] {
        write_line(out, &points, style.path_colors[n], PATH_WIDTHS[n] * page.units_per_px)?;
    }
    Ok(())
}

/// Widths of marks and of the lines below them, in pixels.
const MARK_WIDTHS: [f64; 2] = [2.0, 5.0];

fn write_marks(out: &mut impl Write, page: &Page, style: &SvgStyle) -> io::Result<()> {
    let [width, height] = style.size.map(f64::from);
    let units_per_px = DVec2::new(f64::from(page.width) / width, f64::from(page.height) / height);
    for n in [1, 0] {
        for mark in style.marks {
            let points: Vec<DVec2> = mark.iter().map(|&at| at * units_per_px).collect();
            write_line(out, &points, style.mark_colors[n], MARK_WIDTHS[n] * units_per_px.x)?;
        }
    }
    Ok(())
}

/// Writes a line through points, with a width, all in units of the page.
fn write_line(out: &mut impl Write, points: &[DVec2], [r, g, b]: [u8; 3], width: f64) -> io::Result<()> {
    write!(
        out,
        "<polyline fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" stroke-width=\"{width:.4}\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\" points=\""
    )?;
    points.iter().try_for_each(|at| write!(out, "{:.3},{:.3} ", at.x, at.y))?;
    writeln!(out, "\"/>")
}

fn write_levels(out: &mut impl Write, mesh: &Extract, page: &Page, colors: &[[u8; 4]; 64]) -> io::Result<()> {
    // One pass over the mesh for each level: lists by level would be a second copy of it.
    for (level, _) in mesh.level_counts().into_iter().enumerate().filter(|(_, count)| *count > 0) {
        let [r, g, b, _] = colors[level.min(63)];
        let triangles = mesh.triangles().iter().filter(|triangle| triangle.level() as usize == level);
        let scale = page.scale_for(mesh, triangles.clone().flat_map(|triangle| triangle.vertices));
        write!(out, "<path id=\"level-{level}\"{} fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"", Transform(scale))?;
        write_triangles(out, mesh, page, scale, triangles)?;
        writeln!(out, "\"/>")?;
    }
    Ok(())
}

/// Writes the corners of triangles.
fn write_triangles<'a>(
    out: &mut impl Write,
    mesh: &Extract,
    page: &Page,
    scale: u32,
    triangles: impl Iterator<Item = &'a Triangle>,
) -> io::Result<()> {
    let mut pen = Pen::default();
    for triangle in triangles {
        let [a, b] = triangle.bisection_edge();
        // The two legs are drawn and the bisection edge closes the path: legs are often horizontal or
        // vertical, which is shorter.
        let [a, apex, b] = [a, triangle.apex(), b].map(|node| page.place(mesh, node, scale));
        pen.move_to(out, a)?;
        pen.line_to(out, apex)?;
        pen.line_to(out, b)?;
        pen.close(out, a)?;
    }
    Ok(())
}

/// How wide a line in its own colour is around a triangle, in pixels. Programs smooth each path by itself:
/// without the line, the ground would be seen between two colours.
const SEAM: f64 = 0.4;

/// Writes the triangles of each colour, in the order of the colours.
fn write_colors(out: &mut impl Write, mesh: &Extract, page: &Page, colors: &[[u8; 4]]) -> io::Result<()> {
    let mut order: Vec<usize> = (0..mesh.triangles().len().min(colors.len())).collect();
    order.sort_by_key(|&triangle| colors[triangle]);
    for same in order.chunk_by(|&a, &b| colors[a] == colors[b]) {
        let triangles = same.iter().map(|&triangle| &mesh.triangles()[triangle]);
        let scale = page.scale_for(mesh, triangles.clone().flat_map(|triangle| triangle.vertices));
        let [r, g, b, _] = colors[same[0]];
        let color = format!("#{r:02x}{g:02x}{b:02x}");
        let width = SEAM * page.units_per_px / f64::from(scale);
        write!(
            out,
            "<path{} fill=\"{color}\" stroke=\"{color}\" stroke-width=\"{width:.2e}\" \
             stroke-linejoin=\"round\" d=\"",
            Transform(scale)
        )?;
        write_triangles(out, mesh, page, scale, triangles)?;
        writeln!(out, "\"/>")?;
    }
    Ok(())
}

/// Writes a picture over the whole page of the mesh.
fn write_picture(out: &mut impl Write, page: &Page, file: &[u8]) -> io::Result<()> {
    let (width, height) = (page.width, page.height);
    let text = BASE64_STANDARD.encode(file);
    writeln!(
        out,
        "<image xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" height=\"{height}\" \
         preserveAspectRatio=\"none\" xlink:href=\"data:image/png;base64,{text}\"/>"
    )
}

/// Writes each edge once, at the level of the finer one of its triangles. Widths are chosen in pixels and
/// written in units of the path, as programs disagree on the width of lines in a scaled path.
fn write_edges(out: &mut impl Write, mesh: &Extract, page: &Page) -> io::Result<()> {
    writeln!(
        out,
        "<g id=\"edges\" fill=\"none\" stroke=\"#000\" stroke-opacity=\"0.5\" stroke-linecap=\"round\" \
         stroke-linejoin=\"round\">"
    )?;
    let spacing = mesh.lattice().spacing();
    let units_per_px = page.units_per_px;
    let units_per_world = f64::from(page.width) / mesh.lattice().bounds().size().x;
    for (level, _) in mesh.level_counts().into_iter().enumerate().filter(|(_, count)| *count > 0) {
        let edges = edges(mesh).filter(|edge| edge.0 as usize == level).map(|(_, ends)| ends);
        let scale = page.scale_for(mesh, edges.clone().flatten());
        let width = 0.04 * bisection_edge_length(spacing, level as u32) * units_per_world;
        let width = width.clamp(0.01 * units_per_px, 0.7 * units_per_px) / f64::from(scale);
        write!(out, "<path{} stroke-width=\"{width:.2e}\" d=\"", Transform(scale))?;
        let mut pen = Pen::default();
        for ends in edges {
            pen.join(out, ends.map(|node| page.place(mesh, node, scale)))?;
        }
        writeln!(out, "\"/>")?;
    }
    writeln!(out, "</g>")
}

/// Returns every edge once, with its level.
fn edges<'a>(mesh: &'a Extract) -> impl Iterator<Item = (u32, [NodeId; 2])> + Clone + 'a {
    mesh.triangles().iter().enumerate().flat_map(move |(index, triangle)| {
        let edges = triangle.edge_nodes().into_iter().zip(triangle.raw_neighbours);
        edges.filter_map(move |((from, to), across)| match across.triangle() {
            Some(other) if other.index() < index => None, // listed with the other triangle
            Some(other) => Some((triangle.level().max(mesh.triangles()[other.index()].level()), [from, to])),
            None => Some((triangle.level(), [from, to])),
        })
    })
}

/// The lattice as a page: y grows downwards, and the unit is the largest that all nodes are multiples of.
struct Page {
    width: u32,
    height: u32,
    shift: u32,
    units_per_px: f64,
}

impl Page {
    fn of(mesh: &Extract, style: &SvgStyle) -> Self {
        let bits = mesh.nodes().iter().fold(0, |bits, node| bits | node.x | node.y);
        let LatticePoint { x, y } = mesh.lattice().extent();
        let shift = (bits | x | y).trailing_zeros();
        let (width, height) = (x >> shift, y >> shift);
        let px = match style.map {
            Some(map) => map.px_per_world * mesh.lattice().bounds().size().x,
            None => f64::from(style.size[0]),
        };
        Self { width, height, shift, units_per_px: f64::from(width) / px }
    }

    /// Returns the largest power of two, in units of the page, that all these nodes are multiples of.
    fn scale_for(&self, mesh: &Extract, nodes: impl Iterator<Item = NodeId>) -> u32 {
        let bits = nodes.map(|node| mesh.node(node)).fold(0, |bits, node| bits | node.x | node.y);
        let common = (bits >> self.shift) | self.width | self.height;
        1 << common.trailing_zeros()
    }

    /// Returns the place of a node, in units of `scale` units of the page.
    fn place(&self, mesh: &Extract, node: NodeId, scale: u32) -> [i64; 2] {
        let LatticePoint { x, y } = mesh.node(node);
        [x >> self.shift, self.height - (y >> self.shift)].map(|place| i64::from(place / scale))
    }
}

/// The attribute that scales a path; nothing for a scale of one.
struct Transform(u32);

impl std::fmt::Display for Transform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 == 1 { Ok(()) } else { write!(f, " transform=\"scale({})\"", self.0) }
    }
}

/// Writes a path in relative coordinates, which are short.
#[derive(Default)]
struct Pen {
    at: [i64; 2],
    moved: bool,
}

impl Pen {
    fn move_to(&mut self, out: &mut impl Write, to: [i64; 2]) -> io::Result<()> {
        let [dx, dy] = [to[0] - self.at[0], to[1] - self.at[1]];
        self.at = to;
        match std::mem::replace(&mut self.moved, true) {
            false => write!(out, "M{dx} {dy}"),
            true => write!(out, "m{dx}{}", Next(dy)),
        }
    }

    fn line_to(&mut self, out: &mut impl Write, to: [i64; 2]) -> io::Result<()> {
        let [dx, dy] = [to[0] - self.at[0], to[1] - self.at[1]];
        self.at = to;
        match (dx, dy) {
            (dx, 0) => write!(out, "h{dx}"),
            (0, dy) => write!(out, "v{dy}"),
            (dx, dy) => write!(out, "l{dx}{}", Next(dy)),
        }
    }

    /// Draws a line between two places, from the pen's own place if that is one of them.
    fn join(&mut self, out: &mut impl Write, ends: [[i64; 2]; 2]) -> io::Result<()> {
        let [from, to] = if self.at == ends[1] { [ends[1], ends[0]] } else { ends };
        if !self.moved || self.at != from {
            self.move_to(out, from)?;
        }
        self.line_to(out, to)
    }

    /// Closes the path with a line back to `start`, its first place.
    fn close(&mut self, out: &mut impl Write, start: [i64; 2]) -> io::Result<()> {
        self.at = start;
        write!(out, "z")
    }
}

/// A number after another: a minus sign separates them, too, and a space is not needed.
struct Next(i64);

impl std::fmt::Display for Next {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 < 0 { write!(f, "{}", self.0) } else { write!(f, " {}", self.0) }
    }
}
