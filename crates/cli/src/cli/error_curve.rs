//! What is written of the error of a mesh: the plot against the number of triangles, and what the error
//! forces.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::args::ErrorCurveArguments;
use super::build::FinishedMesh;
use super::details::MeshDetails;
use super::failure::Failure;
use super::output::check_place;
use super::terminal::Terminal;
use meshbrush_core::build::CurveTracing;
use meshbrush_core::layers::SurfaceNorm;
use meshbrush_core::surface::CurvePoint;
use meshbrush_io::io::{Provenance, certificate, write_file};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::Grouped;
use meshbrush_study::error_plot::error_plot;
use meshbrush_study::plot;

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
    let most = CurveTracing::DEFAULT_MOST.max(BEYOND * here.triangles);
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

impl ErrorCurveArguments {
    /// Checks that the files can be written.
    ///
    /// # Errors
    /// Fails with a sentence where an ending is unknown, or a file is one of `inputs`.
    pub fn check(&self, inputs: &[PathBuf]) -> Result<(), Failure> {
        self.error_curve.iter().try_for_each(|file| check_curve_file(file, inputs))?;
        self.certificate.iter().try_for_each(|file| check_place(file, inputs))
    }

    /// Writes the files. `details` has the error of the mesh, where it was measured before.
    ///
    /// # Errors
    /// Fails when there is no surface to be near to, and when a file cannot be written.
    pub fn write(
        &self,
        (finished, extract): (&FinishedMesh, &Extract),
        details: Option<&MeshDetails>,
        provenance: impl FnOnce() -> Provenance,
        terminal: &mut Terminal,
    ) -> Result<(), Failure> {
        if let Some(file) = &self.error_curve {
            write_error_curve(file, (finished, extract), details, terminal)?;
        }
        let Some(file) = &self.certificate else { return Ok(()) };
        if finished.spec().surface_norm().is_some_and(|norm| norm != SurfaceNorm::Largest) {
            return Err(Failure::Usage(
                "--certificate: a --norm that sums over the whole mesh forces no single bisection. Use --norm max."
                    .into(),
            ));
        }
        let bisections = terminal.while_working("finding the demands", || finished.bisections());
        let lattice = finished.mesh().lattice();
        write_file(file, |out| certificate::write_mesh(out, &bisections, lattice, &provenance()))
            .map_err(|error| Failure::Write { file: file.clone(), problem: error.to_string() })?;
        terminal.say(&format!("wrote {}", file.display()));
        Ok(())
    }
}
