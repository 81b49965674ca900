//! Finds paths on a mesh, and keeps what it knows for the next one.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::adaptation::Adaptation;
use super::leg::LegSearch;
use super::lines::LineSearch;
use super::march::March;
use super::origin::WaypointMarch;
use super::path_mesh::PathMesh;
use super::place::MeshPlace;
use super::planning::Planning;
use super::refine::{Effort, refine};
use super::trace::{trace, trace_by_nodes};
use super::triangle_costs::TriangleCosts;
use super::walls::Walls;
use super::{CostDensity, Passage, PathError, Solution, Waypoint};
use crate::mesh::Progress;

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

/// Finds paths of least cost on one mesh.
///
/// The mesh is bisected further where the cost varies much within a triangle. The path follows the march with
/// the mean cost of each triangle, and bounds the marches with its least cost.
///
/// The marches from the waypoints are kept: for another path between the same places after the cost changed
/// in some triangles, only what the change can reach is recomputed.
#[derive(Clone, Debug)]
pub struct Planner {
    pub(super) mesh: Arc<PathMesh>,
    pub(super) walls: Arc<Walls>,
    /// How the mesh was bisected from that which the planner was made with; `None` where it never is.
    pub(super) adaptation: Option<Adaptation>,
    pub(super) costs: TriangleCosts,
    /// Marches with mean costs through open triangles, one for each waypoint.
    pub(super) origins: Vec<WaypointMarch>,
    /// Marches with least costs through all triangles that are not closed, one for each waypoint.
    pub(super) origins_for_bounds: Vec<WaypointMarch>,
}

/// A march from a place.
struct Marching<'a> {
    origin: &'a mut WaypointMarch,
    costs: &'a [f64],
    least: Passage,
    place: MeshPlace,
    /// Where it may pause.
    until: Option<MeshPlace>,
}

impl Planner {
    /// Creates a planner for a mesh and a cost density.
    ///
    /// # Errors
    /// Fails when the cost is zero, negative, NaN or infinite somewhere.
    pub fn new(mesh: impl Into<Arc<PathMesh>>, density: &dyn CostDensity) -> Result<Self, PathError> {
        let mut planning = Planning::new(mesh);
        loop {
            if let Some(planner) = planning.advance(density)? {
                return Ok(planner);
            }
        }
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

    pub(super) fn with_costs(mesh: Arc<PathMesh>, costs: TriangleCosts) -> Self {
        let walls = Arc::new(Walls::new(&mesh));
        let (origins, origins_for_bounds) = Default::default();
        Self { mesh, walls, adaptation: None, costs, origins, origins_for_bounds }
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
        self.legs_between(density, &places, request)
    }

    pub(super) fn legs_between(
        &mut self,
        density: &dyn CostDensity,
        places: &[MeshPlace],
        request: PathRequest,
    ) -> Result<Vec<Solution>, PathError> {
        self.march_from(places, false, request.has_bounds);
        let leg = |(leg, pair): (usize, &[MeshPlace])| {
            let mut search = LegSearch::new(leg, [pair[0], pair[1]], request);
            loop {
                if let Some(found) = search.advance(self, density, places.len(), usize::MAX)? {
                    return Ok(found);
                }
            }
        };
        let legs: Vec<Result<Solution, PathError>> = places.par_windows(2).enumerate().map(leg).collect();
        // Of several errors, that of the first leg counts.
        legs.into_iter().collect()
    }

    /// Accepts a limited number of nodes in the march from one of the places, given by its number. Returns
    /// whether more are left; `None` where there is no such march.
    pub(super) fn march_one(
        &mut self,
        places: &[MeshPlace],
        has_bounds: bool,
        number: usize,
        most: usize,
    ) -> Option<Progress> {
        self.resize_origins(places.len(), has_bounds);
        let mesh = Arc::clone(&self.mesh);
        let marches = self.marches(places, false, has_bounds);
        let Marching { origin, costs, least, place, until } = marches.into_iter().nth(number)?;
        Some(origin.run(&mesh, costs, least, (place, until), most))
    }

    /// Returns the places on the mesh.
    pub(super) fn places(&self, places: &[DVec2]) -> Result<Vec<MeshPlace>, PathError> {
        if places.len() < 2 {
            return Err(PathError::TooFewPlaces);
        }
        let find =
            |(n, &point): (usize, &DVec2)| MeshPlace::find(&self.mesh, point, Waypoint::of(n, places.len()));
        places.iter().enumerate().map(find).collect()
    }

    /// Marches from each place; to the end from all of them with `complete`.
    pub(super) fn march(&mut self, places: &[MeshPlace], complete: bool) {
        self.march_from(places, complete, false);
    }

    /// [`Self::march`], and for bounds to the end from each place with the least costs. Each march is the
    /// work of one thread.
    fn march_from(&mut self, places: &[MeshPlace], complete: bool, has_bounds: bool) {
        self.resize_origins(places.len(), has_bounds);
        let mesh = Arc::clone(&self.mesh);
        let marches = self.marches(places, complete, has_bounds);
        marches.into_par_iter().for_each(|Marching { origin, costs, least, place, until }| {
            _ = origin.run(&mesh, costs, least, (place, until), usize::MAX);
        });
    }

    fn resize_origins(&mut self, count: usize, has_bounds: bool) {
        self.origins.resize_with(count, WaypointMarch::default);
        if has_bounds {
            self.origins_for_bounds.resize_with(count, WaypointMarch::default);
        }
    }

    /// Returns what [`Self::march_from`] does.
    fn marches(&mut self, places: &[MeshPlace], complete: bool, has_bounds: bool) -> Vec<Marching<'_>> {
        let Self { costs, origins, origins_for_bounds, .. } = self;
        // No leg begins at the last place.
        let starts = if complete { places.len() } else { places.len() - 1 };
        let open = origins[..starts].iter_mut().enumerate().map(|(n, origin)| {
            let until = places.get(n + 1).filter(|_| !complete).copied();
            Marching { origin, costs: &costs.mean, least: Passage::Open, place: places[n], until }
        });
        let for_bounds = if has_bounds { &mut origins_for_bounds[..] } else { &mut [] };
        let partly = for_bounds.iter_mut().zip(places).map(|(origin, &place)| Marching {
            origin,
            costs: &costs.least,
            least: Passage::Partly,
            place,
            until: None,
        });
        open.chain(partly).collect()
    }

