//! The strokes of a brush.

use glam::DVec2;

use super::history::EntryData;
use super::{Document, RecordedStroke};
use crate::layers::LayerId;
use crate::mesh::Progress;
use crate::paint::{Brush, Medium, Mirror, PathPoint, Stroke};

/// A stroke, and the layer that it paints on.
#[derive(Clone, Debug)]
pub(super) struct LayerStroke {
    layer: LayerId,
    stroke: Stroke,
    /// The path and the brush of the stroke, if it is recorded.
    recorded: Option<RecordedStroke>,
    /// Whether the layer had no pixels before.
    is_first: bool,
}

impl Document {
    /// Returns the current stroke, from [`Self::begin_stroke`] until it ends.
    pub fn stroke(&self) -> Option<&Stroke> {
        self.stroke.as_ref().map(|current| &current.stroke)
    }

    /// Begins a stroke on the layer that [`Self::layer_for`] chooses. It touches nothing until
    /// [`Self::extend_stroke`]. The current stroke or gesture ends first. Nothing begins where no layer can
    /// be painted on.
    pub fn begin_stroke(&mut self, brush: Brush) {
        self.begin_mirrored_stroke(brush, Mirror::default());
    }

    /// Begins a stroke that is repeated in the lines of `mirror`, as [`Self::begin_stroke`] does.
    pub fn begin_mirrored_stroke(&mut self, brush: Brush, mirror: Mirror) {
        self.end_stroke();
        self.end_gesture();
        let Ok(layer) = self.layer_for(&brush.medium) else { return };
        self.active = Some(layer);
        let settings = &self.settings;
        let is_first = self.paint.get(layer).is_none();
        self.paint.get_or_insert(layer, || settings.blank_raster(layer));
        let stroke = Stroke::new(brush, settings.transfer.h_max, settings.domain.bounds).mirrored(mirror);
        let recorded =
            self.recording.is_some().then(|| RecordedStroke { layer, brush, mirror, path: Vec::new() });
        self.stroke = Some(LayerStroke { layer, stroke, recorded, is_first });
        self.finishing = false;
    }

    /// Extends the current stroke to a point in world units and draws it there at once.
    pub fn draw_to(&mut self, point: DVec2) {
        self.extend_stroke(point);
        while self.advance_stroke(usize::MAX) == Progress::More {}
    }

    /// Extends the current stroke to a point; [`Self::advance_stroke`] draws the new segment.
    pub fn extend_stroke(&mut self, point: impl Into<PathPoint>) {
        if let Some(LayerStroke { layer, stroke, recorded, .. }) = &mut self.stroke
            && let Some(raster) = self.paint.get(*layer)
        {
            let point = point.into();
            stroke.extend(raster, point);
            recorded.iter_mut().filter(|_| point.is_finite()).for_each(|stroke| stroke.path.push(point));
        }
    }

    /// Draws at most one segment of the current stroke, and about `pixels` of it. A stroke that was finished
    /// ends with its last segment.
    pub fn advance_stroke(&mut self, pixels: usize) -> Progress {
        let Some(LayerStroke { layer, stroke, .. }) = &mut self.stroke else { return Progress::Done };
        let layer = *layer;
        let area = self.paint.get_mut(layer).and_then(|raster| stroke.advance(raster, pixels));
        let progress = if stroke.is_drawn() { Progress::Done } else { Progress::More };
        if let Some(area) = area {
            self.note_repainted(layer, [area]);
        }
        if self.finishing && progress == Progress::Done {
            self.end_stroke();
        }
        progress
    }

    /// Returns whether the current stroke is drawn to its last point; true without a stroke.
    pub fn is_stroke_drawn(&self) -> bool {
        self.stroke().is_none_or(Stroke::is_drawn)
    }

    /// Lets the current stroke end as soon as [`Self::advance_stroke`] has drawn it to its last point.
    pub fn finish_stroke(&mut self) {
        self.finishing = true;
        if self.is_stroke_drawn() {
            self.end_stroke();
        }
    }

    /// Draws the rest of the current stroke at once and ends it: it becomes one entry of the history.
    pub fn end_stroke(&mut self) {
        self.finishing = false;
        while self.advance_stroke(usize::MAX) == Progress::More {}
        let Some(LayerStroke { layer, stroke, recorded, .. }) = self.stroke.take() else { return };
        let title = match stroke.brush().medium {
            Medium::Eraser => "erase",
            _ => "paint",
        };
        let Some(raster) = self.paint.get_mut(layer) else { return };
        let patch = stroke.finish(raster);
        if !patch.is_empty() {
            self.enter(title, EntryData::Paint(vec![(layer, patch)]));
        }
        self.note_stroke(title, recorded);
    }

    /// Removes the current stroke, as if it had never begun.
    pub fn cancel_stroke(&mut self) {
        let Some(LayerStroke { layer, stroke, recorded, is_first, .. }) = self.stroke.take() else { return };
        let Some(raster) = self.paint.get_mut(layer) else { return };
        let areas = stroke.finish(raster).exchange(raster);
        self.note_repainted(layer, areas);
        let without_path =
            recorded.filter(|_| is_first).map(|stroke| RecordedStroke { path: Vec::new(), ..stroke });
        self.note_stroke("cancelled stroke", without_path);
    }
}
