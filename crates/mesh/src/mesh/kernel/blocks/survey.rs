//! Which triangles of the bisection tree exceed their target.
//!
//! ```text
//!            exceeds                        slots:   0: bisected, children at 1 and 2
//!           /       \                                1: uniform, 0 levels
//!     satisfied    exceeds                           2: uniform, 1 level
//!                 /       \
//!          satisfied     satisfied
//! ```
//!
//! Tasks go down the tree depth first. Each asks a limited number of questions; what it leaves open becomes
//! the tasks of the next round. So tasks are small, and few levels of the tree are enough to keep all threads
//! busy.

use rayon::prelude::*;

use super::template::MOST_DEPTH;
use super::{LevelsWithin, RuleAnswers, SharedRule};
use crate::geometry::LatticePoint;
use crate::mesh::kernel::bisect::children_vertices;
use crate::mesh::kernel::{Limits, Mesh, Progress, RefineError, TriangleId};

/// The most triangles whose children a task asks about.
const TASK_VISITS: usize = 2048;
/// About the number of tasks into which a round is divided, where it has enough subtrees.
const TASKS: usize = 64;
/// The most subtrees of a task.
const MOST_SUBTREES: usize = 64;
/// The most triangles of the first task.
const MOST_AT_FIRST: usize = 4096;
/// The most tasks between two looks at the limits, unless the threads need more.
const MOST_TASKS: usize = 1024;
/// The fewest tasks of a slice for each thread: with one task for each, all threads would wait for the
/// slowest one.
const TASKS_PER_THREAD: usize = 4;

/// The planned treatment of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// The rule was not called yet.
    Open,
    /// The triangle is refined by this number of levels, everywhere.
    Uniform(u32),
    /// The triangle is bisected. Its children have two slots from this one on, first the child that keeps the
    /// parent's entry.
    Bisected(u32),
}

impl Wanted {
    /// The number of [`Slot`] for an open triangle. Below it are those of uniform ones, by their depth.
    const OPEN: u32 = u32::MAX;

    /// Returns this treatment as one number: there can be two for each triangle of the mesh.
    #[inline]
    pub const fn packed(self) -> Slot {
        Slot(match self {
            Self::Open => Self::OPEN,
            Self::Uniform(depth) => Self::OPEN - 1 - depth,
            Self::Bisected(first) => first,
        })
    }
}

/// [`Wanted`] in four bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slot(u32);

impl Slot {
    pub const OPEN: Self = Wanted::Open.packed();

    /// Returns the treatment.
    #[inline]
    pub const fn wanted(self) -> Wanted {
        match Wanted::OPEN - self.0 {
            0 => Wanted::Open,
            behind if behind <= MOST_DEPTH + 1 => Wanted::Uniform(behind - 1),
            _ => Wanted::Bisected(self.0),
        }
    }
}

/// The planned treatment of the triangles of a mesh, which have the first slots, in the order of their ids,
/// and of their descendants.
pub(super) type Slots = Vec<Slot>;

/// The survey of a mesh, in slices.
#[derive(Clone, Debug, Default)]
pub(super) struct Survey {
    slots: Slots,
    /// The subtrees of this round.
    round: Vec<Subtree>,
    /// The first of them that was not asked about.
    next: usize,
    /// The subtrees of the next round.
    open: Vec<Subtree>,
    triangles: usize,
    capped: usize,
}

/// A triangle of the tree, and its slot.
#[derive(Clone, Copy, Debug)]
struct Subtree {
    slot: u32,
    level: u32,
    /// The corners in the order of [`Triangle::vertices`](crate::mesh::Triangle::vertices).
    corners: [LatticePoint; 3],
}

impl Survey {
    pub fn new(mesh: &Mesh) -> Self {
        let subtree = |index| {
            let id = TriangleId::from_index(index);
            Subtree { slot: id.0, level: mesh.triangle(id).level(), corners: mesh.corners(id) }
        };
        let count = mesh.raw_triangle_count();
        Self { slots: vec![Slot::OPEN; count], round: (0..count).map(subtree).collect(), ..Self::default() }
    }

