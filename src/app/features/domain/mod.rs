//! The domain.

mod command;
mod files;

pub use command::{DomainCommand, OutlineChange};
pub use files::{ADD_OUTLINE, OPEN_DOMAIN};
