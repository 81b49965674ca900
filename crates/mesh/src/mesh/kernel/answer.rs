//! The answers of a refinement rule.

use std::convert::Infallible;

/// The answer of a refinement rule about a triangle: whether it exceeds its target.
///
/// A rule that always knows answers with `bool`, and one that can fail with a `Result`: its error ends the
/// work and comes back as [`RefineError::Rule`](crate::mesh::RefineError::Rule).
pub trait Answer {
    /// Why a rule cannot answer.
    type Error;

    /// Returns the answer.
    ///
    /// # Errors
    /// Fails when the rule cannot answer.
    fn into_result(self) -> Result<bool, Self::Error>;
}

impl Answer for bool {
    type Error = Infallible;

    #[inline]
    fn into_result(self) -> Result<bool, Infallible> {
        Ok(self)
    }
}

impl<E> Answer for Result<bool, E> {
    type Error = E;

    #[inline]
    fn into_result(self) -> Self {
        self
    }
}
