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
use super::trace::{trace, trace_by_nodes};
use super::triangle_costs::TriangleCosts;
use super::walls::Walls;
use super::{CostDensity, Passage, PathError, Solution, Waypoint};
use crate::geometry::Rect;

/// What is asked of a path.
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
    /// With mean costs through open triangles, one for each waypoint.
    origins: Vec<Origin>,
    /// With least costs through all triangles that are not closed.
    origins_for_bounds: Vec<Origin>,
    bound: LowerBound,
}

/// What the mesh of a planner was bisected from.
#[derive(Clone, Debug)]
struct Adaptation {
    /// The mesh that the planner was made with.
    base: Arc<PathMesh>,
    /// Whether the mesh may be another one than for the cost as it is.
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
    /// A planner for a mesh and a cost density.
    ///
    /// # Errors
    /// When the cost is zero, negative, NaN or infinite somewhere.
    pub fn new(mesh: impl Into<Arc<PathMesh>>, density: &dyn CostDensity) -> Result<Self, PathError> {
        let base = mesh.into();
        let mut mesh = Arc::clone(&base);
        let costs = TriangleCosts::on_adapted(&mut mesh, density)?;
        let adaptation = Some(Adaptation { base, is_outdated: false });
        Ok(Self { adaptation, ..Self::with_costs(mesh, costs) })
    }

    /// As [`Self::new`], on the mesh as it is.
    ///
    /// # Errors
    /// As [`Self::new`].
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

    /// The triangles that paths go through: those of the mesh that the planner was made with, or parts of
    /// them.
    pub fn mesh(&self) -> &Arc<PathMesh> {
        &self.mesh
    }

    /// The cost of each triangle.
    pub fn costs(&self) -> &TriangleCosts {
        &self.costs
    }

    /// Follows a change of the cost inside rectangles in world units: paths are then those of a new planner.
    /// Where the mesh would be bisected in another way for the new cost, it is one.
    ///
    /// # Errors
    /// When the new cost is zero, negative, NaN or infinite somewhere; then nothing changes.
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
    /// As [`Self::update`].
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

    /// The path of least cost from the first of the places to the last by way of the others, in order.
    ///
    /// # Errors
    /// When a place is not in the domain, or no path leads from one to the next.
    pub fn solve(
        &mut self,
        density: &dyn CostDensity,
        places: &[DVec2],
        request: PathRequest,
    ) -> Result<Solution, PathError> {
        Ok(Solution::joined(self.legs(density, places, request)?))
    }

    /// The paths from each of the places to the next: those that [`Self::solve`] joins.
    ///
    /// # Errors
    /// As [`Self::solve`].
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

    /// The places on the mesh.
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

    /// The marches through open triangles from two places, one after the other.
    pub(super) fn open_marches(&self, leg: usize) -> [&March; 2] {
        [&self.origins[leg].march, &self.origins[leg + 1].march]
    }

    /// A path with each leg moved to where it costs least nearby.
    pub(super) fn relaxed(&self, path: &Solution, density: &dyn CostDensity, tolerance: f64) -> Solution {
        let leg = |stops: &[usize]| {
            let points = refine(&path.points[stops[0]..=stops[1]], density, &self.walls, Effort::FULL);
            self.solution(points, density, tolerance)
        };
        Solution::joined(path.stops.windows(2).map(leg))
    }

    /// A polyline that the walls admit, with its figures.
    fn solution(&self, points: Vec<DVec2>, density: &dyn CostDensity, tolerance: f64) -> Solution {
        debug_assert!(self.walls.admit_all(&points), "a path leaves the open triangles: {points:?}");
        Solution { walls: vec![Arc::clone(&self.walls)], ..Solution::of(points, density, tolerance) }
    }

    /// The path of a leg; `None` where no march leads to its goal.
    ///
    /// # Errors
    /// When its cost is not finite.
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
        if PathFigures::of(&traced, density, COMPARED).cost < solution.cost {
            let other = self.solution(traced, density, request.tolerance);
            if other.upper < solution.upper {
                solution = other;
            }
        }
        if request.effort == Effort::FULL {
            let others = [self.backwards(ends), self.along_lines(density, ends, solution.cost)];
            for other in others.into_iter().flatten() {
                let refined = refine(&other, density, &self.walls, request.effort);
                for points in [refined, other] {
                    // Bounds are much work: only for what promises to cost less.
                    if PathFigures::of(&points, density, COMPARED).cost < solution.cost {
                        let other = self.solution(points, density, request.tolerance);
                        if other.upper < solution.upper {
                            solution = other;
                        }
                    }
                }
            }
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

    /// The path that a march from the goal leads to. It errs elsewhere than one from the start, and can find
    /// the better one of two ways that cost nearly the same.
    fn backwards(&self, [start, goal]: [Place; 2]) -> Option<Vec<DVec2>> {
        let (mut march, costs) = (March::default(), &self.costs.mean);
        let seeds = goal.seeds(&self.mesh, costs);
        march.run(&self.mesh, costs, Passage::Open, &seeds, Some(start.corner_nodes(&self.mesh)));
        let mut traced = trace(&self.mesh, costs, &march, [goal, start])?;
        traced.reverse();
        self.walls.admit_all(&traced).then_some(traced)
    }

    /// A path by way of lines that are cheaper than the triangles around them.
    fn along_lines(&self, density: &dyn CostDensity, ends: [Place; 2], known: f64) -> Option<Vec<DVec2>> {
        let size = self.mesh.bounds().map_or(0.0, |bounds| bounds.size().max_element());
        let lines = Lines { mesh: &self.mesh, costs: &self.costs, walls: &self.walls, density, size };
        lines.path(ends, known, Effort::FULL)
    }

    /// The path that a march leads to, through open triangles only.
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
