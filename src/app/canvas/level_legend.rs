//! The levels of the mesh on the canvas: colours, diameters and counts. A click shows a level alone.

use eframe::egui::{
    Align2, Color32, CornerRadius, PointerButton, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2,
};

use super::legend::{MARGIN, ROW, TITLE, boxed, place_of};
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_render::render::furniture::{LevelLegend, LevelRow};
use meshbrush_ui::theme::{font, tokens};

/// Least width of the rows, in points: beside a square domain there is room for them.
const WIDTH: f32 = 134.0;
/// Width of a swatch, in points.
const SWATCH: f32 = 10.0;
/// Most of the canvas that the legend takes, as shares of its width and of its height.
const MOST: [f32; 2] = [0.25, 0.55];
/// Columns at whose right ends the level and the diameter are, in points from the left.
const COLUMNS: [f32; 2] = [SWATCH + 17.0, SWATCH + 66.0];

/// Shows the levels of a mesh with these `counts` of triangles in the upper right corner of `inner`. Returns
/// the place of the box, and the level under the pointer or with the focus; `None` where there is no room,
/// where the box would cover something of `uncovered`, or where there is no mesh yet.
pub fn show(
    ui: &Ui,
    inner: Rect,
    uncovered: Option<Rect>,
    counts: &[usize],
    state: &FrameState<'_>,
    commands: &mut Vec<Command>,
) -> Option<(Rect, Option<u32>)> {
    let mesh = state.session.mesh();
    let LevelLegend { title, rows } = LevelLegend::new(counts, |level| mesh.diameter(level), state.unit());
    let height = ROW * rows.len() as f32;
    let title_width = ui.painter().layout_no_wrap(title.clone(), font::caption(), Color32::WHITE).size().x;
    let width = title_width.ceil().max(WIDTH);
    let place = place_of(inner, vec2(width, height));
    let has_room = width <= MOST[0] * inner.width()
        && TITLE + height <= MOST[1] * inner.height()
        && !uncovered.is_some_and(|mesh| mesh.intersects(place));
    if rows.is_empty() || state.session.awaits_mesh() || !has_room {
        return None;
    }
    let within = boxed(ui, inner, vec2(width, height), &title, "Legend: levels of the mesh");
    let colors = state.view.level_colors(state.session.follower().settings());
    let mut hovered = None;
    for (row, LevelRow { level, texts }) in rows.into_iter().enumerate() {
        let place = Rect::from_min_size(within.min + vec2(0.0, ROW * row as f32), vec2(within.width(), ROW));
        let response = ui.interact(place, ui.scope_id().with(("level on the canvas", level)), Sense::click());
        let name = format!("Show level {level} alone");
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        if response.hovered() || response.has_focus() {
            hovered = Some(level);
        }
        if response.clicked() {
            // Keys belong to the canvas after a click.
            if response.clicked_by(PointerButton::Primary) {
                response.surrender_focus();
            }
            commands.push(Command::from(ViewCommand::IsolateLevel(level)));
        }
        let [r, g, b, _] = colors.of(level as u8);
        let is_shown = state.view.hidden_levels >> level.min(63) & 1 == 0;
        paint_row(ui, place, Color32::from_rgb(r, g, b), texts, [is_shown, hovered == Some(level)]);
        response.on_hover_text_at_pointer(if is_shown && state.view.hidden_levels != 0 {
            "A click shows all levels."
        } else {
            "A click shows this level alone."
        });
    }
    Some((within.expand2(MARGIN), hovered))
}

fn paint_row(ui: &Ui, place: Rect, color: Color32, texts: [String; 3], [is_shown, is_lit]: [bool; 2]) {
    let t = tokens(ui);
    if is_lit {
        ui.painter().rect_filled(place.expand2(vec2(4.0, 0.0)), 3.0, t.field);
    }
    let opacity = if is_shown { 1.0 } else { 0.25 };
    let swatch = Rect::from_min_size(place.min, vec2(SWATCH, place.height()));
    ui.painter().rect_filled(swatch, CornerRadius::ZERO, color.gamma_multiply(opacity));
    let ends = [place.left() + COLUMNS[0], place.left() + COLUMNS[1], place.right()];
    for ((end, text), ink) in ends.into_iter().zip(texts).zip([t.label, t.value, t.label]) {
        let at = pos2(end, place.center().y);
        ui.painter().text(at, Align2::RIGHT_CENTER, text, font::axis(), ink.gamma_multiply(opacity));
    }
}
