//! `meshbrush locate`: build, then answer where each point lies.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use glam::DVec2;

use super::args::LocateArguments;
use super::build::{FinishedMesh, build};
use super::failure::Failure;
use super::mesh::note_capped;
use super::output::{check_place, is_standard_stream};
use super::request::{MeshRequest, parse_formula};
use super::terminal::Terminal;
use crate::field::Formula;
use crate::io::{Interruption, Number, points, write_file_metered};
use crate::mesh::{
    Cell, Extract, Location, Locator, NodeId, PatchedLocator, TriangleId, barycentric, interpolate,
};

const HEADER: &str = "x,y,where,triangle,level,v1,v2,v3,zeta1,zeta2,zeta3,value";

/// With more than one point for this many triangles, building a search tree pays off.
const TRIANGLES_PER_POINT: usize = 16;

/// Runs the command. `out` is standard output.
///
/// # Errors
/// With the reason, when the arguments make no sense or the work failed.
pub fn run(typed: &LocateArguments, out: &mut dyn Write, terminal: &mut Terminal) -> Result<(), Failure> {
    let request = MeshRequest::new(&typed.input)?;
    let quantity = typed.quantity.as_deref().map(|text| parse_formula("--quantity", text)).transpose()?;
    let output = typed.output.as_ref().filter(|path| !is_standard_stream(path));
    if let Some(path) = output {
        let inputs = [request.input_files(), vec![typed.points.clone()]].concat();
        check_place(path, &inputs)?;
    }
    request.options_without_effect(&typed.input).iter().for_each(|note| terminal.note(note));
    let points = read_points(&typed.points, &request)?;
    let finished = build(&request, terminal)?;
    note_capped(&finished, terminal);
    let extract = finished.extract();
    let answers = Answers { finished: &finished, extract, quantity: quantity.as_ref() };
    let Some(path) = output else {
        let mut out = BufWriter::new(out);
        return answers.write(&points, &mut out).and_then(|()| out.flush()).map_err(Failure::Print);
    };
    let interruption = Interruption::listen().map_err(|error| Failure::Work(format!("{error}.")))?;
    let meter = interruption.meter();
    let written = terminal.while_metered(&format!("writing {}", path.display()), &meter, || {
        write_file_metered(path, &meter, |out| answers.write(&points, &mut meter.count(out)))
    });
    interruption.end_program();
    written.map_err(|error| Failure::Write { file: path.clone(), problem: error.to_string() })
}

fn read_points(path: &Path, request: &MeshRequest) -> Result<Vec<DVec2>, Failure> {
    if !is_standard_stream(path) {
        return Ok(points::read(path)?);
    }
    if request.region.as_deref().is_some_and(is_standard_stream) {
        let problem = "--region - and --points - both read standard input";
        return Err(Failure::Usage(format!("{problem}. Name a file for one of them.")));
    }
    Ok(points::read_from(io::stdin().lock(), Path::new("standard input"))?)
}

/// What the answers are computed from.
struct Answers<'a> {
    finished: &'a FinishedMesh,
    /// The mesh as files have it: ids are those of a file.
    extract: Extract<'a>,
    /// What to interpolate instead of h̄.
    quantity: Option<&'a Formula>,
}

impl Answers<'_> {
    /// One row for each point, in their order.
    fn write(&self, points: &[DVec2], out: &mut dyn Write) -> io::Result<()> {
        let mesh = self.finished.mesh();
        let many = points.len() > mesh.raw_triangle_count() / TRIANGLES_PER_POINT;
        let locator = many.then(|| Locator::new(mesh));
        let patch = self.finished.derived.patch();
        let patched = (!patch.is_empty()).then(|| PatchedLocator::new(mesh, patch, &self.extract));
        writeln!(out, "{HEADER}")?;
        for &point in points {
            let location = match &locator {
                Some(locator) => locator.locate(point),
                None => mesh.locate(point),
            };
            let (location, number) = match &patched {
                Some(patched) => {
                    let location = patched.locate(&self.extract, point, location);
                    (location, location.triangle())
                }
                None => (location, location.triangle().and_then(|id| self.extract.place_of(id))),
            };
            write!(out, "{},{},{}", Number(point.x), Number(point.y), name(&location))?;
            match number {
                Some(triangle) => self.write_triangle(point, triangle, out)?,
                None => writeln!(out, ",,,,,,,,,")?,
            }
        }
        Ok(())
    }

    /// The columns from `triangle` on. Vertices and ζ are in the order of the vertices in files, so that each
    /// ζ belongs to the vertex in the same place.
    fn write_triangle(&self, point: DVec2, place: TriangleId, out: &mut dyn Write) -> io::Result<()> {
        let Cell { corners, level, .. } = self.extract.cell(place);
        let nodes = corners.map(NodeId::from_index);
        let at = self.finished.mesh().lattice().lattice_from_world(point);
        let zeta = barycentric(nodes.map(|node| self.extract.node(node)), at);
        let value = interpolate(zeta, nodes.map(|node| self.value_at(self.extract.world(node))));
        let [a, b, c] = corners;
        let [zeta1, zeta2, zeta3] = zeta.map(Number);
        writeln!(out, ",{},{},{a},{b},{c},{zeta1},{zeta2},{zeta3},{}", place.index(), level, Number(value))
    }

    fn value_at(&self, node: DVec2) -> f64 {
        match self.quantity {
            Some(formula) => formula.eval(node.x, node.y),
            None => self.finished.target_at(node),
        }
    }
}

fn name(location: &Location) -> &'static str {
    match location {
        Location::Inside { .. } => "inside",
        Location::OnEdge { .. } => "edge",
        Location::OnVertex { .. } => "vertex",
        Location::OutsideBounds | Location::OutsideDomain => "outside",
        Location::Invalid => "invalid",
    }
}
