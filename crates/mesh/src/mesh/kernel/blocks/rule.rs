//! The interface of rules for refinement in blocks.

use crate::geometry::LatticePoint;
use crate::mesh::kernel::Answer;

/// A refinement rule that several threads can ask. It must be monotone: all triangles within a triangle that
/// satisfies it satisfy it too.
pub trait SharedRule: Sync {
    /// Why the rule cannot answer; [`Infallible`](std::convert::Infallible) where it always can.
    type Error: Send;

    /// Returns the answers for one thread, which may keep what helps with the next triangles nearby.
    fn answers(&self) -> impl RuleAnswers<Error = Self::Error>;

    /// Returns how many questions are worth another thread: they should take longer than the tenth of a
    /// millisecond that it needs to wake up.
    fn questions_per_thread(&self) -> usize {
        1024
    }
}

impl<F, A> SharedRule for F
where
    F: Fn() -> A + Sync,
    A: RuleAnswers<Error: Send>,
{
    type Error = A::Error;

    fn answers(&self) -> impl RuleAnswers<Error = Self::Error> {
        self()
    }
}

/// Answers of a refinement rule. A closure that returns whether a triangle exceeds its target is enough.
pub trait RuleAnswers {
    /// Why the rule cannot answer.
    type Error;

    /// Returns the answers for a triangle, given by its corners in any order and its level, and as far as
    /// known for all triangles within it. The answer for the triangle itself must be known.
    ///
    /// # Errors
    /// Fails when the rule cannot answer.
    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> Result<LevelsWithin, Self::Error>;

    /// Returns whether a triangle exceeds its target, where nothing needs to be known of those within it.
    ///
    /// # Errors
    /// Fails when the rule cannot answer.
    #[inline]
    fn exceeds(&mut self, corners: [LatticePoint; 3], level: u32) -> Result<bool, Self::Error> {
        Ok(self.levels_within(corners, level)?.exceeds(level) == Some(true))
    }
}

impl<F, A> RuleAnswers for F
where
    F: FnMut([LatticePoint; 3], u32) -> A,
    A: Answer,
{
    type Error = A::Error;

    #[inline]
    fn levels_within(&mut self, corners: [LatticePoint; 3], level: u32) -> Result<LevelsWithin, A::Error> {
        Ok(LevelsWithin::single(level, self(corners, level).into_result()?))
    }
}

/// The known answers for all triangles within a triangle, by their levels.
///
/// ```text
///   level   …   exceed_below                satisfied_from   …
///   all exceed │ some exceed their target │ all satisfy it
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelsWithin {
    /// All triangles at levels coarser than this one exceed their target.
    pub exceed_below: u32,
    /// All triangles at this level and finer ones satisfy their target.
    pub satisfied_from: u32,
}

impl LevelsWithin {
    /// Anything is possible.
    pub const UNKNOWN: Self = Self { exceed_below: 0, satisfied_from: u32::MAX };

    /// Returns the answers that follow from the answer for the triangle itself.
    #[inline]
    pub fn single(level: u32, exceeds: bool) -> Self {
        if exceeds {
            Self { exceed_below: level + 1, ..Self::UNKNOWN }
        } else {
            Self { satisfied_from: level, ..Self::UNKNOWN }
        }
    }

    /// Adds the answer for a triangle of `level` itself. `exceeds` is called unless the answer is known.
    #[inline]
    pub fn decided_at(self, level: u32, exceeds: impl FnOnce() -> bool) -> Self {
        match self.exceeds(level) {
            Some(_) => self,
            None => self.and(Self::single(level, exceeds())),
        }
    }

    /// Returns these answers if that for a triangle of `level` itself is among them, else those that `ask`
    /// adds.
    #[inline]
    pub(in crate::mesh) fn or_ask<E>(
        self,
        level: u32,
        ask: impl FnOnce() -> Result<Self, E>,
    ) -> Result<Self, E> {
        match self.exceeds(level) {
            Some(_) => Ok(self),
            None => Ok(self.and(ask()?)),
        }
    }

    /// Combines two sets of answers for the same triangles.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        Self {
            exceed_below: self.exceed_below.max(other.exceed_below),
            satisfied_from: self.satisfied_from.min(other.satisfied_from),
        }
    }

    /// Returns the answer for a triangle of a level, if it is known.
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

    /// Returns the level of all triangles, if it is known.
    #[inline]
    pub fn one_level(&self) -> Option<u32> {
        (self.exceed_below >= self.satisfied_from).then_some(self.satisfied_from)
    }
}
