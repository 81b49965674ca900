//! The edits of a document since it was opened, as data from which they can be repeated.

use std::sync::Arc;

use super::history::{own_bytes, shared_data};
use super::{Document, History, NoPaintLayer, Settings, SettingsError};
use crate::layers::{LayerId, PaintLayers};
use crate::paint::{Brush, Mirror, PathPoint};

/// One edit of a document.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// A stroke, from its first point to its last.
    Stroke(Arc<RecordedStroke>),
    /// The settings as they are after a gesture, without the background picture.
    Settings(Arc<Settings>),
    /// The paint of these layers is removed.
    Clear(Vec<LayerId>),
    /// A layer without pixels gets those of another one.
    CopyPaint {
        /// The layer with pixels.
        from: LayerId,
        /// The layer that gets them.
        to: LayerId,
    },
    /// The last gesture is undone.
    Undo,
    /// The gesture that was undone last is done again.
    Redo,
}

/// A stroke as data.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedStroke {
    /// The layer that it paints on.
    pub layer: LayerId,
    /// The brush.
    pub brush: Brush,
    /// The lines in which it is repeated.
    pub mirror: Mirror,
    /// The points of its path in world units. There are none in a stroke that was cancelled: it left blank
    /// pixels, whose place later strokes depend on.
    pub path: Vec<PathPoint>,
}

/// An edit with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedEdit {
    /// The name in the history, for display only.
    pub title: &'static str,
    /// The edit.
    pub edit: Edit,
}

