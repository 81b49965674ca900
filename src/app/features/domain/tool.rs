//! The domain tool: cuts the domain with a brush or with shapes, or sets its bounds.

use eframe::egui::{Key, Painter, Pos2, Rect};
use glam::DVec2;

use super::{DOMAIN_OPTIONS, DomainCommand};
use meshbrush_core::document::DrawnPart;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::tools::{ToolSettings, Tools, first_settings};
use meshbrush_kit::kit::{
    CLICK_SLACK, DraggedShape, DrawingCommands, FrameState, Gesture, OverMesh, Pointer, Press, Tab, ToolSpec,
    UNDER_POINTER, marks, press_brush, press_corner, press_shape,
};
use meshbrush_mesh::geometry::Rect as WorldRect;
use meshbrush_ui::widgets::Hint::{self, Key as HintKey, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Edits the domain.
pub static DOMAIN: ToolSpec = ToolSpec {
    place: 6,
    tab: Some(Tab::Domain),
    options: &DOMAIN_OPTIONS,
    hint,
    has_ring: |tools| tools.settings::<DomainTool>().mode == DomainToolMode::Brush,
    paint,
    press,
    press_secondary,
    menu,
    settings: Some(first_settings::<DomainTool>),
    ..ToolSpec::new("Domain", Key::D, Icon::DOMAIN)
};

/// Returns what to do next with the shape that cuts.
fn hint(state: &FrameState<'_>) -> &'static [Hint<'static>] {
    match state.tools.settings::<DomainTool>().mode {
        DomainToolMode::Brush | DomainToolMode::Rectangle => HINT,
        DomainToolMode::Circle | DomainToolMode::Lasso => HINT,
        DomainToolMode::Fill => FILL_HINT,
        DomainToolMode::Polygon => POLYGON_HINT,
        DomainToolMode::Frame => FRAME_HINT,
    }
}

const POLYGON_HINT: &[Hint] = &[
    Text("Click each corner; drag one to move it"),
    HintKey("Enter"),
    Text("or a double click closes the polygon"),
    HintKey("Backspace"),
    Text("removes the last corner"),
    HintKey("Esc"),
    Text("all"),
];
const FILL_HINT: &[Hint] = &[
    Text("Click land within the outline to add it, or a part of the domain to remove it"),
    KeyOf("add-to-the-domain"),
    Text("add or remove"),
    HintKey("Alt"),
    Text("the opposite"),
];
const FRAME_HINT: &[Hint] =
    &[Text("Drag a rectangle: the coarse grid covers it, and cuts polygons off at its sides")];
const HINT: &[Hint] = &[
    Text("Drag to cut the domain"),
    KeyOf("add-to-the-domain"),
    Text("add or remove"),
    HintKey("Alt"),
    Text("the opposite"),
    KeyOf("undo"),
    Text("undo"),
];

/// The shape that the domain tool cuts with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DomainToolMode {
    /// The brush ring.
    #[default]
    Brush,
    /// A rectangle from corner to corner.
    Rectangle,
    /// A circle from its centre.
    Circle,
    /// An outline by free hand.
    Lasso,
    /// The hole, or the part of the domain, under the pointer.
    Fill,
    /// A polygon, corner by corner.
    Polygon,
    /// The rectangle that the coarse grid covers: nothing is cut.
    Frame,
}

/// Settings of the domain tool, and its open polygon.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DomainTool {
    /// The shape that the tool cuts with.
    pub mode: DomainToolMode,
    /// Whether it adds to the domain instead of removing from it.
    pub adds: bool,
    /// Corners so far of the polygon to cut with, in world units.
    pub corners: Vec<DVec2>,
}

impl ToolSettings for DomainTool {
    fn differs_in_choice(&self, other: &Self) -> bool {
        (self.mode, self.adds) != (other.mode, other.adds)
    }
}

