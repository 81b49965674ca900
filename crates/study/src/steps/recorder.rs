//! Runs Algorithms 10 to 12 in the order of the report, and notes every step.

use std::collections::BTreeSet;

use super::pseudo_code::NeighbourCase;
use super::recording::{RecordedStep, Recording, ReportRow, RowChange, StepAction, report_row};
use super::stages::StepStage;
use crate::domain::DomainOnLattice;
use crate::mesh::{Answer, Cleaning, Element, Limits, Mesh, Orientation, Progress, RefineError, TriangleId};
use crate::outline::{EdgeTargets, derivation_stages};

/// A triangle and its row; `None` while it is not in the array.
type KnownRow = (TriangleId, Option<ReportRow>);

/// Refines a coarse grid as the report does, from the start of the array to its end, and records the steps.
///
/// The report never comes back to a triangle that it found satisfied. Where compatibility bisects such a
/// triangle later and a half of it exceeds its target, this visits the half at the end, so that the mesh is
/// the one of [`Refiner`](crate::mesh::Refiner).
#[derive(Clone, Debug)]
pub struct StepRecorder {
    mesh: Mesh,
    limits: Limits,
    most_triangles: usize,
    /// The entry that Algorithm 12 comes to next.
    next: usize,
    /// The entry whose rule is being asked, if it may have to be asked again.
    current: Option<TriangleId>,
    /// Whether `current` was visited before.
    again: bool,
    /// Entries that were bisected after their visit.
    reopened: BTreeSet<usize>,
    nodes_before: usize,
    coarse_rows: Vec<ReportRow>,
    steps: Vec<RecordedStep>,
    changes: Vec<RowChange>,
    is_cut_short: bool,
}

impl StepRecorder {
    /// Returns the work on a coarse grid. It stops before it bisects a triangle of a mesh that has
    /// `most_triangles`.
    pub fn new(mesh: Mesh, limits: Limits, most_triangles: usize) -> Self {
        Self {
            next: 0,
            current: None,
            again: false,
            reopened: BTreeSet::new(),
            nodes_before: mesh.raw_nodes().len(),
            coarse_rows: mesh.raw_triangles().iter().map(report_row).collect(),
            steps: Vec::new(),
            changes: Vec::new(),
            is_cut_short: false,
            mesh,
            limits,
            most_triangles,
        }
    }

    /// Returns how many triangles the mesh has so far.
    pub fn triangles(&self) -> usize {
        self.mesh.raw_triangle_count()
    }

    /// Continues until done or until `visits` triangles were asked about. `exceeds` is as for
    /// [`Refiner::advance`](crate::mesh::Refiner::advance).
    ///
    /// # Errors
    /// Fails when the rule fails, or a target is too small for the lattice.
    pub fn advance<A: Answer>(
        &mut self,
        mut exceeds: impl FnMut(&Element) -> A,
        visits: usize,
    ) -> Result<Progress, RefineError<A::Error>> {
        let cap = self.limits.max_level.unwrap_or(u32::MAX);
        let mut asks = |mesh: &Mesh, id: TriangleId| -> Result<bool, A::Error> {
            Ok(exceeds(&mesh.element(id)).into_result()? && mesh.triangle(id).level() < cap)
        };
        for _ in 0..visits {
            let Some(id) = self.current.or_else(|| self.next_in_array()) else {
                match self.reopened.pop_first().map(TriangleId::from_index) {
                    // Nothing is noted where it is satisfied, as in the report.
                    Some(id) if asks(&self.mesh, id)? => (self.current, self.again) = (Some(id), true),
                    Some(_) => {}
                    None => return Ok(self.end(false)),
                }
                continue;
            };
            let asks_for_more = asks(&self.mesh, id)?;
            self.current = asks_for_more.then_some(id);
            self.note(StepAction::Visit { exceeds: asks_for_more, again: self.again }, id, id);
            self.again &= asks_for_more;
            if !asks_for_more {
                continue;
            }
            if self.mesh.raw_triangle_count() >= self.most_triangles {
                self.steps.pop();
                return Ok(self.end(true));
            }
            if self.mesh.triangle(id).level() >= self.mesh.lattice().deepest_level() {
                return Err(RefineError::too_fine(self.mesh.lattice(), self.mesh.corners(id)[0]));
            }
            self.refine_triangle(id);
        }
        Ok(Progress::More)
    }

    /// Returns the recording.
    pub fn finish(self) -> Recording {
        Recording {
            lattice: *self.mesh.lattice(),
            coarse_nodes: self.nodes_before,
            coarse_rows: self.coarse_rows,
            nodes: self.mesh.raw_nodes().to_vec(),
            is_cut_short: self.is_cut_short,
            steps: self.steps,
            changes: self.changes,
            stages: Vec::new(),
        }
    }

    /// Returns the recording with what follows the refinement on a domain, if that came to its end: triangles
    /// outside are removed, and nodes move onto the outline. The end is the mesh that is shown and exported.
    pub fn finish_on(
        mut self,
        domain: &DomainOnLattice,
        targets: Option<EdgeTargets>,
        cleaning: &Cleaning,
    ) -> Recording {
        if self.is_cut_short {
            return self.finish();
        }
        if domain.is_fitted() {
            let all = 0..self.mesh.raw_triangle_count();
            self.mesh.classify(all, |element| domain.excludes(element));
        }
        let stages = StepStage::all(&self.mesh, derivation_stages(&self.mesh, domain, targets, cleaning));
        self.finish().with_stages(stages)
    }

