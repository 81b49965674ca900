//! The search for the path of one leg, a step at a time: a page has no other thread, and the whole search
//! takes longer than one of its frames.

use glam::DVec2;

use super::integral::PathFigures;
use super::lower::LowerBound;
use super::march::March;
use super::obstacle::obstacle;
use super::place::MeshPlace;
use super::planner::{PathRequest, Planner};
use super::refine::{Effort, Refining, refine};
use super::shortest::{CornerSearch, Shortest};
use super::taut::is_constant_along;
use super::ways::Ways;
use super::{CostDensity, PathError, Solution, Waypoint};
use crate::mesh::Progress;

/// The tolerance with which two paths are compared.
const COMPARED: f64 = 1e-3;
/// Number of nodes of a march that take as long as an interval of a shortest way.
const INTERVALS: usize = 8;
/// Another way is worth a closer look if sketches promise that it costs less by this share.
const LEAST_GAIN: f64 = 1e-4;

/// The search for the path of a leg, after the marches from its ends.
#[derive(Clone, Debug)]
pub(super) struct LegSearch {
    leg: usize,
    ends: [MeshPlace; 2],
    request: PathRequest,
    step: LegStep,
    /// The best path so far.
    solution: Solution,
    /// Ways along which paths are searched for. The first one is that of the march from the start.
    ways: Vec<Vec<DVec2>>,
    /// The least cost of a sketch so far.
    least: f64,
}

/// What is done next.
#[derive(Clone, Debug)]
enum LegStep {
    /// Follows the march from the start.
    Trace,
    /// Makes a way smooth: the first one, or another one.
    Smooth(Box<Refining>, Option<WayCandidates>),
    /// Takes the first solution.
    Solve(Vec<DVec2>),
    /// Takes each of these paths if it costs less, the last one first, then takes that step.
    Better(Vec<Vec<DVec2>>, Box<LegStep>),
    /// Compares that with the path as it was traced: where the cost jumps, a smooth one can cost more.
    Compare,
    /// Begins to march from the goal.
    Back,
    /// Marches from the goal.
    March(Box<March>),
    /// Finds other ways.
    Ways(Box<March>),
    /// Sketches the way with this number, and takes it if it promises to cost less.
    Sketch(usize),
    /// Tries a path by way of lines that are cheaper than the triangles around them.
    Lines,
    /// Begins to look for the shortest way in the plane.
    Shortest,
    /// Looks for it.
    Corners(Box<CornerSearch>),
    /// Begins with the lower bound.
    Bound,
    /// Raises the lower bound.
    Raise(Box<LowerBound>),
}

/// A smooth path was made from a way: either may cost less than the solution.
#[derive(Clone, Debug)]
struct WayCandidates {
    way: Vec<DVec2>,
    /// Whether the smooth one is tried first.
    is_smooth_first: bool,
    next: Box<LegStep>,
}

impl WayCandidates {
    fn with(self, smooth: Vec<DVec2>) -> LegStep {
        let Self { way, is_smooth_first, next } = self;
        LegStep::Better(if is_smooth_first { vec![way, smooth] } else { vec![smooth, way] }, next)
    }
}

impl LegSearch {
    pub fn new(leg: usize, ends: [MeshPlace; 2], request: PathRequest) -> Self {
        let (step, solution) = (LegStep::Trace, Solution::default());
        Self { leg, ends, request, step, solution, ways: Vec::new(), least: f64::INFINITY }
    }

    /// Takes a step, in which a march accepts a limited number of nodes. Returns the path at the end.
    /// `places` is the number of places of the route.
    ///
    /// # Errors
    /// Fails when no march leads to the goal, or the cost of the path is not finite.
    pub fn advance(
        &mut self,
        planner: &Planner,
        density: &dyn CostDensity,
        places: usize,
        nodes: usize,
    ) -> Result<Option<Solution>, PathError> {
        let Self { ends, request, .. } = *self;
        self.step = match std::mem::replace(&mut self.step, LegStep::Bound) {
            LegStep::Trace if ends[0].point == ends[1].point => {
                let points = ends.map(|end| end.point).to_vec();
                return Ok(Some(planner.solution(points, density, request.tolerance)));
            }
            LegStep::Trace => {
                let traced = self.trace(planner, places)?;
                self.ways.push(traced.clone());
                LegStep::Smooth(self.refining(traced), None)
            }
            LegStep::Bound => match self.begin_bound(planner)? {
                Some(bound) => LegStep::Raise(Box::new(bound)),
                None => return Ok(Some(std::mem::take(&mut self.solution))),
            },
            LegStep::Raise(mut bound) => {
                match bound.raise(&planner.mesh, &planner.costs.least, ends, nodes) {
                    None => LegStep::Raise(bound),
                    Some(lower) => {
                        self.solution.lower = lower.min(self.solution.upper);
                        return Ok(Some(std::mem::take(&mut self.solution)));
                    }
                }
            }
            step => self.improve(step, planner, density, nodes),
        };
        Ok(None)
    }

