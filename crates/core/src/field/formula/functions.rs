//! The names in formulas: functions, coordinates and constants.

use std::f64::consts;

use super::derivatives::Varying;
use super::gradient::{Along, Gradient};
use super::program::{Op, max, min};
use super::{function_bounds as bounds, models, slopes};
use crate::field::{Bounds, TaylorModel};

/// How a function's values become instructions.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// One instruction after a fixed number of values.
    Fixed(u32, Op),
    /// Two values or more, joined by the instruction from left to right.
    Join(Op),
    /// `if(c, a, b)`, which evaluates only one branch.
    If,
}

impl Form {
    /// Returns the number of values on the stack while the value after `count` others is computed.
    pub(super) fn held(self, count: usize) -> usize {
        match self {
            Self::Fixed(..) => count,
            Self::Join(_) => count.min(1),
            Self::If => 0,
        }
    }
}

/// A function and its help text.
#[derive(Clone, Copy, Debug)]
pub(super) struct NamedFunction {
    pub(super) form: Form,
    /// A call: the name up to the parenthesis, and the names of the values.
    pub(super) call: &'static str,
    meaning: &'static str,
}

impl NamedFunction {
    pub(super) fn name(&self) -> &'static str {
        self.call.split('(').next().unwrap_or(self.call)
    }
}

/// A function of one value.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfOne {
    pub value: fn(f64) -> f64,
    /// Bounds of the values.
    pub bounds: fn(Bounds) -> Bounds,
    /// Computes bounds of the derivative from bounds of the argument and of the result, if it is known.
    pub slope: Option<fn(Bounds, Bounds) -> Bounds>,
    /// A model of the values, if there is a better one than bounds.
    pub model: Option<fn(&TaylorModel) -> TaylorModel>,
}

/// Computes values and gradient of a function from those of its two arguments and bounds of the result.
pub(super) type OfTwoVarying<G> = fn(Varying<G>, Varying<G>, Bounds) -> Varying<G>;

/// Computes the gradient of a function from its three arguments.
type OfThreeVarying<G> = fn(Varying<G>, Varying<G>, Varying<G>) -> Option<G>;

/// A derivative for each of the two kinds of gradients.
#[derive(Clone, Copy, Debug)]
pub(super) struct ForGradients<A, B> {
    pub along: A,
    pub with_length: B,
}

type OfTwoDerivative = ForGradients<OfTwoVarying<Along>, OfTwoVarying<Gradient>>;
type OfThreeDerivative = ForGradients<OfThreeVarying<Along>, OfThreeVarying<Gradient>>;

macro_rules! derivative {
    ($function:path) => {
        ForGradients { along: $function, with_length: $function }
    };
}

/// A function of two values.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfTwo {
    pub value: fn(f64, f64) -> f64,
    pub bounds: fn(Bounds, Bounds) -> Bounds,
    /// The gradient with the values, if it is known.
    pub derivative: Option<OfTwoDerivative>,
    /// Whether it is `pow`, and so with the exponent 1/2 a square root.
    pub is_power: bool,
    pub model: Option<fn(&TaylorModel, &TaylorModel) -> TaylorModel>,
}

/// A function of three values.
#[derive(Clone, Copy, Debug)]
pub(super) struct OfThree {
    pub value: fn(f64, f64, f64) -> f64,
    pub bounds: fn(Bounds, Bounds, Bounds) -> Bounds,
    /// The gradient, if it is known.
    pub derivative: OfThreeDerivative,
    pub model: Option<fn(&TaylorModel, &TaylorModel, &TaylorModel) -> TaylorModel>,
}

const fn of_one(value: fn(f64) -> f64, bounds: fn(Bounds) -> Bounds) -> OfOne {
    OfOne { value, bounds, slope: None, model: None }
}

const fn of_two(value: fn(f64, f64) -> f64, bounds: fn(Bounds, Bounds) -> Bounds) -> OfTwo {
    OfTwo { value, bounds, derivative: None, is_power: false, model: None }
}

impl OfOne {
    const fn smooth(
        self,
        slope: fn(Bounds, Bounds) -> Bounds,
        model: fn(&TaylorModel) -> TaylorModel,
    ) -> Self {
        Self { slope: Some(slope), model: Some(model), ..self }
    }
}

impl OfTwo {
    const fn smooth(
        self,
        derivative: OfTwoDerivative,
        model: fn(&TaylorModel, &TaylorModel) -> TaylorModel,
    ) -> Self {
        Self { derivative: Some(derivative), model: Some(model), ..self }
    }

    const fn modelled(self, model: fn(&TaylorModel, &TaylorModel) -> TaylorModel) -> Self {
        Self { model: Some(model), ..self }
    }
}

