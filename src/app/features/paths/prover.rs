//! Raises the lower bounds of paths on another thread, and takes better paths, until a requested width is
//! reached.

use std::sync::Arc;

use super::work::FoundPath;
use meshbrush_core::domain::Domain;
use meshbrush_core::path::{
    CertificateEnd, CertificateTask, CostDensity, PathCertificate, PathMesh, Solution,
};
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs, Output, Taken};
use meshbrush_mesh::mesh::Progress;

/// Certifies one path after the other.
pub struct Prover {
    known: Option<FoundPaths>,
    /// The requested width of the interval, as a share of the cost.
    pub width: f64,
    /// The job that certifies a path. Each proof that it sends is better than the previous one.
    running: Option<Job<Proof>>,
    /// How many of the paths were certified, or as well as possible.
    done: usize,
}

/// The data with which the paths were found.
#[derive(Clone)]
pub struct FoundPaths {
    /// The cost density of the paths.
    pub density: Arc<dyn CostDensity>,
    /// The triangles that they go through, and the area that these are in.
    pub mesh: Arc<PathMesh>,
}

/// The state of a certificate after a step.
struct Proof {
    solution: Solution,
    end: Option<CertificateEnd>,
}

impl Default for Prover {
    fn default() -> Self {
        Self { known: None, width: 0.01, running: None, done: 0 }
    }
}

impl Prover {
    /// Returns whether a certificate is in the making.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Ends the work. What was proved stays with the paths.
    pub fn cancel(&mut self) {
        self.running = None;
    }

    /// Begins again with the same paths.
    pub fn restart(&mut self) {
        self.cancel();
        self.done = 0;
    }

    /// Begins with new paths.
    pub fn begin(&mut self, known: Option<FoundPaths>) {
        self.restart();
        self.known = known;
    }

    /// Takes what was proved, waiting as long as the frame may, and begins the next certificate.
    pub fn advance(&mut self, mut paths: Vec<&mut FoundPath>, domain: &Domain, jobs: &Jobs) {
        while let Some(path) = paths.get_mut(self.done) {
            let Some(proof) = &self.running else {
                if path.solution.gap() <= self.width {
                    self.done += 1;
                } else {
                    self.running = self.start(&path.solution, domain, jobs);
                    self.done += usize::from(self.running.is_none());
                }
                continue;
            };
            match proof.take(jobs) {
                Taken::Value(Proof { solution, end }) => {
                    path.end = end;
                    if let Some(known) = &self.known {
                        path.take(solution, &*known.density);
                    }
                }
                Taken::Working => return,
                Taken::Ended => {
                    self.running = None;
                    self.done += 1;
                }
            }
        }
    }

    fn start(&self, solution: &Solution, domain: &Domain, jobs: &Jobs) -> Option<Job<Proof>> {
        let FoundPaths { density, mesh } = self.known.clone()?;
        let (path, upper) = (solution.points.clone(), solution.upper);
        let task = CertificateTask::in_rectangle(domain.bounds, density, path, upper, self.width).ok()?;
        let (domain, solution) = (domain.clone(), solution.clone());
        let begin = move || {
            let task = task.in_domain(&domain).in_area(mesh.area().clone());
            Some(PathCertificate::new(&solution, &task).ok()?.with_search(mesh))
        };
        let advance = |certificate: &mut PathCertificate, output: &Output<Proof>| {
            match certificate.advance_slice() {
                Ok(Progress::Done) => {}
                Ok(Progress::More) if output.is_wanted() => return Progress::More,
                Ok(Progress::More) | Err(_) => return Progress::Done,
            }
            let end = certificate.end();
            let goes_on = output.send(Proof { solution: certificate.solution(), end }) && end.is_none();
            if goes_on { Progress::More } else { Progress::Done }
        };
        Some(jobs.start_in_slices(JobKind::Compute, begin, advance))
    }
}
