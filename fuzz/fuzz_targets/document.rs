//! A document edited as a fuzzer's bytes say, the follower cut where they say.

#![no_main]

#[path = "../../tests/operations/mod.rs"]
mod operations;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| operations::run_bytes(bytes));
