//! The queried point and its triangle: what is known of them, why the triangle is there, and the ways to
//! other triangles.

mod cause_marks;
mod command;
mod entries;
mod execute;
mod explore;
mod inspector;
mod options;
#[cfg(test)]
mod tests;
mod text;
mod tool;
mod walk_marks;
mod walk_panel;
mod walks;
mod why;

pub use command::{ExploreCommand, InspectCommand};
use glam::DVec2;

use explore::{Explore, TreeStep};
use inspector::{DETAILS, INSPECTOR};
use options::QUERY_OPTIONS;
pub use text::decided_by;
pub use tool::QUERY;
use walk_panel::WALK;
use walks::WalkMeter;
use why::WHY;

/// What the window keeps of the queried triangle; the queried point is in the session.
#[derive(Default)]
pub struct Inspector {
    /// Why the triangle is in the mesh.
    explore: Explore,
    /// How long the walks of point location are.
    walks: WalkMeter,
    /// The point that was gone to by its coordinates: nobody asked for the walk to it.
    arrived_at: Option<DVec2>,
}
