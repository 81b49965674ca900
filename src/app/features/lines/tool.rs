//! The line tool: draws lines corner by corner or in one drag, and moves the corners of lines.

use eframe::egui::{Key, Pos2};
use glam::DVec2;

use super::corners::press_to_edit;
use super::snap::place_of;
use super::{LINE_OPTIONS, LineEnd, LineToolMode, LinesCommand, drawing_marks};
use meshbrush_core::domain::{CutShape, Line};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::tools::{ToolSettings, Tools, first_settings};
use meshbrush_kit::kit::{
    DraggedShape, DrawingCommands, FrameState, Gesture, Pointer, Press, Tab, ToolSpec, press_corner,
    press_shape,
};
use meshbrush_ui::widgets::Hint::{self, Key as HintKey, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Draws lines along which the mesh has edges.
pub static LINE: ToolSpec = ToolSpec {
    place: 7,
    tab: Some(Tab::Domain),
    options: &LINE_OPTIONS,
    hint: |state| match state.tools.settings::<LineTool>().mode {
        LineToolMode::Corners => CORNERS_HINT,
        LineToolMode::FreeHand => FREE_HAND_HINT,
        LineToolMode::Rectangle => RECTANGLE_HINT,
        LineToolMode::Circle => CIRCLE_HINT,
        LineToolMode::DeepestWay if state.tools.settings::<LineTool>().way_from.is_some() => WAY_END_HINT,
        LineToolMode::DeepestWay => WAY_HINT,
        LineToolMode::Edit => EDIT_HINT,
    },
    paint: drawing_marks::paint,
    press,
    press_secondary,
    menu,
    settings: Some(first_settings::<LineTool>),
    ..ToolSpec::new("Line", Key::W, Icon::LINE)
};

const CORNERS_HINT: &[Hint] = &[
    Text("Click each corner; the first one closes the line"),
    HintKey("Enter"),
    Text("or a double click ends it"),
    HintKey("Backspace"),
    Text("removes the last corner"),
    HintKey("Alt"),
    Text("no snapping, or the opposite"),
];
const FREE_HAND_HINT: &[Hint] =
    &[Text("Drag along the line"), HintKey("Alt"), Text("ends do not snap, or the opposite")];
const RECTANGLE_HINT: &[Hint] = &[Text("Drag from corner to corner"), HintKey("Shift"), Text("square")];
const CIRCLE_HINT: &[Hint] = &[Text("Drag from the centre to the rim")];
const WAY_HINT: &[Hint] = &[Text("Click the two ends of the way: it follows the deepest water between them")];
const WAY_END_HINT: &[Hint] = &[Text("Click the other end of the way"), HintKey("Esc"), Text("no way")];
const EDIT_HINT: &[Hint] = &[
    Text("Click a line; drag its corners, or drag elsewhere on it for another corner"),
    KeyOf("delete-the-selected-line"),
    Text("deletes the corner"),
];

/// Settings of the line tool, the line that is being drawn, and what is selected.
#[derive(Clone, Debug, PartialEq)]
pub struct LineTool {
    /// What a press does.
    pub mode: LineToolMode,
    /// Whether corners snap to what is near.
    pub snaps: bool,
    /// Corners so far of the line that is being drawn, in world units.
    pub corners: Vec<DVec2>,
    /// The first end of the deepest way, while the other one is to be set.
    pub way_from: Option<DVec2>,
    /// The number of the selected line. An undo can have removed it.
    pub selected: Option<usize>,
    /// The corner of the selected line that was taken hold of last.
    pub corner: Option<usize>,
    /// The place not on edges that was shown last, by its number along the selected line.
    pub shown_place: Option<usize>,
}

impl Default for LineTool {
    fn default() -> Self {
        Self {
            mode: LineToolMode::default(),
            snaps: true,
            corners: Vec::new(),
            way_from: None,
            selected: None,
            corner: None,
            shown_place: None,
        }
    }
}

impl ToolSettings for LineTool {
    fn differs_in_choice(&self, other: &Self) -> bool {
        (self.mode, self.snaps) != (other.mode, other.snaps)
    }
}

impl LineTool {
    /// Returns the number of the selected line among the lines of the document.
    pub fn selected_in(&self, lines: &[Line]) -> Option<usize> {
        self.selected.filter(|&number| number < lines.len())
    }

    /// Returns the numbers of the selected line and of its corner that was taken hold of last.
    pub fn corner_in(&self, lines: &[Line]) -> Option<(usize, usize)> {
        let number = self.selected_in(lines)?;
        let corner = self.corner.filter(|&corner| corner < lines[number].points.len())?;
        (self.mode == LineToolMode::Edit).then_some((number, corner))
    }

    /// Selects a line, or none.
    pub fn select(&mut self, number: Option<usize>) {
        (self.selected, self.corner, self.shown_place) = (number, None, None);
    }
}

static COMMANDS: DrawingCommands = DrawingCommands {
    draw: |shape, _| {
        let (CutShape::Ring(points) | CutShape::Stroke { path: points, .. }) = shape;
        Command::from(LinesCommand::Draw(points, LineEnd::Closed))
    },
    drawn: |_| None,
    draw_line: Some(|points| Command::from(LinesCommand::Draw(points, LineEnd::Open))),
    add_corner: |corner| Command::from(LinesCommand::AddCorner(corner)),
    move_corner: |index, corner| Command::from(LinesCommand::MoveCorner(index, corner)),
    close: || Command::from(LinesCommand::End(LineEnd::Closed)),
    end: || Command::from(LinesCommand::End(LineEnd::Open)),
    place,
};

fn place(pointer: &Pointer<'_>, at: Pos2) -> DVec2 {
    place_of(pointer, at, None)
}

fn press(press: &Press, pointer: &Pointer<'_>, commands: &mut Vec<Command>) -> Option<Box<dyn Gesture>> {
    let tool = pointer.tools.settings::<LineTool>();
    match tool.mode {
        LineToolMode::Corners => Some(press_corner(&COMMANDS, press, pointer, &tool.corners, commands)),
        LineToolMode::FreeHand => Some(press_shape(&COMMANDS, DraggedShape::Trail, press, true)),
        LineToolMode::Rectangle => Some(press_shape(&COMMANDS, DraggedShape::Rectangle, press, true)),
        LineToolMode::Circle => Some(press_shape(&COMMANDS, DraggedShape::Circle, press, true)),
        LineToolMode::DeepestWay => {
            commands.push(Command::from(LinesCommand::WayAt(place(pointer, press.at))));
            None
        }
        LineToolMode::Edit => press_to_edit(press, pointer, commands),
    }
}

/// The secondary button ends the line.
fn press_secondary(tools: &Tools, commands: &mut Vec<Command>) -> bool {
    COMMANDS.end_if_begun(&tools.settings::<LineTool>().corners, commands)
}

fn menu(state: &FrameState<'_>, point: DVec2) -> Vec<(&'static str, Command)> {
    let tool = state.tools.settings::<LineTool>();
    let lines = &state.session.document().settings().lines;
    let begin = ("Begin a line here", Command::from(LinesCommand::AddCorner(point)));
    let delete = match (tool.corner_in(lines), tool.selected_in(lines)) {
        (Some(_), _) => Some("Delete the corner"),
        (None, Some(_)) => Some("Delete the selected line"),
        (None, None) => None,
    };
    let delete = delete.map(|title| (title, Command::from(LinesCommand::Delete)));
    let begin = (tool.mode == LineToolMode::Corners).then_some(begin);
    [begin, delete].into_iter().flatten().collect()
}
