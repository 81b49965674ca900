//! Parts of messages for a person: counts, lengths and their unit, sizes in bytes, excerpts of files.

mod area;
mod bytes;
pub mod decimal;
mod digits;
mod excerpt;
mod grouped;
mod length;
mod number;
mod round;
pub mod typed;
mod unit;
mod xml;

pub use area::area;
pub use bytes::Bytes;
pub use digits::{decimals_for, digits, fixed, percent_above, rounded, significant, with_unit};
pub use excerpt::{abridged, excerpt, printable, short_name};
pub use grouped::{Grouped, group_digits};
pub use length::Length;
pub use number::Number;
pub use round::{round_below, tick_step};
pub use unit::LengthUnit;
pub use xml::xml_text;
