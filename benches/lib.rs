//! Code that several benches share.

pub mod diamond;
pub mod documents;
pub mod field;
pub mod memory;
pub mod numbering;
pub mod resident;
pub mod risks;
pub mod scene;
pub mod window;
