//! Work on other threads that ended with a panic: a person is told once, and nothing starts it again.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use eframe::egui::{Context, Id};

/// Longest part of a panic's message that is shown, in bytes.
const LONGEST: usize = 200;

/// What work gives, or `None` if it panics: the window then shows a message.
pub fn caught<T>(ctx: &Context, work: impl FnOnce() -> T) -> Option<T> {
    let result = catch_unwind(AssertUnwindSafe(work));
    result.map_err(|panic| note(ctx, &message(&*panic))).ok()
}

fn note(ctx: &Context, problem: &str) {
    let text = format!(
        "A computation beside the window failed because of a bug in Meshbrush ({problem}). What it would show is missing until \
         the next edit; the document is unchanged."
    );
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Vec<String>>(place()).push(text));
    ctx.request_repaint();
}

/// The messages about work that failed since the last call.
pub fn take(ctx: &Context) -> Vec<String> {
    ctx.data_mut(|data| data.remove_temp::<Vec<String>>(place())).unwrap_or_default()
}

fn place() -> Id {
    Id::unique("failed work")
}

/// The beginning of what a panic says.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
    let line = text.lines().next().unwrap_or_default();
    line[..line.floor_char_boundary(LONGEST)].to_owned()
}
