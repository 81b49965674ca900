//! Compiles tokens to a program in one pass: an operator is emitted as soon as its operands are read.
//!
//! No tree is built, so a sum of ten thousand terms needs no more stack than a sum of two. Only nesting needs
//! stack, and nesting is limited.

use std::ops::Range;

use super::error::{ParseError, quote};
use super::functions::{
    Form, NamedFunction, Noun, Third, coordinates, find_function, find_noun, instruction, suggestion,
};
use super::lexer::{Lexer, Token};
use super::program::{Compare, LARGE_STACK, Op, Program, run};

/// The longest formula, in bytes.
pub const MAX_LENGTH: usize = 64 * 1024;

/// The deepest nesting, counting parentheses, calls, signs, and right sides of operators.
pub const MAX_NESTING: usize = 200;
const _: () = assert!(2 * MAX_NESTING < LARGE_STACK);

/// Precedences, from the loosest. The right side of an operator binds at least as tightly as the operator's
/// own precedence plus one.
mod binding {
    pub(super) const ANYTHING: u8 = 0;
    pub(super) const OR: u8 = 1;
    pub(super) const AND: u8 = 2;
    pub(super) const NOT: u8 = 3;
    pub(super) const COMPARE: u8 = 4;
    pub(super) const SUM: u8 = 5;
    pub(super) const PRODUCT: u8 = 6;
    pub(super) const POWER: u8 = 7;
}

/// Compiles a formula, which may use a third value.
pub(super) fn compile(source: &str, third: Third) -> Result<Program, ParseError> {
    if source.len() > MAX_LENGTH {
        let start = source.floor_char_boundary(MAX_LENGTH);
        let message = format!("The formula is {} bytes long; at most {MAX_LENGTH} are read.", source.len());
        return Err(ParseError::new(source, start..source.len(), message));
    }
    let (lexer, code) = (Lexer::new(source), Vec::new());
    let mut parser = Parser { source, lexer, token: Token::End, span: 0..0, code, nesting: 0, third };
    parser.advance()?;
    if parser.token == Token::End {
        let message = "The formula is empty; write a number or a formula in x and y.";
        return Err(parser.mistake(0..source.len(), message));
    }
    let value = parser.expression(binding::ANYTHING)?;
    if parser.token != Token::End {
        return Err(parser.unexpected_after_value());
    }
    Ok(Program::new(parser.code, value.slots))
}

/// A part of the formula whose instructions are at the end of the code.
#[derive(Clone, Copy)]
struct Value {
    /// Index of its first instruction.
    start: usize,
    /// Whether it uses no coordinate.
    constant: bool,
    /// The stack slots that it needs.
    slots: usize,
}

/// The values of a call, in code and text.
struct Arguments {
    start: usize,
    count: usize,
    constant: bool,
    slots: usize,
    /// The indices of the skips of the first and of the second branch of `if`.
    skips: [usize; 2],
    /// The byte after the closing parenthesis.
    end: usize,
}

struct Parser<'a> {
    source: &'a str,
    lexer: Lexer<'a>,
    /// The next token and its place.
    token: Token<'a>,
    span: Range<usize>,
    code: Vec<Op>,
    nesting: usize,
    third: Third,
}

impl<'a> Parser<'a> {
    /// Advances to the next token, and returns the place of the former one.
    fn advance(&mut self) -> Result<Range<usize>, ParseError> {
        let (token, span) = self.lexer.next()?;
        self.token = token;
        Ok(std::mem::replace(&mut self.span, span))
    }

    /// Reads operands and operators that bind at least as tightly as `floor`.
    fn expression(&mut self, floor: u8) -> Result<Value, ParseError> {
        if self.nesting == MAX_NESTING {
            let message = format!("The formula is nested deeper than {MAX_NESTING} levels; simplify it.");
            return Err(self.mistake(self.span.clone(), message));
        }
        self.nesting += 1;
        let mut left = self.operand(floor)?;
        while let Some(binding) = infix_binding(self.token).filter(|&b| b >= floor) {
            left = self.infix(left, binding)?;
        }
        self.nesting -= 1;
        Ok(left)
    }

