//! Everything that can be done, as data: menus, keys, panels, the palette and tests send the same commands.
//!
//! A command belongs to a feature, or to the window itself: documents and files, edits, the view, the shell.
//! Each of these has an enum of its own, and one `match` without a wildcard that says what its commands do. A
//! [`Command`] is a command of any of them.

mod any;
mod brush;
mod edit;
mod file;
mod help;
mod layer;
mod shell;
mod view;

pub use any::{Command, CommandSet};
pub use brush::BrushCommand;
pub use edit::EditCommand;
pub use file::{FileCommand, Opened};
pub use help::HelpTopic;
pub use layer::LayerCommand;
pub use shell::ShellCommand;
pub use view::{InterfaceScale, SpaceCommand, ViewCommand};