    /// Asks about `visits` triangles, or more where that occupies all threads.
    ///
    /// # Errors
    /// Fails when the rule fails, or there are more triangles than the limits allow, or too fine ones.
    pub fn advance<R: SharedRule>(
        &mut self,
        mesh: &Mesh,
        limits: &Limits,
        rule: &R,
        visits: usize,
    ) -> Result<Progress, RefineError<R::Error>> {
        if self.next == self.round.len() {
            (self.round, self.next) = (std::mem::take(&mut self.open), 0);
        }
        let threads = rayon::current_num_threads();
        // Several threads need enough for all of them; one alone ends its slice in time.
        let (most_visits, at_least) = match threads {
            1 => (visits.clamp(1, TASK_VISITS), 1),
            _ => (TASK_VISITS, TASKS_PER_THREAD * threads),
        };
        let tasks = (visits / TASK_VISITS).min(MOST_TASKS).max(at_least);
        let size = match self.is_first_round() {
            true if threads == 1 => self.round.len().min(most_visits),
            true => self.round.len().min(MOST_AT_FIRST),
            false => (self.round.len() / TASKS).clamp(1, MOST_SUBTREES),
        };
        let end = (self.next + tasks * size).min(self.round.len());
        let task = |answers| Task::new(mesh, limits, answers, most_visits);
        let subtrees = self.round[self.next..end].par_chunks(size).with_max_len(1);
        let found: Vec<_> = subtrees.map(|subtrees| task(rule.answers()).survey(subtrees)).collect();
        let firsts = (self.next..).step_by(size);
        for (found, first) in found.into_iter().zip(firsts) {
            let found = found?;
            if let Some(at) = found.too_fine {
                return Err(RefineError::too_fine(mesh.lattice(), at));
            }
            self.take(found, first);
        }
        self.next = end;
        if self.triangles > limits.most_triangles() {
            return Err(limits.passed().with_rule());
        }
        let is_done = self.next == self.round.len() && self.open.is_empty();
        Ok(if is_done { Progress::Done } else { Progress::More })
    }

    /// Returns whether nothing is known yet. Then one task asks about all triangles: small meshes are done
    /// before another thread could wake.
    fn is_first_round(&self) -> bool {
        self.next == 0 && self.triangles == 0 && self.slots.len() == self.round.len()
    }

    /// Takes the result of the task whose first subtree is this one of the round.
    fn take(&mut self, found: SurveyPart, first: usize) {
        let SurveyPart { slots, open, subtrees, triangles, capped, .. } = found;
        self.triangles += triangles;
        self.capped += capped;
        let behind = self.slots.len() - subtrees;
        let moved = |slot: Slot| match slot.wanted() {
            Wanted::Bisected(first) => Wanted::Bisected(first + behind as u32).packed(),
            _ => slot,
        };
        let round = &self.round[first..first + subtrees];
        for (subtree, &slot) in round.iter().zip(&slots) {
            self.slots[subtree.slot as usize] = moved(slot);
        }
        self.slots.extend(slots[subtrees..].iter().copied().map(moved));
        self.open.extend(open.into_iter().map(|subtree| {
            let slot = match round.get(subtree.slot as usize) {
                Some(of_round) => of_round.slot,
                None => subtree.slot + behind as u32,
            };
            Subtree { slot, ..subtree }
        }));
    }

    /// Returns how many triangles of the tree need not be bisected, as far as known.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Returns how many triangles exceed their target at the level cap.
    pub fn capped(&self) -> usize {
        self.capped
    }

    /// Returns the slots, once all questions are answered.
    pub fn finish(mut self) -> Slots {
        // Parents come before their children; tasks could not join what other tasks have found.
        for slot in (0..self.slots.len()).rev() {
            if let Wanted::Bisected(first) = self.slots[slot].wanted() {
                self.slots[slot] = joined(&self.slots, first).packed();
            }
        }
        self.slots
    }
}

/// Returns the planned treatment of a bisected triangle from the treatments of its children.
#[inline]
fn joined(slots: &[Slot], first: u32) -> Wanted {
    match [0, 1].map(|child| slots[first as usize + child].wanted()) {
        [Wanted::Uniform(a), Wanted::Uniform(b)] if a == b && a < MOST_DEPTH => Wanted::Uniform(a + 1),
        _ => Wanted::Bisected(first),
    }
}

/// Questions about some subtrees.
struct Task<A> {
    answers: A,
    /// The level of the limits, and the deepest one of the lattice.
    cap: u32,
    deepest: u32,
    /// How many triangles may still be visited.
    visits: usize,
    found: SurveyPart,
}

