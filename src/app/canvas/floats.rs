//! Message, progress and hint, floating over the canvas.

use std::time::Duration;

use eframe::egui::{Align2, Id, Rect, Response, Ui, UiBuilder, pos2, vec2};

use super::{Canvas, coordinates, legend, menu, navigation, way_back};

use crate::app::features::painting::show_limit_offer;
use crate::app::features::picture::show_corners;
use meshbrush_core::document::{DrawnPart, Stage};
use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::background::ProgressRow;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, ShellCommand};
use meshbrush_kit::kit::marks::point_from_px;
use meshbrush_kit::kit::notices::Notice;
use meshbrush_kit::kit::session::Session;
use meshbrush_render::scene::Camera;
use meshbrush_ui::widgets::{
    Banner, BannerAnswer, bytes_row, format, hint_pill, paint_floating, progress_row,
};

/// Room for the numbers beside the outermost nodes of a step, in points.
const ROOM_OF_NUMBERS: f32 = 16.0;
/// How long news is shown at least, in seconds, and with a button.
const NEWS_SECONDS: f64 = 5.0;
const NEWS_SECONDS_WITH_BUTTON: f64 = 12.0;
/// Characters that people read in a second who do not wait for them.
const READ_PER_SECOND: f64 = 14.0;
/// How long it is shown after the pointer has left it, in seconds.
const NEWS_SECONDS_AFTER_POINTER: f64 = 2.0;

impl Canvas {
    /// Draws message, progress and hint. Returns the places that take clicks.
    pub fn draw_floats(
        &self,
        ui: &mut Ui,
        response: &Response,
        state: &FrameState<'_>,
        files: &[ProgressRow],
        commands: &mut Vec<Command>,
    ) -> Vec<Rect> {
        let inner = response.rect.shrink(12.0);
        navigation::show_focus(ui, response);
        let mut places = self.draw_progress(ui, inner, state.session, files, commands);
        let hints = state.tools.hint(state);
        // In a small window only one of them fits.
        if !hints.is_empty() && places.is_empty() && state.session.notices().shown().is_none() {
            let room = if state.view.aids.scale_bar { coordinates::BAR_ROOM } else { 0.0 };
            let bounds = inner.with_max_x(inner.right() - room);
            hint_pill(ui, inner.left_bottom(), Align2::LEFT_BOTTOM, bounds, hints);
        }
        if let Some(camera) = state.view.camera {
            // Where work is shown there is no room for it.
            if state.view.aids.scale_bar && places.is_empty() {
                coordinates::show_scale_bar(ui, inner, &camera, state);
            }
            let mesh = on_screen(response.rect, &camera, ui.pixels_per_point());
            places.extend(legend::show(ui, inner, mesh, state, commands));
            places.extend(show_corners(ui, response.rect, state, &camera, commands));
            places.extend(show_limit_offer(ui, response.rect, state, &camera, commands));
            places.extend(way_back::show(ui, inner, state, &camera, commands));
        }
        menu::show(ui, state, commands);
        places.extend(draw_notice(ui, inner, state.session, commands));
        // A message is more important, and at the same place.
        if let Some(toast) = self.toast.as_ref().filter(|_| state.session.notices().shown().is_none()) {
            toast.show(ui, inner);
        }
        places
    }

    /// Draws the progress of long work: on the mesh lowest, then on files. Returns the places of the rows.
    fn draw_progress(
        &self,
        ui: &mut Ui,
        inner: Rect,
        session: &Session,
        files: &[ProgressRow],
        commands: &mut Vec<Command>,
    ) -> Vec<Rect> {
        let size = vec2(inner.width().min(360.0), 36.0);
        let lowest = Rect::from_min_size(inner.right_bottom() - size, size);
        let place = |row: usize| lowest.translate(vec2(0.0, -(size.y + 8.0) * row as f32));
        let mut rows = 0;
        if let Some((what, done)) = work_on_mesh(session).filter(|_| self.mesh_work.is_long()) {
            if progress_row(&mut card(ui, place(rows)), what, &done) {
                commands.push(Command::from(EditCommand::CancelUpdate));
            }
            rows += 1;
        }
        for ProgressRow { id, what, meter, .. } in files {
            if bytes_row(&mut card(ui, place(rows)), what, meter.done(), meter.total()) {
                commands.push(Command::from(FileCommand::CancelWork(*id)));
            }
            rows += 1;
        }
        (0..rows).map(place).collect()
    }
}

