//! The kernel: bisection, the literal report, closures, location and updates.

#[path = "../../../../tests/shared/closure/mod.rs"]
mod closure;
mod invariants;
#[path = "../../../../tests/shared/literal/mod.rs"]
mod literal;
mod location;
mod own_errors;
mod referee_closure;
mod referee_literal;
#[path = "../../../../tests/shared/runs.rs"]
#[expect(dead_code, reason = "tests of the model use the rest")]
mod runs;
mod update;
