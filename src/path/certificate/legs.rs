use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::{Certificate, CertificateEnd, CertificateTask};
use crate::path::{PathError, PathFigures, Solution};

/// Upper bounds are above the cost by about this part of the requested width.
const TOLERANCE: f64 = 0.05;

/// Certificates of all legs of a path, from waypoint to waypoint.
#[derive(Clone)]
pub struct PathCertificate {
    legs: Vec<Certificate>,
    width: f64,
}

impl PathCertificate {
    /// The work for a solution. Path and upper bound of `task` are replaced by those of each leg.
    ///
    /// # Errors
    /// As [`Certificate::new`].
    pub fn new(solution: &Solution, task: &CertificateTask) -> Result<Self, PathError> {
        let stop: Arc<AtomicBool> = Arc::default();
        let leg = |ends: &[usize]| {
            let path = solution.points[ends[0]..=ends[1]].to_vec();
            let upper = PathFigures::of(&path, &*task.cost, TOLERANCE * task.width).upper;
            let mut leg = Certificate::new(CertificateTask { path, upper, ..task.clone() })?;
            leg.stop = Arc::clone(&stop);
            Ok(leg)
        };
        let legs = solution.stops.windows(2).map(leg).collect::<Result<_, _>>()?;
        Ok(Self { legs, width: task.width })
    }

    /// No path by way of the waypoints costs less.
    pub fn lower(&self) -> f64 {
        self.legs.iter().map(Certificate::lower).sum::<f64>() * (1.0 - 4.0 * f64::EPSILON)
    }

    /// What the known path costs, rounded up.
    pub fn upper(&self) -> f64 {
        self.legs.iter().map(Certificate::upper).sum::<f64>() * (1.0 + 4.0 * f64::EPSILON)
    }

    /// By what part of its cost the known path can be improved at most.
    pub fn width(&self) -> f64 {
        let upper = self.upper();
        if upper > 0.0 { ((upper - self.lower()) / upper).max(0.0) } else { 0.0 }
    }

    /// Why it ended; `None` while there is more to do. Where a leg falls short, the reason is that of the leg
    /// that is left with the widest interval.
    pub fn end(&self) -> Option<CertificateEnd> {
        if self.width() <= self.width {
            return Some(CertificateEnd::Reached);
        }
        if self.legs.iter().any(|leg| leg.end().is_none()) {
            return None;
        }
        self.widest(|_| true).and_then(|leg| self.legs[leg].end())
    }

    /// How many programmes were solved.
    pub fn programmes(&self) -> usize {
        self.legs.iter().map(Certificate::programmes).sum()
    }

    /// How many nodes the meshes of the last programmes had.
    pub fn nodes(&self) -> usize {
        self.legs.iter().map(Certificate::nodes).sum()
    }

    /// As [`Certificate::stop_signal`], for all legs.
    pub fn stop_signal(&self) -> Arc<AtomicBool> {
        self.legs.first().map(Certificate::stop_signal).unwrap_or_default()
    }

    /// Solves one programme, for the leg with the widest interval. Returns why all ended, or `None` if it
    /// goes on.
    ///
    /// # Errors
    /// As [`Certificate::advance`].
    pub fn advance(&mut self) -> Result<Option<CertificateEnd>, PathError> {
        if self.end().is_none()
            && let Some(leg) = self.widest(|leg| leg.end().is_none())
        {
            self.legs[leg].advance()?;
        }
        Ok(self.end())
    }

    /// The leg with the widest interval of those that count.
    fn widest(&self, counts: impl Fn(&Certificate) -> bool) -> Option<usize> {
        let width = |leg: usize| self.legs[leg].upper() - self.legs[leg].lower();
        let legs = (0..self.legs.len()).filter(|&leg| counts(&self.legs[leg]));
        legs.max_by(|&a, &b| width(a).total_cmp(&width(b)))
    }
}
