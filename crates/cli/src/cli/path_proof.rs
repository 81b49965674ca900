//! The proof of `meshbrush path --within`, and its certificate.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::build::FinishedMesh;
use super::failure::Failure;
use super::terminal::Terminal;
use meshbrush_core::document::PathCost;
use meshbrush_core::domain::Domain;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::{
    CertificateEnd, CertificateTask, CostDensity, PathArea, PathCertificate, PathError, PathMesh, Solution,
};
use meshbrush_io::io::certificate::{self, CertifiedPath};
use meshbrush_io::io::{Provenance, write_file_metered};
use meshbrush_mesh::text::percent_above;

/// Returns the statement to prove about a path.
pub fn task(
    finished: &FinishedMesh,
    cost: Arc<dyn CostDensity>,
    area: PathArea,
    solution: &Solution,
    width: f64,
) -> CertificateTask {
    let domain = finished.domain();
    CertificateTask::in_rectangle(domain.bounds, cost, solution.points.clone(), solution.upper, width)
        .expect("the bounds of a domain are a rectangle")
        .in_domain(domain)
        .in_area(area)
}

/// What a search for a proof found.
pub struct Proof {
    /// The bounds as they are at the end; `None` where there is no proof.
    certificate: Option<PathCertificate>,
    end: Result<Option<CertificateEnd>, PathError>,
}

impl Proof {
    /// Raises the lower bound of a solution, and takes better paths.
    pub fn search(
        solution: &mut Solution,
        task: &CertificateTask,
        mesh: Arc<PathMesh>,
        terminal: &mut Terminal,
    ) -> Self {
        let gap = AtomicU64::new(solution.gap().to_bits());
        let line = |elapsed: Duration| {
            let reached = percent_above(f64::from_bits(gap.load(Ordering::Relaxed)));
            format!("within {reached} of the best, {} s", elapsed.as_secs())
        };
        terminal.while_shown(line, || {
            let mut certificate = match PathCertificate::new(solution, task) {
                Ok(certificate) => certificate.with_search(mesh),
                Err(error) => return Self { certificate: None, end: Err(error) },
            };
            let mut end = Ok(certificate.end());
            while let Ok(None) = end {
                end = certificate.advance();
                if end.is_ok() {
                    solution.take(certificate.solution());
                    gap.store(solution.gap().to_bits(), Ordering::Relaxed);
                }
            }
            Self { certificate: Some(certificate), end }
        })
    }

    /// Says why a path is not proved to be as good as asked for. The path itself is there all the same.
    /// Returns the certificate.
    pub fn noted(self, solution: &Solution, width: f64, terminal: &mut Terminal) -> Option<PathCertificate> {
        let asked = percent_above(width);
        match &self.end {
            Ok(Some(end)) if solution.gap() > width => {
                let reached = percent_above(solution.gap());
                terminal.note(&format!(
                    "The path is proved to be within {reached} of the best, not {asked}. {end}"
                ));
            }
            Ok(_) => {}
            Err(error) => {
                terminal.note(&format!("The path is not proved to be within {asked} of the best. {error}"));
            }
        }
        self.certificate
    }
}

/// What a certificate is about, beside the path.
pub struct About<'a> {
    pub cost: &'a PathCost,
    pub domain: &'a Domain,
    pub keep_out: &'a [Mask],
    /// In the plane, in world units.
    pub clearance: f64,
}

/// Writes the certificate of a path.
///
/// # Errors
/// Fails when nothing is proved, and when the file cannot be written.
pub fn write_certificate(
    file: &Path,
    certificate: Option<&PathCertificate>,
    about: &About<'_>,
    provenance: &Provenance,
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    let Some(certificate) = certificate.filter(|certificate| certificate.lower() > 0.0) else {
        let problem = "there is no lower bound of the cost, so there is nothing to certify";
        return Err(Failure::Write { file: file.to_owned(), problem: problem.to_owned() });
    };
    let About { cost, domain, keep_out, clearance } = *about;
    let proofs = certificate.proofs();
    let (lower, upper) = (certificate.lower(), certificate.upper());
    let path = CertifiedPath { proofs: &proofs, cost, domain, keep_out, clearance, lower, upper };
    terminal.while_writing(file, |meter| {
        write_file_metered(file, meter, |out| certificate::write_path(out, &path, provenance))
    })?;
    terminal.say(&format!("wrote {}", file.display()));
    Ok(())
}
