//! Contour lines of h̄ on the canvas.

use eframe::egui::{Painter, Rect};

use super::Canvas;
use meshbrush_kit::kit::marks;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::View;
use meshbrush_render::scene::Camera;

/// Most corners of contour lines that a frame draws.
const MOST_CONTOUR_CORNERS: usize = 150_000;

impl Canvas {
    /// Brings the contour lines closer to the field, while they are shown.
    pub(super) fn follow_contours(&mut self, session: &Session, view: &View) {
        if !view.aids.contours {
            return self.contours.clear(&self.jobs);
        }
        let revision = session.document().revision() + session.follower().revision();
        self.contours.advance(session.follower(), session.document().paint(), revision, &self.jobs);
    }

    /// Draws the contour lines that are in view.
    pub(super) fn paint_contours(&self, painter: &Painter, rect: Rect, camera: &Camera) {
        let (screen, visible) = (camera.screen_map(), camera.visible_world());
        let at = |world| marks::point_from_px(rect, screen(world), painter.pixels_per_point());
        let lines = self.contours.lines().iter();
        let in_view = lines.filter(|line| line.bounds.intersection(&visible).is_some());
        let in_view: Vec<_> = in_view.map(|line| &line.contour).collect();
        // Where there are very many, only every second level has lines, or every fourth.
        let mut every = 1;
        let corners = |every: u32| {
            let shown = in_view.iter().filter(|line| line.level.is_multiple_of(every));
            shown.map(|line| line.points.len()).sum::<usize>()
        };
        while every < 64 && corners(every) > MOST_CONTOUR_CORNERS {
            every *= 2;
        }
        for line in in_view.iter().filter(|line| line.level.is_multiple_of(every)) {
            marks::paint_contour(painter, line.points.iter().map(|&point| at(point)));
        }
    }
}
