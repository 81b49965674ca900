//! The recorded steps beside the literal report.

#[path = "../../../../tests/shared/literal/mod.rs"]
#[expect(dead_code, reason = "the tests of the mesh use the rest")]
mod literal;
#[path = "../../../core/tests/model/random_coast/mod.rs"]
mod random_coast;
mod coast;
mod names;
mod steps;
