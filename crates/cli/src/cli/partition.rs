//! `--parts-for N`: the parts of a mesh for a solver on several processors, beside each file of the mesh.

use serde::Serialize;

use super::args::MeshArguments;
use super::build::FinishedMesh;
use super::details::MeshDetails;
use super::exported_mesh::ExportedMesh;
use super::failure::Failure;
use super::output::{Output, failed};
use super::output_coordinates::OutputCoordinates;
use super::requested_files::RequestedFiles;
use super::terminal::Terminal;
use meshbrush_io::io::{MeshData, Meter, PartitionFigures};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::Grouped;

/// How the cells of the first file are divided.
#[derive(Clone, Debug, Serialize)]
pub struct PartitionSummary {
    /// The file of the parts.
    pub file: String,
    /// The parts.
    pub parts: u32,
    /// The cells of the smallest part.
    pub smallest: usize,
    /// The cells of the largest part, at most one more.
    pub largest: usize,
    /// Edges with cells of two parts.
    pub cut_edges: usize,
}

/// Checks what is asked for together with parts.
///
/// # Errors
/// Fails where parts would be those of several meshes, or of a file that has no name.
pub fn check(typed: &MeshArguments, outputs: &[Output]) -> Result<(), Failure> {
    let Some(parts) = typed.parts_for else { return Ok(()) };
    let refused = |why: &str| Err(Failure::Usage(format!("--parts-for {parts}: {why}.")));
    if typed.sequence.is_some() {
        return refused("it is for one mesh, and --sequence writes several. Leave one of them out");
    }
    if outputs.iter().any(Output::is_stdout) {
        return refused(
            "its file stands beside that of the mesh, and standard output has none. Name a file with -o",
        );
    }
    Ok(())
}

/// Writes the parts of each file of a mesh, if they are asked for, and returns how the first one is divided.
/// `details` are there where a file is written.
///
/// # Errors
/// Fails when there are more parts than cells, or a file cannot be written.
pub fn write(
    parts: Option<u32>,
    files: &[RequestedFiles],
    (finished, extract): (&FinishedMesh, &Extract),
    details: Option<&MeshDetails>,
    coordinates: OutputCoordinates,
    terminal: &mut Terminal,
) -> Result<Option<PartitionSummary>, Failure> {
    let Some(parts) = parts else { return Ok(None) };
    let outputs = || files.iter().flat_map(|files| &files.outputs);
    let Some(details) = details.filter(|_| !outputs().all(Output::is_picture)) else {
        terminal.note("--parts-for changes nothing: no file with a mesh is written (-o).");
        return Ok(None);
    };
    let (provenance, target_diameter) = (&details.provenance, &[][..]);
    let exported = ExportedMesh { finished, extract, details, provenance, coordinates, target_diameter };
    let placed = exported.in_coordinates()?;
    let placed = placed.as_ref().unwrap_or(exported.extract);
    let mut first = None;
    for requested in files {
        let data = MeshData { cells: requested.cells(), ..exported.data(&[], true) };
        for output in requested.outputs.iter().filter(|output| !output.is_picture()) {
            let Some(written) = output.write_parts(placed, &data, parts, &Meter::default()) else { continue };
            let (path, figures) =
                written.map_err(|error| failed(&output.parts_file(parts), error.to_string()))?;
            let summary = PartitionSummary::new(path.display().to_string(), figures);
            terminal.say(&summary.for_people());
            first.get_or_insert(summary);
        }
    }
    Ok(first)
}

impl PartitionSummary {
    fn new(file: String, figures: PartitionFigures) -> Self {
        let PartitionFigures { parts, smallest, largest, cut_edges } = figures;
        Self { file, parts, smallest, largest, cut_edges }
    }

    fn for_people(&self) -> String {
        let Self { file, parts, smallest, largest, cut_edges } = self;
        let cells = match smallest == largest {
            true => Grouped(*largest).to_string(),
            false => format!("{} or {}", Grouped(*smallest), Grouped(*largest)),
        };
        let cut = Grouped(*cut_edges);
        format!("wrote {file}: {parts} parts of {cells} cells, with {cut} edges between two parts")
    }
}
