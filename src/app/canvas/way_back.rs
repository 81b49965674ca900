//! The way back to the mesh, where none of it is in view.

use eframe::egui::{CursorIcon, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};
use glam::{DVec2, dvec2};

use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::geometry;
use meshbrush_render::scene::Camera;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::paint_floating;

/// Places along each side of the canvas where the mesh is looked for.
const PROBES: u32 = 7;
/// Radius of the button, in points.
const RADIUS: f32 = 20.0;

/// Returns an arrow towards the mesh while none of it is in view; a click shows all of it. Returns its place.
pub fn show(
    ui: &Ui,
    inner: Rect,
    state: &FrameState<'_>,
    camera: &Camera,
    commands: &mut Vec<Command>,
) -> Option<Rect> {
    let towards = direction_to_mesh(state.session, camera)?;
    let direction = vec2(towards.x as f32, -towards.y as f32).normalized();
    // On the ray from the middle, at the edge of the canvas.
    let reach = inner.shrink(RADIUS + 16.0).size() / 2.0;
    let scale = (reach.x / direction.x.abs()).min(reach.y / direction.y.abs());
    let place = Rect::from_center_size(inner.center() + scale * direction, Vec2::splat(2.0 * RADIUS));
    let response = ui.interact(place, ui.scope_id().with("way back"), Sense::click());
    let name = "Back to the mesh";
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    paint_floating(ui, place);
    let color = if response.hovered() { tokens(ui).accent } else { tokens(ui).value };
    paint_arrow(ui, place, direction, color);
    if response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(name).clicked() {
        commands.push(Command::from(ViewCommand::Fit));
    }
    Some(place)
}

fn paint_arrow(ui: &Ui, place: Rect, direction: Vec2, color: eframe::egui::Color32) {
    let (tip, size) = (place.center() + 9.0 * direction, font::body().size * 0.55);
    let side = direction.rot90();
    let head = vec![tip, tip - size * (direction + 0.7 * side), tip - size * (direction - 0.7 * side)];
    ui.painter().line_segment(
        [place.center() - 9.0 * direction, tip - 0.8 * size * direction],
        Stroke::new(2.0, color),
    );
    ui.painter().add(Shape::convex_polygon(head, color, Stroke::NONE));
}

/// Returns the vector from the middle of the view towards the mesh, in world units; `None` if some of the
/// mesh is in view.
fn direction_to_mesh(session: &Session, camera: &Camera) -> Option<DVec2> {
    let visible = camera.visible_world();
    let on_mesh = |place: DVec2| session.locate(place).triangle().is_some();
    if probes(visible).any(on_mesh) {
        return None;
    }
    let (domain, middle) = (&session.follower().settings().domain, visible.center());
    let Some(region) = domain.region() else {
        let towards = domain.bounds.center() - middle;
        return (!visible.contains(domain.bounds.center()) && towards != DVec2::ZERO).then_some(towards);
    };
    let nearest = region.edges().map(|edge| geometry::nearest_on_segment(middle, edge)).min_by(|a, b| {
        let distance = |place: &DVec2| place.distance_squared(middle);
        distance(a).total_cmp(&distance(b))
    })?;
    (!visible.contains(nearest)).then_some(nearest - middle)
}

/// Places spread over a rectangle.
fn probes(visible: geometry::Rect) -> impl Iterator<Item = DVec2> {
    let share = |i: u32| (f64::from(i) + 0.5) / f64::from(PROBES);
    (0..PROBES * PROBES)
        .map(move |i| visible.min + visible.size() * dvec2(share(i % PROBES), share(i / PROBES)))
}