    /// Returns the marches through open triangles from two places, one after the other.
    pub(super) fn open_marches(&self, leg: usize) -> [&March; 2] {
        [&self.origins[leg].march, &self.origins[leg + 1].march]
    }

    /// Returns the marches with least costs from the ends of a leg.
    pub(super) fn partly_open_marches(&self, leg: usize) -> [&March; 2] {
        [leg, leg + 1].map(|place| &self.origins_for_bounds[place].march)
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
    pub(super) fn solution(&self, points: Vec<DVec2>, density: &dyn CostDensity, tolerance: f64) -> Solution {
        debug_assert!(self.walls.admit_all(&points), "a path leaves the open triangles: {points:?}");
        Solution { walls: vec![Arc::clone(&self.walls)], ..Solution::new(points, density, tolerance) }
    }

    /// Begins a march from the goal to the start. Its errors differ from those of a march from the start, so
    /// that it can find the better one of two ways that cost nearly the same.
    pub(super) fn begin_back(&self, goal: MeshPlace) -> March {
        let mut march = March::default();
        march.begin(&self.mesh, &goal.seeds(&self.mesh, &self.costs.mean));
        march
    }

    /// Accepts at most `most` nodes in the march from the goal. Returns whether more are left.
    pub(super) fn march_back(&self, march: &mut March, start: MeshPlace, most: usize) -> Progress {
        let until = Some(start.corner_nodes(&self.mesh));
        march.go_on_for(&self.mesh, &self.costs.mean, Passage::Open, until, most)
    }

    /// The path that a march from the goal leads to.
    pub(super) fn traced_back(&self, march: &March, [start, goal]: [MeshPlace; 2]) -> Option<Vec<DVec2>> {
        let mut traced = trace(&self.mesh, &self.costs.mean, march, [goal, start])?;
        traced.reverse();
        self.walls.admit_all(&traced).then_some(traced)
    }

    /// Returns a path by way of lines that are cheaper than the triangles around them.
    pub(super) fn along_lines(
        &self,
        density: &dyn CostDensity,
        ends: [MeshPlace; 2],
        known: f64,
    ) -> Option<Vec<DVec2>> {
        let size = self.mesh.bounds().map_or(0.0, |bounds| bounds.size().max_element());
        let lines = LineSearch { mesh: &self.mesh, costs: &self.costs, walls: &self.walls, density, size };
        lines.path(ends, known, Effort::FULL)
    }

    /// Returns the path that a march leads to, through open triangles only.
    pub(super) fn traced(&self, leg: usize, ends: [MeshPlace; 2]) -> Option<Vec<DVec2>> {
        let march = &self.origins[leg].march;
        let traced = trace(&self.mesh, &self.costs.mean, march, ends)?;
        // In triangles as small as rounding, a point beside an edge may belong to a third one.
        match self.walls.admit_all(&traced) {
            true => Some(traced),
            false => trace_by_nodes(&self.mesh, &self.costs.mean, march, ends),
        }
    }
}
