//! The plot of the error against the number of triangles.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::build::FinishedMesh;
use super::details::MeshDetails;
use super::failure::Failure;
use super::output::check_place;
use super::terminal::Terminal;
use meshbrush_core::build::CurveTracing;
use meshbrush_core::surface::CurvePoint;
use meshbrush_io::io::write_file;
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::Grouped;
use meshbrush_study::error_plot::error_plot;
use meshbrush_study::plot;

/// The plot that is asked for.
#[derive(Debug, Args)]
pub struct ErrorCurveArguments {
    /// Plot to write of the error from the surface against the number of triangles, .svg or .csv: that of the
    /// smallest mesh, of uniform meshes, and of the mesh without the surface
    ///
    /// The error is that of --norm. The curve of the smallest mesh has what other layers ask for as well. The
    /// rates by which the errors fall are printed beside the best one that is possible.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub error_curve: Option<PathBuf>,
}

/// How many times as many triangles as the mesh the largest one of the curve has at least.
const BEYOND: usize = 4;

/// Checks that a plot can be written to a file.
///
/// # Errors
/// Fails with a sentence where the ending is unknown, or the file is one of `inputs`.
pub fn check_curve_file(path: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    if !ending.is_some_and(|ending| plot::ENDINGS.contains(&ending.as_str())) {
        return Err(Failure::Usage(format!(
            "--error-curve {}: the ending chooses the format; use .svg or .csv.",
            path.display()
        )));
    }
    check_place(path, inputs)
}

/// Writes the plot of a mesh that is close to a surface. `details` has the error of the mesh, where it was
/// measured before.
///
/// # Errors
/// Fails when no visible layer is a surface, or the file cannot be written.
pub fn write_error_curve(
    path: &Path,
    (finished, extract): (&FinishedMesh, &Extract),
    details: Option<&MeshDetails>,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let measured = details.is_none().then(|| finished.surface_fit(extract)).flatten();
    let fit = details.map_or(measured.as_ref(), |details| details.surface.as_ref());
    let Some((norm, fit)) = finished.spec().surface_norm().zip(fit) else {
        return Err(Failure::Usage(
            "--error-curve: the error is that from a surface, and no visible layer is one. Add --surface."
                .into(),
        ));
    };
    let here = CurvePoint { triangles: finished.mesh().triangles().count(), error: fit.error(norm) };
    let most = CurveTracing::USUAL_MOST.max(BEYOND * here.triangles);
    let start = Instant::now();
    let curves = finished.error_curves(norm, most, |triangles| {
        terminal.progress(start, || format!("error curve, {} triangles", Grouped(triangles)));
        true
    });
    terminal.clear();
    let Some(curves) = curves? else { return Ok(()) };
    let plot = error_plot(&curves, Some(here));
    write_file(path, |mut out| plot::write(&mut out, &plot, path))
        .map_err(|error| Failure::Write { file: path.to_owned(), problem: error.to_string() })?;
    if !plot.note.is_empty() {
        terminal.say(&plot.note);
    }
    terminal.say(&format!("wrote {}", path.display()));
    Ok(())
}