const fn one(call: &'static str, of: &'static OfOne, meaning: &'static str) -> NamedFunction {
    function(call, Form::Fixed(1, Op::One(of)), meaning)
}

const fn two(call: &'static str, of: &'static OfTwo, meaning: &'static str) -> NamedFunction {
    function(call, Form::Fixed(2, Op::Two(of)), meaning)
}

const fn three(call: &'static str, of: &'static OfThree, meaning: &'static str) -> NamedFunction {
    function(call, Form::Fixed(3, Op::Three(of)), meaning)
}

const fn function(call: &'static str, form: Form, meaning: &'static str) -> NamedFunction {
    NamedFunction { form, call, meaning }
}

/// All functions, in the order of the help: the call, the value, its bounds, its derivative and its model
/// where they are known, and the meaning.
#[rustfmt::skip] // one line a function
pub(super) static FUNCTIONS: &[NamedFunction] = &[
    function("if(c, a, b)", Form::If, "a where c is true, else b"),
    function("abs(v)", Form::Fixed(1, Op::Abs), "size without sign"),
    one("sign(v)", &const { of_one(sign, bounds::sign) }, "-1, 0 or 1"),
    function("min(a, b, ...)", Form::Join(Op::Min), "the smallest of two values or more"),
    function("max(a, b, ...)", Form::Join(Op::Max), "the largest of two values or more"),
    three("clamp(v, lo, hi)", &OfThree { value: clamp, bounds: bounds::clamp, derivative: derivative!(slopes::clamp), model: Some(models::clamp) }, "v, kept between lo and hi"),
    three("mix(a, b, t)", &OfThree { value: mix, bounds: bounds::mix, derivative: derivative!(slopes::mix), model: Some(models::mix) }, "a at t = 0, b at t = 1, straight between and beyond"),
    two("step(edge, v)", &const { of_two(step, bounds::step) }, "0 where v is below the edge, else 1"),
    three("smoothstep(lo, hi, v)", &OfThree { value: smoothstep, bounds: bounds::smoothstep, derivative: derivative!(slopes::smoothstep), model: Some(models::smoothstep) }, "0 up to lo, 1 from hi, an S-curve between"),
    two("gauss(d, s)", &const { of_two(gauss, bounds::gauss).smooth(derivative!(slopes::gauss), models::gauss) }, "bell curve exp(-(d/s)^2/2): 1 at d = 0, 0.61 at d = s"),
    two("hypot(a, b)", &const { of_two(libm::hypot, bounds::hypot).smooth(derivative!(slopes::hypot), models::hypot) }, "sqrt(a^2 + b^2): the distance, from differences in x and y"),
    function("sqrt(v)", Form::Fixed(1, Op::Sqrt), "square root"),
    one("cbrt(v)", &const { of_one(libm::cbrt, bounds::cbrt) }, "cube root"),
    two("pow(a, b)", &const { OfTwo { is_power: true, ..of_two(power, bounds::power) }.smooth(derivative!(slopes::power), models::power) }, "a to the power b, as a^b"),
    one("exp(v)", &const { of_one(libm::exp, bounds::exp).smooth(slopes::exp, models::exp) }, "e to the power v"),
    one("ln(v)", &const { of_one(libm::log, bounds::ln).smooth(slopes::ln, models::ln) }, "logarithm to base e"),
    one("log10(v)", &const { of_one(libm::log10, bounds::log10).smooth(slopes::log10, models::log10) }, "logarithm to base 10"),
    one("log2(v)", &const { of_one(libm::log2, bounds::log2).smooth(slopes::log2, models::log2) }, "logarithm to base 2"),
    one("sin(v)", &const { of_one(libm::sin, bounds::sin).smooth(slopes::sin, models::sin) }, "sine of an angle in radians"),
    one("cos(v)", &const { of_one(libm::cos, bounds::cos).smooth(slopes::cos, models::cos) }, "cosine of an angle in radians"),
    one("tan(v)", &const { of_one(libm::tan, bounds::tan).smooth(slopes::tan, models::tan) }, "tangent of an angle in radians"),
    one("asin(v)", &const { of_one(libm::asin, bounds::asin) }, "angle whose sine is v"),
    one("acos(v)", &const { of_one(libm::acos, bounds::acos) }, "angle whose cosine is v"),
    one("atan(v)", &const { of_one(libm::atan, bounds::atan).smooth(slopes::atan, models::atan) }, "angle whose tangent is v"),
    two("atan2(y, x)", &const { of_two(libm::atan2, bounds::atan2).modelled(models::atan2) }, "angle of the direction (x, y), from -pi to pi"),
    one("sinh(v)", &const { of_one(libm::sinh, bounds::sinh).smooth(slopes::sinh, models::sinh) }, "hyperbolic sine"),
    one("cosh(v)", &const { of_one(libm::cosh, bounds::cosh).smooth(slopes::cosh, models::cosh) }, "hyperbolic cosine"),
    one("tanh(v)", &const { of_one(libm::tanh, bounds::tanh).smooth(slopes::tanh, models::tanh) }, "hyperbolic tangent"),
    one("floor(v)", &const { of_one(f64::floor, bounds::floor) }, "whole number at or below v"),
    one("ceil(v)", &const { of_one(f64::ceil, bounds::ceil) }, "whole number at or above v"),
    one("round(v)", &const { of_one(f64::round, bounds::round) }, "nearest whole number, halves away from 0"),
    one("trunc(v)", &const { of_one(f64::trunc, bounds::trunc) }, "whole part, towards 0"),
    one("fract(v)", &const { of_one(fract, bounds::fract) }, "v - floor(v): from 0 up to 1, repeating"),
    two("mod(a, b)", &const { of_two(modulo, bounds::modulo) }, "a % b: what is left of a after whole steps of b, with the sign of b"),
];

