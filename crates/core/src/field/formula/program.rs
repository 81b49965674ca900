//! A compiled formula: instructions in postfix order for a stack machine with an accumulator.

use super::functions::{OfOne, OfThree, OfTwo};

/// One instruction.
///
/// The accumulator holds the newest value, the stack the older ones. A *load* first pushes the accumulator;
/// an operation with n operands pops n − 1 of them from the stack, the last operand is the accumulator. Skips
/// only go forward, by a number of instructions after their own: so every program ends, and a part of a
/// program can be run or moved.
///
/// ```text
/// 2 * x + 1        acc      stack
/// Number(2)        2        [–]          the first load pushes the unused initial value
/// X                x        [–, 2]
/// Multiply         2x       [–]
/// Number(1)        1        [–, 2x]
/// Add              2x + 1   [–]
/// ```
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    /// Loads a number.
    Number(f64),
    /// Loads the x coordinate.
    X,
    /// Loads the y coordinate.
    Y,
    /// Loads the third value: the risk of a cost, or the depth of a target diameter.
    Third,
    Negate,
    Not,
    /// 1 if the value is not 0, else 0.
    Truth,
    Abs,
    Sqrt,
    Add,
    Subtract,
    Multiply,
    Divide,
    Min,
    Max,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    /// First link of a chain `a < b < c`: a becomes `a < b`, and b stays for the next link.
    FirstLink(Compare),
    /// Later link: with r, b on the stack and c in the accumulator, r becomes `r and b < c`; c stays.
    NextLink(Compare),
    /// Drops the accumulator and takes the value below: the end of a chain.
    Drop,
    /// Any other function of one value.
    One(&'static OfOne),
    /// Any other function of two values.
    Two(&'static OfTwo),
    /// Any other function of three values.
    Three(&'static OfThree),
    /// Takes a condition and skips if it is 0.
    SkipIfZero(u32),
    /// Skips always.
    Skip(u32),
    /// `and`: a left side of 0 is the result, 0, and skips the right side; otherwise it is dropped.
    SkipIfFalse(u32),
    /// `or`: a left side other than 0 gives the result 1 and skips the right side; otherwise it is dropped.
    SkipIfTrue(u32),
}

/// A comparison sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compare {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
}

impl Compare {
    /// Returns the instruction for a comparison outside a chain.
    pub(super) fn op(self) -> Op {
        match self {
            Self::Less => Op::Less,
            Self::LessEqual => Op::LessEqual,
            Self::Greater => Op::Greater,
            Self::GreaterEqual => Op::GreaterEqual,
            Self::Equal => Op::Equal,
            Self::NotEqual => Op::NotEqual,
        }
    }

    fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Less => a < b,
            Self::LessEqual => a <= b,
            Self::Greater => a > b,
            Self::GreaterEqual => a >= b,
            Self::Equal => a == b,
            Self::NotEqual => a != b,
        }
    }
}

/// Slots of the stack for nearly every formula; clearing a small stack costs nothing.
pub(super) const SMALL_STACK: usize = 16;
/// Slots for any formula that the parser accepts: at most two for each level of nesting, and one.
pub(super) const LARGE_STACK: usize = 512;

/// Instructions, and the number of stack slots they need.
#[derive(Clone, Debug)]
pub(super) struct Program {
    code: Box<[Op]>,
    slots: usize,
    takes_roots: bool,
    loads_third: bool,
}

impl Program {
    /// `slots` is the largest number of loads in flight; at most [`LARGE_STACK`].
    pub(super) fn new(code: Vec<Op>, slots: usize) -> Self {
        debug_assert!(slots <= LARGE_STACK);
        let takes_roots = takes_roots(&code);
        let loads_third = code.iter().any(|op| matches!(op, Op::Third));
        Self { code: code.into(), slots, takes_roots, loads_third }
    }

    pub(super) fn run(&self, x: f64, y: f64) -> f64 {
        run(&self.code, self.slots, [x, y, f64::NAN])
    }

    /// Runs a program that may load a third value.
    pub(super) fn run_with(&self, x: f64, y: f64, third: f64) -> f64 {
        run(&self.code, self.slots, [x, y, third])
    }

    pub(super) fn code(&self) -> &[Op] {
        &self.code
    }

    /// Returns the number of stack slots that the program needs.
    pub(super) fn slots(&self) -> usize {
        self.slots
    }

