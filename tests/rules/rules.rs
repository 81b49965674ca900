//! The rules of the source code. This binary uses nothing of the crate, so it compiles in a moment.

mod architecture;
mod public_api;
mod source;
