//! The queried point and its triangle.

mod command;

pub use command::{ExploreCommand, InspectCommand};
