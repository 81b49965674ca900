//! Formulas in x and y, as a person types them: `if(abs(x)+abs(y)<0.4, 0.0125, 1)`.
//!
//! # The language
//!
//! From the loosest binding to the tightest:
//!
//! | written | meaning |
//! |---|---|
//! | `a or b`, `a \|\| b` | 1 if either is true, else 0; `b` is not evaluated if `a` decides |
//! | `a and b`, `a && b` | 1 if both are true, else 0; `b` is not evaluated if `a` decides |
//! | `not a` | 1 if `a` is 0, else 0; binds loosely: `not x < 1` is `not (x < 1)` |
//! | `<` `<=` `>` `>=` `==` `!=` | 1 or 0; a chain such as `0 < x <= 1` is `0 < x and x <= 1` |
//! | `+` `-` | from left to right |
//! | `*` `/` `%` | from left to right; `%` takes the sign of its right side, as in Python |
//! | `-a` `+a` `!a` | `-2^2` is −4; `!` is `not`, and binds like a sign |
//! | `a^b`, `a**b` | from right to left: `2^3^2` is 512 |
//!
//! A *value* is a number (`1`, `.5`, `1e-3`), a coordinate (`x`, `y`, and the polar `r` and `theta`),
//! a constant (`pi`, `tau`, `e`, `inf`), a function call ([`functions`] lists them), or a formula in
//! parentheses. Everything but 0 counts as true, NaN too. The signs `×` `·` `÷` `−` `≤` `≥` `≠`
//! `π` `τ` `θ`, as pasted from a document, are understood.
//!
//! # Exactness
//!
//! Every operation is one operation of f64, done in the order written: nothing is re-associated,
//! fused or approximated. Roots and rounding are exact by IEEE 754; every other function comes from
//! `libm`, so a formula has the same bits on every machine.

#[cfg(test)]
mod bounds_tests;
mod cost;
mod derivatives;
mod error;
mod function_bounds;
mod functions;
mod gradient;
#[cfg(test)]
mod gradient_tests;
mod interval;
mod lexer;
mod machine;
#[cfg(test)]
mod model_tests;
mod models;
mod parser;
mod pointer;
mod program;
mod slopes;
#[cfg(test)]
mod tests;

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

pub use cost::CostFormula;
pub use error::ParseError;
use functions::Third;
pub use functions::functions;
pub use parser::{MAX_LENGTH, MAX_NESTING};
pub use pointer::draw_pointer;
use program::{Op, Program};

use crate::field::{Bounds, TaylorModel};
use crate::geometry::Rect;

/// A formula in x and y, compiled once and evaluated many times.
///
/// Cloning shares the compiled program. Two formulas are equal when their texts are.
///
/// ```
/// use meshbrush_core::field::Formula;
///
/// let target = Formula::parse("if(abs(x)+abs(y)<0.4, 0.0125, 1)")?;
/// assert_eq!(target.eval(0.1, -0.2), 0.0125);
/// assert_eq!(target.eval(0.4, 0.0), 1.0); // the line itself is outside: `<` is strict
/// # Ok::<(), meshbrush_core::field::formula::ParseError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Formula {
    source: Arc<str>,
    program: Arc<Program>,
}

impl Formula {
    /// Reads and compiles a formula.
    ///
    /// # Errors
    ///
    /// Fails with the first mistake in reading order, with its place and what would help. Texts longer than
    /// 64 KiB and expressions nested deeper than 200 are mistakes too.
    ///
    /// ```
    /// use meshbrush_core::field::Formula;
    ///
    /// let mistake = Formula::parse("1 + 2*sqr(x)").unwrap_err();
    /// assert_eq!(mistake.to_string(), "There is no `sqr`; write `v^2`.");
    /// assert_eq!(mistake.pointer(), "1 + 2*sqr(x)\n      ^^^");
    /// ```
    pub fn parse(source: &str) -> Result<Self, ParseError> {
        let program = parser::compile(source, Third::Nothing)?;
        Ok(Self { source: source.into(), program: Arc::new(program) })
    }

    /// Reads and compiles a formula for a target diameter or a value at the nodes, which may also use
    /// `depth`: the depth of the water in metres, positive downwards.
    ///
    /// # Errors
    /// Fails as [`Self::parse`] does.
    ///
    /// ```
    /// use meshbrush_core::field::Formula;
    ///
    /// let target = Formula::parse_of_size("50 + 2*max(depth, 0)")?;
    /// assert!(target.uses_depth());
    /// assert_eq!(target.eval_with_depth(0.0, 0.0, 20.0), 90.0);
    /// # Ok::<(), meshbrush_core::field::formula::ParseError>(())
    /// ```
    pub fn parse_of_size(source: &str) -> Result<Self, ParseError> {
        let program = parser::compile(source, Third::Depth)?;
        Ok(Self { source: source.into(), program: Arc::new(program) })
    }

    /// Returns whether the value can depend on the depth. Without one, such a formula has no value.
    pub fn uses_depth(&self) -> bool {
        self.program.loads_third()
    }

    /// Returns the value at the point (x, y), in world units, where the depth in metres is `depth`. The
    /// caller must check it, as for [`Self::eval`].
    pub fn eval_with_depth(&self, x: f64, y: f64, depth: f64) -> f64 {
        self.program.run_with(x, y, depth)
    }

