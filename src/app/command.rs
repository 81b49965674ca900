//! Everything that can be done, as data: menu, shortcut, palette, panel and test send the same commands.

use std::path::PathBuf;

use eframe::egui::{Key, KeyboardShortcut, Modifiers, ThemePreference};
use glam::DVec2;

use super::tools::{DomainToolMode, PaintKind, Tool};
use super::view::FieldOverlay;
use crate::colormap::Colormap;
use crate::document::{Example, Setting, Settings};
use crate::domain::CutShape;
use crate::geometry::Rect;
use crate::mesh::TriangleId;

/// One thing to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// An empty document.
    New,
    /// One of the documents that come with the program.
    OpenExample(Example),
    /// Asks for a file to open.
    AskToOpen,
    /// Opens a file; the ending says what it is.
    Open(PathBuf),
    /// Opens a project in place of the document.
    OpenProject(PathBuf),
    /// Saves the document to its file, or asks where.
    Save,
    /// Asks where to save it.
    AskWhereToSave,
    /// Saves it to a file, and asks before another one is replaced.
    SaveAs(PathBuf),
    /// Saves it to a file.
    SaveTo(PathBuf),
    /// Asks for a picture to take as risk.
    AskForImage,
    /// Takes a greyscale picture as the base field's risk.
    OpenImage(PathBuf),
    /// A document with these settings and no paint.
    NewWith(Box<Settings>),
    /// Asks for a file of polygons to mesh.
    AskForDomain,
    /// Opens a file of polygons as a new document's domain.
    OpenDomain(PathBuf),
    /// Asks where to write the mesh.
    AskForExport,
    /// Writes the mesh to a file, and asks before another one is replaced.
    ExportAs(PathBuf),
    /// Writes the mesh; the ending chooses the format.
    Export(PathBuf),
    /// Ends the program.
    Quit,
    /// Opens the unsaved work that an earlier run left behind and that is offered now.
    Restore,

    /// Takes back the last gesture.
    Undo,
    /// Does it again.
    Redo,
    /// Takes all paint away.
    ClearPaint,
    /// Changes a setting of the document. Goes on until [`Command::EndGesture`].
    Set(Setting),
    /// The slider was let go.
    EndGesture,
    /// Gives up the update of the mesh.
    CancelUpdate,

    /// Puts the brush down, at a point in world units.
    BeginStroke(DVec2),
    /// Draws on, to a point in world units.
    DrawTo(DVec2),
    /// Lifts the brush.
    EndStroke,
    /// A straight line from where the last stroke ended, to a point in world units.
    LineTo(DVec2),
    /// Gives up the stroke under way, or forgets the queried point.
    Escape,

    /// Takes a tool in hand.
    Use(Tool),
    /// What the brush paints.
    Paint(PaintKind),
    /// Radius of the brush, in world units.
    BrushRadius(f64),
    /// Makes the brush larger or smaller by a factor.
    ScaleBrush(f64),
    /// Hardness of the brush, 0 to 1.
    BrushHardness(f64),
    /// Strength of the tool in hand, 0 to 1.
    BrushStrength(f64),
    /// The diameter that the brush paints, in world units.
    BrushDiameter(f64),
    /// Takes the value under a point, in world units, as the brush's own.
    PickValue(DVec2),

    /// Asks about a point in world units.
    Query(DVec2),
    /// Asks about a triangle.
    QueryTriangle(TriangleId),

    /// Cuts the domain, or chooses what with.
    Domain(DomainCommand),

    /// Shows the whole domain.
    Fit,
    /// Puts a point, in world units, in the middle of the canvas.
    LookAt(DVec2),
    /// Zooms about the middle of the canvas by a factor.
    Zoom(f64),
    /// Draws edges or not.
    ToggleEdges,
    /// What is laid over the mesh.
    Overlay(FieldOverlay),
    /// Colours of the levels.
    Colormap(Colormap),
    /// Dark, light, or as the desktop has it.
    Theme(ThemePreference),
    /// Shows or hides the panels.
    TogglePanels,
    /// Opens the list of all commands.
    Palette,
    /// Shows what the program is.
    About,
}

/// What the domain tool does.
#[derive(Clone, Debug, PartialEq)]
pub enum DomainCommand {
    /// Adds a shape to the domain (`true`) or takes it away. Goes on until [`Command::EndGesture`].
    Reshape(CutShape, bool),
    /// Sets the next corner of the polygon to cut the domain with, in world units.
    AddCorner(DVec2),
    /// Closes that polygon and cuts.
    CloseOutline,
    /// What the domain tool cuts with.
    Shape(DomainToolMode),
    /// Whether it adds or takes away.
    Adds(bool),
    /// Makes a rectangle, in world units, the domain's.
    Frame(Rect),
}

/// The menu that an entry is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Documents and files.
    File,
    /// History and paint.
    Edit,
    /// Tools and the brush.
    Tool,
    /// What is shown.
    View,
    /// Documents that come with the program.
    Examples,
    /// About.
    Help,
}

impl Menu {
    /// All menus, from left to right, with their names.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::File, "File"),
        (Self::Edit, "Edit"),
        (Self::Tool, "Tool"),
        (Self::View, "View"),
        (Self::Examples, "Examples"),
        (Self::Help, "Help"),
    ];
}

/// A command with its name, its place and its key.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Where it stands.
    pub menu: Menu,
    /// What it is called, in menus and in the palette.
    pub title: String,
    /// Its shortcut.
    pub shortcut: Option<KeyboardShortcut>,
    /// What it does.
    pub command: Command,
    /// Whether it can be done now.
    pub enabled: bool,
    /// Whether it is what is shown now, for entries that are one of several.
    pub checked: bool,
    /// Whether a line stands above it.
    pub begins_group: bool,
}

impl Entry {
    /// An entry that can be done, without a key.
    pub fn new(menu: Menu, title: impl Into<String>, command: Command) -> Self {
        Self {
            menu,
            title: title.into(),
            shortcut: None,
            command,
            enabled: true,
            checked: false,
            begins_group: false,
        }
    }

    /// With a plain key.
    pub fn key(self, key: Key) -> Self {
        self.keys(Modifiers::NONE, key)
    }

    /// With a key and Ctrl (Cmd on a Mac).
    pub fn ctrl(self, key: Key) -> Self {
        self.keys(Modifiers::COMMAND, key)
    }

    /// With a key and modifiers.
    pub fn keys(mut self, modifiers: Modifiers, key: Key) -> Self {
        self.shortcut = Some(KeyboardShortcut::new(modifiers, key));
        self
    }

    /// Only where `enabled`.
    pub fn enabled(mut self, enabled: bool) -> Self {
        self.enabled = enabled;
        self
    }

    /// Marked where `checked`.
    pub fn checked(mut self, checked: bool) -> Self {
        self.checked = checked;
        self
    }

    /// With a line above it.
    pub fn group(mut self) -> Self {
        self.begins_group = true;
        self
    }
}