/// Returns the instruction of a function that has one.
pub(super) fn instruction(name: &str) -> Option<Op> {
    match find_function(name)?.form {
        Form::Fixed(_, op) | Form::Join(op) => Some(op),
        Form::If => None,
    }
}

/// A name of a value.
#[derive(Clone, Copy, Debug)]
pub(super) enum Noun {
    X,
    Y,
    Radius,
    Angle,
    /// The third value, in formulas that have one.
    Third,
    Number(f64),
}

/// The value beside x and y that a formula may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Third {
    /// None.
    Nothing,
    /// `risk`, in costs.
    Risk,
    /// `depth`, in target diameters and in values at the nodes.
    Depth,
}

impl Third {
    /// Returns its name in formulas.
    fn name(self) -> Option<&'static str> {
        match self {
            Self::Nothing => None,
            Self::Risk => Some("risk"),
            Self::Depth => Some("depth"),
        }
    }
}

/// Coordinates and constants, in the order of the help.
pub(super) const NOUNS: &[(&str, Noun)] = &[
    ("x", Noun::X),
    ("y", Noun::Y),
    ("r", Noun::Radius),
    ("theta", Noun::Angle),
    ("pi", Noun::Number(consts::PI)),
    ("tau", Noun::Number(consts::TAU)),
    ("e", Noun::Number(consts::E)),
    ("inf", Noun::Number(f64::INFINITY)),
    ("θ", Noun::Angle),
    ("π", Noun::Number(consts::PI)),
    ("τ", Noun::Number(consts::TAU)),
];

/// Names from other tools, and what to write here.
const ELSEWHERE: &[(&str, &str)] = &[
    ("log", "`ln(v)` for base e or `log10(v)` for base 10"),
    ("lg", "`log10(v)`"),
    ("sqr", "`v^2`"),
    ("square", "`v^2`"),
    ("power", "`a^b`"),
    ("fabs", "`abs(v)`"),
    ("sgn", "`sign(v)`"),
    ("arcsin", "`asin(v)`"),
    ("arccos", "`acos(v)`"),
    ("arctan", "`atan(v)`"),
    ("arctan2", "`atan2(y, x)`"),
    ("ceiling", "`ceil(v)`"),
    ("int", "`trunc(v)`"),
    ("fmod", "`mod(a, b)`"),
    ("lerp", "`mix(a, b, t)`"),
    ("saturate", "`clamp(v, 0, 1)`"),
    ("heaviside", "`step(0, v)`"),
    ("length", "`hypot(a, b)`"),
    ("distance", "`hypot(x - x0, y - y0)`"),
    ("minimum", "`min(a, b)`"),
    ("maximum", "`max(a, b)`"),
    ("where", "`if(c, a, b)`"),
    ("iif", "`if(c, a, b)`"),
    ("ifelse", "`if(c, a, b)`"),
    ("select", "`if(c, a, b)`"),
    ("phi", "`theta` for the polar angle"),
    ("rho", "`r` for the distance from the origin"),
    ("infinity", "`inf`"),
    ("true", "`1`"),
    ("false", "`0`"),
    ("xor", "`(a != 0) != (b != 0)`"),
    ("z", "the formula in `x` and `y`"),
    ("depth", "`x` and `y`: only target diameters have depths, and values at the nodes of files"),
];

/// Returns every function as (call, meaning), for a help page or a completion list.
///
/// ```
/// use meshbrush_core::field::formula::functions;
///
/// assert!(functions().any(|(call, _)| call == "clamp(v, lo, hi)"));
/// ```
pub fn functions() -> impl ExactSizeIterator<Item = (&'static str, &'static str)> {
    FUNCTIONS.iter().map(|f| (f.call, f.meaning))
}