/// Alt swaps adding and removing.
fn press(press: &Press, pointer: &Pointer<'_>, commands: &mut Vec<Command>) -> Option<Box<dyn Gesture>> {
    let tool = pointer.tools.settings::<DomainTool>();
    let adds = tool.adds != press.modifiers.alt;
    Some(match tool.mode {
        DomainToolMode::Brush => press_brush(&COMMANDS, press, pointer, adds, commands),
        DomainToolMode::Rectangle => press_shape(&COMMANDS, DraggedShape::Rectangle, press, adds),
        DomainToolMode::Circle => press_shape(&COMMANDS, DraggedShape::Circle, press, adds),
        DomainToolMode::Lasso => press_shape(&COMMANDS, DraggedShape::Lasso, press, adds),
        DomainToolMode::Fill => {
            commands.push(Command::from(DomainCommand::Fill(pointer.world(press.at), adds)));
            return None;
        }
        DomainToolMode::Frame => Box::new(Framing { from: press.at, to: press.at }),
        DomainToolMode::Polygon => press_corner(&COMMANDS, press, pointer, &tool.corners, commands),
    })
}

/// The commands of the strokes and the polygon that cut the domain.
static COMMANDS: DrawingCommands = DrawingCommands {
    draw: |cut_shape, adds| Command::from(DomainCommand::Reshape(cut_shape, adds)),
    drawn: |command| match command.get_mut() {
        Some(DomainCommand::Reshape(cut_shape, _)) => Some(cut_shape),
        _ => None,
    },
    draw_line: None,
    add_corner: |corner| Command::from(DomainCommand::AddCorner(corner)),
    move_corner: |index, corner| Command::from(DomainCommand::MoveCorner(index, corner)),
    close: || Command::from(DomainCommand::ClosePolygon),
    end: || Command::from(DomainCommand::ClosePolygon),
    place: UNDER_POINTER,
};

/// The secondary button closes the polygon.
fn press_secondary(tools: &Tools, commands: &mut Vec<Command>) -> bool {
    COMMANDS.end_if_begun(&tools.settings::<DomainTool>().corners, commands)
}

fn menu(state: &FrameState<'_>, point: DVec2) -> Vec<(&'static str, Command)> {
    let tool = state.tools.settings::<DomainTool>();
    let swap = if tool.adds { "Remove from the domain" } else { "Add to the domain" };
    let mut entries = vec![(swap, Command::from(DomainCommand::Adds(!tool.adds)))];
    if tool.mode == DomainToolMode::Polygon {
        entries.push(("Begin a polygon here", Command::from(DomainCommand::AddCorner(point))));
    }
    entries
}

/// Drawing the bounds of the domain.
#[derive(Debug)]
struct Framing {
    /// The point where the pointer went down, in points.
    from: Pos2,
    /// The position of the pointer, in points.
    to: Pos2,
}

impl Gesture for Framing {
    fn moved(&mut self, at: Pos2, _pointer: &Pointer<'_>, _commands: &mut Vec<Command>) {
        self.to = at;
    }

    fn released(&self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        if (at.x - self.from.x).abs().min((at.y - self.from.y).abs()) <= CLICK_SLACK {
            return;
        }
        let rect = WorldRect::spanning(pointer.rounded_world(self.from), pointer.rounded_world(at));
        commands.push(Command::from(DomainCommand::Bounds(rect)));
    }

    fn ends_on_escape(&self) -> bool {
        true
    }

    fn paint(&self, painter: &Painter) {
        marks::paint_frame(painter, Rect::from_two_pos(self.from, self.to));
    }
}

/// Draws the outline of the domain, cuts that are not made yet, and the open polygon.
fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let at = over.screen_from_world;
    if let Some(region) = state.session.document().settings().domain.region() {
        for ring in region.rings() {
            marks::paint_outline(over.painter, ring.iter().map(|&corner| at(corner)));
        }
    }
    for cut_shape in state.session.pending_cuts(|part| part == DrawnPart::Domain) {
        marks::paint_cut_shape(over.painter, cut_shape, at);
    }
    let corners: Vec<Pos2> =
        state.tools.settings::<DomainTool>().corners.iter().map(|&corner| at(corner)).collect();
    marks::paint_open_polygon(over.painter, &corners, over.pointer);
}
