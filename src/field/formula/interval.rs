//! Runs a compiled formula on intervals: bounds of its values over a rectangle.

use super::program::{Compare, LARGE_STACK, Op, Program, SMALL_STACK};
use crate::field::Bounds;
use crate::geometry::Rect;

/// 0 or 1.
const TRUTH: Bounds = Bounds::new(0.0, 1.0);

/// Bounds of the values of a program over a rectangle, with the given risks.
pub(super) fn bounds(program: &Program, rect: &Rect, risk: Bounds) -> Bounds {
    if program.slots() <= SMALL_STACK {
        run_on::<SMALL_STACK>(program.code(), rect, risk)
    } else {
        run_on::<LARGE_STACK>(program.code(), rect, risk)
    }
}

fn run_on<const SLOTS: usize>(code: &[Op], rect: &Rect, risk: Bounds) -> Bounds {
    let mut machine = Machine {
        stack: [Bounds::ANYTHING; SLOTS],
        top: 0,
        x: Bounds::new(rect.min.x, rect.max.x),
        y: Bounds::new(rect.min.y, rect.max.y),
        risk,
    };
    machine.run(code, Bounds::ANYTHING)
}

/// The stack machine of [`super::program`], with bounds in place of numbers.
struct Machine<const SLOTS: usize> {
    stack: [Bounds; SLOTS],
    /// The number of bounds on the stack.
    top: usize,
    x: Bounds,
    y: Bounds,
    risk: Bounds,
}

impl<const SLOTS: usize> Machine<SLOTS> {
    fn push(&mut self, bounds: Bounds) {
        self.stack[self.top] = bounds;
        self.top += 1;
    }

    fn pop(&mut self) -> Bounds {
        self.top -= 1;
        self.stack[self.top]
    }

    /// Runs code from an accumulator, and returns the accumulator at the end.
    fn run(&mut self, code: &[Op], accumulator: Bounds) -> Bounds {
        let mut acc = accumulator;
        let mut at = 0;
        // Ends: `at` grows by at least one in each iteration.
        while let Some(&op) = code.get(at) {
            at += 1;
            match op {
                Op::Number(value) => self.load(&mut acc, Bounds::one(value)),
                Op::X => self.load(&mut acc, self.x),
                Op::Y => self.load(&mut acc, self.y),
                Op::Risk => self.load(&mut acc, self.risk),
                Op::FirstLink(sign) => {
                    let left = self.pop();
                    self.push(compared(sign, left, acc));
                }
                Op::NextLink(sign) => {
                    let middle = self.pop();
                    let before = self.pop();
                    self.push(before.times(compared(sign, middle, acc)));
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
                Op::Three(_, function) => {
                    let second = self.pop();
                    let first = self.pop();
                    acc = function(first, second, acc);
                }
                _ => acc = unary(op, acc).unwrap_or_else(|| binary(op, self.pop(), acc)),
            }
        }
        acc
    }

    fn load(&mut self, acc: &mut Bounds, bounds: Bounds) {
        self.push(*acc);
        *acc = bounds;
    }

    /// Runs the branches of a choice that the condition in the accumulator allows, and returns the number of
    /// instructions that are done.
    ///
    /// ```text
    /// condition  SkipIfZero(n)  | first branch  Skip(m) | second branch |
    ///                           +------ code[..n] ------+-- m instr. ---+
    /// ```
    fn choose(&mut self, code: &[Op], count: usize, acc: &mut Bounds) -> usize {
        let (first, rest) = code.split_at(count);
        let Some((Op::Skip(length), first)) = first.split_last() else {
            unreachable!("the parser ends a first branch with a skip");
        };
        let second = &rest[..*length as usize];
        let condition = *acc;
        let below = self.pop();
        let value = match known_truth(condition) {
            Some(true) => self.run(first, below),
            Some(false) => self.run(second, below),
            None => {
                let start = self.top;
                let value = self.run(first, below);
                self.top = start;
                value.union(self.run(second, below))
            }
        };
        *acc = value;
        count + second.len()
    }

    /// Runs the right side of `and` or `or` if it may be needed, and returns the number of its instructions.
    fn decide(&mut self, right: &[Op], decides_if_true: bool, acc: &mut Bounds) -> usize {
        let decided = Bounds::one(f64::from(u8::from(decides_if_true)));
        match known_truth(*acc) {
            Some(left) if left == decides_if_true => *acc = decided,
            known => {
                let below = self.pop();
                let value = self.run(right, below);
                *acc = if known.is_some() { value } else { value.union(decided) };
            }
        }
        right.len()
    }
}

/// Whether values are true, if all or none of them are. NaN is true.
fn known_truth(bounds: Bounds) -> Option<bool> {
    if !bounds.has_zero() { Some(true) } else { bounds.is_one().then_some(false) }
}

fn truth(known: Option<bool>) -> Bounds {
    known.map_or(TRUTH, |known| Bounds::one(f64::from(u8::from(known))))
}

/// Bounds of an operation on the accumulator; `None` for another operation.
pub(super) fn unary(op: Op, a: Bounds) -> Option<Bounds> {
    Some(match op {
        Op::Negate => a.negated(),
        Op::Not => truth(known_truth(a).map(|truth| !truth)),
        Op::Truth => truth(known_truth(a)),
        Op::Abs => a.abs(),
        Op::Sqrt => a.sqrt(),
        Op::One(value, bounds) if a.is_one() => at_point(a, value).unwrap_or_else(|| bounds(a)),
        Op::One(_, bounds) => bounds(a),
        _ => return None,
    })
}

/// Bounds of an operation on two values.
pub(super) fn binary(op: Op, a: Bounds, b: Bounds) -> Bounds {
    match op {
        Op::Add => a.plus(b),
        Op::Subtract => a.minus(b),
        Op::Multiply => a.times(b),
        Op::Divide => a.over(b),
        Op::Min => a.min(b),
        Op::Max => a.max(b),
        Op::Less => compared(Compare::Less, a, b),
        Op::LessEqual => compared(Compare::LessEqual, a, b),
        Op::Greater => compared(Compare::Greater, a, b),
        Op::GreaterEqual => compared(Compare::GreaterEqual, a, b),
        Op::Equal => compared(Compare::Equal, a, b),
        Op::NotEqual => compared(Compare::NotEqual, a, b),
        Op::Two(value, bounds) => {
            // The sign of a zero is not known, so bounds of it are not a point.
            let is_point = |v: Bounds| v.is_one() && v.least != 0.0;
            let value = if is_point(a) && is_point(b) { value(a.least, b.least) } else { f64::NAN };
            if value.is_nan() { bounds(a, b) } else { Bounds::one(value) }
        }
        _ => unreachable!("every other operation is run before"),
    }
}

/// The value of a function at one number, if it is not NaN; at 0, the values at 0 and −0.
fn at_point(a: Bounds, function: fn(f64) -> f64) -> Option<Bounds> {
    let value = Bounds::one(function(a.least));
    let other = if a.least == 0.0 { Bounds::one(function(-a.least)) } else { value };
    let both = value.union(other);
    both.valid.then_some(both)
}

/// Bounds of a comparison. With NaN, only `!=` holds.
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