    /// Takes one of the steps from the traced way to the best path. Returns the next one.
    fn improve(
        &mut self,
        step: LegStep,
        planner: &Planner,
        density: &dyn CostDensity,
        nodes: usize,
    ) -> LegStep {
        let Self { ends, request, .. } = *self;
        match step {
            LegStep::Smooth(mut refining, others) => {
                match (refining.advance(density, &planner.walls), others) {
                    (None, others) => LegStep::Smooth(refining, others),
                    (Some(smooth), Some(others)) => others.with(smooth),
                    (Some(smooth), None) => LegStep::Solve(smooth),
                }
            }
            LegStep::Solve(points) => {
                self.solution = planner.solution(points, density, request.tolerance);
                LegStep::Compare
            }
            LegStep::Compare => {
                self.take_better(planner, density, self.ways[0].clone());
                if request.effort == Effort::FULL { LegStep::Back } else { LegStep::Bound }
            }
            LegStep::Better(mut paths, next) => match paths.pop() {
                Some(path) => {
                    self.take_better(planner, density, path);
                    LegStep::Better(paths, next)
                }
                None => *next,
            },
            LegStep::Back => LegStep::March(Box::new(planner.begin_back(ends[1]))),
            LegStep::March(mut march) => match planner.march_back(&mut march, ends[0], nodes) {
                Progress::More => LegStep::March(march),
                Progress::Done => LegStep::Ways(march),
            },
            LegStep::Ways(march) => {
                self.find_ways(planner, &march);
                (self.least, _) = sketch(planner, density, &self.ways[0]);
                LegStep::Sketch(1)
            }
            LegStep::Sketch(number) if number < self.ways.len() => self.try_way(planner, density, number),
            LegStep::Sketch(_) => LegStep::Lines,
            LegStep::Lines => match planner.along_lines(density, ends, self.solution.cost) {
                Some(along) => self.smooth(along, true, LegStep::Shortest),
                None => LegStep::Shortest,
            },
            LegStep::Shortest => match self.begin_shortest(planner, density) {
                Some(search) => LegStep::Corners(Box::new(search)),
                None => LegStep::Bound,
            },
            LegStep::Corners(search) => self.go_around(search, planner, density, nodes),
            step @ (LegStep::Trace | LegStep::Bound | LegStep::Raise(_)) => step,
        }
    }

    /// Continues the search for the shortest way, and smooths the way at the end.
    fn go_around(
        &mut self,
        mut search: Box<CornerSearch>,
        planner: &Planner,
        density: &dyn CostDensity,
        nodes: usize,
    ) -> LegStep {
        if self.look_around(&mut search, planner, density, nodes / INTERVALS) == Progress::More {
            return LegStep::Corners(search);
        }
        match search.way(&planner.mesh, &planner.walls) {
            Some(way) => self.smooth(way, false, LegStep::Bound),
            None => LegStep::Bound,
        }
    }

    /// Follows the march from the start.
    pub(super) fn trace(&self, planner: &Planner, places: usize) -> Result<Vec<DVec2>, PathError> {
        planner.traced(self.leg, self.ends).ok_or_else(|| {
            let [from, to] = [self.leg, self.leg + 1].map(|index| Waypoint::of(index, places));
            obstacle(&planner.mesh, self.ends, [from, to])
        })
    }

    fn refining(&self, way: Vec<DVec2>) -> Box<Refining> {
        Box::new(Refining::new(way, self.request.effort))
    }

