//! The corners of the background picture, to be dragged on the canvas.

use eframe::egui::{Color32, CursorIcon, Pos2, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2};
use glam::DVec2;

use meshbrush_core::document::{Background, Setting};
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_kit::kit::marks::point_from_px;
use meshbrush_mesh::geometry::Rect as WorldRect;
use meshbrush_render::scene::Camera;

/// Names of the handles for tests and screen readers: the corner with the lowest coordinates first.
pub const NAMES: [&str; 2] = ["Lower left corner of the picture", "Upper right corner of the picture"];
/// Side of a handle, in points.
const HANDLE: f32 = 14.0;

/// Shows a handle at each of two opposite corners, while they are switched on. Returns their places.
pub fn show(
    ui: &Ui,
    rect: Rect,
    state: &FrameState<'_>,
    camera: &Camera,
    commands: &mut Vec<Command>,
) -> Vec<Rect> {
    let background = state.session.document().settings().background.as_ref();
    let Some(background) = background.filter(|_| state.view.aids.picture_corners) else { return Vec::new() };
    let WorldRect { min, max } = background.bounds;
    let corners = [min, max];
    let px_per_point = ui.pixels_per_point();
    let on_screen = |world| point_from_px(rect, camera.screen_from_world(world), px_per_point);
    let frame = Rect::from_two_pos(on_screen(min), on_screen(max));
    let painter = ui.painter_at(rect);
    painter.rect_stroke(frame, 0.0, Stroke::new(3.0, Color32::from_black_alpha(120)), StrokeKind::Middle);
    painter.rect_stroke(frame, 0.0, Stroke::new(1.0, Color32::WHITE), StrokeKind::Middle);
    let in_view = (0..2).filter(|&i| rect.contains(on_screen(corners[i])));
    let in_view: Vec<usize> = in_view.collect();
    let handles = in_view.into_iter().map(|i| {
        let place = Rect::from_center_size(on_screen(corners[i]), vec2(HANDLE, HANDLE));
        if let Some(to) = drag(ui, place, NAMES[i], commands) {
            let px =
                f64::from(px_per_point) * DVec2::new((to.x - rect.min.x).into(), (to.y - rect.min.y).into());
            move_corner(background, corners[1 - i], camera.world_from_screen(px), commands);
        }
        place
    });
    handles.collect()
}

/// Returns a handle. Returns where it is dragged to; the end of the drag ends the gesture.
fn drag(ui: &Ui, place: Rect, name: &str, commands: &mut Vec<Command>) -> Option<Pos2> {
    let response = ui.interact(place, ui.scope_id().with(name), Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let response = response.on_hover_cursor(CursorIcon::Grab);
    let fill = if response.hovered() || response.dragged() { Color32::WHITE } else { Color32::LIGHT_GRAY };
    let shown = place.shrink(2.0);
    ui.painter().rect(
        shown,
        2.0,
        fill,
        Stroke::new(2.0, Color32::from_black_alpha(190)),
        StrokeKind::Outside,
    );
    if response.drag_stopped() {
        commands.push(Command::from(EditCommand::EndGesture));
    }
    response.interact_pointer_pos().filter(|_| response.dragged())
}

/// Moves a corner to `to`; the opposite one stays. A picture without area is refused.
fn move_corner(background: &Background, opposite: DVec2, to: DVec2, commands: &mut Vec<Command>) {
    let bounds = WorldRect::spanning(opposite, to);
    if bounds.is_proper() && bounds != background.bounds {
        commands.push(Command::from(EditCommand::Set(Setting::Background(Some(Background {
            bounds,
            ..background.clone()
        })))));
    }
}
