//! The commands about paths.

use std::path::PathBuf;

use glam::DVec2;

use super::{AlternativesCommand, FrontCommand, KeepOutCommand};
use meshbrush_core::document::PathCost;
use meshbrush_core::layers::LayerId;
use meshbrush_kit::kit::command::CommandSet;

/// Why nothing can be done with a path of a document without one.
pub const NO_PATH: &str = "There is no path: set its start and goal with the path tool[ ({path})].";

/// One thing to do with paths. Points and lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum PathCommand {
    /// Adds a layer with a corridor along the paths as they are.
    AddCorridor,
    /// Moves the corridor of a layer to the paths as they are.
    MoveCorridor(LayerId),
    /// Takes hold of the place at a point, at most `reach` away, or adds a place there.
    Press {
        /// Where.
        at: DVec2,
        /// How far from a place still counts.
        reach: f64,
        /// Whether a place that is added lies between start and goal.
        is_between: bool,
    },
    /// Moves the place that was taken hold of. Further moves join this gesture until
    /// [`EditCommand::EndGesture`](meshbrush_kit::kit::command::EditCommand::EndGesture).
    DragTo(DVec2),
    /// Begins a path.
    StartAt(DVec2),
    /// Ends the path that was begun.
    GoalAt(DVec2),
    /// Adds a place in between to the path that is shown.
    ViaAt(DVec2),
    /// Removes the selected place in between, or the path of a selected start or goal.
    Delete,
    /// Removes all paths.
    DeleteAll,
    /// Names the path that is shown. Further changes join this gesture.
    Name(String),
    /// Leads a path along the one that was shown before its proof found a better one.
    KeepFormer(usize),
    /// Makes the start the goal of the path that is shown.
    Swap,
    /// Sets the speed for the time of the path, in knots; 0 asks for no time.
    Speed(f64),
    /// Sets how far paths stay from the outline and from keep-out regions. Further changes join this gesture.
    Clearance(f64),
    /// Sets what paths cost. Further changes join this gesture.
    Cost(PathCost),
    /// Lets paths cost what weights say, or a formula: the one that is equal to the weights at first.
    CostBy(CostKind),
    /// Sets the width of the interval that is proved, as a share of the cost.
    Width(f64),
    /// Shows the corridor of nearly best paths, or does not.
    ShowCorridor(bool),
    /// Sets how much more than the best path those in the corridor cost at most, as a share.
    CorridorShare(f64),
    /// Concerns alternatives of the path that is shown.
    Alternatives(AlternativesCommand),
    /// Concerns the front of length against risk.
    Front(FrontCommand),
    /// Marks the place at a distance from the start of the path that is shown.
    ShowDistance(Option<f64>),
    /// Edits the keep-out regions.
    KeepOut(KeepOutCommand),
    /// Sets how far points that files leave out are from the path; 0 leaves out none.
    ExportTolerance(f64),
    /// Writes the path that is shown, and asks before another file is replaced.
    ExportAs(PathBuf),
    /// Writes the path that is shown.
    Export(PathBuf),
}

impl CommandSet for PathCommand {}

/// How the cost of paths is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostKind {
    /// The cost is given by the weights of length and risk.
    Weights,
    /// The cost is given by a formula.
    Formula,
}

impl CostKind {
    /// How a cost is given.
    pub fn of(cost: &PathCost) -> Self {
        match cost {
            PathCost::Weighted(_) => Self::Weights,
            PathCost::Formula(_) => Self::Formula,
        }
    }
}