    /// Reads one operator and its right side.
    fn infix(&mut self, left: Value, binding: u8) -> Result<Value, ParseError> {
        let token = self.token;
        if let Token::Compare(sign) = token {
            return self.comparison(left, sign);
        }
        self.advance()?;
        let op = match token {
            Token::And => return self.decided(left, binding, Op::SkipIfFalse),
            Token::Or => return self.decided(left, binding, Op::SkipIfTrue),
            // Right-associative: the right side may contain further powers.
            Token::Power => {
                let right = self.expression(binding)?;
                return Ok(self.join(left, right, named_operator("pow")));
            }
            Token::Plus => Op::Add,
            Token::Minus => Op::Subtract,
            Token::Times => Op::Multiply,
            Token::Over => Op::Divide,
            _ => named_operator("mod"), // `infix_binding` lets nothing else through
        };
        let right = self.expression(binding + 1)?;
        Ok(self.join(left, right, op))
    }

    /// `left and right`, `left or right`: the right side is skipped if the left side decides.
    fn decided(&mut self, left: Value, binding: u8, skip: fn(u32) -> Op) -> Result<Value, ParseError> {
        let at = self.emit(skip(0));
        let right = self.expression(binding + 1)?;
        self.emit(Op::Truth);
        self.code[at] = skip(self.distance_from(at));
        let slots = left.slots.max(right.slots);
        Ok(self.finish(left.start, left.constant && right.constant, slots))
    }

    /// `a < b`, or a chain `a < b <= c` in which every middle value is evaluated once.
    fn comparison(&mut self, first: Value, sign: Compare) -> Result<Value, ParseError> {
        self.advance()?;
        let second = self.expression(binding::COMPARE + 1)?;
        let mut chain = Value {
            start: first.start,
            constant: first.constant && second.constant,
            slots: first.slots.max(second.slots + 1),
        };
        if !matches!(self.token, Token::Compare(_)) {
            self.emit(sign.op());
            return Ok(self.finish(chain.start, chain.constant, chain.slots));
        }
        self.emit(Op::FirstLink(sign));
        let mut direction = sign;
        // Ends: each iteration reads a token.
        while let Token::Compare(sign) = self.token {
            direction = self.chain_direction(direction, sign)?;
            self.advance()?;
            let next = self.expression(binding::COMPARE + 1)?;
            self.emit(Op::NextLink(sign));
            chain.constant &= next.constant;
            chain.slots = chain.slots.max(next.slots + 2);
        }
        self.emit(Op::Drop);
        Ok(self.finish(chain.start, chain.constant, chain.slots))
    }

    /// Checks that all signs of a chain of comparisons have the same direction, and returns it.
    fn chain_direction(&self, before: Compare, next: Compare) -> Result<Compare, ParseError> {
        use Compare::{Equal, Less, LessEqual, NotEqual};
        let rising = |sign| matches!(sign, Less | LessEqual);
        match (before, next) {
            (NotEqual, _) | (_, NotEqual) => {}
            (Equal, _) => return Ok(next),
            (_, Equal) => return Ok(before),
            _ if rising(before) == rising(next) => return Ok(next),
            _ => {}
        }
        let message = "A chain of comparisons must run one way, as in `0 < x < 1`; \
                       join others with `and`.";
        Err(self.mistake(self.span.clone(), message))
    }

    /// Reads a value with the signs before it.
    fn operand(&mut self, floor: u8) -> Result<Value, ParseError> {
        let token = self.token;
        match token {
            Token::Number(value) => {
                self.advance()?;
                Ok(self.load(Op::Number(value)))
            }
            Token::Name(name) => self.named(name),
            Token::Open => self.parenthesis(),
            Token::Minus => self.prefix(binding::POWER, Some(Op::Negate)),
            Token::Bang => self.prefix(binding::POWER, Some(Op::Not)),
            Token::Plus => self.prefix(binding::POWER, None),
            Token::Not if floor <= binding::NOT => self.prefix(binding::NOT, Some(Op::Not)),
            Token::Not => {
                let message = "`not` needs parentheses around it here: `(not v)`.";
                Err(self.mistake(self.span.clone(), message))
            }
            _ => Err(self.value_expected()),
        }
    }

    /// Reads a sign or `not`, and its operand.
    fn prefix(&mut self, floor: u8, op: Option<Op>) -> Result<Value, ParseError> {
        self.advance()?;
        let value = self.expression(floor)?;
        self.code.extend(op);
        Ok(self.finish(value.start, value.constant, value.slots))
    }

