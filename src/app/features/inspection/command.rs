//! Commands about the queried point and its triangle.

use glam::DVec2;

use super::TreeStep;
use meshbrush_kit::kit::command::CommandSet;
use meshbrush_kit::kit::readout::Quantity;
use meshbrush_mesh::mesh::TriangleId;

/// One thing to do with the queried point.
#[derive(Clone, Debug, PartialEq)]
pub enum InspectCommand {
    /// Queries a point.
    Query(DVec2),
    /// Queries a triangle.
    QueryTriangle(TriangleId),
    /// Queries a neighbour of the queried triangle, by its place from 0; 0 is the bisection neighbour.
    QueryNeighbour(usize),
    /// Queries a neighbour as [`Self::QueryNeighbour`] does, and keeps the trail of triangles in sight.
    FollowNeighbour(usize),
    /// Looks at other triangles and nodes of the bisection tree than the queried one.
    Explore(ExploreCommand),
    /// Measures how many steps point location takes.
    MeasureWalks,
    /// Copies everything that the inspector shows of the queried triangle.
    CopyReadout,
    /// Puts a point in the middle of the canvas, and queries it.
    GoTo(DVec2),
    /// Puts a triangle in the middle of the canvas, large enough to be seen, and queries it.
    GoToTriangle(TriangleId),
    /// Asks why the triangle at a point is there: queries it, shows it at least this large, in world units,
    /// and opens the explanation.
    AskWhy(DVec2, f64),
    /// Chooses what the inspector interpolates.
    Interpolate(Quantity),
}

impl CommandSet for InspectCommand {}

/// A step in the bisection tree around the queried triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExploreCommand {
    /// Goes to another triangle of the tree.
    Step(TreeStep),
    /// Shows the node at a corner of the shown triangle, 0 being the apex, or none.
    ShowCorner(Option<usize>),
}