    /// Smooths a way, tries both, the smooth one first or last, and continues with a step.
    fn smooth(&self, way: Vec<DVec2>, is_smooth_first: bool, next: LegStep) -> LegStep {
        let next = Box::new(next);
        LegStep::Smooth(self.refining(way.clone()), Some(WayCandidates { way, is_smooth_first, next }))
    }

    /// Begins with the lower bound; `None` where none is wanted, or nothing is known.
    fn begin_bound(&self, planner: &Planner) -> Result<Option<LowerBound>, PathError> {
        let (ends, value) = (self.ends, self.solution.upper);
        if !value.is_finite() {
            return Err(PathError::CostOutOfRange { at: ends[0].point, value });
        }
        // A path through a part of the domain that no triangle covers may cost less than any that is known.
        let has_bound = self.request.has_bounds && planner.mesh.covers_domain;
        Ok(has_bound.then(|| {
            let marches = planner.partly_open_marches(self.leg);
            LowerBound::new(&planner.mesh, &planner.costs.least, ends, marches, value)
        }))
    }

    /// Takes a path in place of the solution if it costs less.
    fn take_better(&mut self, planner: &Planner, density: &dyn CostDensity, points: Vec<DVec2>) {
        // Bounds are much work: only for what promises to cost less.
        if PathFigures::new(&points, density, COMPARED).cost < self.solution.cost {
            let other = planner.solution(points, density, self.request.tolerance);
            if other.upper < self.solution.upper {
                self.solution = other;
            }
        }
    }

    /// Finds the way of the march from the goal, and those by other valleys.
    fn find_ways(&mut self, planner: &Planner, march: &March) {
        self.ways.extend(planner.traced_back(march, self.ends));
        let marches = [planner.open_marches(self.leg)[0], march];
        let Planner { mesh, walls, costs, .. } = planner;
        let others = Ways { mesh, costs: &costs.mean, walls, ends: self.ends, marches }.others(&self.ways);
        self.ways.extend(others);
    }

    /// Sketches the way with this number. Returns the next step.
    fn try_way(&mut self, planner: &Planner, density: &dyn CostDensity, number: usize) -> LegStep {
        let (promised, sketched) = sketch(planner, density, &self.ways[number]);
        let next = LegStep::Sketch(number + 1);
        if promised < self.least * (1.0 - LEAST_GAIN) {
            self.least = promised;
            return self.smooth(sketched, true, next);
        }
        next
    }

    /// Begins to search for the shortest way in the plane that is shorter than the solution, if the solution
    /// has the same cost everywhere.
    fn begin_shortest(&self, planner: &Planner, density: &dyn CostDensity) -> Option<CornerSearch> {
        let Self { ends, solution, .. } = self;
        if !is_constant_along(&solution.points, |rectangle| density.range_on_ground(rectangle)) {
            return None;
        }
        // On the Earth a longer line in the plane can be the shorter one.
        let scales = solution.points.iter().map(|&at| density.inverse_scale_at(at));
        let [least, greatest] =
            scales.fold([f64::INFINITY, 0.0_f64], |[a, b], scale| [a.min(scale), b.max(scale)]);
        Some(CornerSearch::new(&planner.mesh, &planner.walls, *ends, solution.length * (greatest / least)))
    }

    /// Looks at a limited number of intervals for the shortest way. Returns whether there is more to do.
    fn look_around(
        &self,
        search: &mut CornerSearch,
        planner: &Planner,
        density: &dyn CostDensity,
        intervals: usize,
    ) -> Progress {
        let Planner { mesh, costs, .. } = planner;
        let (first, means) = (self.ends[0].triangle, &costs.mean);
        let range = |triangle: u32| density.range_on_ground(&mesh.rectangle(triangle));
        let cost = range(first);
        let has_cost = |t: u32| means[t as usize] == means[first as usize] || range(t) == cost;
        search.advance(&Shortest { mesh, has_cost: &has_cost }, intervals.max(1))
    }
}

/// Returns what a rough path along a way costs, and the path.
fn sketch(planner: &Planner, density: &dyn CostDensity, way: &[DVec2]) -> (f64, Vec<DVec2>) {
    let sketch = refine(way, density, &planner.walls, Effort::SKETCH);
    (PathFigures::new(&sketch, density, COMPARED).cost, sketch)
}
