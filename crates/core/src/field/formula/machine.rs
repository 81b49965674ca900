//! Runs a compiled formula on bounds or models of its values over a whole rectangle.

use super::functions::OfThree;
use super::program::{Compare, LARGE_STACK, Op, Program, SMALL_STACK};
use crate::field::Bounds;

/// An enclosure of the values of a part of a formula over a rectangle: bounds, bounds with derivatives, or a
/// Taylor model.
pub(super) trait Enclosure: Copy {
    /// Returns the description that follows from bounds alone.
    fn from_bounds(bounds: Bounds) -> Self;

    /// Returns bounds of the values.
    fn bounds(&self) -> Bounds;

    /// Returns an operation on one value.
    fn one(op: Op, a: Self) -> Self;

    /// Returns an operation on two values, except a comparison.
    fn two(op: Op, a: Self, b: Self) -> Self;

    /// Returns a function of three values.
    fn three(function: &OfThree, a: Self, b: Self, c: Self) -> Self;

    /// Returns a description that holds for both: at each point of the rectangle, either may be the value.
    fn either(self, other: Self) -> Self;
}

/// 0 or 1.
const TRUTH: Bounds = Bounds::new(0.0, 1.0);

/// Slots of the stack for short formulas. A description can take many words, and clearing a larger stack
/// would take longer than the formula.
const TINY_STACK: usize = 4;

/// Returns the description of the values of a program, from the descriptions of x, y and the third value.
pub(super) fn run<V: Enclosure>(program: &Program, values: [V; 3]) -> V {
    let (slots, code) = (program.slots(), program.code());
    if slots <= TINY_STACK {
        run_on::<V, TINY_STACK>(code, values)
    } else if slots <= SMALL_STACK {
        run_on::<V, SMALL_STACK>(code, values)
    } else {
        run_on::<V, LARGE_STACK>(code, values)
    }
}

fn run_on<V: Enclosure, const SLOTS: usize>(code: &[Op], [x, y, third]: [V; 3]) -> V {
    let unknown = V::from_bounds(Bounds::ANYTHING);
    Machine { stack: &mut [unknown; SLOTS], top: 0, x, y, third }.run(code, unknown)
}

/// The stack machine of [`super::program`].
struct Machine<'a, V> {
    stack: &'a mut [V],
    /// The number of values on the stack.
    top: usize,
    x: V,
    y: V,
    third: V,
}

