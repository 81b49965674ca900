//! The domain: the tool that cuts it, its outline, its bounds and its formula, and how well the mesh fits it.

mod command;
mod entries;
mod execute;
mod files;
mod fit;
mod load;
mod options;
mod panel;
#[cfg(test)]
mod tests;
mod tool;

pub use command::DomainCommand;
use command::OutlineChange;
use files::ROLES;
pub use files::{ADD_OUTLINE, OPEN_DOMAIN, OPEN_DOMAIN_AS_IT_IS, OPEN_DOMAIN_IN_METRES, OPEN_SEA};
use fit::FIT;
use options::DOMAIN_OPTIONS;
use panel::DOMAIN_PANEL;
pub use tool::{DOMAIN, DomainTool, DomainToolMode};

/// The domain is in the document, and the open polygon in [`DomainTool`].
#[derive(Default)]
pub struct DomainEditor;
