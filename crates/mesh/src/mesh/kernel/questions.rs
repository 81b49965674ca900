//! Questions to a rule, many at once and on all threads.
//!
//! The mesh does not change meanwhile, and each question is answered by itself: the answers are the same for
//! any number of threads.

use rayon::prelude::*;

use super::{RuleAnswers, SharedRule};
use crate::geometry::LatticePoint;

/// Tasks for each thread: with one task each, all threads would wait for the slowest one.
const TASKS_PER_THREAD: usize = 4;

/// A kind of question.
pub(in crate::mesh) trait Questions: Sync {
    /// A question, and once asked its answer.
    type Question: Send;

    /// Answers a question.
    fn ask<A: RuleAnswers>(&self, question: &mut Self::Question, answers: &mut A) -> Result<(), A::Error>;
}

/// Asks all questions; on the threads of the current pool of rayon where that is faster.
pub(in crate::mesh) fn ask_all<Q: Questions, R: SharedRule>(
    kind: &Q,
    questions: &mut [Q::Question],
    rule: &R,
) -> Result<(), R::Error> {
    let ask = |questions: &mut [Q::Question]| {
        let mut answers = rule.answers();
        questions.iter_mut().try_for_each(|question| kind.ask(question, &mut answers))
    };
    let fewest = rule.questions_per_thread().max(1);
    let threads = rayon::current_num_threads();
    if threads == 1 || questions.len() < 2 * fewest {
        return ask(questions);
    }
    let size = questions.len().div_ceil(TASKS_PER_THREAD * threads).max(fewest / 2);
    // The first error, whichever thread is the first to meet one.
    questions.par_chunks_mut(size).map(ask).collect::<Vec<_>>().into_iter().collect()
}

/// Returns whether one of some triangles, given by their corners and levels, exceeds its target. Those at the
/// cap or finer do not.
#[inline]
pub(in crate::mesh) fn any_exceeds<A: RuleAnswers>(
    answers: &mut A,
    level_cap: u32,
    triangles: impl IntoIterator<Item = ([LatticePoint; 3], u32)>,
) -> Result<bool, A::Error> {
    for (corners, level) in triangles {
        if level < level_cap && answers.exceeds(corners, level)? {
            return Ok(true);
        }
    }
    Ok(false)
}
