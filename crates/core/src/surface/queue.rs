//! Where the bisections for a surface end.

use super::SurfaceRule;
use super::order::{BisectionOrder, MeasuredTriangle};
use crate::domain::DomainOnLattice;
use crate::layers::SurfaceNorm;
use crate::mesh::{Element, Limits, Mesh, Progress};

/// What an [`ErrorQueue`] looks for, by a norm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueueGoal {
    /// The error that is meant.
    pub norm: SurfaceNorm,
    /// The error that the mesh is to have at most.
    pub within: Option<f64>,
    /// The number of triangles that it may have.
    pub at_most: Option<usize>,
}

/// Bisects the triangles of a mesh in the order in which they count, and finds where a goal is met, in
/// slices.
///
/// ```text
///   bisections ───────────────────────────────▶
///   error       9    7    5    3    2    1
///                         ▲         ▲
///                within 5 ┘         └ the least with at most N triangles
/// ```
///
/// Each time that all triangles left count less than those bisected so far, the mesh does not depend on the
/// order of equals: these are the meshes that can be found. For the largest difference, each is the smallest
/// of its error.
#[derive(Clone, Debug)]
pub struct ErrorQueue {
    order: BisectionOrder,
    goal: QueueGoal,
    /// No mesh has more triangles.
    limit: usize,
    within: Option<GoalMesh>,
    at_most: Option<GoalMesh>,
    curve: Vec<CurvePoint>,
    last: Option<CurvePoint>,
}

/// A mesh, as a point of the curve of error against triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The number of triangles in the domain.
    pub triangles: usize,
    /// The error of the mesh.
    pub error: f64,
}

/// A mesh that meets a part of the goal.
#[derive(Clone, Copy, Debug)]
struct GoalMesh {
    error: f64,
    /// The number of bisections in order until then.
    bisections: usize,
}

/// By how much the number of triangles grows from one point of a curve to the next at least.
const CURVE_GROWTH: f64 = 1.02;

impl ErrorQueue {
    /// Returns the work on a mesh that meets everything else that is asked of it.
    pub fn new(mesh: Mesh, goal: QueueGoal, limits: &Limits) -> Self {
        let deepest = mesh.lattice().deepest_level();
        let deepest = limits.max_level.unwrap_or(deepest).min(deepest);
        Self {
            order: BisectionOrder::new(mesh, goal.norm, deepest),
            goal,
            limit: limits.most_triangles(),
            within: None,
            at_most: None,
            curve: Vec::new(),
            last: None,
        }
    }

    /// Returns the number of triangles so far.
    pub fn triangles(&self) -> usize {
        self.order.triangles()
    }

    /// Returns what is looked for.
    pub fn goal(&self) -> QueueGoal {
        self.goal
    }

    /// One slice of work: about `budget` triangles. `is_bound` says which triangles must be bisected by
    /// another rule that is not monotone.
    ///
    /// # Errors
    /// Fails with the errors of `is_bound`.
    pub fn advance<E>(
        &mut self,
        rule: &SurfaceRule,
        domain: &DomainOnLattice,
        mut is_bound: impl FnMut(&Element) -> Result<bool, E>,
        budget: usize,
    ) -> Result<Progress, E> {
        let norm = self.goal.norm;
        let mut measure = |element: &Element, nodes: &mut _| {
            let measured = rule.measure(element, nodes, norm);
            let is_bound = measured.is_bound || is_bound(element)?;
            Ok(MeasuredTriangle { is_bound, is_inside: !domain.excludes(element), ..measured })
        };
        for _ in 0..budget {
            if self.order.measure_next(&mut measure)? {
                continue;
            }
            if self.is_finished(rule) {
                return Ok(Progress::Done);
            }
            self.order.bisect_next(&mut measure)?;
        }
        Ok(Progress::More)
    }

    /// Returns the error of the mesh that was found; `None` where every mesh has too many triangles.
    pub fn found_error(&self) -> Option<f64> {
        self.found().map(|found| found.error)
    }

    /// Returns the triangles that are bisected for the goal, as `triangle_key`, and all there are where no
    /// mesh meets it.
    pub(super) fn bisected(&self) -> &[u64] {
        let all = self.order.bisected();
        match (self.found(), self.within_is_missed()) {
            (_, true) => all,
            (found, false) => &all[..found.map_or(0, |found| found.bisections)],
        }
    }

    /// Returns the error of the meshes by the number of their triangles, from the first mesh to the last;
    /// some of those between.
    pub fn curve(&self) -> impl Iterator<Item = CurvePoint> + '_ {
        let last = self.last.filter(|last| self.curve.last() != Some(last));
        self.curve.iter().copied().chain(last)
    }

    /// Returns the later one of the meshes that were looked for.
    fn found(&self) -> Option<GoalMesh> {
        let found = [self.within, self.at_most].into_iter().flatten();
        found.max_by_key(|found| found.bisections)
    }

    fn within_is_missed(&self) -> bool {
        self.goal.within.is_some() && self.within.is_none()
    }

    /// Returns whether nothing better can follow. Notes the mesh as it is where it can be one that is looked
    /// for.
    fn is_finished(&mut self, rule: &SurfaceRule) -> bool {
        let (key, can_be_found) = self.order.next_key();
        let triangles = self.order.counted();
        if can_be_found && key.is_finite() {
            let error = match self.goal.norm {
                SurfaceNorm::Largest => key,
                norm => rule.samples().root_of_mean(self.order.squares(), norm),
            };
            self.note(CurvePoint { triangles, error });
        }
        let may_be_better = self.goal.at_most.is_some_and(|most| triangles <= most);
        let is_met = !self.within_is_missed() && !may_be_better;
        is_met || key == 0.0 || self.order.triangles() > self.limit
    }

    fn note(&mut self, point: CurvePoint) {
        let found = GoalMesh { error: point.error, bisections: self.order.bisected().len() };
        if self.within_is_missed() && self.goal.within.is_some_and(|within| point.error <= within) {
            self.within = Some(found);
        }
        let is_allowed = self.goal.at_most.is_some_and(|most| point.triangles <= most);
        if is_allowed && self.at_most.is_none_or(|least| point.error < least.error) {
            self.at_most = Some(found);
        }
        if self.goal.at_most.is_some_and(|most| point.triangles > most) {
            return;
        }
        self.last = Some(point);
        let grown = |last: &CurvePoint| point.triangles as f64 >= CURVE_GROWTH * last.triangles as f64;
        if self.curve.last().is_none_or(grown) {
            self.curve.push(point);
        }
    }
}
