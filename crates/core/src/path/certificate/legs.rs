use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::DVec2;

use super::{Certificate, CertificateEnd, CertificateTask, DualFunction};
use crate::mesh::Progress;
use crate::path::{CostDensity, PathError, PathMesh, PathRequest, PathSearch, Planner, Solution};

/// Upper bounds are above the cost by about this part of the requested width.
const TOLERANCE: f64 = 0.05;
/// A better path lowers the upper bound by at least this part of the requested width.
const LEAST_GAIN: f64 = 0.02;
/// How often a better path is sought for each leg.
const MOST_SEARCHES: usize = 4;

/// Certificates of all legs of a path, from waypoint to waypoint.
///
/// Where a leg ends short of the requested width, a better path may exist: it is searched for on the mesh of
/// [`Self::with_search`], made as fine as the certificate's mesh, and the certificate continues with it.
#[derive(Clone)]
pub struct PathCertificate {
    legs: Vec<Leg>,
    cost: Arc<dyn CostDensity>,
    width: f64,
    mesh: Option<Arc<PathMesh>>,
    /// The search for a better path of the leg with the widest interval.
    seeking: Option<Seeking>,
}

/// A search for a better path of a leg.
#[derive(Clone)]
enum Seeking {
    /// Through this mesh.
    Through(Arc<PathMesh>),
    With(Box<Planner>, PathSearch),
}

#[derive(Clone)]
struct Leg {
    certificate: Certificate,
    /// The best path that is known.
    solution: Solution,
    /// How often a better one may still be sought.
    searches: usize,
}

/// What is proved of a leg, and what proves it.
#[derive(Clone, Debug)]
pub struct LegProof {
    /// The best path that is known, in world units, from the start of the leg to its goal.
    pub path: Vec<DVec2>,
    /// No path costs less.
    pub lower: f64,
    /// What the path costs, rounded up.
    pub upper: f64,
    /// The function that proves the lower bound; `None` where that is 0.
    pub dual: Option<Arc<DualFunction>>,
}

impl PathCertificate {
    /// Returns the work for a solution. Path and upper bound of `task` are replaced by those of each leg.
    ///
    /// # Errors
    /// Fails as [`Certificate::new`] does.
    pub fn new(solution: &Solution, task: &CertificateTask) -> Result<Self, PathError> {
        let stop: Arc<AtomicBool> = Arc::default();
        let count = solution.stops.len();
        let leg = |(number, ends): (usize, &[usize])| {
            let path = solution.points[ends[0]..=ends[1]].to_vec();
            let walls = solution.walls.get(number).into_iter().cloned().collect();
            let figures = Solution::new(path.clone(), &*task.cost, TOLERANCE * task.width);
            let solution = Solution { walls, ..figures };
            let upper = solution.upper;
            let mut certificate = Certificate::new(CertificateTask { path, upper, ..task.clone() })
                .map_err(|error| error.of_leg(number, count))?;
            certificate.stop = Arc::clone(&stop);
            Ok(Leg { certificate, solution, searches: MOST_SEARCHES })
        };
        let legs = solution.stops.windows(2).enumerate().map(leg).collect::<Result<_, _>>()?;
        Ok(Self { legs, cost: Arc::clone(&task.cost), width: task.width, mesh: None, seeking: None })
    }

    /// Returns this work with a search for better paths through the open triangles of a mesh.
    pub fn with_search(self, mesh: Arc<PathMesh>) -> Self {
        Self { mesh: Some(mesh), ..self }
    }

    /// Returns the proved lower bound: no path through the waypoints costs less.
    pub fn lower(&self) -> f64 {
        self.legs.iter().map(|leg| leg.certificate.lower()).sum::<f64>() * (1.0 - 4.0 * f64::EPSILON)
    }

    /// Returns the cost of the known path, rounded up.
    pub fn upper(&self) -> f64 {
        self.legs.iter().map(|leg| leg.certificate.upper()).sum::<f64>() * (1.0 + 4.0 * f64::EPSILON)
    }

    /// Returns the best path that is known, with the bound so far.
    pub fn solution(&self) -> Solution {
        let mut solution = Solution::joined(self.legs.iter().map(|leg| leg.solution.clone()));
        solution.tighten(self.lower());
        solution
    }

    /// Returns what is proved of each leg. The bounds of the whole path are sums of theirs, rounded.
    pub fn proofs(&self) -> Vec<LegProof> {
        let proof = |Leg { certificate, .. }: &Leg| LegProof {
            path: certificate.task.path.clone(),
            lower: certificate.lower(),
            upper: certificate.upper(),
            dual: certificate.dual().cloned(),
        };
        self.legs.iter().map(proof).collect()
    }

