//! The recorded steps beside the literal report.

#[path = "../../../../tests/shared/literal/mod.rs"]
#[expect(dead_code, reason = "the tests of the mesh use the rest")]
mod literal;
mod steps;
