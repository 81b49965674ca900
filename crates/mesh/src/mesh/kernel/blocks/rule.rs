//! What refinement in blocks asks a rule.

use crate::geometry::LatticePoint;

/// A refinement rule that several threads can ask. It must be monotone.
pub trait SharedRule: Sync {
    /// The answers for one thread, which may keep what helps with the next triangles nearby.
    fn answers(&self) -> impl RuleAnswers;
}

impl<F, A> SharedRule for F
where
    F: Fn() -> A + Sync,
    A: RuleAnswers,
{
    fn answers(&self) -> impl RuleAnswers {
        self()
    }
}

/// Answers of a refinement rule. A closure that says whether a triangle exceeds its target is enough.
pub trait RuleAnswers {
    /// What is known of a triangle, given by its corners in any order and its level, and of all triangles
    /// within it: at least whether the triangle itself exceeds its target.
    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> LevelsWithin;
}

impl<F: FnMut([LatticePoint; 3], u32) -> bool> RuleAnswers for F {
    #[inline]
    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> LevelsWithin {
        LevelsWithin::of_one(level, self(corners, level))
    }
}

/// What is known of all triangles within a triangle, by their levels.
///
/// ```text
///   level   …   exceed_below                satisfied_from   …
///   all exceed │ some exceed their target │ all satisfy it
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelsWithin {
    /// At coarser levels than this one, all exceed their target.
    pub exceed_below: u32,
    /// At this level and finer ones, all satisfy it.
    pub satisfied_from: u32,
}

impl LevelsWithin {
    /// Anything is possible.
    pub const UNKNOWN: Self = Self { exceed_below: 0, satisfied_from: u32::MAX };

    /// What follows from the answer for the triangle itself.
    #[inline]
    pub fn of_one(level: u32, exceeds: bool) -> Self {
        if exceeds {
            Self { exceed_below: level + 1, ..Self::UNKNOWN }
        } else {
            Self { satisfied_from: level, ..Self::UNKNOWN }
        }
    }

    /// The same, with an answer for the triangle itself, which is asked for unless it is known.
    #[inline]
    pub fn decided_at(self, level: u32, exceeds: impl FnOnce() -> bool) -> Self {
        match self.exceeds(level) {
            Some(_) => self,
            None => self.and(Self::of_one(level, exceeds())),
        }
    }

    /// What both say together.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        Self {
            exceed_below: self.exceed_below.max(other.exceed_below),
            satisfied_from: self.satisfied_from.min(other.satisfied_from),
        }
    }

    /// The answer for a triangle of a level, if it is known.
    #[inline]
    pub fn exceeds(&self, level: u32) -> Option<bool> {
        if level < self.exceed_below {
            Some(true)
        } else if level >= self.satisfied_from {
            Some(false)
        } else {
            None
        }
    }

    /// The level of all triangles, if it is known.
    #[inline]
    pub fn one_level(&self) -> Option<u32> {
        (self.exceed_below >= self.satisfied_from).then_some(self.satisfied_from)
    }
}
