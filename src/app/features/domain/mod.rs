//! The domain.

mod command;

pub use command::{DomainCommand, OutlineChange};
