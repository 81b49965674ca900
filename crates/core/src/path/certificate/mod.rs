//! A proven lower bound of what any path costs, which tells by how many percent at most the best known path
//! exceeds the least cost.
//!
//! Let v be a subsolution of the eikonal equation, |∇v| ≤ c. Then no path from start to goal costs less than
//! v(goal) − v(start): this is weak duality. The greatest such difference is the least cost (strong duality).
//! [`Certificate`] maximizes it over continuous, piecewise quadratic functions on a small mesh of its own, as
//! a second-order cone program, and refines that mesh where the solution says that the bound loses most. Such
//! a v is a dual certificate: whoever has it can check the bound.
//!
//! ```text
//! setup       mesh with h ≤ max(h_min, 0.7 · distance from the path)
//!   ↓
//! minorant    for each triangle an affine function ℓ ≤ c     ◀──────────┐
//! edges       on each edge, too, by one of the triangles beside it      │
//! program     max v(goal) − v(start), |∇v| ≤ ℓ at all corners           │
//! proof       λ = min ℓ / |∇v|, bound = λ (v(goal) − v(start))          │
//! marking     what each triangle loses, from the flow of the dual ──────┘ bisect
//! ```
//!
//! # Why it is a bound
//!
//! 1. v is continuous and a polynomial on each closed triangle. Along a Lipschitz path γ, v∘γ is Lipschitz,
//!    and for almost every τ with γ(τ) in a triangle t, (v∘γ)′ = ∇v·γ′ with the gradient in t. Finitely many
//!    triangles cover γ, so its cost is at least ∫ |(v∘γ)′| ≥ v(goal) − v(start). This includes paths along
//!    edges and boundaries and through nodes where two parts meet.
//! 2. The gradient of v is affine, so |∇v| is convex, and with an affine ℓ ≤ c the corners decide.
//! 3. Where γ stays on an edge, its direction is that of the edge, and there the gradients of both triangles
//!    agree. So on an edge it suffices that one of the two ℓ is at most c there: a jump that follows the mesh
//!    costs nothing, and a cost that is smaller on the edge alone counts.
//!    An edge stands for a strip of some ulps, because a jump that lies on an edge in one formula lies beside
//!    it in another. Consider v∘φ, where φ moves each point by some ulps such that all strips go to their
//!    edges, and those around a node to the node. Its gradient in a strip is that along the edge, and
//!    elsewhere at most the share of ulps in a triangle greater: the bound is rounded down by that share.
//! 4. Only triangles wholly outside the domain are left out. The others allow more paths than the domain has:
//!    the bound is still one. The known path must stay in the domain for its cost to be an upper bound.
//!
//! The solver is not trusted: λ and the difference are computed from the values of v, and rounded down. If a
//! program fails, the bound of the previous ones stays.

mod clipped;
mod dual;
mod edges;
mod legs;
mod marking;
mod minorant;
mod conic_program;
mod proof;
mod quadratic;
mod setup;
mod solver;
mod task;
mod triangle;
mod under_way;

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec2;

use super::{Passage, PathError, PathMesh};
use crate::geometry::Rect;
use crate::mesh::{Limits, Mesh, Progress};
use conic_program::{ConicProgram, ConicSolution};
use marking::{bisections, estimates};
use minorant::Minorant;
use proof::proven_gain;
use quadratic::{QuadraticElement, QuadraticSpace};
use triangle::FlatTriangle;
use under_way::{ProgramStage, ProgramUnderWay, UnderWay};

pub use dual::DualFunction;
pub use legs::{LegProof, PathCertificate};
pub use task::{CertificateEnd, CertificateTask, Placement, PlacementTest};

/// Each round aims to reduce the interval by this share of the requested width.
const AIM: f64 = 0.65;
/// The accuracy to which each program is solved, as a share of the requested width.
const ACCURACY: f64 = 0.05;
/// The most triangles that are added to the mesh on which a better path is searched.
const MOST_ADDED: usize = 60_000;
/// A triangle beside a keep-out region is small for a path if its diameter is this part of the requested
/// width times the length of the path.
const SHORT_DETOUR: f64 = 0.1;
/// The width of the strip on each side of an edge, in ulps of the largest coordinate.
const STRIP_ULPS: f64 = 16.0;
/// The gradient grows by at most this factor times the width of a strip, as a share of the smallest triangle.
const STRIP_LOSS: f64 = 20.0;
/// The most work of a certificate, in nodes times steps of the solver: some ten seconds. A program that
/// would exceed it is not started. It is a count, so that every machine proves the same.
const MOST_WORK: u64 = 700_000;
/// The number of steps that the solver usually takes for a program.
const DEFAULT_STEPS: u64 = 25;
/// Number of programs in a row that hardly raise the bound after which the work ends.
const MOST_IDLE: usize = 3;

