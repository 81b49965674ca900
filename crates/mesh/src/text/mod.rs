//! What messages for a person are made of: counts, lengths and their unit, sizes in bytes, excerpts of files.

mod bytes;
mod digits;
mod excerpt;
mod grouped;
mod number;
mod unit;

pub use bytes::Bytes;
pub use digits::{digits, fixed, percent_above, rounded, significant, with_unit};
pub use excerpt::{abridged, excerpt, short_name};
pub use grouped::{Grouped, group_digits};
pub use number::Number;
pub use unit::LengthUnit;
