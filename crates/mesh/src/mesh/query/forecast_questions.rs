//! What forecasts ask a rule.

use crate::mesh::kernel::{LevelsWithin, Questions, RuleAnswers, TreeTriangle, any_exceeds};

/// A triangle that may exceed its target.
#[derive(Clone, Copy, Debug)]
pub(super) struct AskedTriangle {
    pub(super) triangle: TreeTriangle,
    /// The known answers for it and for all triangles within it.
    pub(super) known: LevelsWithin,
}

impl AskedTriangle {
    pub(super) fn level(&self) -> u32 {
        self.triangle.level()
    }

    /// Returns whether the triangle is known to exceed its target.
    pub(super) fn exceeds(&self) -> bool {
        self.known.exceeds(self.level()) == Some(true)
    }
}

/// The newest vertex of triangles that coarsening would remove.
pub(super) struct LooseVertex {
    pub(super) parents: [Option<TreeTriangle>; 2],
    /// Whether a parent exceeds its target.
    pub(super) is_needed: bool,
}

impl LooseVertex {
    pub(super) fn parents(&self) -> impl Iterator<Item = &TreeTriangle> {
        self.parents.iter().flatten()
    }
}

/// Asks about triangles of the tree, and about those within them.
pub(super) struct TreeQuestions {
    pub(super) level_cap: u32,
}

impl Questions for TreeQuestions {
    type Question = AskedTriangle;

    #[inline]
    fn ask<A: RuleAnswers>(&self, asked: &mut AskedTriangle, answers: &mut A) -> Result<(), A::Error> {
        let (corners, level) = (asked.triangle.corners(), asked.triangle.level());
        if level < self.level_cap {
            asked.known = asked.known.or_ask(level, || answers.levels_within(corners, level))?;
        }
        Ok(())
    }
}

/// Asks about entries of the mesh, most of which satisfy their target.
pub(super) struct MeshQuestions {
    pub(super) level_cap: u32,
}

impl Questions for MeshQuestions {
    type Question = AskedTriangle;

    #[inline]
    fn ask<A: RuleAnswers>(&self, asked: &mut AskedTriangle, answers: &mut A) -> Result<(), A::Error> {
        let level = asked.triangle.level();
        let exceeds = level < self.level_cap && answers.exceeds(asked.triangle.corners(), level)?;
        asked.known = LevelsWithin::single(level, exceeds);
        Ok(())
    }
}

/// Asks whether parents exceed their targets.
pub(super) struct ForecastParentQuestions {
    pub(super) level_cap: u32,
}

impl Questions for ForecastParentQuestions {
    type Question = LooseVertex;

    #[inline]
    fn ask<A: RuleAnswers>(&self, loose: &mut LooseVertex, answers: &mut A) -> Result<(), A::Error> {
        let parents = loose.parents().map(|parent| (parent.corners(), parent.level()));
        loose.is_needed = any_exceeds(answers, self.level_cap, parents)?;
        Ok(())
    }
}