/// Raises the lower bound of what any path costs, program by program.
///
/// The state is kept between two programs, so that the work can run on a thread, report progress, be stopped,
/// and continue when a better path is known.
///
/// ```
/// use std::sync::Arc;
/// use glam::{DVec2, dvec2};
/// use meshbrush_core::path::{Certificate, CertificateEnd, CertificateTask, CostDensity, CostRange};
/// use meshbrush_mesh::geometry::Rect;
///
/// /// 1 everywhere: the least cost is the distance.
/// struct One;
/// impl CostDensity for One {
///     fn at(&self, _: DVec2) -> f64 { 1.0 }
///     fn range(&self, _: &Rect) -> CostRange { CostRange { least: 1.0, greatest: 1.0 } }
/// }
/// let path = vec![dvec2(0.1, 0.2), dvec2(0.9, 0.8)];
/// let task = CertificateTask::in_rectangle(Rect::UNIT, Arc::new(One), path, 1.0, 0.001)?;
/// let mut certificate = Certificate::new(task)?;
/// while certificate.advance()?.is_none() {}
/// assert_eq!(certificate.end(), Some(CertificateEnd::Reached));
/// assert!(certificate.lower() <= 1.0 && certificate.lower() >= 0.999);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(alias = "dual certificate")]
#[derive(Clone)]
pub struct Certificate {
    task: CertificateTask,
    mesh: Mesh,
    /// The bounds of the cost density in each triangle, by its id, with the level that it had then.
    minorants: Vec<Option<(u32, Minorant)>>,
    lower: f64,
    /// What proves the lower bound.
    dual: Option<Arc<DualFunction>>,
    programs: usize,
    nodes: usize,
    /// The work of all programs so far: nodes times steps of the solver.
    work: u64,
    /// Programmes in a row that hardly raised the bound.
    idle: usize,
    end: Option<CertificateEnd>,
    stop: Arc<AtomicBool>,
    under_way: UnderWay,
}

impl Certificate {
    /// Returns the work for a task. The first bound comes with the first program.
    ///
    /// # Errors
    /// Fails when start or goal lie outside the domain or apart, or the grid is too fine for a certificate.
    pub fn new(task: CertificateTask) -> Result<Self, PathError> {
        task.check()?;
        let end = (task.start() == task.goal()).then_some(CertificateEnd::Reached);
        let mesh = setup::graded_mesh(&task)?;
        setup::reachable(&mesh, &task)?;
        Ok(Self {
            task,
            mesh,
            minorants: Vec::new(),
            lower: 0.0,
            dual: None,
            programs: 0,
            nodes: 0,
            work: 0,
            idle: 0,
            end,
            stop: Arc::default(),
            under_way: UnderWay::default(),
        })
    }

    /// Returns the proved lower bound: no path costs less.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// Returns the function that proves the lower bound; `None` before the first bound.
    pub(super) fn dual(&self) -> Option<&Arc<DualFunction>> {
        self.dual.as_ref()
    }

    /// Returns the cost of the known path.
    pub fn upper(&self) -> f64 {
        self.task.upper
    }

    /// Returns the largest share of its cost by which the known path can be improved: (upper − lower) /
    /// upper.
    pub fn width(&self) -> f64 {
        if self.task.upper > 0.0 { (self.task.upper - self.lower).max(0.0) / self.task.upper } else { 0.0 }
    }

    /// Returns how many programs were solved.
    pub fn programs(&self) -> usize {
        self.programs
    }

    /// Returns how many nodes the mesh of the last program had.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Returns why it ended; `None` while there is more to do.
    pub fn end(&self) -> Option<CertificateEnd> {
        self.end
    }

