//! What updates ask a rule.

use super::area::ChangedArea;
use crate::mesh::kernel::coarsen::Star;
use crate::mesh::kernel::{LevelsWithin, Mesh, Questions, RuleAnswers, TriangleId};

/// A triangle that a search has found, or that may touch its area.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) id: TriangleId,
    /// Whether it touches the area.
    pub(super) touches: bool,
    /// Whether it exceeds its target, which the change can have caused.
    pub(super) exceeds: bool,
    /// Whether its newest vertex can have become free to go.
    pub(super) is_loose: bool,
}

impl Found {
    pub(super) fn new(id: TriangleId) -> Self {
        Self { id, touches: false, exceeds: false, is_loose: false }
    }
}

/// Asks what a change in an area can have done to triangles.
pub(super) struct InArea<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) area: &'a ChangedArea,
    pub(super) level_cap: u32,
}

impl Questions for InArea<'_> {
    type Question = Found;

    #[inline]
    fn ask<A: RuleAnswers>(&self, found: &mut Found, answers: &mut A) -> Result<(), A::Error> {
        let (corners, level) = (self.mesh.corners(found.id), self.mesh.triangle(found.id).level());
        found.touches = self.area.rect.touches(corners);
        if found.touches {
            let [asks, loosens] = self.area.concerns(self.mesh, corners, level);
            found.exceeds = asks && level < self.level_cap && answers.exceeds(corners, level)?;
            found.is_loose = loosens;
        }
        Ok(())
    }
}

/// A triangle that may exceed its target.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    pub(super) id: TriangleId,
    /// The level of the triangle. That of the entry is finer once the triangle was bisected.
    pub(super) level: u32,
    /// The known answers for it and for all triangles within it.
    pub(super) known: LevelsWithin,
}

/// Asks whether triangles exceed their targets, and those within them.
pub(super) struct Within<'a> {
    pub(super) mesh: &'a Mesh,
}

impl Questions for Within<'_> {
    type Question = Open;

    #[inline]
    fn ask<A: RuleAnswers>(&self, open: &mut Open, answers: &mut A) -> Result<(), A::Error> {
        let &mut Open { id, level, known } = open;
        if self.mesh.triangle(id).level() == level && known.exceeds(level).is_none() {
            open.known = known.and(answers.levels_within(self.mesh.corners(id), level)?);
        }
        Ok(())
    }
}

/// The triangles around a node that can go, if neither parent needs it.
#[derive(Clone, Debug)]
pub(super) struct Loose {
    pub(super) star: Star,
    /// Whether a parent exceeds its target.
    pub(super) is_needed: bool,
}

/// Asks whether the parents of stars exceed their targets.
pub(super) struct OfParents<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) level_cap: u32,
}

impl Questions for OfParents<'_> {
    type Question = Loose;

    #[inline]
    fn ask<A: RuleAnswers>(&self, loose: &mut Loose, answers: &mut A) -> Result<(), A::Error> {
        for parent in self.mesh.parents(&loose.star).iter().flatten() {
            let corners = parent.vertices.map(|node| self.mesh.node(node));
            let level = parent.level();
            loose.is_needed =
                loose.is_needed || (level < self.level_cap && answers.exceeds(corners, level)?);
        }
        Ok(())
    }
}
