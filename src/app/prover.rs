//! Raises the lower bounds of paths on another thread, until a requested width is reached.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use eframe::egui::Context;

use crate::domain::Domain;
use crate::path::{CertificateTask, CostDensity, PathCertificate, Solution};

/// Certifies one path after the other.
pub struct Prover {
    density: Option<Arc<dyn CostDensity>>,
    /// The requested width of the interval, as a share of the cost.
    pub width: f64,
    running: Option<Proof>,
    /// How many of the paths were certified, or as well as possible.
    done: usize,
}

/// A certificate in the making.
struct Proof {
    /// Each bound is better than the one before.
    lower_bounds: Receiver<f64>,
    cancelled: Arc<AtomicBool>,
}

impl Default for Prover {
    fn default() -> Self {
        Self { density: None, width: 0.01, running: None, done: 0 }
    }
}

impl Drop for Prover {
    fn drop(&mut self) {
        self.cancel();
    }
}

impl Prover {
    /// Whether a certificate is in the making.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Ends the work at the next programme. What was proved stays with the paths.
    pub fn cancel(&mut self) {
        if let Some(proof) = self.running.take() {
            proof.cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Begins again with the same paths.
    pub fn restart(&mut self) {
        self.cancel();
        self.done = 0;
    }

    /// Begins with new paths under a cost density.
    pub fn begin(&mut self, density: Option<Arc<dyn CostDensity>>) {
        self.restart();
        self.density = density;
    }

    /// Takes the bounds that were proved, waiting up to `patience` for each, and begins the next certificate.
    pub fn advance(
        &mut self,
        mut solutions: Vec<&mut Solution>,
        domain: &Domain,
        patience: Duration,
        ctx: &Context,
    ) {
        while let Some(solution) = solutions.get_mut(self.done) {
            let Some(proof) = &self.running else {
                if solution.gap() <= self.width {
                    self.done += 1;
                } else {
                    self.running = self.start(solution, domain, ctx);
                    self.done += usize::from(self.running.is_none());
                }
                continue;
            };
            match proof.lower_bounds.recv_timeout(patience) {
                Ok(lower) => solution.tighten(lower),
                Err(RecvTimeoutError::Timeout) => return,
                Err(RecvTimeoutError::Disconnected) => {
                    self.running = None;
                    self.done += 1;
                }
            }
        }
    }

    fn start(&self, solution: &Solution, domain: &Domain, ctx: &Context) -> Option<Proof> {
        let cost = self.density.clone()?;
        let (path, upper) = (solution.points.clone(), solution.upper);
        let task = CertificateTask::in_rectangle(domain.bounds, cost, path, upper, self.width).ok()?;
        let (domain, solution, ctx) = (domain.clone(), solution.clone(), ctx.clone());
        let (sender, lower_bounds) = channel();
        let cancelled = Arc::new(AtomicBool::new(false));
        let is_cancelled = cancelled.clone();
        thread::spawn(move || {
            let task = task.in_domain(&domain);
            let Ok(mut certificate) = PathCertificate::new(&solution, &task) else { return };
            while !is_cancelled.load(Ordering::Relaxed) {
                let ended = certificate.advance();
                let is_heard = sender.send(certificate.lower()).is_ok();
                ctx.request_repaint();
                if !is_heard || !matches!(ended, Ok(None)) {
                    break;
                }
            }
            drop(sender);
            ctx.request_repaint();
        });
        Some(Proof { lower_bounds, cancelled })
    }
}
