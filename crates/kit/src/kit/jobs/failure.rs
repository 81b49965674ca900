//! Jobs that end with a panic: a person gets one message, and nothing starts the work again.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Longest part of a panic's message that is shown, in bytes.
const LONGEST: usize = 200;

/// Runs work and catches a panic.
///
/// # Errors
/// Fails with a sentence about the panic. The work owns all data that it changes, so no data are left half
/// changed.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| sentence(&message(&*panic)))
}

fn sentence(problem: &str) -> String {
    format!(
        "A computation beside the window failed because of a bug in Meshbrush ({problem}). What it would show is missing until \
         the next edit; the document is unchanged."
    )
}

/// Returns the beginning of what a panic says.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
    let line = text.lines().next().unwrap_or_default();
    line[..line.floor_char_boundary(LONGEST)].to_owned()
}
