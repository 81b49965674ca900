//! The tools: one file each, listed in [`TOOLS`].
//!
//! Name, key, icon, hint, panel sections and gestures of a tool are fields of its [`ToolSpec`]. Menus, keys,
//! the tool strip, the side panel and the canvas read the table, so that a new tool is one file and one
//! entry.

mod brush;
mod domain;
mod eraser;
mod gesture;
mod pan;
mod path;
mod pen;
mod query;
mod threats;

use std::fmt;

use eframe::egui::{CursorIcon, Key, Painter, Pos2};
use glam::DVec2;

pub use brush::{BRUSH, BrushMode, picks};
pub use domain::{DOMAIN, DomainTool, DomainToolMode};
pub use eraser::ERASER;
pub use gesture::{CLICK_SLACK, Gesture, Pointer, Press, SettingsDrag, nearest_within};
pub use pan::{PAN, Panning};
pub use path::{ALTERNATIVE_COLOR, PATH, PATH_COLOR, POINTED_COLOR, PathPlace, PathTool, paint_place};
pub use pen::{Pen, PenEffect};
pub use query::{PIN_REACH_POINTS, QUERY};
pub use threats::{THREATS, ThreatGrip, ThreatsTool, grip_at};

use super::command::Command;
use super::features::boundary::{BOUNDARY, BoundaryTool};
use super::frame::FrameState;
use super::panels::Panel;
use super::session::Session;
use super::widgets::{Hint, Icon};
use meshbrush_core::paint::{Brush, Mirror, PathPoint};
use meshbrush_mesh::geometry::Rect;

/// All tools, in the order of the tool strip.
pub static TOOLS: [Tool; 8] = [&BRUSH, &ERASER, &QUERY, &THREATS, &PATH, &DOMAIN, &BOUNDARY, &PAN];

/// One of [`TOOLS`].
pub type Tool = &'static ToolSpec;

/// How often a tool is used before its hint goes away.
const USES_WITH_HINT: u32 = 6;

/// What a tool is called and what it does on the canvas.
pub struct ToolSpec {
    /// Name in menus and on the tool strip.
    pub name: &'static str,
    /// The key that selects it.
    pub key: Key,
    /// Its icon on the tool strip.
    pub icon: Icon,
    /// The cursor over the canvas, where no ring is drawn.
    pub cursor: CursorIcon,
    /// Sections of the side panel that stand first while it is selected.
    pub panels: &'static [&'static Panel],
    /// What to do with it next.
    pub hint: fn(&Tools) -> &'static [Hint<'static>],
    /// Whether the brush ring is drawn around the pointer.
    pub has_ring: fn(&Tools) -> bool,
    /// The brush of its strokes, if it paints.
    pub brush: Option<fn(&Tools) -> Brush>,
    /// Whether the triangle under the pointer is highlighted.
    pub highlights_hovered: bool,
    /// Whether it moves pins, and shows the values of the one under the pointer.
    pub moves_pins: bool,
    /// Whether it needs the pieces of the boundary.
    pub finds_boundary: bool,
    /// Whether it says why the queried triangle is there.
    pub explains: bool,
    /// Draws over the mesh while the tool is selected.
    pub paint: fn(&FrameState<'_>, &OverMesh<'_>),
    /// What happens when the primary button is pressed.
    pub press: BeginGesture,
    /// What happens when the secondary button is pressed. Returns whether anything does: if not, the menu of
    /// the canvas opens.
    pub press_secondary: fn(&Tools, &mut Vec<Command>) -> bool,
    /// Entries of the canvas's menu at a point, in world units.
    pub menu: fn(&FrameState<'_>, DVec2) -> Vec<(&'static str, Command)>,
}

/// Begins a gesture, or acts at once and returns `None`.
pub type BeginGesture = fn(&Press, &Pointer<'_>, &mut Vec<Command>) -> Option<Box<dyn Gesture>>;

/// Where a tool draws over the mesh.
pub struct OverMesh<'a> {
    /// Clipped to the canvas.
    pub painter: &'a Painter,
    /// Screen points from world coordinates.
    pub screen_from_world: &'a dyn Fn(DVec2) -> Pos2,
    /// The pointer in points, while it is over the canvas.
    pub pointer: Option<Pos2>,
}

impl ToolSpec {
    /// A tool that does nothing yet; use it as the base of a struct update.
    pub const fn new(name: &'static str, key: Key, icon: Icon) -> Self {
        Self {
            name,
            key,
            icon,
            cursor: CursorIcon::Crosshair,
            panels: &[],
            hint: |_| &[],
            has_ring: |_| false,
            brush: None,
            highlights_hovered: false,
            moves_pins: false,
            finds_boundary: false,
            explains: false,
            paint: |_, _| {},
            press: |_, _, _| None,
            press_secondary: |_, _| false,
            menu: |_, _| Vec::new(),
        }
    }
}

impl PartialEq for ToolSpec {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for ToolSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// What the brush paints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintKind {
    /// Risk, which the transfer curve turns into a diameter.
    Risk,
    /// The target diameter itself.
    Diameter,
}

