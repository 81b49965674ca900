//! `meshbrush locate`: build, then answer where each point lies.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use glam::DVec2;

use super::args::LocateArguments;
use super::build::{FinishedMesh, build};
use super::failure::Failure;
use super::input::Input;
use super::mesh::note_capped;
use super::options::parse_formula;
use super::output::{check_place, is_standard_stream};
use super::terminal::Terminal;
use meshbrush_core::field::Formula;
use meshbrush_io::io::located::LocatedIn;
use meshbrush_io::io::points::{self, PointTable};
use meshbrush_io::io::write_file_metered;
use meshbrush_mesh::mesh::Extract;

/// Runs the command. `out` is standard output.
///
/// # Errors
/// Fails with the reason, when the arguments make no sense or the work failed.
pub fn run(typed: &LocateArguments, out: &mut dyn Write, terminal: &mut Terminal) -> Result<(), Failure> {
    let input = Input::new(&typed.input)?;
    let quantity = typed.quantity.as_deref().map(|text| parse_formula("--quantity", text)).transpose()?;
    let output = typed.output.as_ref().filter(|path| !is_standard_stream(path));
    if let Some(path) = output {
        let inputs = [input.files(), vec![typed.points.clone()]].concat();
        check_place(path, &inputs)?;
    }
    input.options_without_effect(&typed.input).iter().for_each(|note| terminal.note(note));
    let table = read_points(&typed.points, &input)?;
    let finished = build(&input, terminal)?;
    let points = placed_points(table, &typed.points, &finished, terminal);
    note_capped(&finished, terminal);
    let extract = finished.extract();
    let answers = Answers { finished: &finished, extract, quantity: quantity.as_ref() };
    let Some(path) = output else {
        let mut out = BufWriter::new(out);
        return answers.write(&points, &mut out).and_then(|()| out.flush()).map_err(Failure::Print);
    };
    terminal.while_writing(path, |meter| {
        write_file_metered(path, meter, |out| answers.write(&points, &mut meter.count(out)))
    })
}

fn read_points(path: &Path, input: &Input) -> Result<PointTable, Failure> {
    if !is_standard_stream(path) {
        return Ok(points::read_table(path)?);
    }
    if input.settings.domain.outline_file().is_some_and(is_standard_stream) {
        let option = if input.settings.domain.land.is_some() { "--land" } else { "--region" };
        let problem = format!("{option} - and --points - both read standard input");
        return Err(Failure::Usage(format!("{problem}. Name a file for one of them.")));
    }
    Ok(points::read_table_from(io::stdin().lock(), Path::new("standard input"))?)
}

/// Returns the points of a table in world units, and says what is assumed about them.
fn placed_points(
    table: PointTable,
    path: &Path,
    finished: &FinishedMesh,
    terminal: &mut Terminal,
) -> Vec<DVec2> {
    let (domain, has_header, file) = (finished.domain(), table.has_header, path.display());
    let points = table.points(domain.projection);
    if !has_header {
        terminal.note(&format!(
            "{file} has no header: its first two columns are taken for x and y, in the coordinates of the mesh."
        ));
    }
    let is_elsewhere = !points.is_empty() && !points.iter().any(|&at| domain.bounds.contains(at));
    if is_elsewhere && domain.projection.is_some() {
        terminal.note(&format!(
            "No point of {file} is in the rectangle of the domain. Columns called lon and lat are degrees, and x and y are \
             metres in the plane of the mesh."
        ));
    }
    points
}

/// The data from which answers are computed.
struct Answers<'a> {
    finished: &'a FinishedMesh,
    extract: Extract<'a>,
    /// The quantity to interpolate in place of h̄.
    quantity: Option<&'a Formula>,
}

impl Answers<'_> {
    fn write(&self, points: &[DVec2], out: &mut dyn Write) -> io::Result<()> {
        let value_at = |node: DVec2| match self.quantity {
            Some(formula) => formula.eval(node.x, node.y),
            None => self.finished.target_at(node),
        };
        let (mesh, patch) = (self.finished.mesh(), self.finished.derived.patch());
        LocatedIn { mesh, patch, extract: &self.extract, value_at: &value_at }.write(points, out)
    }
}