    /// Reads a formula in parentheses.
    fn parenthesis(&mut self) -> Result<Value, ParseError> {
        let open = self.advance()?;
        let value = self.expression(binding::ANYTHING)?;
        match self.token {
            Token::Close => self.advance()?,
            Token::End => return Err(self.never_closed(open)),
            _ => return Err(self.unexpected_after_value()),
        };
        Ok(value)
    }

    /// Reads a coordinate, a constant or a function call.
    fn named(&mut self, name: &'a str) -> Result<Value, ParseError> {
        let span = self.advance()?;
        let called = self.token == Token::Open;
        if let Some(function) = find_function(name) {
            if called {
                return self.call(function, span);
            }
            let message = format!("`{name}` needs its values in parentheses: `{}`.", function.call);
            return Err(self.mistake(span, message));
        }
        let Some(noun) = find_noun(name, self.third) else {
            return Err(self.unknown_name(name, span));
        };
        if called {
            let message = format!("`{name}` is not a function; to multiply, write `{name}*(`.");
            return Err(self.mistake(span.start..self.span.end, message));
        }
        Ok(match noun {
            Noun::X => self.load(Op::X),
            Noun::Y => self.load(Op::Y),
            Noun::Third => self.load(Op::Third),
            Noun::Number(value) => self.load(Op::Number(value)),
            Noun::Radius => {
                let (x, y) = (self.load(Op::X), self.load(Op::Y));
                self.join(x, y, named_operator("hypot"))
            }
            Noun::Angle => {
                let (y, x) = (self.load(Op::Y), self.load(Op::X));
                self.join(y, x, named_operator("atan2"))
            }
        })
    }

    /// Reads a function's values in parentheses, and emits its instructions.
    fn call(&mut self, function: &NamedFunction, name: Range<usize>) -> Result<Value, ParseError> {
        let values = self.arguments(function.form)?;
        self.check_count(function, values.count, &name, values.end)?;
        match function.form {
            Form::Fixed(_, op) => self.code.push(op),
            Form::Join(_) => {}
            Form::If => {
                let [condition, branch] = values.skips;
                self.code[condition] = Op::SkipIfZero((branch - condition) as u32);
                self.code[branch] = Op::Skip(self.distance_from(branch));
            }
        }
        Ok(self.finish(values.start, values.constant, values.slots))
    }

    /// Reads any number of values from the opening parenthesis to the closing one.
    fn arguments(&mut self, form: Form) -> Result<Arguments, ParseError> {
        let open = self.advance()?;
        let mut values =
            Arguments { start: self.code.len(), count: 0, constant: true, slots: 1, skips: [0; 2], end: 0 };
        // Ends: each iteration reads a token.
        while values.count > 0 || self.token != Token::Close {
            let value = self.expression(binding::ANYTHING)?;
            values.constant &= value.constant;
            values.slots = values.slots.max(value.slots + form.held(values.count));
            values.count += 1;
            match (form, values.count) {
                (Form::Join(op), 2..) => self.code.push(op),
                (Form::If, 1) => values.skips[0] = self.emit(Op::SkipIfZero(0)),
                (Form::If, 2) => values.skips[1] = self.emit(Op::Skip(0)),
                _ => {}
            }
            match self.token {
                Token::Comma => self.advance()?,
                Token::Close => break,
                Token::End => return Err(self.never_closed(open)),
                _ => return Err(self.unexpected_after_value()),
            };
        }
        values.end = self.advance()?.end;
        Ok(values)
    }

    fn check_count(
        &self,
        function: &NamedFunction,
        found: usize,
        name: &Range<usize>,
        end: usize,
    ) -> Result<(), ParseError> {
        let (least, most, expected) = match function.form {
            Form::Fixed(1, _) => (1, 1, "1 value"),
            Form::Fixed(2, _) => (2, 2, "2 values"),
            Form::Fixed(..) | Form::If => (3, 3, "3 values"),
            Form::Join(_) => (2, usize::MAX, "at least 2 values"),
        };
        if (least..=most).contains(&found) {
            return Ok(());
        }
        let text = &self.source.as_bytes()[name.start..end];
        let decimal_comma = |w: &[u8]| w[0].is_ascii_digit() && w[1] == b',' && w[2].is_ascii_digit();
        let advice = if found > most && text.windows(3).any(decimal_comma) {
            " A decimal fraction is written with a point, as in `0.4`."
        } else {
            ""
        };
        let message = format!("`{}` takes {expected}; found {found}.{advice}", function.call);
        Err(self.mistake(name.clone(), message))
    }

