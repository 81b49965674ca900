//! The part of a rectangle that a formula gives, with its outline once that is known.

use std::sync::{Arc, Mutex, PoisonError};

use super::zero_line::{ZeroLine, ZeroLineTracer};
use crate::field::Formula;
use crate::geometry::Rect;

/// The part of a rectangle where a formula is neither zero nor NaN.
///
/// Clones share the outline: it is found once for a formula and a rectangle.
#[derive(Clone, Debug)]
pub struct FormulaShape {
    formula: Formula,
    outline: Arc<Mutex<Option<(Rect, ZeroLine)>>>,
}

impl FormulaShape {
    /// Returns the formula.
    pub fn formula(&self) -> &Formula {
        &self.formula
    }

    /// Returns the polygons in a proper rectangle, or why there are none. Where they are not known yet, they
    /// are found now, which takes some 0.15 s for a circle, and can take seconds.
    pub(super) fn outline_in(&self, bounds: &Rect) -> ZeroLine {
        // Not under the lock: threads that share the work might wait for each other.
        self.known_outline(bounds).unwrap_or_else(|| {
            self.keep_outline(*bounds, ZeroLineTracer::new(self.formula.clone(), *bounds).finish())
        })
    }

    /// Returns what [`Self::outline_in`] does, if it is known.
    pub(super) fn known_outline(&self, bounds: &Rect) -> Option<ZeroLine> {
        let known = self.outline.lock().unwrap_or_else(PoisonError::into_inner);
        known.as_ref().filter(|(of, _)| of == bounds).map(|(_, outline)| outline.clone())
    }

    /// Keeps what was found, for all clones, and returns it.
    pub(super) fn keep_outline(&self, bounds: Rect, outline: ZeroLine) -> ZeroLine {
        *self.outline.lock().unwrap_or_else(PoisonError::into_inner) = Some((bounds, outline.clone()));
        outline
    }
}

impl From<Formula> for FormulaShape {
    fn from(formula: Formula) -> Self {
        Self { formula, outline: Arc::default() }
    }
}

impl PartialEq for FormulaShape {
    fn eq(&self, other: &Self) -> bool {
        self.formula == other.formula
    }
}