    fn next_in_array(&mut self) -> Option<TriangleId> {
        let index = self.next;
        (index < self.mesh.raw_triangle_count()).then(|| {
            self.next += 1;
            TriangleId::from_index(index)
        })
    }

    fn end(&mut self, is_cut_short: bool) -> Progress {
        let is_first_end = self.steps.last().is_none_or(|step| step.action != StepAction::Finish);
        if !is_cut_short && is_first_end {
            self.steps.push(RecordedStep::of_all(StepAction::Finish, self.changes.len()));
        }
        self.is_cut_short = is_cut_short;
        Progress::Done
    }

    /// Algorithms 10 and 11.
    fn refine_triangle(&mut self, visited: TriangleId) {
        let (mut stack, mut id) = (Vec::new(), visited);
        while let Some(across) = self.across(id)
            && self.mesh.triangle(across).level() < self.mesh.triangle(id).level()
        {
            self.note(StepAction::Push, id, visited);
            stack.push(id);
            id = across;
        }
        self.note(StepAction::Divisible, id, visited);
        self.bisect(id, visited);
        while let Some(waiting) = stack.pop() {
            self.note(StepAction::Pop, waiting, visited);
            self.bisect(waiting, visited);
        }
    }

    /// Algorithms 8 and 19, in two steps.
    fn bisect(&mut self, id: TriangleId, visited: TriangleId) {
        let across = self.across(id);
        let parents: Vec<TriangleId> = [Some(id), across].into_iter().flatten().collect();
        parents.iter().for_each(|&parent| self.note_reopened(parent));
        let around = parents.iter().flat_map(|&parent| self.mesh.triangle(parent).raw_neighbours);
        let around = around.filter_map(|n| n.triangle()).filter(|one| !parents.contains(one));
        let row = |id: TriangleId| (id, Some(report_row(self.mesh.triangle(id))));
        let before = (parents.iter().copied().map(row).collect(), around.map(row).collect());
        let first_new = self.mesh.raw_triangle_count();
        let update = self.described(StepAction::UpdateNeighbours(self.case(id)), id, visited);
        self.note(StepAction::Bisect, id, visited);
        if let Some(step) = self.steps.last_mut() {
            step.new_node = Some(self.mesh.raw_nodes().len() as u32 + 1);
        }
        let new_node = self.mesh.bisect_compatible(id);
        debug_assert!(new_node.is_some(), "the pair is compatibly divisible");
        self.note_changes(update, before, first_new);
    }

    /// Divides the changes between the step that bisects and the one that updates neighbours. The rows are
    /// those of the parents and of the triangles around them, before both steps.
    fn note_changes(
        &mut self,
        update: RecordedStep,
        (parents, around): (Vec<KnownRow>, Vec<KnownRow>),
        first_new: usize,
    ) {
        let new =
            (first_new..self.mesh.raw_triangle_count()).map(|index| (TriangleId::from_index(index), None));
        let mut linked = Vec::new();
        for (id, before) in parents.into_iter().chain(new).chain(around) {
            let number = id.index() as u32 + 1;
            let after = report_row(self.mesh.triangle(id));
            let mut halfway = after;
            halfway[3..6].copy_from_slice(&before.map_or([0; 3], |row| [row[3], row[4], row[5]]));
            if before != Some(halfway) {
                self.changes.push(RowChange { number, before, after: halfway });
            }
            if halfway != after {
                linked.push(RowChange { number, before: Some(halfway), after });
            }
        }
        self.steps.push(RecordedStep { first_change: self.changes.len() as u32, ..update });
        self.changes.append(&mut linked);
    }

    /// Notes that a triangle is bisected that was found satisfied.
    fn note_reopened(&mut self, id: TriangleId) {
        if id.index() < self.next && self.current != Some(id) {
            self.reopened.insert(id.index());
        }
    }

    fn across(&self, id: TriangleId) -> Option<TriangleId> {
        self.mesh.triangle(id).raw_neighbours[0].triangle()
    }

    fn orientation(&self, id: TriangleId) -> u8 {
        u8::from(self.mesh.triangle(id).orientation() == Orientation::Anticlockwise)
    }

    fn case(&self, id: TriangleId) -> NeighbourCase {
        let across = self.across(id).map(|across| self.orientation(across));
        NeighbourCase::of(self.mesh.triangle(id).bisection_end() as u8, self.orientation(id), across)
    }

    fn note(&mut self, action: StepAction, id: TriangleId, visited: TriangleId) {
        let step = self.described(action, id, visited);
        self.steps.push(step);
    }

    fn described(&self, action: StepAction, id: TriangleId, visited: TriangleId) -> RecordedStep {
        let (triangle, across) = (self.mesh.triangle(id), self.across(id));
        RecordedStep {
            action,
            triangle: id.index() as u32 + 1,
            visited: visited.index() as u32 + 1,
            across: across.map(|across| across.index() as u32 + 1),
            level: triangle.level() as u8,
            k: triangle.bisection_end() as u8,
            orientation: self.orientation(id),
            orientation_across: across.map(|across| self.orientation(across)),
            new_node: None,
            first_change: self.changes.len() as u32,
        }
    }
}
