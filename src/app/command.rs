//! Everything that can be done, as data: menus, keys, panels, the palette and tests send the same commands.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::ThemePreference;
use glam::DVec2;

use super::background::WorkId;
use super::dialogs::FileRequest;
use super::explore::TreeStep;
use super::help::HelpTopic;
use super::home::Home;
use super::paths::PathCommand;
use super::plots::PlotsCommand;
use super::readout::Quantity;
use super::report::FigureCommand;
use super::stepping::StepCommand;
use super::tools::{BoundaryToolMode, BrushMode, DomainToolMode, PaintKind, PenEffect, Tool};
use super::view::{CanvasAid, FieldOverlay};
use super::widgets::Answer;
use meshbrush_core::document::{Document, Example, Setting};
use meshbrush_core::domain::{CutShape, Domain};
use meshbrush_core::layers::{Combine, DistanceTo, LayerId, LayerKind, Mask};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::TriangleId;
use meshbrush_render::colormap::Colormap;

/// One thing to do. Lengths and points are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Opens an empty document.
    New,
    /// Opens one of the documents that come with the program.
    OpenExample(Example),
    /// Asks for a file.
    Ask(FileRequest),
    /// Opens a file; its ending says what it is.
    Open(PathBuf),
    /// Reads a project, and opens it in place of the document.
    OpenProject(PathBuf),
    /// Reads a greyscale picture, or a grid of its own placement, as a layer of risk.
    OpenImage(PathBuf),
    /// Reads a grid as a layer of target diameters.
    OpenDiameters(PathBuf),
    /// Edits the layers.
    Layer(LayerCommand),
    /// Edits the threats of the selected layer.
    Threats(ThreatsCommand),
    /// Reads a table of threats in place of those of the selected layer.
    OpenThreats(PathBuf),
    /// Reads a picture or a grid, and adds a band of its values.
    OpenBand(PathBuf),
    /// Reads a picture or a grid, and adds it as a layer with a curve from its values to diameters.
    OpenValues(PathBuf),
    /// Reads points, lines and polygons, and adds a layer of the distance to them.
    OpenShapes(PathBuf),
    /// Reads points, lines and polygons, to which the selected layer measures the distance from then on.
    ReplaceShapes(PathBuf),
    /// Reads polygons as the mask of the selected layer.
    OpenMask(PathBuf),
    /// Writes the threats of the selected layer as a table, and asks before another file is replaced.
    SaveThreatsAs(PathBuf),
    /// Writes the threats of the selected layer as a table.
    SaveThreats(PathBuf),
    /// Reads a picture to be shown behind the mesh.
    OpenBackground(PathBuf),
    /// Reads polygons, and opens a new document with them as its domain.
    OpenDomain(PathBuf),
    /// Reads a recipe, and opens a new document with its mesh.
    OpenRecipe(PathBuf),
    /// Reads polygons, and adds them to the domain of the document.
    AddOutline(PathBuf),
    /// Adds an outline that was read.
    SetOutline(Box<OutlineChange>),
    /// Opens a document that was read.
    Show(Opened),
    /// Saves the document to its file, or asks where.
    Save,
    /// Saves it to a file, and asks before another one is replaced.
    SaveAs(PathBuf),
    /// Saves it to a file.
    SaveTo(PathBuf),
    /// Saves to a path, whatever is there.
    SaveOver(PathBuf),
    /// Writes the document as a recipe, and asks before other files are replaced.
    SaveRecipeAs(PathBuf),
    /// Writes the document as a recipe, with the files that it names beside it.
    SaveRecipe(PathBuf),
    /// Writes what was done since the document was opened, and asks before another file is replaced.
    ExportTestAs(PathBuf),
    /// Writes what was done since the document was opened, with the fingerprint after each edit.
    ExportTest(PathBuf),
    /// Writes the mesh to a file, and asks before another one is replaced.
    ExportAs(PathBuf),
    /// Writes the mesh; the ending chooses the format.
    Export(PathBuf),
    /// Writes steps of the refinement, and asks before other files are replaced.
    ExportStepsAs(PathBuf),
    /// Writes steps of the refinement, each to a file with its number.
    ExportSteps(PathBuf),
    /// Cancels the reading or writing of a file.
    CancelWork(WorkId),
    /// Opens the unsaved work that an earlier run left behind and that is offered now.
    Restore,
    /// Closes the window.
    Quit,

    /// Takes back the last gesture.
    Undo,
    /// Does the last undone gesture again.
    Redo,
    /// Removes all paint.
    ClearPaint,
    /// Changes a setting of the document. Further changes of it join this gesture until
    /// [`Command::EndGesture`].
    Set(Setting),
    /// Ends the gesture, as when a slider is released.
    EndGesture,
    /// Stops the update of the mesh.
    CancelUpdate,

    /// Begins a stroke at a point.
    BeginStroke(DVec2),
    /// Extends the stroke to a point.
    DrawTo(DVec2),
    /// Ends the stroke.
    EndStroke,
    /// Paints a straight line to a point from where the last stroke ended.
    LineTo(DVec2),
    /// Cancels the current stroke, cut or polygon, or else clears the query and the message.
    Escape,

    /// Selects a tool.
    Use(Tool),
    /// Changes the brush.
    Brush(BrushCommand),

    /// Queries a point.
    Query(DVec2),
    /// Queries a triangle.
    QueryTriangle(TriangleId),
    /// Queries a neighbour of the queried triangle, by its place from 0; 0 is the bisection neighbour.
    QueryNeighbour(usize),
    /// Looks at other triangles and nodes of the bisection tree than the queried one.
    Explore(ExploreCommand),
    /// As [`Command::QueryNeighbour`], and keeps the triangles on the way in sight.
    FollowNeighbour(usize),
    /// Measures how many steps point location takes.
    MeasureWalks,
    /// Copies everything that the inspector shows of the queried triangle.
    CopyReadout,
    /// Opens the question for a place to go to.
    AskPlace,
    /// Opens it with a point typed in.
    AskPlaceNear(DVec2),
    /// Puts a point in the middle of the canvas, and queries it.
    GoTo(DVec2),
    /// Puts a triangle in the middle of the canvas, large enough to be seen, and queries it.
    GoToTriangle(TriangleId),
    /// Computes the figures of the mesh.
    Measure,
    /// Copies a text to the clipboard.
    Copy(String),
    /// Chooses what the inspector interpolates.
    Inspect(Quantity),

    /// Edits the pins, or does something with their table.
    Pins(PinsCommand),

    /// Edits the paths, or sets up how they are found.
    Path(PathCommand),

    /// Shows plots, or does something with them.
    Plots(PlotsCommand),

    /// Opens or closes a figure of the report.
    Figure(FigureCommand),

    /// Edits the domain, or sets up the tool for it.
    Domain(DomainCommand),
    /// Selects or splits pieces of the boundary, or sets up the tool for it.
    Boundary(BoundaryCommand),

    /// Steps through the refinement.
    Steps(StepCommand),

    /// Shows the whole domain.
    Fit,
    /// Puts a point in the middle of the canvas.
    LookAt(DVec2),
    /// Shows an area, in world units, as large as it fits.
    ShowArea(Rect),
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
    /// Limits the threads on which the window computes.
    LimitThreads(NonZeroUsize),
    /// Shows or hides the panels.
    TogglePanels,

    /// Opens the list of all commands.
    Palette,
    /// Shows what the program is.
    About,
    /// Shows a topic of the help.
    ShowHelp(HelpTopic),
    /// Closes the help.
    CloseHelp,
    /// Closes the open dialog.
    CloseDialog,
    /// Dismisses the message.
    DismissNotice,
    /// Answers whether to save edits before they would be lost.
    AnswerLeaving(Answer),
    /// Answers whether to replace files.
    AnswerReplacing(Answer),
    /// Answers whether to restore unsaved work of an earlier run.
    AnswerRecovery(Answer),
    /// Shows a failure.
    Report(String),
    /// Shows news.
    Tell(String),
}

