//! The contour lines of h̄ on the canvas. They are computed on another thread: a large field takes longer
//! than a frame.

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;

use eframe::egui::Context;

use crate::document::Follower;
use crate::field::{Contour, contours};
use crate::geometry::Rect;

/// Levels that have contour lines.
const LEVELS: u32 = 63;

/// A line with the rectangle around it, in world units.
#[derive(Clone, Debug)]
pub struct PlacedContour {
    /// The line.
    pub contour: Contour,
    /// The rectangle around it.
    pub bounds: Rect,
}

/// Identifies the contents of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FieldState {
    revision: u64,
    bounds: Rect,
}

/// The lines that were computed last, and those that are being computed.
#[derive(Default)]
pub struct ContourFinder {
    found: Option<(FieldState, Vec<PlacedContour>)>,
    running: Option<(FieldState, Receiver<Vec<PlacedContour>>)>,
}

impl ContourFinder {
    /// The lines of the field, or of its last state until the new ones are computed.
    pub fn lines(&self) -> &[PlacedContour] {
        self.found.as_ref().map_or(&[], |(_, lines)| lines)
    }

    /// Drops the lines.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Takes the lines that are ready, and computes those of a field at `revision`.
    pub fn advance(&mut self, follower: &Follower, revision: u64, ctx: &Context) {
        let state = FieldState { revision, bounds: follower.field().target().bounds() };
        // Lines of another domain are of no use.
        self.found.take_if(|(found, _)| found.bounds != state.bounds);
        if let Some((computed, lines)) = &self.running {
            match lines.try_recv() {
                Ok(lines) => {
                    self.found = Some((*computed, lines)).filter(|(found, _)| found.bounds == state.bounds);
                    self.running = None;
                }
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => self.running = None,
            }
        }
        let is_current = self.found.as_ref().is_some_and(|(found, _)| *found == state);
        if is_current || !follower.field().is_sampled() {
            return;
        }
        let (sender, lines) = channel();
        let (target, ctx) = (follower.field().target().clone(), ctx.clone());
        let mesh = follower.mesh();
        let diameters: Vec<f64> = (0..LEVELS).map(|level| mesh.diameter(level)).collect();
        thread::spawn(move || {
            // The receiver is gone when the lines were switched off.
            let _ = sender.send(contours(&target, &diameters).into_iter().map(placed).collect());
            ctx.request_repaint();
        });
        self.running = Some((state, lines));
    }
}

fn placed(contour: Contour) -> PlacedContour {
    let (low, high) =
        contour.points.iter().fold((contour.points[0], contour.points[0]), |(low, high), &point| {
            (low.min(point), high.max(point))
        });
    PlacedContour { bounds: Rect::new(low, high), contour }
}