    /// Returns the memory of the instructions, in bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.code)
    }

    /// Returns whether the value can depend on a third value.
    pub(super) fn loads_third(&self) -> bool {
        self.loads_third
    }

    /// Returns whether the program takes a square root, or may raise something to the power 1/2.
    pub(super) fn takes_roots(&self) -> bool {
        self.takes_roots
    }

    pub(super) fn constant(&self) -> Option<f64> {
        match *self.code {
            [Op::Number(value)] => Some(value),
            _ => None,
        }
    }

    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.code.len()
    }
}

fn takes_roots(code: &[Op]) -> bool {
    let mut before = None;
    code.iter().any(|&op| {
        let exponent = before.replace(op);
        match op {
            Op::Sqrt => true,
            Op::Two(function) if function.is_power => !matches!(exponent, Some(Op::Number(n)) if n != 0.5),
            _ => false,
        }
    })
}

/// Runs code that needs `slots` slots of the stack and leaves one value in the accumulator. `values` are x, y
/// and the third value.
pub(super) fn run(code: &[Op], slots: usize, values: [f64; 3]) -> f64 {
    if slots <= SMALL_STACK {
        run_on::<SMALL_STACK>(code, values)
    } else {
        run_on::<LARGE_STACK>(code, values)
    }
}

/// Runs code with a stack of `SLOTS` slots.
///
/// Longer than other functions by design: one line for each instruction, around one accumulator and one stack
/// that separate functions would have to pass on.
fn run_on<const SLOTS: usize>(code: &[Op], [x, y, third]: [f64; 3]) -> f64 {
    let mut stack = [0.0; SLOTS];
    let mut top = 0; // number of values on the stack
    let mut acc = 0.0;
    let mut at = 0;

    macro_rules! load {
        ($value:expr) => {{
            stack[top] = acc;
            top += 1;
            acc = $value;
        }};
    }
    macro_rules! pop {
        () => {{
            top -= 1;
            stack[top]
        }};
    }
    macro_rules! compare {
        ($sign:tt) => {
            acc = truth(pop!() $sign acc)
        };
    }

    // Ends: `at` grows by at least one in each iteration.
    while let Some(&op) = code.get(at) {
        at += 1;
        match op {
            // Values.
            Op::Number(value) => load!(value),
            Op::X => load!(x),
            Op::Y => load!(y),
            Op::Third => load!(third),
            // Operations on the accumulator, then on the stack and the accumulator.
            Op::Negate => acc = -acc,
            Op::Not => acc = truth(acc == 0.0),
            Op::Truth => acc = truth(acc != 0.0),
            Op::Abs => acc = acc.abs(),
            Op::Sqrt => acc = acc.sqrt(),
            Op::Add => acc += pop!(),
            Op::Subtract => acc = pop!() - acc,
            Op::Multiply => acc *= pop!(),
            Op::Divide => acc = pop!() / acc,
            Op::Min => acc = min(pop!(), acc),
            Op::Max => acc = max(pop!(), acc),
            Op::Less => compare!(<),
            Op::LessEqual => compare!(<=),
            Op::Greater => compare!(>),
            Op::GreaterEqual => compare!(>=),
            Op::Equal => compare!(==),
            Op::NotEqual => compare!(!=),
            // Chains of comparisons: the result so far is on the stack, the middle value in the accumulator.
            Op::FirstLink(sign) => stack[top - 1] = truth(sign.holds(stack[top - 1], acc)),
            Op::NextLink(sign) => {
                let middle = pop!();
                stack[top - 1] *= truth(sign.holds(middle, acc));
            }
            Op::Drop => acc = pop!(),
            // Functions.
            Op::One(function) => acc = (function.value)(acc),
            Op::Two(function) => acc = (function.value)(pop!(), acc),
            Op::Three(function) => {
                let second = pop!();
                let first = pop!();
                acc = (function.value)(first, second, acc);
            }
            // Branches.
            Op::SkipIfZero(count) => {
                at += if acc == 0.0 { count as usize } else { 0 };
                acc = pop!();
            }
            Op::Skip(count) => at += count as usize,
            Op::SkipIfFalse(count) => {
                if acc == 0.0 {
                    acc = 0.0; // not −0
                    at += count as usize;
                } else {
                    acc = pop!();
                }
            }
            Op::SkipIfTrue(count) => {
                if acc == 0.0 {
                    acc = pop!();
                } else {
                    acc = 1.0;
                    at += count as usize;
                }
            }
        }
    }
    acc
}

fn truth(condition: bool) -> f64 {
    f64::from(u8::from(condition))
}

/// Returns the smaller value, the later of two equal ones (0 and −0); NaN if either is.
///
/// `f64::min` would hide a NaN and leave the sign of 0 to the machine.
pub(super) fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// Returns the larger value, the later of two equal ones; NaN if either is.
pub(super) fn max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
