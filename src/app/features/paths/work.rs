//! The work on paths that a thread does with the planner.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec2;

use meshbrush_core::document::PathPlan;
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::earth::{EarthPlane, metres_along};
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{
    CertificateEnd, Corridor, CostDensity, PathArea, PathError, PathMesh, PathMeshing, PathRequest,
    PathSample, PathSearch, Planner, PlannerMove, Planning, Solution,
};
use meshbrush_kit::kit::jobs::Slice;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Extract, Mesh, Progress};
use meshbrush_mesh::text::LengthUnit;

/// Triangles that are compared with the area of paths in a step, or bisected along its rim.
const AT_ONCE: usize = 2048;
/// Places on a path at which its profile is known.
const PROFILE_SAMPLES: usize = 200;

/// The result of a job on paths. It returns the planner, which the next job uses again.
pub(super) struct FinishedWork {
    pub planner: Option<KnownPlanner>,
    pub result: WorkResult,
}

/// The paths that were found.
pub(super) enum WorkResult {
    /// The paths, and what they cost.
    Paths { density: Option<Arc<dyn CostDensity>>, routes: Vec<Result<FoundPath, PathError>> },
    /// The lines around the corridor.
    Corridor(Vec<Vec<DVec2>>),
}

/// A planner, what its costs and its triangles were computed from, and the corridor of its paths.
pub(super) struct KnownPlanner {
    pub planner: Planner,
    pub plan: Arc<PathPlan>,
    risk: RiskField,
    /// What the area of paths and the place of the plane on the Earth were taken from.
    domain: Domain,
    /// `None` where paths may go everywhere: no place needs smaller triangles then.
    before_detail: Option<BeforeDetail>,
    corridor: Option<Corridor>,
    /// How often it went over to another mesh.
    #[cfg(test)]
    pub moves: usize,
}

/// The triangles in the area of paths, before smaller ones were made for the places of a plan.
struct BeforeDetail {
    mesh: Arc<PathMesh>,
    plan: Arc<PathPlan>,
    /// Whether its places need smaller ones.
    needs_detail: bool,
}

impl BeforeDetail {
    /// Takes the triangles before and after smaller ones were made.
    fn of([mesh, detailed]: [Arc<PathMesh>; 2], plan: &Arc<PathPlan>) -> Option<Self> {
        let needs_detail = !Arc::ptr_eq(&mesh, &detailed);
        (!mesh.area().is_everything()).then(|| Self { mesh, plan: plan.clone(), needs_detail })
    }

    /// Returns the triangles for the places of a plan, where the planner does not have them already.
    fn detailed_for(&mut self, plan: &Arc<PathPlan>) -> Option<Arc<PathMesh>> {
        if self.plan.routes == plan.routes {
            return None;
        }
        let detailed = self.mesh.detailed(&plan.routes);
        let needs_detail = !Arc::ptr_eq(&self.mesh, &detailed);
        let needed_detail = std::mem::replace(&mut self.needs_detail, needs_detail);
        self.plan = plan.clone();
        (needed_detail || needs_detail).then_some(detailed)
    }
}

impl KnownPlanner {
    fn new(
        planner: Planner,
        meshes: [Arc<PathMesh>; 2],
        (plan, risk): (Arc<PathPlan>, RiskField),
        domain: &Domain,
    ) -> Self {
        let (domain, before_detail) = (domain.clone(), BeforeDetail::of(meshes, &plan));
        Self {
            planner,
            plan,
            risk,
            domain,
            before_detail,
            corridor: None,
            #[cfg(test)]
            moves: 0,
        }
    }

    /// Returns whether its paths may go where those of a plan may.
    pub fn has_area_of(&self, plan: &PathPlan) -> bool {
        Arc::ptr_eq(&self.plan.keep_out, &plan.keep_out) && self.plan.clearance == plan.clearance
    }

    /// Returns the rectangles in which the cost of a plan may differ from the known one.
    fn changed_areas(&self, plan: &PathPlan, risk: &RiskField, domain: &Domain) -> Vec<Rect> {
        let has_same_cost = plan.cost == self.plan.cost && *domain == self.domain;
        let areas = if has_same_cost { risk.areas_that_differ(&self.risk) } else { None };
        areas.unwrap_or_else(|| vec![domain.bounds])
    }

