//! Commands about what is shown, and how.

use egui::ThemePreference;
use glam::DVec2;

use super::CommandSet;
use crate::kit::coordinates::CoordinateStyle;
use crate::kit::file_coordinates::FileCoordinates;
use crate::kit::picture_choices::PictureChoices;
use crate::kit::view::{CanvasAid, FieldOverlay};
use crate::kit::{DockPlace, Tab};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::TriangleId;
use meshbrush_render::colormap::Colormap;
use meshbrush_render::scene::{Light, ViewDirection};

/// One thing to do with the view.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewCommand {
    /// Shows the whole domain.
    Fit,
    /// Puts a point in the middle of the canvas.
    LookAt(DVec2),
    /// Puts a point in the middle of the canvas, near enough that something of this size there can be seen;
    /// both in world units.
    GoTo(DVec2, f64),
    /// Shows an area, in world units, as large as it fits.
    ShowArea(Rect),
    /// Shows an area of a domain with these bounds, once its mesh is there; both in world units.
    ShowAreaOf(Rect, Rect),
    /// Zooms about the middle of the canvas by a factor.
    Zoom(f64),
    /// Zooms by a factor about a place on the canvas, in pixels.
    ZoomAt(f64, DVec2),
    /// Moves the view, in pixels.
    Pan(DVec2),
    /// Shows or hides edges.
    ToggleEdges,
    /// Shows or hides an aid to orientation on the canvas.
    ToggleAid(CanvasAid),
    /// Chooses what is drawn over the mesh.
    SetOverlay(FieldOverlay),
    /// Chooses the colours of the levels.
    Colormap(Colormap),
    /// Chooses the coordinates that places are written in.
    Coordinates(CoordinateStyle),
    /// Chooses the coordinates of exported meshes.
    FileCoordinates(FileCoordinates),
    /// Chooses how exported pictures look.
    Picture(PictureChoices),
    /// Shows one level alone, or all, while the pointer is on the legend.
    ShowLevel(Option<u32>),
    /// Hides or shows a level on the canvas.
    ToggleLevel(u32),
    /// Shows one level alone on the canvas; all if it is alone already.
    IsolateLevel(u32),
    /// Shows all levels on the canvas.
    ShowAllLevels,
    /// Highlights a neighbour of the queried triangle, or none.
    HighlightNeighbour(Option<TriangleId>),
    /// Dark, light, or as the desktop has it.
    Theme(ThemePreference),
    /// Opens a section of the panels, and scrolls to it or to a control in it.
    Reveal(&'static DockPlace),
    /// Shows or hides the panels.
    TogglePanels,
    /// Shows a tab of the lower dock.
    ShowTab(Tab),
    /// Begins or ends the mode for a projector.
    TogglePresentation,
    /// Changes the size of text and controls.
    Scale(InterfaceScale),
    /// Changes the view in space.
    Space(SpaceCommand),
}

impl CommandSet for ViewCommand {}

/// One thing to do with the view in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpaceCommand {
    /// Shows the mesh in space, or the plan again.
    Toggle,
    /// Turns around the middle, and raises the viewer, by degrees.
    Turn(DVec2),
    /// Turns and zooms are from now on about what is at a height, in steps.
    About(f64),
    /// Looks in a direction.
    LookFrom(ViewDirection),
    /// Multiplies heights by a factor; with none by one that makes relief visible.
    Exaggerate(Option<f64>),
    /// Puts the light elsewhere.
    Light(Light),
    /// Shows the mesh in space from a direction, with a factor for heights and a height in the middle.
    Show(ViewDirection, [Option<f64>; 2]),
}

/// A change of the size of text and controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InterfaceScale {
    /// By a tenth of the normal size.
    Larger,
    /// By a tenth of the normal size.
    Smaller,
    /// The size that the system asks for.
    Normal,
}
