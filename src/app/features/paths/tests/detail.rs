//! The triangles beside a keep-out region are smaller around the places of paths, also of those that moved
//! while the mesh was under way.

use std::sync::Arc;

use glam::{DVec2, dvec2};

use crate::app::features::paths::work::{KnownPlanner, PathWork, PlannedMesh, PlannerSource, WorkResult};
use meshbrush_core::document::{KeepOut, PathPlan};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::layers::{Mask, RiskField};
use meshbrush_core::path::Solution;
use meshbrush_kit::kit::jobs::Slice;
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};
use meshbrush_mesh::text::LengthUnit;

fn plan_to(goal: DVec2) -> Arc<PathPlan> {
    let ring = [(0.4, 0.2), (0.93, 0.5), (0.4, 0.8)].map(|(x, y)| dvec2(x, y));
    let keep_out = KeepOut { name: String::from("Zone"), mask: Mask::new(&[vec![ring.to_vec()]]).unwrap() };
    let routes = vec![vec![dvec2(0.05, 0.5), goal]];
    Arc::new(PathPlan { routes, keep_out: Arc::from([keep_out]), ..PathPlan::default() })
}

/// Returns the planner after the work on a plan, and its path.
fn after(source: PlannerSource, plan: Arc<PathPlan>, is_live: bool) -> (KnownPlanner, Option<Solution>) {
    let place = (Domain::rectangle(Rect::UNIT), BoundaryTreatment::Report, LengthUnit::default());
    let mut work = PathWork::new(source, (plan, RiskField::default()), place, is_live).unwrap();
    let work = loop {
        if let Slice::Found(work) = work.advance() {
            break work.unwrap();
        }
    };
    let WorkResult::Paths { mut routes, .. } = work.result else { panic!("no corridor was asked for") };
    (work.planner.unwrap(), routes.remove(0).ok().map(|found| found.solution))
}

#[test]
fn a_place_that_moves_while_the_mesh_is_under_way_gets_its_triangles_afterwards() {
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 10_000).unwrap();
    let mesh = Arc::new(Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap());
    let begin = || PlannerSource { known: None, mesh: Some(PlannedMesh::Mesh(Arc::clone(&mesh))) };
    let go_on = |known| PlannerSource { known: Some(Box::new(known)), mesh: None };
    // In a triangle through which the rim of the region passes.
    let [away, beside] = [dvec2(0.9, 0.1), dvec2(0.395, 0.5)].map(plan_to);
    let (known, _) = after(begin(), away, false);
    let count = known.planner.mesh().triangle_count();
    let (known, _) = after(go_on(known), beside.clone(), true);
    let (known, found) = after(go_on(known), beside.clone(), false);
    assert!(known.planner.mesh().triangle_count() > count);
    let (fresh, expected) = after(begin(), beside, false);
    assert_eq!(known.planner.mesh().triangle_count(), fresh.planner.mesh().triangle_count());
    assert!(found.is_some() && found == expected);
}