    /// Follows another plan with the same area, where the cost changed in some rectangles.
    fn follow(
        &mut self,
        plan: Arc<PathPlan>,
        density: &dyn CostDensity,
        areas: &[Rect],
        is_live: bool,
    ) -> Result<(), PathError> {
        self.plan = plan;
        if is_live {
            return self.planner.follow(density, areas);
        }
        match self.before_detail.as_mut().and_then(|detail| detail.detailed_for(&self.plan)) {
            Some(detailed) => self.planner.move_to(detailed, density, areas),
            None => self.planner.update(density, areas),
        }
    }

    /// Notes that its planner has gone over to the mesh as it is after an edit.
    fn note_move(&mut self, meshes: [Arc<PathMesh>; 2], plan: Arc<PathPlan>) {
        (self.before_detail, self.plan) = (BeforeDetail::of(meshes, &plan), plan);
        #[cfg(test)]
        {
            self.moves += 1;
        }
    }
}

/// A path with its profile.
#[derive(Clone, Debug)]
pub struct FoundPath {
    /// The path and its bounds.
    pub solution: Solution,
    /// Cost and risk along it.
    pub profile: Vec<PathSample>,
    /// Why its certificate ended.
    pub end: Option<CertificateEnd>,
    /// The path that was shown before its certificate found a better one.
    pub former: Option<Box<Solution>>,
    /// How its plane lies on the Earth, if it does, and the unit of coordinates.
    place: PlaceOfPlane,
    /// The length in metres: on the ellipsoid, or from the unit; `None` where neither is known.
    pub metres: Option<f64>,
}

/// How a plane lies on the Earth, if it does, and the unit of coordinates.
pub(super) type PlaceOfPlane = (Option<EarthPlane>, LengthUnit);

impl FoundPath {
    fn new(solution: Solution, density: &dyn CostDensity, place: PlaceOfPlane) -> Self {
        let profile = solution.profile(density, PROFILE_SAMPLES);
        let metres = metres_along(place.0, place.1, &solution.points);
        Self { solution, profile, end: None, former: None, place, metres }
    }

    /// Returns the length on the ellipsoid in metres, in the plane of a projection.
    pub fn length_on_the_ellipsoid(&self) -> Option<f64> {
        self.metres.filter(|_| matches!(self.place.0, Some(EarthPlane::Projected(_))))
    }

    /// Takes what a certificate found out. The path that a person saw first is kept.
    pub fn take(&mut self, proved: Solution, density: &dyn CostDensity) {
        let former = self.solution.clone();
        if self.solution.take(proved) {
            self.profile = self.solution.profile(density, PROFILE_SAMPLES);
            self.metres = metres_along(self.place.0, self.place.1, &self.solution.points);
            self.former.get_or_insert_with(|| Box::new(former));
        }
    }

    /// Returns the highest risk on the way: that of the profile.
    pub fn highest_risk(&self) -> f64 {
        self.profile.iter().map(|sample| sample.risk).fold(self.solution.highest_risk, f64::max)
    }

    /// Returns how much more than this path the one before its proof costs, as a share.
    pub fn former_excess(&self) -> Option<f64> {
        self.former.as_ref().map(|former| former.cost / self.solution.cost - 1.0)
    }
}

/// The results for a route so far.
#[derive(Clone, Debug, Default)]
pub struct ShownPath {
    /// The last path that was found.
    pub found: Option<FoundPath>,
    /// Why there is none for the route as it is: the one that is shown is outdated.
    pub problem: Option<PathError>,
}

/// The source of a planner.
pub(super) struct PlannerSource {
    /// One that knows a mesh.
    pub known: Option<Box<KnownPlanner>>,
    /// The mesh to go over to, or to begin with; `None` where the planner knows it.
    pub mesh: Option<PlannedMesh>,
}

