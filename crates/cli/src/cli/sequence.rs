//! `--sequence N`: meshes each of which has every node of the one before.

use serde::Serialize;

use super::args::MeshArguments;
use super::build::FinishedMesh;
use super::details::{DetailUses, MeshDetails};
use super::failure::Failure;
use super::output::Output;
use super::output_coordinates::OutputCoordinates;
use super::requested_files::{RequestedFiles, write_files};
use super::terminal::Terminal;
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::Grouped;

/// A mesh of a sequence.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SequenceMesh {
    /// Its triangles: four for each one of the mesh before it.
    pub triangles: usize,
    /// Its nodes: first those of the mesh before it, then one for each of its edges.
    pub nodes: usize,
}

/// Returns the files of the first mesh: those that are asked for, and in a sequence with the number 1.
///
/// # Errors
/// Fails when an output cannot be that of a sequence.
pub fn first_files(
    typed: &MeshArguments,
    files: Vec<RequestedFiles>,
) -> Result<Vec<RequestedFiles>, Failure> {
    let Some(count) = typed.sequence else { return Ok(files) };
    let refused = |why: &str| Err(Failure::Usage(format!("--sequence {count}: {why}.")));
    if files.iter().flat_map(|files| &files.outputs).any(Output::is_stdout) {
        return refused("there are several files, and standard output is one. Name a file with -o");
    }
    if files.iter().flat_map(|files| &files.outputs).any(Output::is_picture) {
        return refused("it is for files of meshes. Leave out .svg and .png");
    }
    Ok(files.iter().map(|files| files.numbered(1)).collect())
}

/// A mesh and how it is written.
pub struct SequenceStart<'a> {
    /// The mesh.
    pub finished: &'a FinishedMesh,
    /// Its triangles as files get them.
    pub extract: &'a Extract<'a>,
    /// The files, without numbers.
    pub files: &'a [RequestedFiles],
    /// Coordinates in files.
    pub coordinates: OutputCoordinates,
}

impl SequenceStart<'_> {
    /// Writes the meshes, or the one mesh where no sequence is asked for. `details` are those of the first
    /// one.
    ///
    /// # Errors
    /// Fails when the last mesh has too many triangles, or a file cannot be written.
    pub fn write(
        &self,
        count: Option<u32>,
        mut details: MeshDetails,
        uses: DetailUses<'_>,
        terminal: &mut Terminal,
    ) -> Result<Option<Vec<SequenceMesh>>, Failure> {
        let Self { finished, extract, files, coordinates } = *self;
        let Some(count) = count else {
            write_files(files, finished, extract, &details, coordinates, terminal)?;
            return Ok(None);
        };
        self.check_budget(count)?;
        let origin = details.provenance.clone();
        let (mut meshes, mut current) = (Vec::new(), extract.clone());
        for number in 1..=count {
            if number > 1 {
                current = current.refined().ok_or_else(|| too_fine(count, number))?;
                details = MeshDetails::with_provenance(finished, &current, origin.clone(), uses)?;
                details.target_factor = 0.5_f64.powi(number as i32 - 1);
            }
            let line = format!("{number} of {count}; each has the nodes of the one before");
            details.provenance = origin.clone().with_line("sequence", &line);
            let numbered: Vec<RequestedFiles> = files.iter().map(|files| files.numbered(number)).collect();
            write_files(&numbered, finished, &current, &details, coordinates, terminal)?;
            meshes.push(SequenceMesh { triangles: current.triangles().len(), nodes: current.nodes().len() });
        }
        Ok(Some(meshes))
    }

    /// Fails when the last mesh would have more triangles than allowed.
    fn check_budget(&self, count: u32) -> Result<(), Failure> {
        let most = self.finished.spec().limits.most_triangles();
        let last = self.extract.triangles_refined(count - 1);
        if last.is_some_and(|last| last <= most) {
            return Ok(());
        }
        let last = last.map_or("too many".to_owned(), |last| Grouped(last).to_string());
        Err(Failure::Work(format!(
            "--sequence {count}: the last mesh would have {last} triangles, and {} are allowed. Ask for fewer meshes, a \
             larger --scale, or raise --max-triangles.",
            Grouped(most)
        )))
    }
}

fn too_fine(count: u32, number: u32) -> Failure {
    Failure::Work(format!(
        "--sequence {count}: the triangles of mesh {number} would be too small for the lattice of nodes. Ask for fewer meshes."
    ))
}
