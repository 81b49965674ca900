use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use super::functions::Third;
use super::{ParseError, Program, derivatives, gradient, interval, machine, parser};
use crate::field::{Bounds, TaylorModel};
use crate::geometry::Rect;

/// A formula in x, y and `risk`: a cost per unit of length.
///
/// The language is the one of [`Formula`](super::Formula). Clones share the compiled program.
///
/// ```
/// use meshbrush_core::field::CostFormula;
///
/// let cost = CostFormula::parse("1 + 20*risk^2")?;
/// assert_eq!(cost.eval(0.0, 0.0, 0.5), 6.0);
/// # Ok::<(), meshbrush_core::field::formula::ParseError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CostFormula {
    source: Arc<str>,
    program: Arc<Program>,
}

impl CostFormula {
    /// Reads and compiles a formula.
    ///
    /// # Errors
    /// Fails with the first mistake in reading order, as for [`Formula::parse`](super::Formula::parse).
    pub fn parse(source: &str) -> Result<Self, ParseError> {
        let program = parser::compile(source, Third::Risk)?;
        Ok(Self { source: source.into(), program: Arc::new(program) })
    }

    /// Returns the address of the compiled formula in memory. It is equal for clones, which share it.
    pub fn address(&self) -> usize {
        Arc::as_ptr(&self.program).addr()
    }

    /// Returns the memory that clones share, in bytes.
    pub fn bytes(&self) -> usize {
        self.source.len() + self.program.bytes()
    }

    /// Returns whether the value can depend on the risk.
    pub fn uses_risk(&self) -> bool {
        self.program.loads_third()
    }

    /// Returns the value at the point (x, y), in world units, with the risk there. The caller must check it.
    pub fn eval(&self, x: f64, y: f64, risk: f64) -> f64 {
        self.program.run_with(x, y, risk)
    }

    /// Returns bounds of [`Self::eval`] over a closed rectangle in world units with the given risks, by
    /// interval arithmetic.
    pub fn bounds(&self, rect: &Rect, risk: Bounds) -> Bounds {
        interval::bounds(&self.program, rect, risk)
    }

    /// Returns a model of [`Self::eval`] over a rectangle, from models of the coordinates and of the risk.
    pub(crate) fn model(&self, [x, y]: [TaylorModel; 2], risk: TaylorModel) -> TaylorModel {
        machine::run(&self.program, [x, y, risk])
    }

    /// Returns bounds of the derivatives along x and y over a closed rectangle in world units, with the given
    /// risks and bounds of their derivatives. `None` where the formula may jump, or a derivative is not
    /// known.
    pub fn derivatives(
        &self,
        rect: &Rect,
        risk: Bounds,
        risk_slopes: Option<[Bounds; 2]>,
    ) -> Option<[Bounds; 2]> {
        let slopes = match risk_slopes {
            Some(slopes) => slopes,
            None if self.uses_risk() && !risk.is_one() => return None,
            None => [gradient::ZERO; 2],
        };
        derivatives::derivatives(&self.program, rect, (risk, slopes))
    }

    /// Returns the text as it was typed.
    pub fn source(&self) -> &str {
        &self.source
    }
}

impl PartialEq for CostFormula {
    fn eq(&self, other: &Self) -> bool {
        self.source == other.source
    }
}

impl fmt::Display for CostFormula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.source)
    }
}

impl FromStr for CostFormula {
    type Err = ParseError;

    fn from_str(source: &str) -> Result<Self, ParseError> {
        Self::parse(source)
    }
}