/// The selected tool, and the settings of all tools.
#[derive(Clone, Debug, PartialEq)]
pub struct Tools {
    /// The selected tool.
    pub tool: Tool,
    /// What the brush paints.
    pub kind: PaintKind,
    /// How a stroke of the brush changes the paint.
    pub mode: BrushMode,
    /// Radius of brush and eraser in world units.
    pub radius: f64,
    /// Hardness of brush and eraser, 0 to 1.
    pub hardness: f64,
    /// Strength of the brush, 0 to 1.
    pub paint_strength: f64,
    /// Strength of the eraser, 0 to 1.
    pub erase_strength: f64,
    /// The risk that the brush paints in the mode *Set*, 0 to 1.
    pub risk: f64,
    /// The diameter that the brush paints, in world units.
    pub diameter: f64,
    /// How strongly strokes are smoothed, 0 to 1.
    pub smoothing: f64,
    /// Whether strokes are repeated: left and right, above and below.
    pub mirrored: [bool; 2],
    /// The pen, where there is one.
    pub pen: Pen,
    /// Where the last stroke ended, in world units.
    pub last_painted: Option<DVec2>,
    /// The domain tool.
    pub domain: DomainTool,
    /// The boundary tool.
    pub boundary: BoundaryTool,
    /// The threats tool.
    pub threats: ThreatsTool,
    /// The path tool.
    pub path: PathTool,
    /// The middles of the triangles that were followed from neighbour to neighbour, in world units.
    pub trail: Vec<DVec2>,
    /// How often each of [`TOOLS`] was used.
    uses: [u32; TOOLS.len()],
}

impl Tools {
    /// A brush that suits a domain whose longer side is `extent` and whose smallest diameter is `h_min`, in
    /// world units.
    pub fn for_domain(extent: f64, h_min: f64) -> Self {
        Self {
            tool: &BRUSH,
            kind: PaintKind::Risk,
            mode: BrushMode::BuildUp,
            radius: 0.06 * extent,
            hardness: 0.35,
            paint_strength: 0.8,
            erase_strength: 1.0,
            risk: 0.5,
            diameter: 2.0 * h_min,
            smoothing: 0.0,
            mirrored: [false; 2],
            pen: Pen::default(),
            last_painted: None,
            domain: DomainTool::default(),
            boundary: BoundaryTool::default(),
            threats: ThreatsTool::default(),
            path: PathTool::default(),
            trail: Vec::new(),
            uses: [0; TOOLS.len()],
        }
    }

    /// Selects a tool.
    pub fn select(&mut self, tool: Tool) {
        self.tool = tool;
        self.domain.corners.clear();
        self.path.pending = None;
    }

    /// Selects the brush.
    pub fn select_brush(&mut self) {
        self.select(&BRUSH);
    }

    /// Queries a point or none. The trail to the former one ends.
    pub fn query(&mut self, point: Option<DVec2>, session: &mut Session) {
        self.trail.clear();
        session.query(point);
    }

    /// Fits radius and diameter to another domain.
    pub fn fit_to(&mut self, extent: f64, h_min: f64) {
        let fitting = Self::for_domain(extent, h_min);
        (self.radius, self.diameter) = (fitting.radius, fitting.diameter);
        self.boundary.selected = None;
        self.threats = ThreatsTool::default();
        self.path = PathTool::default();
        self.trail.clear();
    }

    /// Whether the selected tool shows the brush ring.
    pub fn has_ring(&self) -> bool {
        (self.tool.has_ring)(self)
    }

    /// Whether the selected tool changes the paint.
    pub fn paints(&self) -> bool {
        self.tool.brush.is_some()
    }

    /// The brush of the selected tool's strokes, if it paints.
    pub fn brush(&self) -> Option<Brush> {
        self.tool.brush.map(|brush| brush(self))
    }

    /// The lines in which strokes are repeated, through the middle of the domain.
    pub fn mirror(&self, bounds: Rect) -> Mirror {
        let [x, y] = self.mirrored;
        let middle = bounds.center();
        Mirror { x: x.then_some(middle.x), y: y.then_some(middle.y) }
    }

    /// A point of a stroke, in world units, with the brush as the pressure of the pen makes it.
    pub fn path_point(&self, at: DVec2) -> PathPoint {
        self.pen.path_point(at)
    }

    /// Strength of the selected tool.
    pub fn strength(&self) -> f64 {
        if self.tool == &ERASER { self.erase_strength } else { self.paint_strength }
    }

    /// Sets the strength of the selected tool.
    pub fn set_strength(&mut self, strength: f64) {
        let own = if self.tool == &ERASER { &mut self.erase_strength } else { &mut self.paint_strength };
        *own = strength.clamp(0.01, 1.0);
    }

    /// Counts a use of a tool.
    pub fn note_use(&mut self, tool: Tool) {
        if let Some(index) = TOOLS.iter().position(|known| *known == tool) {
            self.uses[index] = self.uses[index].saturating_add(1);
        }
    }

    /// The hint for the selected tool; empty after a few uses.
    pub fn hint(&self) -> &'static [Hint<'static>] {
        let index = TOOLS.iter().position(|known| *known == self.tool);
        let known = index.is_some_and(|index| self.uses[index] >= USES_WITH_HINT);
        if known { &[] } else { (self.tool.hint)(self) }
    }
}