/// A mesh for paths.
pub(super) enum PlannedMesh {
    Mesh(Arc<Mesh>),
    Extract(Arc<Extract<'static>>),
}

impl PlannedMesh {
    fn in_area(&self, area: &PathArea) -> PathMeshing {
        match self {
            Self::Mesh(mesh) => PathMeshing::new(mesh.view(), area),
            Self::Extract(extract) => PathMeshing::new(extract.view(), area),
        }
    }
}

/// The work on the paths of a document, a step at a time.
pub(super) struct PathWork {
    pub plan: Arc<PathPlan>,
    pub risk: RiskField,
    pub domain: Domain,
    pub boundary: BoundaryTreatment,
    pub unit: LengthUnit,
    pub is_live: bool,
    density: Arc<dyn CostDensity>,
    step: PathStep,
    found: Vec<Result<FoundPath, PathError>>,
}

/// What is done next.
enum PathStep {
    /// Begins with the triangles of a mesh, if there is another one.
    Start(PlannerSource),
    /// Finds those in the area of paths.
    Close(Option<Box<KnownPlanner>>, Box<PathMeshing>),
    /// Makes smaller triangles for the places.
    Detail(Arc<PathMesh>),
    /// Makes a planner.
    Plan([Arc<PathMesh>; 2], Planning),
    /// A planner follows, on the same mesh.
    Follow(Box<KnownPlanner>),
    /// A planner goes over to another mesh.
    Move(Box<KnownPlanner>, [Arc<PathMesh>; 2], Box<PlannerMove>),
    /// Begins with the next route.
    Begin(Box<KnownPlanner>),
    /// Finds its path.
    Search(Box<KnownPlanner>, Box<PathSearch>),
    /// Finds the profile of the path.
    Profile(Box<KnownPlanner>, Box<Solution>),
    /// Nothing is left to do.
    Done,
}

impl PathWork {
    /// Begins; `None` where there is no cost.
    pub fn new(
        source: PlannerSource,
        (plan, risk): (Arc<PathPlan>, RiskField),
        (domain, boundary, unit): (Domain, BoundaryTreatment, LengthUnit),
        is_live: bool,
    ) -> Option<Self> {
        let density = plan.cost.density(risk.clone(), &domain).ok()?;
        let (step, found) = (PathStep::Start(source), Vec::new());
        Some(Self { plan, risk, domain, boundary, unit, is_live, density, step, found })
    }

    /// Takes the next step.
    pub fn advance(&mut self) -> Slice<Option<FinishedWork>> {
        match self.step() {
            Ok(ControlFlow::Continue(step)) => {
                self.step = step;
                Slice::More
            }
            Ok(ControlFlow::Break(work)) => Slice::Found(work),
            // No path can be found.
            Err(problem) => {
                let routes = self.plan.routes.iter().map(|_| Err(problem.clone())).collect();
                let result = WorkResult::Paths { density: None, routes };
                Slice::Found(Some(FinishedWork { planner: None, result }))
            }
        }
    }

    fn step(&mut self) -> Result<ControlFlow<Option<FinishedWork>, PathStep>, PathError> {
        let Self { plan, risk, domain, boundary, density, is_live, .. } = self;
        Ok(ControlFlow::Continue(match std::mem::replace(&mut self.step, PathStep::Done) {
            PathStep::Start(PlannerSource { known, mesh: Some(mesh) }) => {
                PathStep::Close(known, Box::new(mesh.in_area(&plan.area(domain, *boundary)?)))
            }
            PathStep::Start(PlannerSource { known: Some(known), mesh: None }) => PathStep::Follow(known),
            PathStep::Start(PlannerSource { known: None, mesh: None }) => {
                return Ok(ControlFlow::Break(None));
            }
            PathStep::Close(known, mut meshing) => match meshing.advance(AT_ONCE) {
                None => PathStep::Close(known, meshing),
                Some(mesh) => self.take_mesh(known, Arc::new(mesh)),
            },
            PathStep::Detail(mesh) => {
                let detailed = mesh.detailed(&plan.routes);
                let planning = Planning::new(Arc::clone(&detailed));
                PathStep::Plan([mesh, detailed], planning)
            }
            PathStep::Plan(meshes, mut planning) => match planning.advance(&**density)? {
                None => PathStep::Plan(meshes, planning),
                Some(planner) => {
                    let known = KnownPlanner::new(planner, meshes, (plan.clone(), risk.clone()), domain);
                    PathStep::Begin(Box::new(known))
                }
            },
            PathStep::Follow(mut known) => {
                let areas = known.changed_areas(plan, risk, domain);
                known.follow(plan.clone(), &**density, &areas, *is_live)?;
                self.begin_routes(known)
            }
            PathStep::Move(mut known, meshes, mut moving) => {
                match moving.advance(&mut known.planner, &**density)? {
                    Progress::More => PathStep::Move(known, meshes, moving),
                    Progress::Done => {
                        known.note_move(meshes, plan.clone());
                        self.begin_routes(known)
                    }
                }
            }
            PathStep::Begin(known) => {
                let Some(places) = plan.routes.get(self.found.len()) else {
                    return Ok(ControlFlow::Break(Some(self.work(*known))));
                };
                match PathSearch::new(&known.planner, places, request(*is_live)) {
                    Ok(search) => PathStep::Search(known, Box::new(search)),
                    Err(problem) => self.without_path(known, problem),
                }
            }
            PathStep::Search(known, search) => self.search(known, search),
            PathStep::Profile(known, solution) => {
                let place = (EarthPlane::new(domain.projection, self.unit), self.unit);
                self.found.push(Ok(FoundPath::new(*solution, &**density, place)));
                PathStep::Begin(known)
            }
            PathStep::Done => return Ok(ControlFlow::Break(None)),
        }))
    }

