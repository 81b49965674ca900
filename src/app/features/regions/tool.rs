//! The region tool: draws the mask of the selected layer, a keep-out region of paths, or the shapes to which
//! the selected layer measures the distance, with a brush or corner by corner.

use eframe::egui::Key;
use glam::DVec2;

use super::{REGION_OPTIONS, RegionCommand, RegionShape, RegionTarget, marks};
use meshbrush_core::document::DrawnShape;
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_kit::kit::tools::{ToolSettings, Tools, first_settings};
use meshbrush_kit::kit::{
    DraggedShape, DrawingCommands, FrameState, Gesture, Pointer, Press, ToolSpec, UNDER_POINTER, press_brush,
    press_corner, press_shape,
};
use meshbrush_ui::widgets::Hint::{self, Key as HintKey, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Draws regions by hand.
pub static REGION: ToolSpec = ToolSpec {
    place: 5,
    options: &REGION_OPTIONS,
    hint: |state| match state.tools.settings::<RegionTool>().shape() {
        RegionShape::Brush => BRUSH_HINT,
        RegionShape::Rectangle => RECTANGLE_HINT,
        RegionShape::Circle => CIRCLE_HINT,
        RegionShape::Lasso => LASSO_HINT,
        RegionShape::Fill => FILL_HINT,
        RegionShape::Polygon => POLYGON_HINT,
        RegionShape::Line => LINE_HINT,
        RegionShape::Point => POINT_HINT,
    },
    has_ring: |tools| tools.settings::<RegionTool>().shape() == RegionShape::Brush,
    paint: marks::paint,
    press,
    press_secondary,
    menu,
    settings: Some(first_settings::<RegionTool>),
    ..ToolSpec::new("Region", Key::M, Icon::REGION)
};

const BRUSH_HINT: &[Hint] = &[
    Text("Paint the region"),
    KeyOf("cut-from-the-region"),
    Text("add or cut"),
    HintKey("Alt"),
    Text("the opposite"),
    KeyOf("undo"),
    Text("undo"),
];
const RECTANGLE_HINT: &[Hint] = &[
    Text("Drag from corner to corner"),
    HintKey("Shift"),
    Text("square"),
    HintKey("Alt"),
    Text("cuts instead of adding, or the opposite"),
];
const CIRCLE_HINT: &[Hint] = &[
    Text("Drag from the centre to the rim"),
    HintKey("Alt"),
    Text("cuts instead of adding, or the opposite"),
];
const LASSO_HINT: &[Hint] = &[
    Text("Drag around the area: the end joins the beginning"),
    HintKey("Alt"),
    Text("cuts instead of adding, or the opposite"),
];
const FILL_HINT: &[Hint] = &[
    Text("Click in a hole of the region to fill it"),
    HintKey("Alt"),
    Text("click removes the part under the pointer, or the opposite"),
];
const POLYGON_HINT: &[Hint] = &[
    Text("Click each corner; drag one to move it"),
    HintKey("Enter"),
    Text("or a double click closes the polygon"),
    HintKey("Backspace"),
    Text("removes the last corner"),
    HintKey("Esc"),
    Text("all"),
];
const LINE_HINT: &[Hint] = &[
    Text("Click each corner; drag one to move it"),
    HintKey("Enter"),
    Text("or a double click ends the line"),
    HintKey("Backspace"),
    Text("removes the last corner"),
    HintKey("Esc"),
    Text("all"),
];
const POINT_HINT: &[Hint] = &[Text("Click to set points"), KeyOf("undo"), Text("undo")];

/// Settings of the region tool, and its open polygon.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RegionTool {
    /// What it draws on.
    pub target: RegionTarget,
    /// What was chosen to draw with.
    pub chosen_shape: RegionShape,
    /// Whether it cuts away instead of adding.
    pub cuts: bool,
    /// The keep-out region that is drawn on, by its number from 0; `None` for a new one.
    pub keep_out: Option<usize>,
    /// Corners so far of the polygon or the line, in world units.
    pub corners: Vec<DVec2>,
}

impl ToolSettings for RegionTool {
    fn differs_in_choice(&self, other: &Self) -> bool {
        (self.target, self.shape(), self.cuts) != (other.target, other.shape(), other.cuts)
    }
}

impl RegionTool {
    /// What it draws with: lines and points only among shapes, and what cuts is an area.
    pub fn shape(&self) -> RegionShape {
        match self.chosen_shape {
            RegionShape::Line | RegionShape::Point if !self.has_lines_and_points() => RegionShape::Polygon,
            shape => shape,
        }
    }

    /// Returns whether lines and points can be drawn, and not only areas.
    pub fn has_lines_and_points(&self) -> bool {
        self.target == RegionTarget::Shapes && !self.cuts
    }
}

static COMMANDS: DrawingCommands = DrawingCommands {
    draw: |area, adds| Command::from(RegionCommand::Draw(DrawnShape::Area(area), adds)),
    drawn: |command| match command.get_mut() {
        Some(RegionCommand::Draw(DrawnShape::Area(area), _)) => Some(area),
        _ => None,
    },
    draw_line: None,
    add_corner: |corner| Command::from(RegionCommand::AddCorner(corner)),
    move_corner: |index, corner| Command::from(RegionCommand::MoveCorner(index, corner)),
    close: || Command::from(RegionCommand::Close),
    end: || Command::from(RegionCommand::Close),
    place: UNDER_POINTER,
};

/// Alt swaps adding and cutting.
fn press(press: &Press, pointer: &Pointer<'_>, commands: &mut Vec<Command>) -> Option<Box<dyn Gesture>> {
    let tool = pointer.tools.settings::<RegionTool>();
    let adds = tool.cuts == press.modifiers.alt;
    match tool.shape() {
        RegionShape::Brush => Some(press_brush(&COMMANDS, press, pointer, adds, commands)),
        RegionShape::Rectangle => Some(press_shape(&COMMANDS, DraggedShape::Rectangle, press, adds)),
        RegionShape::Circle => Some(press_shape(&COMMANDS, DraggedShape::Circle, press, adds)),
        RegionShape::Lasso => Some(press_shape(&COMMANDS, DraggedShape::Lasso, press, adds)),
        RegionShape::Fill => {
            commands.push(Command::from(RegionCommand::Fill(pointer.world(press.at), adds)));
            None
        }
        RegionShape::Polygon | RegionShape::Line => {
            Some(press_corner(&COMMANDS, press, pointer, &tool.corners, commands))
        }
        RegionShape::Point => {
            let point = DrawnShape::Point(pointer.world(press.at));
            commands.push(Command::from(RegionCommand::Draw(point, true)));
            commands.push(Command::from(EditCommand::EndGesture));
            None
        }
    }
}

/// The secondary button closes the polygon, or ends the line.
fn press_secondary(tools: &Tools, commands: &mut Vec<Command>) -> bool {
    COMMANDS.end_if_begun(&tools.settings::<RegionTool>().corners, commands)
}

fn menu(state: &FrameState<'_>, point: DVec2) -> Vec<(&'static str, Command)> {
    let tool = state.tools.settings::<RegionTool>();
    let swap = if tool.cuts { "Add to the region" } else { "Cut from the region" };
    let mut entries = vec![(swap, Command::from(RegionCommand::Cuts(!tool.cuts)))];
    let begin = match tool.shape() {
        RegionShape::Polygon => "Begin a polygon here",
        RegionShape::Line => "Begin a line here",
        _ => return entries,
    };
    entries.push((begin, Command::from(RegionCommand::AddCorner(point))));
    entries
}
