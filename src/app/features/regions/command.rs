//! Commands about regions drawn by hand.

use glam::DVec2;

use meshbrush_core::document::DrawnShape;
use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with a region drawn by hand. Points are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum RegionCommand {
    /// Adds a shape to the target of the tool (`true`) or cuts it away. Further shapes join until
    /// [`EditCommand::EndGesture`](meshbrush_kit::kit::command::EditCommand::EndGesture).
    Draw(DrawnShape, bool),
    /// Fills the hole around a point (`true`), or cuts away the part that it is in.
    Fill(DVec2, bool),
    /// Sets the next corner of the polygon or the line.
    AddCorner(DVec2),
    /// Moves one of its corners.
    MoveCorner(usize, DVec2),
    /// Removes its last corner.
    RemoveCorner,
    /// Closes the polygon, or ends the line, and draws it.
    Close,
    /// Selects the tool and what it draws on.
    Target(RegionTarget),
    /// Selects the tool and what it draws with.
    Shape(RegionShape),
    /// Sets whether it cuts away instead of adding.
    Cuts(bool),
    /// Chooses the keep-out region that is drawn on, by its number from 0, or a new one.
    KeepOut(Option<usize>),
    /// Names a keep-out region, by its number from 0.
    Rename(usize, String),
    /// Removes the mask, or the keep-out region, that the tool draws on.
    Clear,
}

impl CommandSet for RegionCommand {}

/// What the region tool draws on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RegionTarget {
    /// The mask of the selected layer.
    #[default]
    Mask,
    /// A keep-out region of paths.
    KeepOut,
    /// The shapes to which the selected layer measures the distance.
    Shapes,
}

/// What the region tool draws with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RegionShape {
    /// The brush ring.
    #[default]
    Brush,
    /// A rectangle, from corner to corner.
    Rectangle,
    /// A circle, from its centre.
    Circle,
    /// An outline by free hand.
    Lasso,
    /// A polygon, corner by corner.
    Polygon,
    /// The hole, or the part, under the pointer.
    Fill,
    /// A polyline, among shapes only.
    Line,
    /// Points, among shapes only.
    Point,
}
