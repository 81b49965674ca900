//! The contour lines of h̄ on the canvas. They are computed on another thread: a large field takes longer
//! than a frame.

use meshbrush_core::document::Follower;
use meshbrush_core::field::{Contour, contours};
use meshbrush_core::layers::PaintLayers;
use meshbrush_kit::kit::jobs::{Jobs, Slot, Wanted};
use meshbrush_mesh::geometry::Rect;

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

/// Computes contour lines.
#[derive(Default)]
pub struct ContourFinder(Slot<FieldState, Vec<PlacedContour>>);

impl ContourFinder {
    /// Returns the lines of the field, or of its last state until the new ones are computed.
    pub fn lines(&self) -> &[PlacedContour] {
        self.0.last().map_or(&[], |(_, lines)| lines)
    }

    /// Drops the lines, and ends the work on others.
    pub fn clear(&mut self, jobs: &Jobs) {
        self.0.stop(jobs);
    }

    /// Takes the lines that are ready, and computes those of a field at `revision`.
    pub fn advance(&mut self, follower: &Follower, paint: &PaintLayers, revision: u64, jobs: &Jobs) {
        self.0.poll(jobs);
        let state = FieldState { revision, bounds: follower.field().lattice().bounds() };
        self.0.want(&state, jobs);
        // Lines of another domain are of no use.
        self.0.keep_if(|found| found.bounds == state.bounds);
        if self.0.is_running() || self.0.has(&state) {
            return;
        }
        let (field, paint, mesh) = (follower.shared_field(), paint.clone(), follower.mesh());
        let diameters: Vec<f64> = (0..LEVELS).map(|level| mesh.diameter(level)).collect();
        let find = move |wanted: &Wanted| {
            let (bounds, size) = (state.bounds, pixels_over(&state.bounds));
            let (target, _) = field.sampled_while(&paint, bounds, size, &|| wanted.goes_on())?;
            Some(contours(&target, &diameters).into_iter().map(placed).collect())
        };
        self.0.start_wanted(state, find, jobs);
    }
}

/// Returns the columns and rows of the pixels on which h̄ is sampled: square pixels, 1024 along the longer
/// side.
pub fn pixels_over(bounds: &Rect) -> [u32; 2] {
    let size = bounds.size();
    [size.x, size.y].map(|side| (1024.0 * side / size.max_element()).round().max(2.0) as u32)
}

fn placed(contour: Contour) -> PlacedContour {
    let (low, high) =
        contour.points.iter().fold((contour.points[0], contour.points[0]), |(low, high), &point| {
            (low.min(point), high.max(point))
        });
    PlacedContour { bounds: Rect::new(low, high), contour }
}