/// The result of a task. Slots are numbered within the task: its subtrees have the first ones.
#[derive(Default)]
struct SurveyPart {
    subtrees: usize,
    slots: Slots,
    open: Vec<Subtree>,
    triangles: usize,
    capped: usize,
    /// A corner of a triangle that exceeds its target at the deepest level of the lattice: there is no mesh.
    too_fine: Option<LatticePoint>,
}

impl<A: RuleAnswers> Task<A> {
    fn new(mesh: &Mesh, limits: &Limits, answers: A, visits: usize) -> Self {
        let (cap, deepest) = (limits.level_cap(), mesh.lattice().deepest_level());
        Self { answers, cap, deepest, visits, found: SurveyPart::default() }
    }

    fn survey(mut self, subtrees: &[Subtree]) -> Result<SurveyPart, A::Error> {
        self.found.subtrees = subtrees.len();
        self.found.slots = vec![Slot::OPEN; subtrees.len()];
        for (slot, &subtree) in subtrees.iter().enumerate() {
            let subtree = Subtree { slot: slot as u32, ..subtree };
            let levels = self.ask(&subtree, LevelsWithin::UNKNOWN)?;
            self.found.slots[slot] = self.wanted(&subtree, levels)?.packed();
        }
        Ok(self.found)
    }

    /// Decides the treatment of a triangle from the known answers for it and for all triangles within it.
    #[inline]
    fn wanted(&mut self, triangle: &Subtree, levels: LevelsWithin) -> Result<Wanted, A::Error> {
        if self.is_bisected(triangle, levels) {
            return self.bisected(triangle, levels);
        }
        self.found.triangles += 1;
        Ok(Wanted::Uniform(0))
    }

    /// Asks about the descendants of a triangle that is bisected.
    fn bisected(&mut self, triangle: &Subtree, levels: LevelsWithin) -> Result<Wanted, A::Error> {
        if let Some(depth) = self.uniform_depth(triangle.level, levels) {
            self.found.triangles += 1 << depth;
            return Ok(Wanted::Uniform(depth));
        }
        if self.visits == 0 {
            self.found.open.push(*triangle);
            return Ok(Wanted::Open);
        }
        self.visits -= 1;
        let first = self.found.slots.len() as u32;
        self.found.slots.extend([Slot::OPEN; 2]);
        for child in triangle.children(first) {
            let levels = self.ask(&child, levels)?;
            self.found.slots[child.slot as usize] = self.wanted(&child, levels)?.packed();
        }
        let joined = joined(&self.found.slots, first);
        if let Wanted::Uniform(_) = joined {
            // No slot is behind those of the children.
            self.found.slots.truncate(first as usize);
        }
        Ok(joined)
    }

    /// Returns the known answers for a triangle and for all triangles within it, given the answers known
    /// before.
    #[inline]
    fn ask(&mut self, triangle: &Subtree, known: LevelsWithin) -> Result<LevelsWithin, A::Error> {
        known.or_ask(triangle.level, || self.answers.levels_within(triangle.corners, triangle.level))
    }

    /// Returns whether a triangle exceeds its target and may be bisected.
    #[inline]
    fn is_bisected(&mut self, triangle: &Subtree, levels: LevelsWithin) -> bool {
        let exceeds = triangle.level < levels.exceed_below;
        exceeds && (triangle.level < self.cap.min(self.deepest) || self.stop(triangle))
    }

    /// Notes a triangle that exceeds its target but must not be bisected.
    #[cold]
    fn stop(&mut self, triangle: &Subtree) -> bool {
        if triangle.level >= self.cap {
            self.found.capped += 1;
        } else {
            self.found.too_fine.get_or_insert(triangle.corners[0]);
        }
        false
    }

    /// Returns the number of levels by which a triangle is refined everywhere, if it is known.
    #[inline]
    fn uniform_depth(&self, level: u32, levels: LevelsWithin) -> Option<u32> {
        let depth = levels.one_level()?.checked_sub(level)?;
        (depth <= MOST_DEPTH && level + depth <= self.cap.min(self.deepest)).then_some(depth)
    }
}

impl Subtree {
    /// Returns the children, with slots from this one on.
    #[inline]
    fn children(&self, first_slot: u32) -> [Self; 2] {
        let is_odd = self.level % 2 == 1;
        let midpoint = self.corners[0].midpoint(self.corners[if is_odd { 1 } else { 2 }]);
        let [a, b] = children_vertices(self.corners, midpoint, is_odd);
        [(first_slot, a), (first_slot + 1, b)].map(|(slot, corners)| Self {
            slot,
            level: self.level + 1,
            corners,
        })
    }
}