    /// Set to true from any thread, it stops the program under way within one of its iterations.
    /// [`Self::advance`] then returns at once, and does nothing until it is false again.
    pub fn stop_signal(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    /// Takes a better path, which becomes the upper bound: work that had ended may continue.
    pub fn improve(&mut self, path: Vec<DVec2>, upper: f64) {
        let joins = [path.first(), path.last()] == [self.task.path.first(), self.task.path.last()];
        if joins && upper < self.task.upper && upper > 0.0 {
            self.task.path = path;
            self.task.upper = upper;
            self.under_way = UnderWay::default();
            self.idle = 0;
            self.end = (self.width() <= self.task.width).then_some(CertificateEnd::Reached);
        }
    }

    /// Solves one program, and refines the mesh for the next. Returns why it ended, or `None` if it goes
    /// on.
    ///
    /// # Errors
    /// Fails when the cost has no positive lower bound somewhere, or the finer mesh shows that no path leads
    /// from start to goal.
    pub fn advance(&mut self) -> Result<Option<CertificateEnd>, PathError> {
        while self.advance_slice()? == Progress::More {}
        Ok(self.end)
    }

    /// Does a slice of [`Self::advance`], some milliseconds on one thread. It is done once the program is
    /// solved and the mesh refined, or the work has ended or was told to stop.
    ///
    /// # Errors
    /// Fails as [`Self::advance`] does.
    pub fn advance_slice(&mut self) -> Result<Progress, PathError> {
        if self.end.is_some() || self.stop.load(Ordering::Relaxed) {
            self.under_way = UnderWay::default();
            return Ok(Progress::Done);
        }
        let Some((work, stage)) = self.under_way.take() else { return self.begin_programme() };
        let next = match stage {
            ProgramStage::Minorants(mut found) => match self.find_minorants(&work, &mut found) {
                Progress::More => ProgramStage::Minorants(found),
                Progress::Done => ProgramStage::Edges(found),
            },
            ProgramStage::Edges(found) => ProgramStage::Begin(self.minorants_of(&work.space, found)?),
            ProgramStage::Begin(minorants) => match self.program(&work, &minorants).solver() {
                Some(solver) => ProgramStage::Solve(minorants, Box::new(solver)),
                None => return Ok(self.solver_failed()),
            },
            ProgramStage::Solve(minorants, mut solver) => match solver.advance() {
                Progress::More => ProgramStage::Solve(minorants, solver),
                Progress::Done => match self.program(&work, &minorants).solution(&solver) {
                    Some(solution) => ProgramStage::Solved(minorants, solution),
                    None => return Ok(self.solver_failed()),
                },
            },
            ProgramStage::Solved(minorants, solution) => {
                self.take(&work, &minorants, &solution);
                return Ok(Progress::Done);
            }
        };
        self.under_way = UnderWay::new(work, next);
        Ok(Progress::More)
    }

    /// Finds the triangles of the next program.
    fn begin_programme(&mut self) -> Result<Progress, PathError> {
        let kept = setup::reachable(&self.mesh, &self.task)?;
        let space = QuadraticSpace::new(&self.mesh, &kept.triangles);
        if self.work + (space.nodes as u64) * DEFAULT_STEPS > MOST_WORK {
            self.end = Some(CertificateEnd::TooLarge);
            return Ok(Progress::Done);
        }
        self.minorants.resize(self.mesh.raw_triangle_count(), None);
        let gain = gain_weights(&space.elements[kept.start], &space.elements[kept.goal], &self.task);
        let next = ProgramStage::Minorants(Vec::with_capacity(space.elements.len()));
        self.under_way = UnderWay::new(ProgramUnderWay { kept, space, gain }, next);
        Ok(Progress::More)
    }

    fn program<'a>(&self, work: &'a ProgramUnderWay, minorants: &'a [Minorant]) -> ConicProgram<'a> {
        let ProgramUnderWay { kept, space, gain } = work;
        ConicProgram {
            space,
            minorants,
            gain,
            pinned: space.elements[kept.start].values[0],
            unit: self.task.upper,
            accuracy: (ACCURACY * self.task.width).clamp(1e-8, 1e-4),
        }
    }

    fn solver_failed(&mut self) -> Progress {
        self.end = Some(CertificateEnd::SolverFailed);
        Progress::Done
    }

    /// Takes the bound of a solution, and refines the mesh for the next program.
    fn take(&mut self, work: &ProgramUnderWay, minorants: &[Minorant], solution: &ConicSolution) {
        let ProgramUnderWay { kept, space, gain } = work;
        self.programs += 1;
        self.nodes = space.nodes;
        self.work += (space.nodes as u64) * u64::from(solution.steps);
        let before = self.width();
        let proved = proven_gain(space, minorants, &solution.function, gain);
        let lower = (proved.gain * self.without_strips(space)).min(self.task.upper);
        if lower > self.lower {
            self.lower = lower;
            self.dual = Some(Arc::new(DualFunction::new(space, minorants, solution, proved.scale)));
        }
        let estimates = estimates(space, minorants, solution, kept);
        let lost = estimates.iter().sum::<f64>() / self.task.upper;
        self.end = self.reason_to_end(before, lost);
        if self.end.is_none() {
            self.refine(space, minorants, &estimates, lost);
        }
    }

    /// `before` is the width before the last program, `lost` what the estimates say of the width now.
    fn reason_to_end(&mut self, before: f64, lost: f64) -> Option<CertificateEnd> {
        let width = self.width();
        if width <= self.task.width {
            return Some(CertificateEnd::Reached);
        }
        self.idle = if width < 0.98 * before { 0 } else { self.idle + 1 };
        // Even a lossless bound would not reach the width; estimates may be off by a factor of 2.
        let upper_limits = width - 2.0 * lost > self.task.width;
        if self.idle >= MOST_IDLE || (upper_limits && lost < 0.5 * self.task.width) {
            let reason =
                if upper_limits { CertificateEnd::UpperBoundLimits } else { CertificateEnd::NoMoreGain };
            return Some(reason);
        }
        (self.nodes >= self.task.most_nodes).then_some(CertificateEnd::TooLarge)
    }

    /// Bisects the triangles that lose most. `lost` is what all lose, as a part of the upper bound.
    fn refine(&mut self, space: &QuadraticSpace, minorants: &[Minorant], estimates: &[f64], lost: f64) {
        // What no refinement changes, as far as the estimates can be trusted.
        let fixed = (self.width() - lost).clamp(0.0, 0.5 * self.task.width);
        let aim = (AIM * (self.task.width - fixed)).min(0.5 * lost);
        let deepest = self.mesh.lattice().deepest_level();
        let mut wanted: Vec<u32> = self.mesh.raw_triangles().iter().map(|t| t.level()).collect();
        // There are twice as many triangles as nodes, and the last program may have some more.
        let most = 5 * self.task.most_nodes / 2;
        let bisections = bisections(estimates, minorants, aim * self.task.upper, most);
        for (element, more) in space.elements.iter().zip(bisections) {
            let level = &mut wanted[element.id.index()];
            *level = (*level + more).min(deepest);
        }
        let before = self.mesh.clone();
        let limits = Limits { max_triangles: 8 * self.task.most_nodes, ..Limits::default() };
        let refined = self.mesh.refine(&limits, |element| {
            let ancestor = before.locate(FlatTriangle::new(element.world_corners()).centroid()).triangle();
            ancestor.is_some_and(|id| element.triangle.level() < wanted[id.index()])
        });
        if refined.is_err() {
            self.end = Some(CertificateEnd::TooLarge);
        }
    }

    /// Bisects a mesh for paths until it is as fine everywhere as the certificate's mesh, which is fine where
    /// paths that nearly are the best may go. Where the known path passes a keep-out region, it is bisected
    /// until a detour around the triangles that the region touches is short for the requested width.
    fn refine_like(&self, mesh: &mut PathMesh) {
        let length: f64 = self.task.path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let short = SHORT_DETOUR * self.task.width * length;
        let excess = |mesh: &PathMesh, triangle: u32| {
            let centroid = FlatTriangle::new(mesh.corners(triangle)).centroid();
            let within = self.mesh.locate(centroid).triangle();
            let mut enough = within.map_or(f64::INFINITY, |id| {
                FlatTriangle::new(self.mesh.world_corners(id)).diameter() * (1.0 + 1e-9)
            });
            let diameter = mesh.diameter(triangle);
            if mesh.passage(triangle) == Passage::Partly
                && diameter > short
                && setup::distance_from(&self.task.path, centroid) <= 2.0 * diameter
            {
                enough = enough.min(short);
            }
            if diameter > enough { diameter - enough } else { 0.0 }
        };
        let all = 0..mesh.triangle_count() as u32;
        let wanted = all.map(|t| (excess(mesh, t), t)).filter(|wanted| wanted.0 > 0.0).collect();
        let Ok(()) = mesh.bisect(wanted, MOST_ADDED, |mesh, t| Ok::<_, Infallible>(excess(mesh, t)));
    }

    /// Returns half the width of the strips around edges, in world units.
    fn inset(&self) -> f64 {
        let Rect { min, max } = self.mesh.lattice().bounds();
        let largest = min.abs().max(max.abs()).max_element();
        STRIP_ULPS * (largest.next_up() - largest)
    }

    /// Returns the factor that rounds a bound down for the strips around edges.
    fn without_strips(&self, space: &QuadraticSpace) -> f64 {
        let diameters = space.elements.iter().map(|element| element.flat.diameter());
        (1.0 - STRIP_LOSS * self.inset() / diameters.fold(f64::INFINITY, f64::min)).max(0.0)
    }
}

/// Returns the functional v(goal) − v(start), as weights of values.
fn gain_weights(
    start: &QuadraticElement,
    goal: &QuadraticElement,
    task: &CertificateTask,
) -> Vec<(u32, f64)> {
    let weights = |element: &QuadraticElement, point, sign: f64| {
        element.values.into_iter().zip(element.weights_at(point).map(|weight| sign * weight))
    };
    weights(goal, task.goal(), 1.0).chain(weights(start, task.start(), -1.0)).collect()
}
