//! Everything that can be done, as data: menus, keys, panels, the palette and tests send the same commands.
//!
//! A command belongs to a feature, or to the window itself: documents and files, edits, the view, the shell.
//! Each of these has an enum of its own, and one `match` without a wildcard that says what its commands do.

mod edit;
mod file;
mod shell;
mod view;

pub use super::features::Command;
pub use super::features::boundary::BoundaryCommand;
pub use super::features::domain::DomainCommand;
pub use super::features::inspection::{ExploreCommand, InspectCommand};
pub use super::features::layers::LayerCommand;
pub use super::features::painting::BrushCommand;
pub use super::features::picture::PictureCommand;
pub use super::features::pins::PinsCommand;
pub use super::features::plots::{PlotKind, PlotsCommand};
pub use super::features::regions::{RegionCommand, RegionTarget};
pub use super::features::report::FigureCommand;
pub use super::features::statistics::StatisticsCommand;
pub use super::features::stepping::StepCommand;
pub use super::features::threats::ThreatsCommand;
pub use edit::EditCommand;
pub use file::{FileCommand, Opened};
pub use shell::ShellCommand;
pub use view::{SpaceCommand, ViewCommand};