pub(super) fn find_function(name: &str) -> Option<&'static NamedFunction> {
    FUNCTIONS.iter().find(|f| f.name() == name)
}

pub(super) fn find_noun(name: &str, third: Third) -> Option<Noun> {
    if third.name() == Some(name) {
        return Some(Noun::Third);
    }
    let found = NOUNS.iter().find(|(known, _)| *known == name);
    found.map(|&(_, noun)| noun)
}

/// Returns the names that a formula may use, for a message.
pub(super) fn coordinates(third: Third) -> &'static str {
    match third {
        Third::Nothing => "the coordinates are `x`, `y`, `r` and `theta`",
        Third::Risk => "a cost is a formula of `x`, `y` and `risk`",
        Third::Depth => "this is a formula of `x`, `y`, `r`, `theta` and `depth`",
    }
}

/// Returns a name to write instead of an unknown one, if one is similar enough.
pub(super) fn suggestion(name: &str, third: Third) -> Option<String> {
    let name = name.to_ascii_lowercase();
    if third == Third::Depth && distance(&name, "depth") < 3 {
        return Some("`depth`".to_owned());
    }
    match ELSEWHERE.iter().find(|(other, _)| *other == name) {
        Some((_, here)) => Some((*here).to_owned()),
        None => nearest(&name).map(|word| format!("`{word}`")),
    }
}

/// Returns the known word at the smallest distance, if that is under half of the word's length.
fn nearest(name: &str) -> Option<&'static str> {
    let functions = FUNCTIONS.iter().map(|f| (f.name(), f.call));
    let nouns = NOUNS.iter().map(|&(noun, _)| (noun, noun));
    let operators = ["and", "or", "not"].map(|word| (word, word));
    functions
        .chain(nouns)
        .chain(operators)
        .map(|(word, advice)| (distance(name, word), word, advice))
        .filter(|&(distance, word, _)| distance * 2 < word.chars().count())
        .min_by_key(|&(distance, ..)| distance)
        .map(|(.., advice)| advice)
}

/// Returns the number of letters to insert, remove, replace or swap with their neighbour to get from `a` to
/// `b`.
///
/// The work is the product of the lengths; `b` is a known word, and an `a` over 24 letters is far
/// from all of them.
fn distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().take(25).collect();
    let b: Vec<char> = b.chars().collect();
    if a.len() > 24 {
        return a.len();
    }
    let mut before_last: Vec<usize>;
    let mut last: Vec<usize> = vec![];
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        before_last = last;
        last = row;
        row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(before_last[j - 2] + 1);
            }
            row.push(least);
        }
    }
    row[b.len()]
}

/// `a^b`. A square is one product, which is the nearest number to it; `libm::pow` need not be.
pub(super) fn power(a: f64, b: f64) -> f64 {
    if b == 2.0 { a * a } else { libm::pow(a, b) }
}

/// `a % b` with the sign of b, so that stripes repeat evenly across 0.
pub(super) fn modulo(a: f64, b: f64) -> f64 {
    let left = libm::fmod(a, b);
    if left != 0.0 && (left < 0.0) != (b < 0.0) { left + b } else { left }
}

/// −1, 0 or 1; 0 keeps its sign and NaN stays, unlike `f64::signum`, which has no 0.
pub(super) fn sign(v: f64) -> f64 {
    if v > 0.0 {
        1.0
    } else if v < 0.0 {
        -1.0
    } else {
        v
    }
}

pub(super) fn fract(v: f64) -> f64 {
    v - v.floor()
}

/// `hi` if the limits are reversed; `f64::clamp` would panic.
fn clamp(v: f64, lo: f64, hi: f64) -> f64 {
    min(max(v, lo), hi)
}

/// Returns linear interpolation, exact at both ends.
fn mix(a: f64, b: f64, t: f64) -> f64 {
    a * (1.0 - t) + b * t
}

fn step(edge: f64, v: f64) -> f64 {
    if edge.is_nan() || v.is_nan() {
        f64::NAN
    } else if v < edge {
        0.0
    } else {
        1.0
    }
}

/// Returns a smooth step; if `lo` equals `hi` a sharp one, instead of 0/0.
fn smoothstep(lo: f64, hi: f64, v: f64) -> f64 {
    if lo == hi {
        return step(lo, v);
    }
    let t = clamp((v - lo) / (hi - lo), 0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

pub(super) fn gauss(d: f64, s: f64) -> f64 {
    let t = d / s;
    libm::exp(-0.5 * (t * t))
}
