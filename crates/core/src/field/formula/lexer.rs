//! Splits a formula into tokens.

use std::ops::Range;

use super::error::{ParseError, quote};
use super::program::Compare;
use crate::text::decimal;

/// The smallest meaningful part of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Plus,
    Minus,
    Times,
    Over,
    Percent,
    Power,
    Compare(Compare),
    And,
    Or,
    /// The word `not`, which binds loosely.
    Not,
    /// The sign `!`, which binds tightly.
    Bang,
    Open,
    Close,
    Comma,
    End,
}

/// Signs. A sign comes before those that are its beginning.
const SIGNS: &[(&str, Token)] = &[
    ("&&", Token::And),
    ("||", Token::Or),
    ("**", Token::Power),
    ("<=", Token::Compare(Compare::LessEqual)),
    (">=", Token::Compare(Compare::GreaterEqual)),
    ("==", Token::Compare(Compare::Equal)),
    ("!=", Token::Compare(Compare::NotEqual)),
    ("≤", Token::Compare(Compare::LessEqual)),
    ("≥", Token::Compare(Compare::GreaterEqual)),
    ("≠", Token::Compare(Compare::NotEqual)),
    ("<", Token::Compare(Compare::Less)),
    (">", Token::Compare(Compare::Greater)),
    ("+", Token::Plus),
    ("-", Token::Minus),
    ("−", Token::Minus),
    ("*", Token::Times),
    ("×", Token::Times),
    ("·", Token::Times),
    ("⋅", Token::Times),
    ("/", Token::Over),
    ("÷", Token::Over),
    ("%", Token::Percent),
    ("^", Token::Power),
    ("!", Token::Bang),
    ("(", Token::Open),
    (")", Token::Close),
    (",", Token::Comma),
];

/// Signs of other languages, and what to write here. Tried before [`SIGNS`].
const OTHER_SIGNS: &[(&str, &str)] = &[
    ("===", "to compare, write `==`"),
    ("!==", "to compare, write `!=`"),
    ("<>", "to compare, write `!=`"),
    ("=<", "to compare, write `<=`"),
    ("=>", "to compare, write `>=`"),
    (":=", "write only the right-hand side"),
    ("//", "to divide and round down, write `floor(a/b)`"),
];

/// Characters of other languages, with the sign to write instead. Tried after [`SIGNS`].
const OTHER_CHARS: &[(char, &str)] = &[
    ('=', "to compare, write `==`"),
    ('&', "write `and` or `&&`"),
    ('|', "write `or` or `||`, or `abs(v)` for a size without sign"),
    ('~', "write `not`"),
    ('?', "write `if(c, a, b)`"),
    (':', "write `if(c, a, b)`"),
    (';', "values are separated by a comma"),
    ('[', "write round parentheses"),
    (']', "write round parentheses"),
    ('{', "write round parentheses"),
    ('}', "write round parentheses"),
    ('²', "write `^2`"),
    ('³', "write `^3`"),
    ('√', "write `sqrt(v)`"),
    ('∞', "write `inf`"),
    ('°', "angles are in radians; write `*pi/180`"),
    ('"', "a formula has no text in quotes"),
    ('\'', "a formula has no text in quotes"),
    ('`', "leave it out"),
    ('$', "leave it out"),
    ('#', "a formula has no comments"),
    ('.', "a number needs a digit beside its point"),
];

/// Reads tokens one by one.
pub(super) struct Lexer<'a> {
    source: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(source: &'a str) -> Self {
        Self { source, at: 0 }
    }

    /// Returns the next token and its range of bytes; always [`Token::End`] at the end.
    pub(super) fn next(&mut self) -> Result<(Token<'a>, Range<usize>), ParseError> {
        let rest = &self.source[self.at..];
        let text = rest.trim_start();
        let start = self.at + (rest.len() - text.len());
        let (token, length) = self.token(text, start)?;
        self.at = start + length;
        Ok((token, start..self.at))
    }

    fn token(&self, text: &'a str, start: usize) -> Result<(Token<'a>, usize), ParseError> {
        let Some(first) = text.chars().next() else {
            return Ok((Token::End, 0));
        };
        if let length @ 1.. = number_length(text) {
            return Ok((Token::Number(self.number(&text[..length], start)?), length));
        }
        if let length @ 1.. = name_length(text) {
            return Ok((name_or_word(&text[..length]), length));
        }
        if let Some((sign, advice)) = OTHER_SIGNS.iter().find(|(sign, _)| text.starts_with(sign)) {
            return Err(self.unknown_sign(sign, advice, start));
        }
        if let Some((sign, token)) = SIGNS.iter().find(|(sign, _)| text.starts_with(sign)) {
            return Ok((*token, sign.len()));
        }
        let known = OTHER_CHARS.iter().find(|(c, _)| *c == first);
        let advice = known.map_or("leave it out", |&(_, advice)| advice);
        Err(self.unknown_sign(&text[..first.len_utf8()], advice, start))
    }

    fn number(&self, text: &str, start: usize) -> Result<f64, ParseError> {
        let span = start..start + text.len();
        let mistake = |what: &str| {
            let message = format!("The number {} {what}.", quote(text));
            ParseError::new(self.source, span.clone(), message)
        };
        let value = decimal::parse(text).ok_or_else(|| mistake("cannot be read"))?;
        let digits = text.split(['e', 'E']).next().unwrap_or(text);
        if value.is_infinite() {
            Err(mistake("is too large: the largest is about 1.8e308"))
        } else if value == 0.0 && digits.contains(|c: char| matches!(c, '1'..='9')) {
            Err(mistake("is too small: the smallest is about 4.9e-324"))
        } else {
            Ok(value)
        }
    }

    fn unknown_sign(&self, sign: &str, advice: &str, start: usize) -> ParseError {
        let message = format!("The sign {} has no meaning here; {advice}.", quote(sign));
        ParseError::new(self.source, start..start + sign.len(), message)
    }
}

/// Returns the bytes of the number at the start of `text`: digits with at most one point, then an optional
/// exponent; 0 if there is none. An `e` without digits after it belongs to the next token.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        let rest = &text.as_bytes()[from..];
        rest.iter().take_while(|b| b.is_ascii_digit()).count()
    };
    let byte = |at: usize| text.as_bytes().get(at).copied();

    let whole = digits(0);
    let mut end = whole;
    if byte(end) == Some(b'.') {
        let fraction = digits(end + 1);
        if whole + fraction == 0 {
            return 0;
        }
        end += 1 + fraction;
    }
    if end > 0 && matches!(byte(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(byte(end + 1), Some(b'+' | b'-')));
        if let exponent @ 1.. = byte(end + 1 + sign).map_or(0, |_| digits(end + 1 + sign)) {
            end += 1 + sign + exponent;
        }
    }
    end
}

/// Returns the bytes of the name at the start of `text`: a letter or `_`, then letters, `_`, digits and
/// accents.
fn name_length(text: &str) -> usize {
    let begins = |c: char| c.is_alphabetic() || c == '_';
    let goes_on = |c: char| begins(c) || c.is_ascii_digit() || ('\u{300}'..='\u{36f}').contains(&c);
    if !text.starts_with(begins) {
        return 0;
    }
    text.find(|c| !goes_on(c)).unwrap_or(text.len())
}

fn name_or_word(name: &str) -> Token<'_> {
    match name {
        "and" => Token::And,
        "or" => Token::Or,
        "not" => Token::Not,
        _ => Token::Name(name),
    }
}
