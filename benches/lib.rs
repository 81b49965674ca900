//! What several benches share.

pub mod diamond;
