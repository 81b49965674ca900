//! What updates ask a rule.

use crate::mesh::kernel::coarsen::Star;
use crate::mesh::kernel::{LevelsWithin, Mesh, Questions, RuleAnswers, Triangle, TriangleId, any_exceeds};

/// A triangle that a search has found, and that a change can have made exceed its target.
#[derive(Clone, Debug)]
pub(super) struct FoundEntry {
    pub(super) id: TriangleId,
    /// Whether it exceeds its target.
    pub(super) exceeds: bool,
}

/// Asks whether entries of the mesh exceed their targets: most do not.
pub(super) struct EntryQuestions<'a> {
    pub(super) mesh: &'a Mesh,
}

impl Questions for EntryQuestions<'_> {
    type Question = FoundEntry;

    #[inline]
    fn ask<A: RuleAnswers>(&self, found: &mut FoundEntry, answers: &mut A) -> Result<(), A::Error> {
        let (corners, level) = (self.mesh.corners(found.id), self.mesh.triangle(found.id).level());
        found.exceeds = answers.exceeds(corners, level)?;
        Ok(())
    }
}

/// A triangle that may exceed its target.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenTriangle {
    pub(super) id: TriangleId,
    /// The level of the triangle. That of the entry is finer once the triangle was bisected.
    pub(super) level: u32,
    /// The known answers for it and for all triangles within it.
    pub(super) known: LevelsWithin,
}

/// Asks whether triangles exceed their targets, and those within them.
pub(super) struct SubtreeQuestions<'a> {
    pub(super) mesh: &'a Mesh,
}

impl Questions for SubtreeQuestions<'_> {
    type Question = OpenTriangle;

    #[inline]
    fn ask<A: RuleAnswers>(&self, open: &mut OpenTriangle, answers: &mut A) -> Result<(), A::Error> {
        let &mut OpenTriangle { id, level, known } = open;
        if self.mesh.triangle(id).level() == level {
            open.known = known.or_ask(level, || answers.levels_within(self.mesh.corners(id), level))?;
        }
        Ok(())
    }
}

/// The triangles around a node that can go, if neither parent needs it.
#[derive(Clone, Debug)]
pub(super) struct LooseStar {
    pub(super) star: Star,
    /// Whether a parent exceeds its target.
    pub(super) is_needed: bool,
}

/// Asks whether the parents of stars exceed their targets.
pub(super) struct StarParentQuestions<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) level_cap: u32,
}

impl Questions for StarParentQuestions<'_> {
    type Question = LooseStar;

    #[inline]
    fn ask<A: RuleAnswers>(&self, loose: &mut LooseStar, answers: &mut A) -> Result<(), A::Error> {
        let parents = self.mesh.parents(&loose.star);
        let of_parent =
            |parent: &Triangle| (parent.vertices.map(|node| self.mesh.node(node)), parent.level());
        loose.is_needed = any_exceeds(answers, self.level_cap, parents.iter().flatten().map(of_parent))?;
        Ok(())
    }
}
