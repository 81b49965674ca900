//! Everything that can be done, as data: menus, keys, panels, the palette and tests send the same commands.
//!
//! A command belongs to a feature, or to the window itself: documents and files, edits, the view, the shell.
//! Each of these has an enum of its own, and one `match` without a wildcard that says what its commands do.

mod edit;
mod file;
mod shell;
mod view;

pub use super::features::boundary::BoundaryCommand;
pub use super::features::domain::{DomainCommand, OutlineChange};
pub use super::features::inspection::{ExploreCommand, InspectCommand};
pub use super::features::layers::LayerCommand;
pub use super::features::painting::BrushCommand;
pub use super::features::picture::PictureCommand;
pub use super::features::pins::PinsCommand;
pub use super::features::plots::PlotsCommand;
pub use super::features::statistics::StatisticsCommand;
pub use super::features::threats::ThreatsCommand;
use super::paths::PathCommand;
use super::report::FigureCommand;
pub use super::stepping::StepCommand;
pub use edit::EditCommand;
pub use file::{FileCommand, Opened};
pub use shell::ShellCommand;
pub use view::ViewCommand;

/// One thing to do. Lengths and points are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Documents and their files.
    File(FileCommand),
    /// History, paint and settings of the document.
    Edit(EditCommand),
    /// Strokes and the brush.
    Brush(BrushCommand),
    /// The layers of the size field.
    Layer(LayerCommand),
    /// The threats of the selected layer.
    Threats(ThreatsCommand),
    /// The domain.
    Domain(DomainCommand),
    /// The pieces of the boundary.
    Boundary(BoundaryCommand),
    /// The picture behind the mesh.
    Picture(PictureCommand),
    /// The paths of the document.
    Path(PathCommand),
    /// The pins and their table.
    Pins(PinsCommand),
    /// The queried point and its triangle.
    Inspect(InspectCommand),
    /// The figures of the mesh.
    Statistics(StatisticsCommand),
    /// Plots.
    Plots(PlotsCommand),
    /// The figures of the report.
    Figure(FigureCommand),
    /// The steps of the refinement.
    Steps(StepCommand),
    /// What is shown, and how.
    View(ViewCommand),
    /// Tools, dialogs, help and messages.
    Shell(ShellCommand),
}
