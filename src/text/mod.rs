//! Numbers in sentences for a person: counts, lengths, sizes in bytes.

mod bytes;
mod grouped;
mod number;

pub use bytes::Bytes;
pub use grouped::{Grouped, group_digits};
pub use number::Number;
