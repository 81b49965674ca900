//! Finds paths on a mesh, and keeps what it knows for the next one.

use std::sync::Arc;

use glam::DVec2;

use super::integral::PathFigures;
use super::lines::Lines;
use super::lower::LowerBound;
use super::march::{March, Seed};
use super::obstacle::obstacle;
use super::path_mesh::PathMesh;
use super::place::Place;
use super::refine::{Effort, refine};
use super::shortest::Shortest;
use super::taut::is_constant_along;
use super::trace::{trace, trace_by_nodes};
use super::triangle_costs::TriangleCosts;
use super::walls::Walls;
use super::ways::Ways;
use super::{CostDensity, Passage, PathError, Solution, Waypoint};
use crate::geometry::Rect;

/// The requirements of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathRequest {
    /// How much work goes into the path.
    pub effort: Effort,
    /// Whether a lower bound is computed.
    pub has_bounds: bool,
    /// The upper bound is above the integral of the cost by about this share.
    pub tolerance: f64,
}

impl PathRequest {
    /// A path as good as it gets, with bounds.
    pub const FULL: Self = Self { effort: Effort::FULL, has_bounds: true, tolerance: 2e-5 };
    /// A path for one frame, without a lower bound.
    pub const LIVE: Self = Self { effort: Effort::LIVE, has_bounds: false, tolerance: 2e-3 };
}

/// The tolerance with which two paths are compared.
const COMPARED: f64 = 1e-3;
/// Another way is worth a closer look if sketches promise that it costs less by this share.
const LEAST_GAIN: f64 = 1e-4;

/// Finds paths of least cost on one mesh.
///
/// The mesh is bisected further where the cost varies much within a triangle. The path follows the march with
/// the mean cost of each triangle, and bounds the marches with its least cost.
///
/// The marches from the waypoints are kept: another path between the same places, after the cost changed in
/// some triangles, computes again only what the change can reach.
#[derive(Clone, Debug)]
pub struct Planner {
    mesh: Arc<PathMesh>,
    walls: Arc<Walls>,
    adaptation: Option<Adaptation>,
    costs: TriangleCosts,
    /// Marches with mean costs through open triangles, one for each waypoint.
    origins: Vec<Origin>,
    /// Marches with least costs through all triangles that are not closed, one for each waypoint.
    origins_for_bounds: Vec<Origin>,
    bound: LowerBound,
}

/// The mesh from which a planner's mesh was bisected.
#[derive(Clone, Debug)]
struct Adaptation {
    /// The mesh that the planner was made with.
    base: Arc<PathMesh>,
    /// Whether the cost changed since the mesh was bisected for it.
    is_outdated: bool,
}

/// A march from a waypoint.
#[derive(Clone, Debug, Default)]
pub(super) struct Origin {
    pub march: March,
    place: Option<Place>,
    seeds: Vec<Seed>,
    /// Whether the values are those of the costs as they are.
    is_current: bool,
    /// Whether the costs changed: then they will again, and only a march to the end can follow.
    follows: bool,
}

impl Origin {
    /// Marches from a place, as far as that is not done. `until`: only to the corners of that place's
    /// triangle, unless the costs change again and again.
    fn run(&mut self, mesh: &PathMesh, costs: &[f64], least: Passage, place: Place, until: Option<Place>) {
        let seeds = place.seeds(mesh, costs);
        let is_same_place = self.place == Some(place);
        let to_the_end = is_same_place && self.follows;
        let until = until.filter(|_| !to_the_end).map(|place| place.corner_nodes(mesh));
        if self.is_current && is_same_place && self.seeds == seeds {
            return self.march.go_on(mesh, costs, least, until);
        }
        self.march.run(mesh, costs, least, &seeds, until);
        self.follows = to_the_end;
        (self.place, self.seeds, self.is_current) = (Some(place), seeds, true);
    }

    /// Follows changed costs; what cannot be followed is marched again later.
    fn follow(&mut self, mesh: &PathMesh, costs: &[f64], least: Passage, changed: &[u32]) {
        let seeds = self.place.map(|place| place.seeds(mesh, costs));
        self.follows = true;
        if self.is_current && self.march.is_complete() && seeds.as_ref() == Some(&self.seeds) {
            self.march.resolve(mesh, costs, least, &self.seeds, changed);
        } else {
            self.is_current = false;
        }
    }
}

