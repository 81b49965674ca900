//! Moving the view by the wheel, and by the arrow keys while the canvas has the focus.

use eframe::egui::{
    Context, Event, EventFilter, Id, Key, MultiTouchInfo, Pos2, Rect, Response, Stroke, StrokeKind, Ui, Vec2,
};
use glam::{DVec2, dvec2};

use meshbrush_kit::kit::Pointer;
use meshbrush_kit::kit::command::{Command, SpaceCommand, ViewCommand};
use meshbrush_kit::kit::view::View;
use meshbrush_mesh::geometry::Lattice;
use meshbrush_ui::theme::tokens;

/// Share by which one point of scrolling zooms; a notch of a wheel scrolls by about 50 points.
const ZOOM_PER_POINT: f64 = 0.004;
/// Points that an arrow key moves the view; with Shift an eighth of it.
const STEP_POINTS: f64 = 64.0;
/// Free space around the domain when it is fitted, in points.
const FIT_MARGIN: f32 = 24.0;
/// Additional space below it, where hints are, in points.
const HINT_HEIGHT: f32 = 32.0;

/// Zooms about the pointer by the wheel or by pinching.
pub fn zoom(ctx: &Context, pointer: &mut Pointer<'_>, commands: &mut Vec<Command>) {
    let (scrolled, pinched, at) = ctx.input(|input| {
        let scrolled = f64::from(input.smooth_scroll_delta().y);
        (scrolled, f64::from(input.zoom_delta()), input.pointer.hover_pos())
    });
    let factor = pinched * (scrolled * ZOOM_PER_POINT).exp();
    if let Some(at) = at
        && factor != 1.0
    {
        zoom_about(at, factor, pointer, commands);
    }
}

/// Zooms about a place in points.
fn zoom_about(at: Pos2, factor: f64, pointer: &mut Pointer<'_>, commands: &mut Vec<Command>) {
    let px = pointer.px(at);
    if let Some(space) = &mut pointer.space {
        // About the point of the surface there.
        if let Some(height) = space.height_at_px(px) {
            space.camera = space.camera.about(height);
            commands.push(Command::from(ViewCommand::Space(SpaceCommand::About(height))));
        }
        space.camera = space.camera.zoomed(factor, px);
    }
    pointer.camera = pointer.camera.zoomed(factor, px);
    commands.push(Command::from(ViewCommand::ZoomAt(factor, px)));
}

/// Moves and zooms the view with two fingers or more on the canvas: what is under them stays there.
pub fn by_fingers(fingers: &MultiTouchInfo, pointer: &mut Pointer<'_>, commands: &mut Vec<Command>) {
    if !pointer.rect.contains(fingers.center_pos) {
        return;
    }
    let moved = fingers.translation_delta;
    if moved != Vec2::ZERO {
        let px = dvec2(moved.x.into(), moved.y.into()) * pointer.px_per_point;
        commands.push(Command::from(ViewCommand::Pan(px)));
    }
    if fingers.zoom_delta != 1.0 {
        zoom_about(fingers.center_pos, fingers.zoom_delta.into(), pointer, commands);
    }
}

/// Returns the movement of the picture, in pixels, that arrow keys ask for in this frame.
pub fn movement(ctx: &Context, canvas: Id) -> Option<DVec2> {
    if !ctx.memory(|memory| memory.has_focus(canvas)) {
        return None;
    }
    let step = STEP_POINTS * f64::from(ctx.pixels_per_point());
    let moves = ctx.input(|input| input.events.iter().filter_map(direction).sum::<DVec2>());
    (moves != DVec2::ZERO).then(|| -step * moves)
}

/// Returns the direction in which a key moves the view, in steps to the right and down.
fn direction(event: &Event) -> Option<DVec2> {
    let Event::Key { key, pressed: true, modifiers, .. } = event else { return None };
    let size = if modifiers.shift { 0.125 } else { 1.0 };
    let direction = match key {
        Key::ArrowLeft => dvec2(-1.0, 0.0),
        Key::ArrowRight => dvec2(1.0, 0.0),
        Key::ArrowUp => dvec2(0.0, -1.0),
        Key::ArrowDown => dvec2(0.0, 1.0),
        _ => return None,
    };
    (!modifiers.command && !modifiers.alt).then_some(size * direction)
}

/// Keeps the arrow keys for the canvas, and shows that it has the focus.
pub fn show_focus(ui: &Ui, response: &Response) {
    if response.has_focus() {
        let arrows = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
        let edge = Stroke::new(1.5, tokens(ui).accent);
        ui.painter().rect_stroke(response.rect.shrink(1.0), 2, edge, StrokeKind::Inside);
    }
}

/// Fits the view's camera to a canvas of the given rectangle in points.
pub fn fit_camera(view: &mut View, lattice: &Lattice, rect: Rect, px_per_point: f32) {
    let size = (rect.size() * px_per_point).round();
    let [margin, below] = [FIT_MARGIN, HINT_HEIGHT].map(|points| f64::from((points * px_per_point).round()));
    view.fit_camera(lattice, [size.x as u32, size.y as u32], margin, below);
}