/// A document that was read and not shown yet.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What was read.
    pub document: Arc<Document>,
    /// The project file that it belongs to, if it is from one.
    pub home: Option<Home>,
}

impl PartialEq for Opened {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.document, &other.document) && self.home == other.home
    }
}

/// What is looked at of the bisection tree around the queried triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExploreCommand {
    /// Goes to another triangle of the tree.
    Step(TreeStep),
    /// Shows the node at a corner of the shown triangle, 0 being the apex, or none.
    ShowCorner(Option<usize>),
}

/// What changes about the brush.
#[derive(Clone, Debug, PartialEq)]
pub enum BrushCommand {
    /// Selects the brush and what it paints.
    Kind(PaintKind),
    /// Selects the brush and how a stroke changes the paint.
    Mode(BrushMode),
    /// Sets the radius of the brush.
    Radius(f64),
    /// Makes the brush larger or smaller by a factor.
    Scale(f64),
    /// Sets the hardness of the brush, 0 to 1.
    Hardness(f64),
    /// Sets the strength of the selected tool, 0 to 1.
    Strength(f64),
    /// Sets the risk that the brush paints in the mode *Set*, 0 to 1.
    Risk(f64),
    /// Sets the diameter that the brush paints.
    Diameter(f64),
    /// Takes the value at a point as the brush's own.
    Pick(DVec2),
    /// Sets the smoothing of strokes, 0 to 1.
    Smoothing(f64),
    /// Repeats strokes on the other side: left and right.
    MirrorX(bool),
    /// Repeats strokes on the other side: above and below.
    MirrorY(bool),
    /// Chooses what the pressure of a pen changes.
    PenEffect(PenEffect),
    /// Notes the pressure of the pen, 0 to 1, or that it was lifted.
    Pen(Option<f64>),
}