impl<V: Enclosure> Machine<'_, V> {
    fn push(&mut self, value: V) {
        self.stack[self.top] = value;
        self.top += 1;
    }

    fn pop(&mut self) -> V {
        self.top -= 1;
        self.stack[self.top]
    }

    /// Runs code from an accumulator, and returns the accumulator at the end.
    fn run(&mut self, code: &[Op], accumulator: V) -> V {
        let mut acc = accumulator;
        let mut at = 0;
        // Ends: `at` grows by at least one in each iteration.
        while let Some(&op) = code.get(at) {
            at += 1;
            match op {
                Op::Number(value) => self.load(&mut acc, V::from_bounds(Bounds::one(value))),
                Op::X => self.load(&mut acc, self.x),
                Op::Y => self.load(&mut acc, self.y),
                Op::Third => self.load(&mut acc, self.third),
                Op::FirstLink(sign) => {
                    let left = self.pop();
                    self.push(V::from_bounds(compared(sign, left.bounds(), acc.bounds())));
                }
                Op::NextLink(sign) => {
                    let middle = self.pop();
                    let before = self.pop();
                    let holds = compared(sign, middle.bounds(), acc.bounds());
                    self.push(V::from_bounds(before.bounds().times(holds)));
                }
                Op::Drop => acc = self.pop(),
                Op::SkipIfZero(count) => {
                    let skipped = self.choose(&code[at..], count as usize, &mut acc);
                    at += skipped;
                }
                Op::Skip(count) => at += count as usize,
                Op::SkipIfFalse(count) | Op::SkipIfTrue(count) => {
                    let decides_if_true = matches!(op, Op::SkipIfTrue(_));
                    let right = &code[at..at + count as usize];
                    at += self.decide(right, decides_if_true, &mut acc);
                }
                Op::Three(function) => {
                    let second = self.pop();
                    let first = self.pop();
                    acc = V::three(function, first, second, acc);
                }
                _ => acc = self.operate(op, acc),
            }
        }
        acc
    }

    fn load(&mut self, acc: &mut V, value: V) {
        self.push(*acc);
        *acc = value;
    }

    /// Runs an operation on one value or two.
    fn operate(&mut self, op: Op, acc: V) -> V {
        match op {
            Op::Not => V::from_bounds(truth(known_truth(acc.bounds()).map(|truth| !truth))),
            Op::Truth => V::from_bounds(truth(known_truth(acc.bounds()))),
            Op::Negate | Op::Abs | Op::Sqrt | Op::One(_) => V::one(op, acc),
            _ => {
                let first = self.pop();
                match sign_of(op) {
                    Some(sign) => V::from_bounds(compared(sign, first.bounds(), acc.bounds())),
                    None => V::two(op, first, acc),
                }
            }
        }
    }

    /// Runs the branches of a choice that the condition in the accumulator allows, and returns the number of
    /// instructions that are done.
    ///
    /// ```text
    /// condition  SkipIfZero(n)  | first branch  Skip(m) | second branch |
    ///                           +------ code[..n] ------+-- m instr. ---+
    /// ```
    fn choose(&mut self, code: &[Op], count: usize, acc: &mut V) -> usize {
        let (first, rest) = code.split_at(count);
        let Some((Op::Skip(length), first)) = first.split_last() else {
            unreachable!("the parser ends a first branch with a skip");
        };
        let second = &rest[..*length as usize];
        let condition = known_truth(acc.bounds());
        let below = self.pop();
        *acc = match condition {
            Some(true) => self.run(first, below),
            Some(false) => self.run(second, below),
            None => {
                let start = self.top;
                let value = self.run(first, below);
                self.top = start;
                value.either(self.run(second, below))
            }
        };
        count + second.len()
    }

    /// Runs the right side of `and` or `or` if it may be needed, and returns the number of its instructions.
    fn decide(&mut self, right: &[Op], decides_if_true: bool, acc: &mut V) -> usize {
        let decided = V::from_bounds(Bounds::one(f64::from(u8::from(decides_if_true))));
        match known_truth(acc.bounds()) {
            Some(left) if left == decides_if_true => *acc = decided,
            known => {
                let below = self.pop();
                let value = self.run(right, below);
                *acc = if known.is_some() { value } else { value.either(decided) };
            }
        }
        right.len()
    }
}

/// Returns whether values are true, if all or none of them are. NaN is true.
fn known_truth(bounds: Bounds) -> Option<bool> {
    if !bounds.has_zero() { Some(true) } else { bounds.is_one().then_some(false) }
}

fn truth(known: Option<bool>) -> Bounds {
    known.map_or(TRUTH, |known| Bounds::one(f64::from(u8::from(known))))
}

fn sign_of(op: Op) -> Option<Compare> {
    Some(match op {
        Op::Less => Compare::Less,
        Op::LessEqual => Compare::LessEqual,
        Op::Greater => Compare::Greater,
        Op::GreaterEqual => Compare::GreaterEqual,
        Op::Equal => Compare::Equal,
        Op::NotEqual => Compare::NotEqual,
        _ => return None,
    })
}

/// Returns bounds of a comparison. With NaN, only `!=` holds.
fn compared(sign: Compare, a: Bounds, b: Bounds) -> Bounds {
    let valid = a.valid && b.valid;
    let apart = a.greatest < b.least || b.greatest < a.least;
    let equal = a.is_one() && b.is_one() && a.least == b.least;
    let (always, never) = match sign {
        Compare::Less => (a.greatest < b.least && valid, a.least >= b.greatest),
        Compare::LessEqual => (a.greatest <= b.least && valid, a.least > b.greatest),
        Compare::Greater => (a.least > b.greatest && valid, a.greatest <= b.least),
        Compare::GreaterEqual => (a.least >= b.greatest && valid, a.greatest < b.least),
        Compare::Equal => (equal, apart),
        Compare::NotEqual => (apart, equal),
    };
    truth(if always || never { Some(always) } else { None })
}