    /// Goes over to a mesh in the area of paths, or begins with it.
    fn take_mesh(&self, known: Option<Box<KnownPlanner>>, mesh: Arc<PathMesh>) -> PathStep {
        let Some(known) = known else { return PathStep::Detail(mesh) };
        let detailed = mesh.detailed(&self.plan.routes);
        let areas = known.changed_areas(&self.plan, &self.risk, &self.domain);
        let moving = PlannerMove::new(Arc::clone(&detailed), &areas);
        PathStep::Move(known, [mesh, detailed], Box::new(moving))
    }

    /// Begins with the routes, when the planner knows the plan.
    fn begin_routes(&self, mut known: Box<KnownPlanner>) -> PathStep {
        (known.risk, known.domain, known.corridor) = (self.risk.clone(), self.domain.clone(), None);
        PathStep::Begin(known)
    }

    /// Goes on to find the path of a route.
    fn search(&mut self, mut known: Box<KnownPlanner>, mut search: Box<PathSearch>) -> PathStep {
        match search.advance(&mut known.planner, &*self.density, PathSearch::NODES_AT_ONCE) {
            Ok(None) => PathStep::Search(known, search),
            Ok(Some(solution)) => PathStep::Profile(known, Box::new(solution)),
            Err(problem) => self.without_path(known, problem),
        }
    }

    /// The next route has no path, for a reason.
    fn without_path(&mut self, known: Box<KnownPlanner>, problem: PathError) -> PathStep {
        let places = &self.plan.routes[self.found.len()];
        self.found.push(Err(problem.in_domain(&self.domain, places)));
        PathStep::Begin(known)
    }

    fn work(&mut self, planner: KnownPlanner) -> FinishedWork {
        let routes = std::mem::take(&mut self.found);
        let result = WorkResult::Paths { density: Some(self.density.clone()), routes };
        FinishedWork { planner: Some(planner), result }
    }
}

fn request(is_live: bool) -> PathRequest {
    if is_live { PathRequest::LIVE } else { PathRequest::FULL }
}

/// Finds the lines around the corridor of all routes: the places on paths that cost more than the best of
/// their route by at most `share`. Routes without a path have none.
pub(super) fn find_corridor(mut known: KnownPlanner, routes: &[Vec<DVec2>], share: f64) -> FinishedWork {
    let KnownPlanner { planner, corridor, .. } = &mut known;
    let corridor = corridor.get_or_insert_with(|| {
        let corridors = routes.iter().filter_map(|places| planner.corridor(places).ok());
        corridors.reduce(Corridor::joined).unwrap_or_default()
    });
    let lines = match corridor.excess().is_empty() {
        true => Vec::new(),
        false => corridor.outlines(planner.mesh(), share),
    };
    FinishedWork { planner: Some(known), result: WorkResult::Corridor(lines) }
}
