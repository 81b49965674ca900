//! Numbers in sentences for a person: counts, lengths and their unit, sizes in bytes.

mod bytes;
mod grouped;
mod number;
mod unit;

pub use bytes::Bytes;
pub use grouped::{Grouped, group_digits};
pub use number::Number;
pub use unit::LengthUnit;