impl Planner {
    /// Creates a planner for a mesh and a cost density.
    ///
    /// # Errors
    /// Fails when the cost is zero, negative, NaN or infinite somewhere.
    pub fn new(mesh: impl Into<Arc<PathMesh>>, density: &dyn CostDensity) -> Result<Self, PathError> {
        let base = mesh.into();
        let mut mesh = Arc::clone(&base);
        let costs = TriangleCosts::on_adapted(&mut mesh, density)?;
        let adaptation = Some(Adaptation { base, is_outdated: false });
        Ok(Self { adaptation, ..Self::with_costs(mesh, costs) })
    }

    /// Creates a planner that uses the mesh without further bisections.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does.
    pub fn on_mesh(mesh: impl Into<Arc<PathMesh>>, density: &dyn CostDensity) -> Result<Self, PathError> {
        let mesh = mesh.into();
        let costs = mesh.costs(density)?;
        Ok(Self::with_costs(mesh, costs))
    }

    fn with_costs(mesh: Arc<PathMesh>, costs: TriangleCosts) -> Self {
        let walls = Arc::new(Walls::new(&mesh));
        let (origins, origins_for_bounds) = Default::default();
        let bound = LowerBound::default();
        Self { mesh, walls, adaptation: None, costs, origins, origins_for_bounds, bound }
    }

    /// Returns the triangles that paths go through: those of the mesh that the planner was made with, or
    /// parts of them.
    pub fn mesh(&self) -> &Arc<PathMesh> {
        &self.mesh
    }

    /// Returns the cost of each triangle.
    pub fn costs(&self) -> &TriangleCosts {
        &self.costs
    }

    /// Follows a change of the cost inside rectangles in world units: paths are then those of a new planner.
    /// Where the mesh would be bisected in another way for the new cost, it is one.
    ///
    /// # Errors
    /// Fails when the new cost is zero, negative, NaN or infinite somewhere; then nothing changes.
    pub fn update(&mut self, density: &dyn CostDensity, areas: &[Rect]) -> Result<(), PathError> {
        if let Some(Adaptation { base, is_outdated }) = &self.adaptation {
            let is_bisected = !Arc::ptr_eq(base, &self.mesh) && !base.meeting(areas).is_empty();
            if *is_outdated || is_bisected || base.wants_adapting(density, areas)? {
                *self = Self::new(Arc::clone(base), density)?;
                return Ok(());
            }
        }
        self.change_costs(density, areas).map(|_| ())
    }

    /// Follows a change of the cost as [`Self::update`] does, at once and on the mesh as it is: for paths
    /// that are shown while something is dragged.
    ///
    /// # Errors
    /// Fails as [`Self::update`] does.
    pub fn follow(&mut self, density: &dyn CostDensity, areas: &[Rect]) -> Result<(), PathError> {
        let has_changed = self.change_costs(density, areas)?;
        if let Some(adaptation) = &mut self.adaptation {
            adaptation.is_outdated |= has_changed;
        }
        Ok(())
    }

    /// Computes costs again, and lets the marches follow. Returns whether there was a change.
    fn change_costs(&mut self, density: &dyn CostDensity, areas: &[Rect]) -> Result<bool, PathError> {
        let changed = self.costs.update(&self.mesh, density, areas)?;
        for origin in &mut self.origins {
            origin.follow(&self.mesh, &self.costs.mean, Passage::Open, &changed);
        }
        for origin in &mut self.origins_for_bounds {
            origin.follow(&self.mesh, &self.costs.least, Passage::Partly, &changed);
        }
        Ok(!changed.is_empty())
    }

    /// Returns the path of least cost from the first of the places to the last by way of the others, in
    /// order.
    ///
    /// # Errors
    /// Fails when a place is not in the domain, or no path leads from one to the next.
    pub fn solve(
        &mut self,
        density: &dyn CostDensity,
        places: &[DVec2],
        request: PathRequest,
    ) -> Result<Solution, PathError> {
        Ok(Solution::joined(self.legs(density, places, request)?))
    }