/// An outline that was read for a domain.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineChange {
    /// Name of the file.
    pub name: String,
    /// The domain that it was added to.
    pub before: Domain,
    /// The change of the document.
    pub setting: Setting,
}

/// What the boundary tool does.
#[derive(Clone, Debug, PartialEq)]
pub enum BoundaryCommand {
    /// Selects or splits the piece at a point in world units, at most so far away.
    Click(DVec2, f64),
    /// Selects the piece at a point of the boundary.
    Select(DVec2),
    /// Selects the tool and what a click does.
    Mode(BoundaryToolMode),
    /// Joins the selected piece with the next one.
    Join,
}

/// One thing to do with pins. Points and lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum PinsCommand {
    /// Takes hold of the pin at a point, at most `reach` away, or queries the point.
    Press {
        /// Where.
        at: DVec2,
        /// How far from a pin still counts.
        reach: f64,
    },
    /// Moves the pin that was taken hold of. Further moves join this gesture until [`Command::EndGesture`].
    DragTo(DVec2),
    /// Pins the queried point.
    Pin,
    /// Pins a point.
    Add(DVec2),
    /// Selects a pin by its number from 0, queries it, and puts it in sight.
    Select(usize),
    /// Removes the selected pin.
    Delete,
    /// Removes all pins.
    DeleteAll,
    /// Reads the values of pins for some milliseconds.
    Read,
    /// Makes the table of the pins, and copies it.
    Copy,
    /// Copies the table, which was made for so many pins.
    Copied(String, usize),
    /// Writes the table, and asks before another file is replaced.
    ExportAs(PathBuf),
    /// Writes the table.
    Export(PathBuf),
}

/// What the domain tool does.
#[derive(Clone, Debug, PartialEq)]
pub enum DomainCommand {
    /// Adds a shape to the domain (`true`) or removes it. Further shapes join this gesture until
    /// [`Command::EndGesture`].
    Reshape(CutShape, bool),
    /// Sets the next corner of the polygon to cut with.
    AddCorner(DVec2),
    /// Moves one of its corners.
    MoveCorner(usize, DVec2),
    /// Removes its last corner.
    RemoveCorner,
    /// Closes that polygon and cuts. It needs three corners.
    ClosePolygon,
    /// Selects the tool and what it cuts with.
    Mode(DomainToolMode),
    /// Sets whether it adds or removes.
    Adds(bool),
    /// Gives the domain other bounds.
    Bounds(Rect),
}

/// One thing to do with layers.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerCommand {
    /// Selects a layer: its parameters are shown, and brush and eraser act on it.
    Select(LayerId),
    /// Adds a layer above the selected one.
    Add(Box<LayerKind>),
    /// Adds a band of the selected layer's raster, or else of the highest raster. Asks for a file where there
    /// is none.
    AddBand,
    /// Adds a copy above a layer.
    Duplicate(LayerId),
    /// Removes a layer.
    Delete(LayerId),
    /// Moves a layer to a place, counted from the bottom without that layer.
    Move(LayerId, usize),
    /// Gives a layer a name.
    Rename(LayerId, String),
    /// Shows or hides a layer.
    Show(LayerId, bool),
    /// Locks or unlocks a layer.
    Lock(LayerId, bool),
    /// Chooses how a layer is combined with those below it.
    Combine(LayerId, Combine),
    /// Changes what a layer asks for. Further changes join this gesture until [`Command::EndGesture`].
    SetKind(LayerId, Box<LayerKind>),
    /// Adds a corridor along the paths as they are.
    AddCorridor,
    /// Moves a corridor to the paths as they are.
    TakePaths(LayerId),
    /// Chooses what the distance of a layer is measured to.
    MeasureTo(LayerId, DistanceTo),
    /// Makes a layer count only inside a mask, or everywhere.
    Mask(LayerId, Option<Mask>),
    /// Removes the paint of a layer.
    Clear(LayerId),
    /// Begins to type a new name of a layer in the panel.
    AskName(LayerId),
    /// Limits the gradation of h̄ to the usual slope, or removes the limit.
    LimitGradation(bool),
}

/// One thing to do with the threats of the selected layer. Points and lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum ThreatsCommand {
    /// Takes hold of the threat at a point, or places one there.
    Press {
        /// Where.
        at: DVec2,
        /// How far from the middle or the ring of a threat still counts.
        reach: f64,
        /// Whether to place one even where there is a threat.
        places: bool,
    },
    /// Moves what was taken hold of. Further moves join this gesture until [`Command::EndGesture`].
    DragTo(DVec2),
    /// Places a threat, as a gesture of its own.
    Place(DVec2),
    /// Selects a threat by its number from 0, and puts it in sight.
    Select(usize),
    /// Removes the selected threat.
    Delete,
}