    /// Emits an instruction, and returns its index.
    fn emit(&mut self, op: Op) -> usize {
        self.code.push(op);
        self.code.len() - 1
    }

    fn load(&mut self, op: Op) -> Value {
        Value { start: self.emit(op), constant: matches!(op, Op::Number(_)), slots: 1 }
    }

    fn join(&mut self, left: Value, right: Value, op: Op) -> Value {
        self.emit(op);
        let slots = left.slots.max(right.slots + 1);
        self.finish(left.start, left.constant && right.constant, slots)
    }

    /// Returns the number of instructions after the one at `at`. It fits 32 bits: the text has at most
    /// [`MAX_LENGTH`] bytes, and no token makes more than three instructions.
    fn distance_from(&self, at: usize) -> u32 {
        (self.code.len() - at - 1) as u32
    }

    /// Ends a value. A value without coordinates is evaluated now, by the same interpreter, and replaced by
    /// its result.
    fn finish(&mut self, start: usize, constant: bool, slots: usize) -> Value {
        if !constant {
            return Value { start, constant, slots };
        }
        let result = run(&self.code[start..], slots, [0.0; 3]);
        self.code.truncate(start);
        self.load(Op::Number(result))
    }

    fn mistake(&self, span: Range<usize>, message: impl Into<String>) -> ParseError {
        ParseError::new(self.source, span, message)
    }

    fn found(&self) -> String {
        match self.token {
            Token::End => "the end of the formula".to_owned(),
            _ => quote(&self.source[self.span.clone()]),
        }
    }

    fn value_expected(&self) -> ParseError {
        let message = format!(
            "Expected a value (a number, `x`, `y`, a function or a parenthesis); found {}.",
            self.found()
        );
        self.mistake(self.span.clone(), message)
    }

    fn never_closed(&self, open: Range<usize>) -> ParseError {
        self.mistake(open, "This parenthesis is never closed; add `)`.")
    }

    fn unknown_name(&self, name: &str, span: Range<usize>) -> ParseError {
        let advice = suggestion(name, self.third)
            .map_or_else(|| coordinates(self.third).to_owned(), |here| format!("write {here}"));
        self.mistake(span, format!("There is no {}; {advice}.", quote(name)))
    }

    /// Returns the mistake for a token after a value that neither continues nor ends it.
    fn unexpected_after_value(&self) -> ParseError {
        let found = self.found();
        let message = match self.token {
            Token::Close => "This `)` has no `(` before it.".to_owned(),
            Token::Comma => "A comma only separates the values of a function; \
                             a decimal fraction is written with a point, as in `0.4`."
                .to_owned(),
            Token::Name(name) if let Some(here) = operator_word(name) => {
                format!("Found {found} after a value; write {here}.")
            }
            Token::Number(_) | Token::Name(_) | Token::Open => {
                format!("Found {found} after a value; to multiply, write `*` between them.")
            }
            _ => format!("Found {found} after a value, where an operator was expected."),
        };
        self.mistake(self.span.clone(), message)
    }
}

/// How tightly a token binds as an operator between two values, if it is one.
fn infix_binding(token: Token) -> Option<u8> {
    match token {
        Token::Or => Some(binding::OR),
        Token::And => Some(binding::AND),
        Token::Compare(_) => Some(binding::COMPARE),
        Token::Plus | Token::Minus => Some(binding::SUM),
        Token::Times | Token::Over | Token::Percent => Some(binding::PRODUCT),
        Token::Power => Some(binding::POWER),
        _ => None,
    }
}

/// Returns the instruction of a function that is also written in another way.
fn named_operator(name: &str) -> Op {
    instruction(name).expect("the table has this function")
}

/// Returns the operator to write instead of a word that is an operator in other languages.
fn operator_word(name: &str) -> Option<&'static str> {
    match name.to_ascii_lowercase().as_str() {
        "and" => Some("`and` in small letters"),
        "or" => Some("`or` in small letters"),
        "xor" => Some("`(a != 0) != (b != 0)`"),
        "mod" => Some("`a % b`"),
        "if" | "then" | "else" | "where" => Some("a choice as `if(c, a, b)`"),
        _ => None,
    }
}
