//! The boundary tool: shows the pieces of the boundary with their names, selects one, and splits pieces.

use eframe::egui::{Align2, Color32, CursorIcon, Key, Painter, Pos2, Rect, vec2};
use glam::DVec2;

use super::{BOUNDARY_OPTIONS, BoundaryCommand};
use meshbrush_core::domain::{BoundaryPiece, BoundaryPieces};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::tools::{ToolSettings, first_settings};
use meshbrush_kit::kit::{FrameState, OverMesh, Tab, ToolSpec, marks};
use meshbrush_ui::theme::font;
use meshbrush_ui::widgets::Hint::{self, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Names and splits pieces of the boundary.
pub static BOUNDARY: ToolSpec = ToolSpec {
    place: 8,
    cursor: CursorIcon::PointingHand,
    tab: Some(Tab::Domain),
    options: &BOUNDARY_OPTIONS,
    hint: |_| HINT,
    paint,
    press: |press, pointer, commands| {
        let reach = REACH_POINTS * pointer.px_per_point / pointer.camera.px_per_world();
        commands.push(Command::from(BoundaryCommand::Click(pointer.world(press.at), reach)));
        None
    },
    menu: |state, point| {
        let reach = REACH_POINTS * state.view.world_per_px();
        let click = Command::from(BoundaryCommand::Click(point, reach));
        match state.tools.settings::<BoundaryTool>().mode {
            BoundaryToolMode::Select => vec![("Select the piece here", click)],
            BoundaryToolMode::Split => vec![("Split the boundary here", click)],
        }
    },
    settings: Some(first_settings::<BoundaryTool>),
    ..ToolSpec::new("Boundary", Key::N, Icon::BOUNDARY)
};

const HINT: &[Hint] = &[
    Text("Click a piece of the boundary to name it"),
    KeyOf("select-or-split"),
    Text("select or split"),
    KeyOf("undo"),
    Text("undo"),
];

/// How far from a piece a click still meets it, in points.
const REACH_POINTS: f64 = 10.0;
/// Points along the boundary that a name needs, but for that of the selected piece and the hovered one.
const LENGTH_OF_NAME: f32 = 50.0;
/// Width of a piece in points, and of the selected and the hovered one.
const WIDTH: f32 = 2.5;
const WIDE: f32 = 5.0;

/// The depth beyond which the boundary is opened unless a person chooses another, in metres: about that of
/// the edge of a shelf sea.
const DEFAULT_LEVEL: f64 = 50.0;

/// The effect of a click.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoundaryToolMode {
    /// It selects a piece.
    #[default]
    Select,
    /// It splits a piece there.
    Split,
}

/// Settings of the boundary tool.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryTool {
    /// The effect of a click.
    pub mode: BoundaryToolMode,
    /// A point of the selected piece in world units: numbers of pieces change.
    pub selected: Option<DVec2>,
    /// The depth beyond which the boundary is opened, in metres.
    pub level: f64,
}

impl ToolSettings for BoundaryTool {
    fn differs_in_choice(&self, other: &Self) -> bool {
        self.mode != other.mode
    }
}

impl Default for BoundaryTool {
    fn default() -> Self {
        Self { mode: BoundaryToolMode::default(), selected: None, level: DEFAULT_LEVEL }
    }
}

impl BoundaryTool {
    /// Returns the number of the selected piece.
    pub fn selected_of(&self, pieces: &BoundaryPieces) -> Option<usize> {
        Some(pieces.nearest(self.selected?, pieces.tolerance())?.0)
    }
}

/// Colours that can be told apart on any mesh, by people who confuse red and green too (Okabe and Ito's).
const COLORS: [Color32; 7] = [
    Color32::from_rgb(86, 180, 233),
    Color32::from_rgb(230, 159, 0),
    Color32::from_rgb(0, 190, 145),
    Color32::from_rgb(240, 228, 66),
    Color32::from_rgb(213, 94, 0),
    Color32::from_rgb(204, 121, 167),
    Color32::from_rgb(60, 140, 240),
];

/// Returns the colour of a piece, by its number.
fn piece_color(piece: usize) -> Color32 {
    COLORS[piece % COLORS.len()]
}

/// Draws the pieces, places of splits, and names where there is room.
fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let Some(pieces) = state.session.boundary_pieces() else { return };
    let reach = REACH_POINTS * f64::from(over.painter.pixels_per_point()) * state.view.world_per_px();
    let hovered = state.pointer.and_then(|at| pieces.nearest(at, reach)).map(|(piece, _)| piece);
    let selected = state.tools.settings::<BoundaryTool>().selected_of(pieces);
    let mut lengths = Vec::new();
    for (number, piece) in pieces.list().iter().enumerate() {
        let stands_out = Some(number) == hovered || Some(number) == selected;
        let width = if stands_out { WIDE } else { WIDTH };
        let points = piece.points.iter().map(|&point| (over.screen_from_world)(point));
        let length = marks::paint_line(over.painter, points, piece_color(number), width);
        if stands_out || length >= LENGTH_OF_NAME {
            lengths.push((stands_out, length, number));
        }
    }
    for split in &state.session.document().settings().boundary_marks.splits {
        marks::paint_point(over.painter, (over.screen_from_world)(*split));
    }
    // Names of long pieces first; those in the way are left out.
    lengths.sort_by(|a, b| (b.0, b.1).partial_cmp(&(a.0, a.1)).expect("lengths are numbers"));
    let mut taken = Vec::new();
    for (stands_out, _, number) in lengths {
        paint_name(over, &pieces.list()[number], piece_color(number), stands_out, &mut taken);
    }
}

/// The name of a piece beside its middle, unless it would cover another one.
fn paint_name(
    over: &OverMesh<'_>,
    piece: &BoundaryPiece,
    color: Color32,
    stands_out: bool,
    taken: &mut Vec<Rect>,
) {
    let view = over.painter.clip_rect();
    let at = (over.screen_from_world)(piece.middle());
    if !view.contains(at) {
        return;
    }
    let text = over.painter.layout_no_wrap(piece.name.clone(), font::body(), Color32::WHITE);
    let size = text.size() + vec2(22.0, 6.0);
    let room = view.shrink(4.0);
    let low = (room.max - size).max(room.min);
    let corner = (at + vec2(8.0, 6.0)).clamp(room.min, low);
    let place = Rect::from_min_size(corner, size);
    if !stands_out && taken.iter().any(|other: &Rect| other.intersects(place)) {
        return;
    }
    taken.push(place.expand(3.0));
    paint_tag(over.painter, place, &piece.name, color);
}

fn paint_tag(painter: &Painter, place: Rect, name: &str, color: Color32) {
    painter.rect_filled(place, 4.0, Color32::from_black_alpha(200));
    painter.circle_filled(Pos2::new(place.left() + 9.0, place.center().y), 4.0, color);
    let at = Pos2::new(place.left() + 17.0, place.center().y);
    painter.text(at, Align2::LEFT_CENTER, name, font::body(), Color32::WHITE);
}
