//! The search for the path of one leg, a step at a time: a page has no other thread, and all steps take
//! longer than one of its frames.

use glam::DVec2;

use super::integral::PathFigures;
use super::lower::LowerBound;
use super::march::March;
use super::obstacle::obstacle;
use super::place::Place;
use super::planner::{PathRequest, Planner};
use super::refine::{Effort, refine};
use super::shortest::{CornerSearch, Shortest};
use super::taut::is_constant_along;
use super::ways::Ways;
use super::{CostDensity, PathError, Solution, Waypoint};
use crate::mesh::Progress;

/// The tolerance with which two paths are compared.
const COMPARED: f64 = 1e-3;
/// An interval of a shortest way takes as long as so many nodes of a march.
const INTERVALS: usize = 8;
/// Another way is worth a closer look if sketches promise that it costs less by this share.
const LEAST_GAIN: f64 = 1e-4;

/// The search for the path of a leg, after the marches from its ends.
#[derive(Clone, Debug)]
pub(super) struct LegSearch {
    leg: usize,
    ends: [Place; 2],
    request: PathRequest,
    step: Step,
    /// The best path so far.
    solution: Solution,
    /// Ways along which paths are sought. The first one is that of the march from the start.
    ways: Vec<Vec<DVec2>>,
    /// The least cost of a sketch so far.
    least: f64,
}

/// What is done next.
#[derive(Clone, Debug)]
enum Step {
    /// Follows the march from the start, and makes the path smooth.
    Trace,
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
    /// Tries it.
    Take(Vec<DVec2>),
    /// Begins with the lower bound.
    Bound,
    /// Raises the lower bound.
    Raise(Box<LowerBound>),
}

impl LegSearch {
    pub fn new(leg: usize, ends: [Place; 2], request: PathRequest) -> Self {
        let (step, solution) = (Step::Trace, Solution::default());
        Self { leg, ends, request, step, solution, ways: Vec::new(), least: f64::INFINITY }
    }

    /// Takes a step, in which a march accepts at most so many nodes. Returns the path at the end. `places` is
    /// the number of places of the route.
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
        self.step = match std::mem::replace(&mut self.step, Step::Bound) {
            Step::Trace if ends[0].point == ends[1].point => {
                let points = ends.map(|end| end.point).to_vec();
                return Ok(Some(planner.solution(points, density, request.tolerance)));
            }
            Step::Trace => {
                self.trace(planner, density, places)?;
                Step::Compare
            }
            Step::Compare => {
                self.take_better(planner, density, self.ways[0].clone());
                if request.effort == Effort::FULL { Step::Back } else { Step::Bound }
            }
            Step::Back => Step::March(Box::new(planner.begin_back(ends[1]))),
            Step::March(mut march) => match planner.march_back(&mut march, ends[0], nodes) {
                Progress::More => Step::March(march),
                Progress::Done => Step::Ways(march),
            },
            Step::Ways(march) => {
                self.find_ways(planner, &march);
                (self.least, _) = sketch(planner, density, &self.ways[0]);
                Step::Sketch(1)
            }
            Step::Sketch(number) if number < self.ways.len() => {
                self.try_way(planner, density, number);
                Step::Sketch(number + 1)
            }
            Step::Sketch(_) => Step::Lines,
            Step::Lines => self.try_lines(planner, density),
            Step::Shortest => match self.begin_shortest(planner, density) {
                Some(search) => Step::Corners(Box::new(search)),
                None => Step::Bound,
            },
            Step::Corners(search) => self.go_around(search, planner, density, nodes / INTERVALS),
            Step::Take(points) => self.try_shortest(planner, density, points),
            Step::Bound => match self.begin_bound(planner)? {
                Some(bound) => Step::Raise(Box::new(bound)),
                None => return Ok(Some(std::mem::take(&mut self.solution))),
            },
            Step::Raise(mut bound) => match bound.raise(&planner.mesh, &planner.costs.least, ends, nodes) {
                None => Step::Raise(bound),
                Some(lower) => {
                    self.solution.lower = lower.min(self.solution.upper);
                    return Ok(Some(std::mem::take(&mut self.solution)));
                }
            },
        };
        Ok(None)
    }

    /// Follows the march from the start, and makes the path smooth.
    fn trace(
        &mut self,
        planner: &Planner,
        density: &dyn CostDensity,
        places: usize,
    ) -> Result<(), PathError> {
        let Some(traced) = planner.traced(self.leg, self.ends) else {
            let [from, to] = [self.leg, self.leg + 1].map(|index| Waypoint::of(index, places));
            return Err(obstacle(&planner.mesh, self.ends, [from, to]));
        };
        let refined = refined(planner, density, &traced, self.request);
        self.solution = planner.solution(refined, density, self.request.tolerance);
        self.ways.push(traced);
        Ok(())
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
        if PathFigures::of(&points, density, COMPARED).cost < self.solution.cost {
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

    /// Takes a path along another way if it costs less.
    fn try_way(&mut self, planner: &Planner, density: &dyn CostDensity, number: usize) {
        let (promised, sketched) = sketch(planner, density, &self.ways[number]);
        if promised < self.least * (1.0 - LEAST_GAIN) {
            self.least = promised;
            let refined = refined(planner, density, &sketched, self.request);
            self.take_better(planner, density, refined);
            self.take_better(planner, density, sketched);
        }
    }

    /// Takes a path along lines that are cheaper than the triangles around them if it costs less.
    fn try_lines(&mut self, planner: &Planner, density: &dyn CostDensity) -> Step {
        if let Some(along) = planner.along_lines(density, self.ends, self.solution.cost) {
            let refined = refined(planner, density, &along, self.request);
            self.take_better(planner, density, refined);
            self.take_better(planner, density, along);
        }
        Step::Shortest
    }

    /// Takes the shortest way if it costs less.
    fn try_shortest(&mut self, planner: &Planner, density: &dyn CostDensity, way: Vec<DVec2>) -> Step {
        let refined = refined(planner, density, &way, self.request);
        self.take_better(planner, density, way);
        self.take_better(planner, density, refined);
        Step::Bound
    }

    /// Begins to look for the shortest way in the plane that is shorter than the solution, if that has one
    /// cost all along.
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

    /// Looks at most at so many intervals for the shortest way.
    fn go_around(
        &self,
        mut search: Box<CornerSearch>,
        planner: &Planner,
        density: &dyn CostDensity,
        intervals: usize,
    ) -> Step {
        let Planner { mesh, costs, walls, .. } = planner;
        let (first, means) = (self.ends[0].triangle, &costs.mean);
        let range = |triangle: u32| density.range_on_ground(&mesh.rectangle(triangle));
        let cost = range(first);
        let has_cost = |t: u32| means[t as usize] == means[first as usize] || range(t) == cost;
        match search.advance(&Shortest { mesh, has_cost: &has_cost }, intervals.max(1)) {
            Progress::More => Step::Corners(search),
            Progress::Done => search.way(mesh, walls).map_or(Step::Bound, Step::Take),
        }
    }
}

/// Returns a smooth path along a way.
fn refined(planner: &Planner, density: &dyn CostDensity, way: &[DVec2], request: PathRequest) -> Vec<DVec2> {
    refine(way, density, &planner.walls, request.effort)
}

/// Returns what a rough path along a way costs, and the path.
fn sketch(planner: &Planner, density: &dyn CostDensity, way: &[DVec2]) -> (f64, Vec<DVec2>) {
    let sketch = refine(way, density, &planner.walls, Effort::SKETCH);
    (PathFigures::of(&sketch, density, COMPARED).cost, sketch)
}