    /// Returns the paths from each of the places to the next: those that [`Self::solve`] joins.
    ///
    /// # Errors
    /// Fails as [`Self::solve`] does.
    pub fn legs(
        &mut self,
        density: &dyn CostDensity,
        places: &[DVec2],
        request: PathRequest,
    ) -> Result<Vec<Solution>, PathError> {
        let places = self.places(places)?;
        self.march(&places, false);
        if request.has_bounds {
            self.march_for_bounds(&places);
        }
        let leg = |(leg, pair): (usize, &[Place])| {
            let [from, to] = [leg, leg + 1].map(|index| Waypoint::of(index, places.len()));
            self.leg(density, leg, [pair[0], pair[1]], request)?
                .ok_or_else(|| obstacle(&self.mesh, [pair[0], pair[1]], [from, to]))
        };
        places.windows(2).enumerate().map(leg).collect()
    }

    /// Returns the places on the mesh.
    pub(super) fn places(&self, places: &[DVec2]) -> Result<Vec<Place>, PathError> {
        if places.len() < 2 {
            return Err(PathError::TooFewPlaces);
        }
        let find =
            |(n, &point): (usize, &DVec2)| Place::find(&self.mesh, point, Waypoint::of(n, places.len()));
        places.iter().enumerate().map(find).collect()
    }

    /// Marches from each place; to the end from all of them with `complete`.
    pub(super) fn march(&mut self, places: &[Place], complete: bool) {
        self.origins.resize_with(places.len(), Origin::default);
        for (n, origin) in self.origins.iter_mut().enumerate() {
            match places.get(n + 1) {
                None if !complete => {}
                next => {
                    let until = next.filter(|_| !complete).copied();
                    origin.run(&self.mesh, &self.costs.mean, Passage::Open, places[n], until);
                }
            }
        }
    }

    /// Marches to the end from each place with the least costs.
    fn march_for_bounds(&mut self, places: &[Place]) {
        self.origins_for_bounds.resize_with(places.len(), Origin::default);
        for (origin, &place) in self.origins_for_bounds.iter_mut().zip(places) {
            origin.run(&self.mesh, &self.costs.least, Passage::Partly, place, None);
        }
    }

    /// Returns the marches through open triangles from two places, one after the other.
    pub(super) fn open_marches(&self, leg: usize) -> [&March; 2] {
        [&self.origins[leg].march, &self.origins[leg + 1].march]
    }

    /// Returns a path with each leg moved to where it costs least nearby.
    pub(super) fn relaxed(&self, path: &Solution, density: &dyn CostDensity, tolerance: f64) -> Solution {
        let leg = |stops: &[usize]| {
            let points = refine(&path.points[stops[0]..=stops[1]], density, &self.walls, Effort::FULL);
            self.solution(points, density, tolerance)
        };
        Solution::joined(path.stops.windows(2).map(leg))
    }

    /// Returns a polyline that the walls admit, with its figures.
    fn solution(&self, points: Vec<DVec2>, density: &dyn CostDensity, tolerance: f64) -> Solution {
        debug_assert!(self.walls.admit_all(&points), "a path leaves the open triangles: {points:?}");
        Solution { walls: vec![Arc::clone(&self.walls)], ..Solution::of(points, density, tolerance) }
    }

    /// Returns the path of a leg; `None` where no march leads to its goal.
    ///
    /// # Errors
    /// Fails when its cost is not finite.
    fn leg(
        &mut self,
        density: &dyn CostDensity,
        leg: usize,
        ends: [Place; 2],
        request: PathRequest,
    ) -> Result<Option<Solution>, PathError> {
        let [start, goal] = ends;
        if start.point == goal.point {
            return Ok(Some(self.solution(vec![start.point, goal.point], density, request.tolerance)));
        }
        let Some(traced) = self.traced(leg, ends) else { return Ok(None) };
        let refined = refine(&traced, density, &self.walls, request.effort);
        let mut solution = self.solution(refined, density, request.tolerance);
        // Where the cost jumps, a refined path can cost more.
        self.take_better(&mut solution, traced.clone(), density, request);
        if request.effort == Effort::FULL {
            self.try_others(&mut solution, (leg, ends, traced), density, request);
        }
        if !solution.upper.is_finite() {
            return Err(PathError::CostOutOfRange { at: start.point, value: solution.upper });
        }
        // A path through a part of the domain that no triangle covers may cost less than any that is known.
        if request.has_bounds && self.mesh.covers_domain {
            let bound = &mut LowerBound::default();
            std::mem::swap(bound, &mut self.bound);
            let marches = [leg, leg + 1].map(|place| &self.origins_for_bounds[place].march);
            let lower = bound.compute(&self.mesh, &self.costs.least, ends, marches, solution.upper);
            std::mem::swap(bound, &mut self.bound);
            solution.lower = lower.min(solution.upper);
        }
        Ok(Some(solution))
    }

