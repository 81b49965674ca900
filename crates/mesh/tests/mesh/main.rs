//! The kernel: bisection, the literal report, closures, location, steps and updates.

#[path = "../../../../tests/shared/closure/mod.rs"]
mod closure;
mod invariants;
mod literal;
mod location;
mod referee_closure;
mod referee_literal;
#[path = "../../../../tests/shared/runs.rs"]
#[expect(dead_code, reason = "tests of the model use the rest")]
mod runs;
mod steps;
mod update;
