//! A planner follows edits of the cost and of the mesh.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::adaptation::{Adaptation, Adapted};
use super::origin::WaypointMarch;
use super::path_mesh::{NONE, PathMesh};
use super::shared::SharedParts;
use super::triangle_costs::{TriangleCost, TriangleCosts, coarsest};
use super::walls::Walls;
use super::{CostDensity, Passage, PathError, Planner};
use crate::geometry::Rect;
use crate::mesh::Progress;

/// Number of triangles whose costs one thread computes in a step.
const AT_ONCE: usize = 2048;
/// More rectangles in which the cost changed are joined to one.
const MOST_AREAS: usize = 64;

/// What marches must know to follow from one mesh to another.
struct MeshMove {
    old: Arc<PathMesh>,
    shared: SharedParts,
    /// The triangles that are new, or whose costs or passages changed.
    changed: Vec<u32>,
}

impl Planner {
    /// Follows a change of the cost inside rectangles in world units: paths are then those of a new planner.
    /// Costs are recomputed only there, and marches are updated.
    ///
    /// # Errors
    /// Fails when the new cost is zero, negative, NaN or infinite somewhere; then nothing changes.
    pub fn update(&mut self, density: &dyn CostDensity, areas: &[Rect]) -> Result<(), PathError> {
        let Some(adaptation) = &self.adaptation else {
            return self.change_costs(density, areas);
        };
        let areas = [&adaptation.changed, areas].concat();
        if areas.is_empty() {
            return Ok(());
        }
        let base = adaptation.base(&self.mesh);
        let meeting = base.meeting(&areas);
        if meeting.is_empty() {
            return Ok(());
        }
        let mut known = adaptation.known_costs(&self.costs);
        for (&triangle, cost) in meeting.iter().zip(base.costs_of(&meeting, density)?) {
            known[triangle as usize] = cost;
        }
        let Adapted { mesh, costs, adaptation } = Adapted::new(base, &known, density)?;
        if mesh.is_same_as(&self.mesh) {
            let changed = self.costs.exchange(costs);
            self.follow_costs(&changed);
        } else {
            self.move_marches(mesh, costs);
        }
        self.adaptation = Some(adaptation);
        Ok(())
    }

    /// Moves to another mesh, for example after an edit that refined the mesh in some places, and follows a
    /// change of the cost inside rectangles in world units: paths are then those of a new planner for that
    /// mesh. Costs are recomputed only there and for new triangles, and marches are updated through the
    /// others.
    ///
    /// # Errors
    /// Fails as [`Self::update`] does; then nothing changes.
    pub fn move_to(
        &mut self,
        mesh: impl Into<Arc<PathMesh>>,
        density: &dyn CostDensity,
        areas: &[Rect],
    ) -> Result<(), PathError> {
        let mut moving = PlannerMove::new(mesh, areas);
        while moving.advance(self, density)? == Progress::More {}
        Ok(())
    }

    /// Takes another mesh with its costs, and lets the marches follow.
    fn move_marches(&mut self, mesh: Arc<PathMesh>, costs: TriangleCosts) {
        let moved = self.take_mesh(mesh, costs);
        _ = self.let_follow(&moved, 0..usize::MAX);
    }

    /// Takes another mesh with its costs. The marches must follow.
    fn take_mesh(&mut self, mesh: Arc<PathMesh>, costs: TriangleCosts) -> MeshMove {
        let old = std::mem::replace(&mut self.mesh, mesh);
        let before = std::mem::replace(&mut self.costs, costs);
        self.walls = Arc::new(Walls::new(&self.mesh));
        let Self { mesh, costs, .. } = self;
        let shared = SharedParts::between(&old, mesh);
        let is_changed = |&t: &u32| {
            let (t, known) = (t as usize, shared.triangles[t as usize] as usize);
            known == NONE as usize
                || before.least[known] != costs.least[t]
                || before.mean[known] != costs.mean[t]
                || old.triangles[known].passage != mesh.triangles[t].passage
        };
        let changed: Vec<u32> = (0..mesh.triangle_count() as u32).filter(is_changed).collect();
        MeshMove { old, shared, changed }
    }

    /// Lets the marches with these numbers follow to the mesh. Returns whether there are more.
    fn let_follow(
        &mut self,
        MeshMove { old, shared, changed }: &MeshMove,
        numbers: Range<usize>,
    ) -> Progress {
        let Self { mesh, costs, origins, origins_for_bounds, .. } = self;
        let all = origins.len() + origins_for_bounds.len();
        let open = origins.iter_mut().map(|origin| (origin, &*costs.mean, Passage::Open));
        let partly = origins_for_bounds.iter_mut().map(|origin| (origin, &*costs.least, Passage::Partly));
        let marches: Vec<_> = open.chain(partly).skip(numbers.start).take(numbers.len()).collect();
        marches.into_par_iter().for_each(|(origin, costs, least)| {
            origin.move_to([old, mesh], costs, least, (shared, changed));
        });
        if numbers.end < all { Progress::More } else { Progress::Done }
    }

    /// Follows a change of the cost as [`Self::update`] does, at once and on the mesh as it is: for paths
    /// that are shown while something is dragged.
    ///
    /// # Errors
    /// Fails as [`Self::update`] does.
    pub fn follow(&mut self, density: &dyn CostDensity, areas: &[Rect]) -> Result<(), PathError> {
        self.change_costs(density, areas)?;
        if let Some(Adaptation { changed, .. }) = &mut self.adaptation {
            changed.extend(areas);
            if changed.len() > MOST_AREAS {
                let all = changed.drain(..).reduce(|a, b| a.union(&b));
                changed.extend(all);
            }
        }
        Ok(())
    }

