//! Edits of a document, and slices of the follower's work, both from the fuzzer's bytes.

#![no_main]

#[path = "../../crates/core/tests/model/operations/mod.rs"]
mod operations;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| operations::run_bytes(bytes));
