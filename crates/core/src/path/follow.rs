//! A planner follows edits of the cost and of the mesh.

use std::sync::Arc;

use rayon::prelude::*;

use super::origin::Origin;
use super::path_mesh::{NONE, PathMesh};
use super::planner::Adaptation;
use super::shared::Shared;
use super::triangle_costs::{TriangleCost, TriangleCosts};
use super::walls::Walls;
use super::{CostDensity, Passage, PathError, Planner};
use crate::geometry::Rect;

/// More rectangles in which the cost changed are joined to one.
const MOST_AREAS: usize = 64;

impl Planner {
    /// Follows a change of the cost inside rectangles in world units: paths are then those of a new planner.
    /// Costs are computed again only there, and marches follow.
    ///
    /// # Errors
    /// Fails when the new cost is zero, negative, NaN or infinite somewhere; then nothing changes.
    pub fn update(&mut self, density: &dyn CostDensity, areas: &[Rect]) -> Result<(), PathError> {
        let Some(Adaptation { base, costs: known, changed }) = &self.adaptation else {
            return self.change_costs(density, areas);
        };
        let meeting = base.meeting(&[changed, areas].concat());
        if meeting.is_empty() {
            return Ok(());
        }
        let mut known = known.clone();
        for (&triangle, cost) in meeting.iter().zip(base.costs_of(&meeting, density)?) {
            known[triangle as usize] = cost;
        }
        let (base, mut mesh) = (Arc::clone(base), Arc::clone(base));
        let costs = TriangleCosts::on_adapted(&mut mesh, &known, density)?;
        if mesh.is_same_as(&self.mesh) {
            let changed = self.costs.exchange(costs);
            self.follow_costs(&changed);
        } else {
            self.move_marches(mesh, costs);
        }
        self.adaptation = Some(Adaptation { base, costs: known, changed: Vec::new() });
        Ok(())
    }

    /// Goes over to another mesh, as after an edit that refined the mesh in some places, and follows a change
    /// of the cost inside rectangles in world units: paths are then those of a new planner for that mesh.
    /// Costs are computed again only there and for triangles that are new, and marches follow through those
    /// that are not.
    ///
    /// # Errors
    /// Fails as [`Self::update`] does; then nothing changes.
    pub fn move_to(
        &mut self,
        mesh: impl Into<Arc<PathMesh>>,
        density: &dyn CostDensity,
        areas: &[Rect],
    ) -> Result<(), PathError> {
        let new = mesh.into();
        let Some(Adaptation { base, costs: known, changed }) = &self.adaptation else {
            *self = Self::on_mesh(new, density)?;
            return Ok(());
        };
        if Arc::ptr_eq(base, &new) {
            return self.update(density, areas);
        }
        let shared = Shared::of(base, &new);
        let unknown = (0..).zip(&shared.triangles).filter(|&(_, &t)| t == NONE).map(|(t, _)| t);
        let mut unknown: Vec<u32> =
            new.meeting(&[changed, areas].concat()).into_iter().chain(unknown).collect();
        unknown.sort_unstable();
        unknown.dedup();
        let of_old = |&t: &u32| known.get(t as usize).copied().unwrap_or(TriangleCost::CLOSED);
        let mut known: Vec<TriangleCost> = shared.triangles.iter().map(of_old).collect();
        for (&triangle, cost) in unknown.iter().zip(new.costs_of(&unknown, density)?) {
            known[triangle as usize] = cost;
        }
        let mut mesh = Arc::clone(&new);
        let costs = TriangleCosts::on_adapted(&mut mesh, &known, density)?;
        self.adaptation = Some(Adaptation { base: new, costs: known, changed: Vec::new() });
        self.move_marches(mesh, costs);
        Ok(())
    }

    /// Takes another mesh with its costs, and lets the marches follow.
    fn move_marches(&mut self, mesh: Arc<PathMesh>, costs: TriangleCosts) {
        let old = std::mem::replace(&mut self.mesh, mesh);
        let before = std::mem::replace(&mut self.costs, costs);
        self.walls = Arc::new(Walls::new(&self.mesh));
        let Self { mesh, costs, origins, origins_for_bounds, .. } = self;
        let shared = Shared::of(&old, mesh);
        let is_changed = |&t: &u32| {
            let (t, known) = (t as usize, shared.triangles[t as usize] as usize);
            known == NONE as usize
                || before.least[known] != costs.least[t]
                || before.mean[known] != costs.mean[t]
                || old.triangles[known].passage != mesh.triangles[t].passage
        };
        let changed: Vec<u32> = (0..mesh.triangle_count() as u32).filter(is_changed).collect();
        let follow = |(origin, costs, least): (&mut Origin, &[f64], Passage)| {
            origin.move_to([&old, mesh], costs, least, (&shared, &changed));
        };
        let open = origins.par_iter_mut().map(|origin| (origin, &*costs.mean, Passage::Open));
        let partly = origins_for_bounds.par_iter_mut().map(|origin| (origin, &*costs.least, Passage::Partly));
        open.chain(partly).for_each(follow);
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
        let follow = |(origin, costs, least): (&mut Origin, &[f64], Passage)| {
            origin.follow(mesh, costs, least, changed);
        };
        let open = origins.par_iter_mut().map(|origin| (origin, &*costs.mean, Passage::Open));
        let partly = origins_for_bounds.par_iter_mut().map(|origin| (origin, &*costs.least, Passage::Partly));
        open.chain(partly).for_each(follow);
    }
}