    /// Computes costs again, and lets the marches follow.
    fn change_costs(&mut self, density: &dyn CostDensity, areas: &[Rect]) -> Result<(), PathError> {
        let changed = self.costs.update(&self.mesh, density, areas)?;
        self.follow_costs(&changed);
        Ok(())
    }

    /// Lets the marches follow the costs of some triangles.
    fn follow_costs(&mut self, changed: &[u32]) {
        let Self { mesh, costs, origins, origins_for_bounds, .. } = self;
        let follow = |(origin, costs, least): (&mut WaypointMarch, &[f64], Passage)| {
            origin.follow(mesh, costs, least, changed);
        };
        let open = origins.par_iter_mut().map(|origin| (origin, &*costs.mean, Passage::Open));
        let partly = origins_for_bounds.par_iter_mut().map(|origin| (origin, &*costs.least, Passage::Partly));
        open.chain(partly).for_each(follow);
    }
}

/// The work of [`Planner::move_to`], in steps. The planner and the cost density are the same in all of them.
pub struct PlannerMove {
    mesh: Arc<PathMesh>,
    areas: Vec<Rect>,
    step: FollowStep,
}

/// What is done next.
enum FollowStep {
    Begin,
    /// The costs of these triangles are computed, from that place on.
    Costs {
        known: Vec<TriangleCost>,
        unknown: Vec<u32>,
        next: usize,
    },
    /// The mesh is bisected where the cost varies much.
    Adapt(Vec<TriangleCost>),
    /// The planner takes the mesh.
    Take(Adapted),
    /// Marches follow, from the one with this number on.
    March(MeshMove, usize),
    Done,
}

impl PlannerMove {
    /// Begins to move to another mesh, where the cost changed inside rectangles in world units.
    pub fn new(mesh: impl Into<Arc<PathMesh>>, areas: &[Rect]) -> Self {
        Self { mesh: mesh.into(), areas: areas.to_vec(), step: FollowStep::Begin }
    }

    /// Takes a step.
    ///
    /// # Errors
    /// Fails as [`Planner::update`] does; then the planner is as before.
    pub fn advance(
        &mut self,
        planner: &mut Planner,
        density: &dyn CostDensity,
    ) -> Result<Progress, PathError> {
        let Self { mesh, areas, step } = self;
        *step = match std::mem::replace(step, FollowStep::Done) {
            FollowStep::Begin => match &planner.adaptation {
                None => {
                    *planner = Planner::on_mesh(Arc::clone(mesh), density)?;
                    FollowStep::Done
                }
                Some(adaptation) => known_costs(planner, adaptation, mesh, areas),
            },
            FollowStep::Costs { mut known, unknown, next } => {
                let most = if rayon::current_num_threads() > 1 { unknown.len() } else { AT_ONCE };
                let end = next.saturating_add(most).min(unknown.len());
                let some = &unknown[next..end];
                for (&triangle, cost) in some.iter().zip(mesh.costs_of(some, density)?) {
                    known[triangle as usize] = cost;
                }
                if end < unknown.len() {
                    FollowStep::Costs { known, unknown, next: end }
                } else {
                    FollowStep::Adapt(known)
                }
            }
            FollowStep::Adapt(known) => FollowStep::Take(Adapted::new(Arc::clone(mesh), &known, density)?),
            FollowStep::Take(Adapted { mesh, costs, adaptation }) => {
                planner.adaptation = Some(adaptation);
                FollowStep::March(planner.take_mesh(mesh, costs), 0)
            }
            FollowStep::March(moved, first) => {
                let end = if rayon::current_num_threads() > 1 { usize::MAX } else { first + 1 };
                match planner.let_follow(&moved, first..end) {
                    Progress::More => FollowStep::March(moved, end),
                    Progress::Done => FollowStep::Done,
                }
            }
            FollowStep::Done => FollowStep::Done,
        };
        Ok(if matches!(step, FollowStep::Done) { Progress::Done } else { Progress::More })
    }
}

/// Takes the costs that a planner already knows for a new mesh, and finds the triangles whose costs it does
/// not know.
fn known_costs(planner: &Planner, adaptation: &Adaptation, new: &PathMesh, areas: &[Rect]) -> FollowStep {
    let base = adaptation.base(&planner.mesh);
    let shared = SharedParts::between(&base, new);
    // Triangles that need not be bisected have no greatest cost, and another extent may ask for it.
    let is_known = coarsest(&base) == coarsest(new);
    let is_unknown = |&(_, &t): &(u32, &u32)| t == NONE || !is_known;
    let without = (0..).zip(&shared.triangles).filter(is_unknown).map(|(t, _)| t);
    let in_areas = new.meeting(&[&adaptation.changed, areas].concat());
    let mut unknown: Vec<u32> = in_areas.into_iter().chain(without).collect();
    unknown.sort_unstable();
    unknown.dedup();
    let costs = adaptation.known_costs(&planner.costs);
    let of_old = |&t: &u32| costs.get(t as usize).copied().unwrap_or(TriangleCost::CLOSED);
    let known = shared.triangles.iter().map(of_old).collect();
    FollowStep::Costs { known, unknown, next: 0 }
}