    /// Returns the largest share of its cost by which the known path can be improved.
    pub fn width(&self) -> f64 {
        let upper = self.upper();
        if upper > 0.0 { ((upper - self.lower()) / upper).max(0.0) } else { 0.0 }
    }

    /// Returns why it ended; `None` while there is more to do. Where a leg falls short, the reason is that of
    /// the leg that is left with the widest interval.
    pub fn end(&self) -> Option<CertificateEnd> {
        if self.width() <= self.width {
            return Some(CertificateEnd::Reached);
        }
        if self.widest(|leg| self.has_more(leg)).is_some() {
            return None;
        }
        self.widest(|_| true).and_then(|leg| self.legs[leg].certificate.end())
    }

    /// Returns how many programs were solved.
    pub fn programs(&self) -> usize {
        self.legs.iter().map(|leg| leg.certificate.programs()).sum()
    }

    /// Returns how many nodes the meshes of the last programs had.
    pub fn nodes(&self) -> usize {
        self.legs.iter().map(|leg| leg.certificate.nodes()).sum()
    }

    /// Returns a signal that stops the work on all legs, like [`Certificate::stop_signal`].
    pub fn stop_signal(&self) -> Arc<AtomicBool> {
        self.legs.first().map(|leg| leg.certificate.stop_signal()).unwrap_or_default()
    }

    /// Solves one program, or takes a step of the search for a better path, for the leg with the widest
    /// interval. Returns why all ended, or `None` if it goes on.
    ///
    /// # Errors
    /// Fails as [`Certificate::advance`] does.
    pub fn advance(&mut self) -> Result<Option<CertificateEnd>, PathError> {
        while self.advance_slice()? == Progress::More {}
        Ok(self.end())
    }

    /// Does a slice of [`Self::advance`]. It is done once a program is solved or a step of a search taken,
    /// or there is nothing more to do.
    ///
    /// # Errors
    /// Fails as [`Certificate::advance`] does.
    pub fn advance_slice(&mut self) -> Result<Progress, PathError> {
        if self.end().is_none()
            && let Some(leg) = self.widest(|leg| self.has_more(leg))
        {
            let count = self.legs.len() + 1;
            let certificate = &mut self.legs[leg].certificate;
            match certificate.end() {
                None => return certificate.advance_slice().map_err(|error| error.of_leg(leg, count)),
                Some(_) => self.seeking = self.seek(leg),
            }
        }
        Ok(Progress::Done)
    }

    /// Returns whether a leg can be certified further, or whether a better path can be searched for.
    fn has_more(&self, leg: &Leg) -> bool {
        match leg.certificate.end() {
            None => true,
            Some(CertificateEnd::Reached) => false,
            Some(_) => self.mesh.is_some() && leg.searches > 0,
        }
    }

    /// Takes a step of the search for a better path of a leg, on a mesh that is as fine as the certificate's.
    /// Returns what is left of it.
    fn seek(&mut self, leg: usize) -> Option<Seeking> {
        let Leg { certificate, solution, searches } = &mut self.legs[leg];
        let found = match self.seeking.take() {
            None => {
                let mut mesh = self.mesh.clone()?;
                certificate.refine_like(Arc::make_mut(&mut mesh));
                return Some(Seeking::Through(mesh));
            }
            Some(Seeking::Through(mesh)) => {
                let tolerance = TOLERANCE * self.width;
                let request = PathRequest { has_bounds: false, tolerance, ..PathRequest::FULL };
                let ends = [certificate.task.start(), certificate.task.goal()];
                let begun = Planner::new(mesh, &*self.cost).and_then(|planner| {
                    PathSearch::new(&planner, &ends, request).map(|search| (Box::new(planner), search))
                });
                match begun {
                    Ok((planner, search)) => return Some(Seeking::With(planner, search)),
                    Err(_) => None,
                }
            }
            Some(Seeking::With(mut planner, mut search)) => {
                match search.advance(&mut planner, &*self.cost, PathSearch::NODES_AT_ONCE) {
                    Ok(None) => return Some(Seeking::With(planner, search)),
                    Ok(found) => found,
                    Err(_) => None,
                }
            }
        };
        match found {
            Some(found) if found.upper < solution.upper * (1.0 - LEAST_GAIN * self.width) => {
                certificate.improve(found.points.clone(), found.upper);
                *solution = found;
                *searches -= 1;
            }
            // The same search would find the same again.
            _ => *searches = 0,
        }
        None
    }

    /// Returns the leg with the widest interval of those that count.
    fn widest(&self, counts: impl Fn(&Leg) -> bool) -> Option<usize> {
        let width = |leg: usize| {
            let certificate = &self.legs[leg].certificate;
            certificate.upper() - certificate.lower()
        };
        let legs = (0..self.legs.len()).filter(|&leg| counts(&self.legs[leg]));
        legs.max_by(|&a, &b| width(a).total_cmp(&width(b)))
    }
}
