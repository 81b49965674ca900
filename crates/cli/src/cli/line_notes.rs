//! What files do not keep of lines and weirs, in sentences.

use std::path::Path;

use super::exported_mesh::ExportedMesh;
use super::output::Output;
use meshbrush_core::outline::LineFit;
use meshbrush_io::io::{MeshData, MeshFormat, weir_notes};
use meshbrush_mesh::mesh::Extract;

/// Returns what a person should know about the lines in files: gaps of weirs, what of them has no pairs of
/// nodes, and a sentence for each file that has no place for them. `placed` is the mesh in the coordinates of
/// the files, and `data` are those that they get.
pub(super) fn line_notes(
    outputs: &[Output],
    exported: &ExportedMesh,
    placed: &Extract,
    data: &MeshData,
) -> Vec<String> {
    let finished = exported.finished;
    let lines = finished.spec().lines.iter().zip(finished.derived.line_fits());
    let weirs: Vec<&LineFit> = lines.filter(|(line, _)| line.weir().is_some()).map(|(_, fit)| fit).collect();
    let outputs: Vec<&Output> = outputs.iter().filter(|output| !output.is_picture()).collect();
    let mut notes = Vec::new();
    let has_line_files = |output: &Output| {
        output.mesh_format().is_some_and(|format| !format.line_files(Path::new("-")).is_empty())
    };
    let beside = outputs.iter().filter(|output| output.is_stdout() && has_line_files(output));
    notes.extend(beside.filter(|_| !data.lines.is_empty()).map(|output| {
        let name = output.name();
        format!("{name} has no file beside it for the lines of the document. Name a file with -o to get it.")
    }));
    if weirs.is_empty() || outputs.is_empty() {
        return notes;
    }
    let (with, without): (Vec<&Output>, Vec<&Output>) =
        outputs.into_iter().partition(|output| output.mesh_format().is_some_and(MeshFormat::has_weirs));
    notes.extend(weirs.iter().filter_map(|fit| fit.weir_note()));
    if !with.is_empty() {
        notes.extend(weir_notes(placed, data));
    }
    let edges = if weirs.len() == 1 { "the weir is edges" } else { "the weirs are edges" };
    notes.extend(without.iter().map(|output| {
        format!("{} has no place for crests: {edges} of a mesh without a crack there.", output.name())
    }));
    notes
}