/// Returns where the rectangle around the domain is on the screen, with room for numbers beside its nodes.
fn on_screen(canvas: Rect, camera: &Camera, px_per_point: f32) -> Rect {
    let bounds = camera.lattice().bounds();
    let corner = |world| point_from_px(canvas, camera.screen_from_world(world), px_per_point);
    Rect::from_two_pos(corner(bounds.min), corner(bounds.max)).expand(ROOM_OF_NUMBERS)
}

/// Shows a ground over the canvas for a row of widgets.
fn card(ui: &mut Ui, place: Rect) -> Ui {
    paint_floating(ui, place);
    let row = place.with_min_x(place.left() + 12.0).with_max_x(place.right() - 4.0).shrink2(vec2(0.0, 4.0));
    ui.new_child(UiBuilder::new().max_rect(row))
}

/// Draws the message. Returns its place.
fn draw_notice(ui: &mut Ui, inner: Rect, session: &Session, commands: &mut Vec<Command>) -> Option<Rect> {
    let notice = session.notices().shown()?;
    let width = inner.width().min(640.0);
    let place = Rect::from_center_size(pos2(inner.center().x, inner.top() + 40.0), vec2(width, 80.0));
    let mut child = ui.new_child(UiBuilder::new().max_rect(place));
    let banner = if notice.failed { Banner::error(&notice.text) } else { Banner::info(&notice.text) };
    let stands = session.notices().shown_stands();
    let offer = notice.offer.as_ref();
    let banner = match (offer, &notice.other) {
        (Some(offer), Some(other)) => banner.standing().action(offer.label).other(other.label),
        (Some(offer), None) => banner.action(offer.label),
        (None, _) if stands => banner.standing().action("Undo"),
        (None, _) => banner,
    };
    let answer = banner.show(&mut child);
    if !notice.failed && !stands && has_faded(&child, notice) {
        commands.push(Command::from(ShellCommand::DismissNotice));
    }
    match answer {
        BannerAnswer::Open => {}
        BannerAnswer::Acted => match offer {
            Some(offer) => {
                commands.extend([Command::from(ShellCommand::DismissNotice), offer.command.clone()])
            }
            None => commands.push(Command::from(EditCommand::Undo)),
        },
        BannerAnswer::ActedOtherwise => {
            commands.extend(notice.other.as_ref().map(|other| other.command.clone()));
        }
        BannerAnswer::Dismissed => commands.push(Command::from(ShellCommand::DismissNotice)),
    }
    Some(child.min_rect())
}

/// Returns whether news has been shown long enough. Under the pointer it stays. The window sleeps meanwhile.
fn has_faded(ui: &Ui, notice: &Notice) -> bool {
    let id = Id::unique("end of the news");
    let now = ui.input(|input| input.time);
    let known = ui.data(|data| data.get_temp::<(u64, f64)>(id)).filter(|(of, _)| *of == notice.number);
    let mut end = known.map_or(now + seconds_of(notice), |(_, end)| end);
    if ui.rect_contains_pointer(ui.min_rect()) {
        end = end.max(now + NEWS_SECONDS_AFTER_POINTER);
    }
    ui.data_mut(|data| data.insert_temp(id, (notice.number, end)));
    if now < end {
        ui.ctx().request_repaint_after(Duration::from_secs_f64(end - now));
    }
    now >= end
}

/// Returns how long news is shown: long enough to be read.
fn seconds_of(notice: &Notice) -> f64 {
    let least = if notice.offer.is_some() { NEWS_SECONDS_WITH_BUTTON } else { NEWS_SECONDS };
    least.max(notice.text.chars().count() as f64 / READ_PER_SECOND)
}

/// Returns the present work on the mesh in words, and its progress.
pub fn work_on_mesh(session: &Session) -> Option<(&'static str, String)> {
    match session.stage() {
        _ if session.pending_cuts(|part| part != DrawnPart::Domain).next().is_some() => {
            Some(("Drawing the region", String::new()))
        }
        _ if session.is_cutting() => Some(("Cutting the outline", String::new())),
        _ if session.question().is_some() => None,
        _ if session.is_held() => Some(("Counting triangles", String::new())),
        Stage::Refining { triangles } => {
            Some(("Refining", format!("{} triangles", format::count(triangles as u64))))
        }
        Stage::Copying { triangles } => {
            Some(("Copying the mesh", format!("{} triangles", format::count(triangles as u64))))
        }
        Stage::Indexing => Some(("Indexing the outline", String::new())),
        Stage::Checking => Some(("Checking the layers", String::new())),
        Stage::InStep | Stage::GaveUp(_) => None,
    }
}
