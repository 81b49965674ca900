//! How many random cases a test tries, and which one is the first.
//!
//! `MESHBRUSH_LONG=50` tries 50 times as many as usual (`sh tests/long`), `MESHBRUSH_SEED=17` begins with the
//! 17th case, as a failure names it, and `MESHBRUSH_TABLE=1` prints figures.

use std::ops::Range;

/// Returns the seeds of so many cases, or of a multiple of them in a long run.
pub fn seeds(default: u64) -> Range<u64> {
    let first = number("MESHBRUSH_SEED").unwrap_or(0);
    first..first + runs(default)
}

/// So many cases, or a multiple of them in a long run.
pub fn runs(default: u64) -> u64 {
    default * number("MESHBRUSH_LONG").unwrap_or(1)
}

fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{variable} is a whole number, and not {text:?}")))
}

/// Returns whether a test prints its figures.
pub fn prints_table() -> bool {
    std::env::var_os("MESHBRUSH_TABLE").is_some()
}