/// Why an edit cannot be done.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// There is no gesture to undo.
    #[error("There is nothing to undo.")]
    NothingToUndo,
    /// There is no gesture to redo.
    #[error("There is nothing to redo.")]
    NothingToRedo,
    /// The layer of a stroke does not exist, or has the other quantity.
    #[error("The brush cannot paint on the layer {0}: there is no such paint layer.")]
    OtherLayer(u32),
    /// The layer cannot be painted on.
    #[error(transparent)]
    NoPaintLayer(#[from] NoPaintLayer),
    /// The settings are out of range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}

/// The edits of a document since [`Document::record`], and the document before them.
#[derive(Clone, Debug)]
pub struct Recording {
    settings: Settings,
    paint: PaintLayers,
    edits: Vec<RecordedEdit>,
    /// Memory of the edits, about.
    bytes: usize,
    /// How much of it the last edit takes.
    last_bytes: usize,
    is_full: bool,
}

impl Recording {
    /// Most bytes that a recording holds. One that would need more is dropped.
    pub const MAX_BYTES: usize = 256 << 20;

    fn new(settings: Settings, paint: PaintLayers) -> Self {
        let settings = Settings { background: None, ..settings };
        Self { settings, paint, edits: Vec::new(), bytes: 0, last_bytes: 0, is_full: false }
    }

    /// Returns the settings before the first edit, without the background picture.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Returns the paint before the first edit.
    pub fn paint(&self) -> &PaintLayers {
        &self.paint
    }

    /// Returns the edits, the first one first. There are none if the recording is full.
    pub fn edits(&self) -> &[RecordedEdit] {
        &self.edits
    }

    /// Returns the memory of the edits, about.
    #[cfg(test)]
    pub(super) fn bytes(&self) -> usize {
        self.bytes
    }

    /// Returns whether there were more edits than [`Self::MAX_BYTES`] can hold.
    pub fn is_full(&self) -> bool {
        self.is_full
    }

    fn add(&mut self, title: &'static str, edit: Edit) {
        self.last_bytes = size_of::<RecordedEdit>()
            + match &edit {
                Edit::Stroke(stroke) => size_of_val(&**stroke) + size_of_val(&stroke.path[..]),
                Edit::Settings(settings) => self.new_bytes(settings),
                Edit::Clear(layers) => size_of_val(&layers[..]),
                Edit::CopyPaint { .. } | Edit::Undo | Edit::Redo => 0,
            };
        self.bytes += self.last_bytes;
        self.is_full |= self.bytes > Self::MAX_BYTES;
        if self.is_full {
            self.edits = Vec::new();
        } else {
            self.edits.push(RecordedEdit { title, edit });
        }
    }

    /// Replaces the last settings by those that joined the gesture.
    fn join(&mut self, settings: &Settings) {
        match self.edits.pop() {
            Some(RecordedEdit { title, edit: Edit::Settings(_) }) => {
                self.bytes -= self.last_bytes;
                self.add(title, Edit::Settings(recorded(settings)));
            }
            // The recording is full.
            _ => debug_assert!(self.is_full, "settings join settings"),
        }
    }

    /// Returns the memory that settings need beside the last ones that were recorded.
    fn new_bytes(&self, settings: &Settings) -> usize {
        let last = self.edits.iter().rev().find_map(|edit| match &edit.edit {
            Edit::Settings(settings) => Some(&**settings),
            _ => None,
        });
        let held: Vec<_> = shared_data(last.unwrap_or(&self.settings)).collect();
        let new = shared_data(settings).filter(|data| !held.contains(data));
        own_bytes(settings) + new.map(|(_, bytes)| bytes).sum::<usize>()
    }
}

fn recorded(settings: &Settings) -> Arc<Settings> {
    Arc::new(Settings { background: None, ..settings.clone() })
}

impl Document {
    /// Records the edits from now on, and forgets those recorded so far. What was done before can no longer
    /// be undone: that would reach back beyond the recording.
    pub fn record(&mut self) {
        self.history = History::default();
        // Blank pixels are not saved. The next stroke makes them again, at the place that is right by then.
        let blank = self.paint.iter().filter(|(_, raster)| raster.is_blank()).map(|(id, _)| id);
        for id in blank.collect::<Vec<_>>() {
            self.paint.remove(id);
        }
        self.recording = Some(Recording::new(self.settings.clone(), self.paint.clone()));
    }

    /// Returns the edits since [`Self::record`].
    pub fn recording(&self) -> Option<&Recording> {
        self.recording.as_ref()
    }

    /// Does a recorded edit again.
    ///
    /// # Errors
    /// Fails when it is not possible in this document, which then stays as it was.
    pub fn apply(&mut self, edit: &Edit) -> Result<(), EditError> {
        match edit {
            Edit::Stroke(stroke) => self.repeat_stroke(stroke)?,
            Edit::Settings(settings) => self.replace_settings((**settings).clone())?,
            Edit::Clear(layers) => self.clear_layers(layers, "clear paint"),
            Edit::CopyPaint { from, to } => self.copy_paint(*from, *to),
            Edit::Undo if !self.undo() => return Err(EditError::NothingToUndo),
            Edit::Redo if !self.redo() => return Err(EditError::NothingToRedo),
            Edit::Undo | Edit::Redo => {}
        }
        Ok(())
    }

    fn repeat_stroke(&mut self, stroke: &RecordedStroke) -> Result<(), EditError> {
        self.end_stroke();
        let active = self.active.replace(stroke.layer);
        let layer = self.layer_for(&stroke.brush.medium);
        if layer != Ok(stroke.layer) {
            self.active = active;
            return Err(layer.map_or_else(Into::into, |_| EditError::OtherLayer(stroke.layer.0)));
        }
        self.begin_mirrored_stroke(stroke.brush, stroke.mirror);
        stroke.path.iter().for_each(|point| self.extend_stroke(*point));
        self.end_stroke();
        Ok(())
    }

    /// Changes all settings as one gesture. Equal settings are a gesture as well.
    fn replace_settings(&mut self, settings: Settings) -> Result<(), SettingsError> {
        let settings = settings.checked()?;
        settings.check_paint(&self.paint)?;
        self.end_stroke();
        self.end_gesture();
        self.enter_settings("settings", settings);
        Ok(())
    }

    /// Notes a stroke that ended, if it is recorded.
    pub(super) fn note_stroke(&mut self, title: &'static str, stroke: Option<RecordedStroke>) {
        if let Some(stroke) = stroke {
            self.note_edit(title, || Edit::Stroke(Arc::new(stroke)));
        }
    }

    /// Notes an edit, if edits are recorded.
    pub(super) fn note_edit(&mut self, title: &'static str, edit: impl FnOnce() -> Edit) {
        if let Some(recording) = &mut self.recording {
            recording.add(title, edit());
        }
    }

    /// Notes the settings after a change; one that joins a gesture replaces what was noted of it.
    pub(super) fn note_settings(&mut self, title: &'static str, joins: bool) {
        let Some(recording) = &mut self.recording else { return };
        if joins {
            recording.join(&self.settings);
        } else {
            recording.add(title, Edit::Settings(recorded(&self.settings)));
        }
    }
}