    /// Returns bounds of [`Self::eval_with_depth`] over a closed rectangle in world units with the given
    /// depths, as [`Self::bounds`] does.
    pub(crate) fn bounds_with_depth(&self, rect: &Rect, depth: Bounds) -> Bounds {
        interval::bounds(&self.program, rect, depth)
    }

    /// Returns the value at the point (x, y), in world units.
    ///
    /// The caller must check the value: `sqrt(-1)` is NaN, `1/0` is infinite, and both are returned. `min`,
    /// `max` and `clamp` of NaN are NaN; a comparison with NaN is 0, except `!=`, which is 1.
    pub fn eval(&self, x: f64, y: f64) -> f64 {
        self.program.run(x, y)
    }

    /// Returns bounds of [`Self::eval`] over a closed rectangle in world units, by interval arithmetic.
    ///
    /// They hold for every point of the rectangle with coordinates in f64. A coordinate that occurs several
    /// times makes them wider than the values are; over smaller rectangles they are closer. At a single point
    /// other than on an axis they are the value.
    ///
    /// ```
    /// use glam::dvec2;
    /// use meshbrush_core::field::Formula;
    /// use meshbrush_mesh::geometry::Rect;
    ///
    /// let bounds = Formula::parse("x^2 + y")?.bounds(&Rect::new(dvec2(-1.0, 2.0), dvec2(3.0, 5.0)));
    /// assert_eq!((bounds.least, bounds.greatest), (2.0, 14.0));
    /// assert!(bounds.valid); // no value is NaN
    /// # Ok::<(), meshbrush_core::field::formula::ParseError>(())
    /// ```
    pub fn bounds(&self, rect: &Rect) -> Bounds {
        interval::bounds(&self.program, rect, Bounds::ANYTHING)
    }

    /// Returns bounds of the derivatives along x and y over a closed rectangle in world units. `None` where
    /// the formula may jump, or a derivative is not known.
    pub fn derivatives(&self, rect: &Rect) -> Option<[Bounds; 2]> {
        self.slopes(rect).map(|(along, _)| along)
    }

    /// Returns bounds of the derivatives along x and y over a closed rectangle in world units, and the
    /// largest slope in any direction; `None` where the formula may jump, or one of them is not known.
    pub(crate) fn slopes(&self, rect: &Rect) -> Option<([Bounds; 2], f64)> {
        if self.uses_depth() { None } else { derivatives::slopes(&self.program, rect) }
    }

    /// Returns a polynomial of degree 2 near [`Self::eval`] over a closed rectangle in world units, and a
    /// bound of the distance from it: the coefficients of 1, u, v, u², uv and v², where u and v run from −1
    /// to 1. `None` where no bound is known.
    ///
    /// ```
    /// use glam::dvec2;
    /// use meshbrush_core::field::Formula;
    /// use meshbrush_mesh::geometry::Rect;
    ///
    /// let rect = Rect::new(dvec2(1.0, 0.0), dvec2(1.5, 0.5));
    /// let (coefficients, distance) = Formula::parse("x*y")?.quadratic(&rect).expect("it is smooth");
    /// assert_eq!(coefficients, [0.3125, 0.0625, 0.3125, 0.0, 0.0625, 0.0]);
    /// assert!(distance < 1e-14);
    /// # Ok::<(), meshbrush_core::field::formula::ParseError>(())
    /// ```
    pub fn quadratic(&self, rect: &Rect) -> Option<([f64; 6], f64)> {
        let (middle, half) = (rect.center(), 0.5 * rect.size());
        let coordinate = |axis: usize| {
            let rounding = 4.0 * f64::EPSILON * (middle[axis].abs() + half[axis]);
            TaylorModel::coordinate(axis, middle[axis], half[axis], rounding)
        };
        let model = self.model([coordinate(0), coordinate(1)]);
        model.remainder().is_finite().then(|| (model.coefficients(), model.remainder()))
    }

    /// Returns a model of [`Self::eval`] over a rectangle, from models of the coordinates.
    pub(crate) fn model(&self, [x, y]: [TaylorModel; 2]) -> TaylorModel {
        machine::run(&self.program, [x, y, TaylorModel::UNKNOWN])
    }

    /// Returns the number of instructions.
    pub(crate) fn length(&self) -> usize {
        self.program.code().len()
    }

    /// Returns the formula of a number: its shortest text.
    pub fn constant_of(value: f64) -> Self {
        let source = format!("{value}");
        Self { program: Arc::new(Program::new(vec![Op::Number(value)], 1)), source: source.into() }
    }

    /// Returns the text as it was typed.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Returns the address of the compiled formula in memory. It is equal for clones, which share it.
    pub fn address(&self) -> usize {
        Arc::as_ptr(&self.program).addr()
    }

    /// Returns the memory that clones share, in bytes.
    pub fn bytes(&self) -> usize {
        self.source.len() + self.program.bytes()
    }

    /// Returns the value, if the formula uses no coordinate.
    ///
    /// ```
    /// # use meshbrush_core::field::Formula;
    /// assert_eq!(Formula::parse("0.05/2^3")?.constant(), Some(0.00625));
    /// assert_eq!(Formula::parse("0*x")?.constant(), None);
    /// # Ok::<(), meshbrush_core::field::formula::ParseError>(())
    /// ```
    pub fn constant(&self) -> Option<f64> {
        self.program.constant()
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.source == other.source
    }
}

impl Eq for Formula {}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.source)
    }
}

impl FromStr for Formula {
    type Err = ParseError;

    fn from_str(source: &str) -> Result<Self, ParseError> {
        Self::parse(source)
    }
}
