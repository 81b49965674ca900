//! Finite elements: manufactured solutions, steps of the solver, threads, bounds.

#[path = "../../../../tests/shared/formula_mesh/mod.rs"]
mod formula_mesh;
#[path = "../../../core/tests/model/random_coast/mod.rs"]
mod random_coast;
#[path = "../../../../tests/shared/runs.rs"]
mod runs;
mod solved;
mod manufactured;
mod jump;
mod steps;
mod same_bits;
mod bad_input;
mod adaptive;
mod bounds;