    /// Takes a path in place of the solution if it costs less.
    fn take_better(
        &self,
        solution: &mut Solution,
        points: Vec<DVec2>,
        density: &dyn CostDensity,
        request: PathRequest,
    ) {
        // Bounds are much work: only for what promises to cost less.
        if PathFigures::of(&points, density, COMPARED).cost < solution.cost {
            let other = self.solution(points, density, request.tolerance);
            if other.upper < solution.upper {
                *solution = other;
            }
        }
    }

    /// Looks for paths that cost less than the solution, which was found beside the traced one.
    fn try_others(
        &self,
        solution: &mut Solution,
        (leg, ends, traced): (usize, [Place; 2], Vec<DVec2>),
        density: &dyn CostDensity,
        request: PathRequest,
    ) {
        let march = self.march_back(ends);
        let back = self.traced_back(&march, ends);
        let marches = [&self.origins[leg].march, &march];
        let ways = Ways { mesh: &self.mesh, costs: &self.costs.mean, walls: &self.walls, ends, marches };
        let known: Vec<Vec<DVec2>> = [traced].into_iter().chain(back).collect();
        let others = ways.others(&known);
        let sketch = |way: &[DVec2]| {
            let sketch = refine(way, density, &self.walls, Effort::SKETCH);
            (PathFigures::of(&sketch, density, COMPARED).cost, sketch)
        };
        let (mut least, _) = sketch(&known[0]);
        for (promised, sketched) in known[1..].iter().chain(&others).map(|way| sketch(way)) {
            if promised < least * (1.0 - LEAST_GAIN) {
                least = promised;
                let refined = refine(&sketched, density, &self.walls, request.effort);
                self.take_better(solution, refined, density, request);
                self.take_better(solution, sketched, density, request);
            }
        }
        if let Some(along) = self.along_lines(density, ends, solution.cost) {
            let refined = refine(&along, density, &self.walls, request.effort);
            self.take_better(solution, refined, density, request);
            self.take_better(solution, along, density, request);
        }
        if is_constant_along(&solution.points, density) {
            let cost = self.costs.mean[ends[0].triangle as usize];
            let shortest = Shortest { mesh: &self.mesh, costs: &self.costs.mean, walls: &self.walls, cost };
            if let Some(points) = shortest.way(ends, solution.length) {
                self.take_better(solution, points, density, request);
            }
        }
    }

    /// A march from the goal as far as the start. It errs elsewhere than one from the start, and can find the
    /// better one of two ways that cost nearly the same.
    fn march_back(&self, [start, goal]: [Place; 2]) -> March {
        let (mut march, costs) = (March::default(), &self.costs.mean);
        let seeds = goal.seeds(&self.mesh, costs);
        march.run(&self.mesh, costs, Passage::Open, &seeds, Some(start.corner_nodes(&self.mesh)));
        march
    }

    /// The path that a march from the goal leads to.
    fn traced_back(&self, march: &March, [start, goal]: [Place; 2]) -> Option<Vec<DVec2>> {
        let mut traced = trace(&self.mesh, &self.costs.mean, march, [goal, start])?;
        traced.reverse();
        self.walls.admit_all(&traced).then_some(traced)
    }

    /// Returns a path by way of lines that are cheaper than the triangles around them.
    fn along_lines(&self, density: &dyn CostDensity, ends: [Place; 2], known: f64) -> Option<Vec<DVec2>> {
        let size = self.mesh.bounds().map_or(0.0, |bounds| bounds.size().max_element());
        let lines = Lines { mesh: &self.mesh, costs: &self.costs, walls: &self.walls, density, size };
        lines.path(ends, known, Effort::FULL)
    }

    /// Returns the path that a march leads to, through open triangles only.
    fn traced(&self, leg: usize, ends: [Place; 2]) -> Option<Vec<DVec2>> {
        let march = &self.origins[leg].march;
        let traced = trace(&self.mesh, &self.costs.mean, march, ends)?;
        // In triangles as small as rounding, a point beside an edge may belong to a third one.
        match self.walls.admit_all(&traced) {
            true => Some(traced),
            false => trace_by_nodes(&self.mesh, &self.costs.mean, march, ends),
        }
    }
}
