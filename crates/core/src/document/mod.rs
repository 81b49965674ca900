//! The document that a person edits: settings and paint, with the inverse of every edit. A [`Follower`]
//! derives field and mesh from it; these are never saved.

mod background;
mod celtic_sea;
mod change;
mod drawing;
mod edits;
mod examples;
mod field_price;
mod fill;
mod follower;
mod following;
mod history;
mod idle_layers;
mod layer_extent;
mod layer_titles;
mod layers;
mod outline;
mod pace;
mod path_plan;
mod pending;
mod pricer;
mod readings;
mod rebuild;
mod rebuild_price;
mod recording;
mod replay;
mod setting;
mod settings;
mod shown;
mod stage;
mod strokes;
mod surfaces;
mod transfer_price;
mod whole_settings;

pub use background::{Background, Picture};
pub use celtic_sea::SeaChart;
pub use drawing::{Drawing, DrawingError, DrawnPart, DrawnShape};
pub use edits::Edits;
pub use examples::{Example, ExampleData, ExampleMaking};
pub use field_price::CountEstimate;
pub use follower::{Follower, MeshChange};
pub use history::History;
pub use layers::{NoPaintLayer, check_layer_count, unused_name};
pub use outline::{OutlineError, extent};
pub use pace::Pace;
pub use path_plan::{KeepOut, PathCost, PathPlan};
pub use pricer::{NoChange, Price, Pricer};
pub use readings::Readings;
pub use recording::{Edit, EditError, RecordedEdit, RecordedStroke, Recording};
pub use replay::{Replay, ReplayedMesh};
pub use setting::{Setting, SettingKind};
pub use settings::{LEAST_MEMORY, MAX_COARSE_TRIANGLES, MOST_RASTER_PIXELS, Settings, SettingsError};
pub use stage::Stage;
pub use transfer_price::{SizePricer, TransferPrice, TransferPricer};

use crate::layers::{LayerId, PaintChange, PaintLayers};
use crate::paint::{Patch, Repaint};
use change::Change;
use history::{EntryData, HistoryEntry};
use strokes::LayerStroke;

/// The ground state: settings and paint, the only data that is edited, undone and saved.
///
/// Two counters describe it. [`Self::revision`] grows with every change, undo and single dabs included:
/// compare it to find out whether anything changed. [`Self::version`] names a state between gestures, and
/// undo returns to the former version: compare it to find out whether the document is as it was saved.
#[derive(Clone, Debug)]
pub struct Document {
    settings: Settings,
    /// The pixels of all paint layers; those of a deleted layer stay for undo.
    paint: PaintLayers,
    /// The layer that brush and eraser paint on.
    active: Option<LayerId>,
    history: History,
    stroke: Option<LayerStroke>,
    /// Whether the current stroke ends once it is drawn to its last point.
    finishing: bool,
    /// The setting of the gesture that has not ended. Further changes of that setting join it.
    open_gesture: Option<SettingKind>,
    repainted: Repainted,
    edits: Edits,
    /// The edits as data, if they are recorded.
    recording: Option<Recording>,
    revision: u64,
    version: u64,
    /// The highest version so far.
    last_version: u64,
}

/// The areas in which the paint changed since the last call of [`Document::take_repainted`].
#[derive(Clone, Debug, PartialEq)]
pub enum Repainted {
    /// Within these rectangles, which may overlap; the list may be empty.
    Within(Vec<PaintChange>),
    /// The document was replaced: everything may differ.
    Everything,
}

impl Document {
    /// Creates a document with the given settings and paint and an empty history. Without paint it is blank.
    ///
    /// # Errors
    /// Fails when the settings are out of range.
    pub fn new(settings: Settings, paint: Option<PaintLayers>) -> Result<Self, SettingsError> {
        let settings = settings.checked()?;
        let paint = paint.unwrap_or_default();
        settings.check_paint(&paint)?;
        let active = settings.layers.iter().rev().find(|layer| layer.paints().is_some());
        Ok(Self {
            active: active.map(|layer| layer.id),
            settings,
            paint,
            history: History::default(),
            stroke: None,
            finishing: false,
            open_gesture: None,
            repainted: Repainted::Everything,
            edits: Edits::everything(),
            recording: None,
            revision: 0,
            version: 0,
            last_version: 0,
        })
    }

    /// Returns the current settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Returns the pixels of the paint layers.
    pub fn paint(&self) -> &PaintLayers {
        &self.paint
    }

    /// Returns the edits that can be undone and redone.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Returns a counter that grows with every change and never returns to an earlier value.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Identifies the current state: equal versions of one document have equal settings and paint. Undo and
    /// redo return to the version of the state that they restore. A stroke counts once it has ended.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Opens another document in place of this one. Nothing of this one is kept: the history is empty, and
    /// what was not saved is lost.
    ///
    /// Only the counters run on: [`Self::version`] and [`Self::revision`] are new, so that a copy of the
    /// former document (a file, a mesh) is not taken for one of this.
    pub fn replace_with(&mut self, other: Self) {
        let version = self.last_version + 1;
        let records = self.recording.is_some();
        *self = Self {
            history: History::default(),
            stroke: None,
            finishing: false,
            open_gesture: None,
            repainted: Repainted::Everything,
            edits: Edits::everything(),
            revision: self.revision + 1,
            version,
            last_version: version,
            recording: None,
            ..other
        };
        if records {
            self.record();
        }
    }

    /// Removes the paint of all layers that are not locked, as one gesture.
    pub fn clear_paint(&mut self) {
        let layers = self.settings.layers.iter().filter(|layer| layer.paints().is_some() && !layer.locked);
        let layers: Vec<LayerId> = layers.map(|layer| layer.id).collect();
        self.clear_layers(&layers, "clear paint");
    }

    /// Removes the paint of some layers, as one gesture with this name.
    fn clear_layers(&mut self, layers: &[LayerId], title: &'static str) {
        self.end_stroke();
        self.end_gesture();
        let mut patches = Vec::new();
        for &layer in layers {
            let Some(raster) = self.paint.get_mut(layer) else { continue };
            let mut patch = Patch::clearing(raster);
            if !patch.is_empty() {
                let areas = patch.exchange(raster);
                self.note_repainted(layer, areas);
                patches.push((layer, patch));
            }
        }
        if !patches.is_empty() {
            let cleared = patches.iter().map(|(layer, _)| *layer).collect();
            self.enter(title, EntryData::Paint(patches));
            self.note_edit(title, || Edit::Clear(cleared));
        }
    }

    /// Changes one setting. Changes of the same setting are one gesture until [`Self::end_gesture`].
    ///
    /// # Errors
    /// Fails when the new settings are out of range. The document then stays as it was.
    pub fn set(&mut self, setting: Setting) -> Result<(), SettingsError> {
        let (kind, title) = (setting.kind(), setting.title(&self.settings));
        let mut settings = self.settings.clone();
        setting.apply(&mut settings);
        if settings == self.settings {
            return Ok(());
        }
        let settings = settings.checked()?;
        settings.check_paint(&self.paint)?;
        self.end_stroke();
        let joins = self.open_gesture == Some(kind);
        if joins {
            self.settings = settings;
            self.edits.settings = true;
            self.revision += 1;
            self.next_version();
        } else {
            self.enter_settings(title, settings);
        }
        self.note_settings(title, joins);
        self.open_gesture = Some(kind);
        Ok(())
    }

    /// Changes the settings, as an entry of the history.
    fn enter_settings(&mut self, title: &'static str, settings: Settings) {
        let old = std::mem::replace(&mut self.settings, settings);
        self.edits.settings = true;
        self.enter(title, EntryData::Settings(Box::new(old)));
        self.revision += 1;
    }

    /// Ends the current settings gesture, such as the drag of a slider: the next change is an entry of its
    /// own.
    pub fn end_gesture(&mut self) {
        self.open_gesture = None;
    }

    /// Undoes the last gesture, or removes the current stroke. Returns whether there was one.
    pub fn undo(&mut self) -> bool {
        if self.stroke.is_some() {
            self.cancel_stroke();
            return true;
        }
        self.end_gesture();
        let mut history = std::mem::take(&mut self.history);
        let did = history.undo(|entry| self.exchange(entry));
        self.history = history;
        if did {
            self.note_edit("undo", || Edit::Undo);
        }
        did
    }

    /// Redoes the gesture that was undone last. Returns whether there was one.
    pub fn redo(&mut self) -> bool {
        self.end_stroke();
        self.end_gesture();
        let mut history = std::mem::take(&mut self.history);
        let did = history.redo(|entry| self.exchange(entry));
        self.history = history;
        if did {
            self.note_edit("redo", || Edit::Redo);
        }
        did
    }

    /// Returns whether the last gesture changed settings that the mesh follows in place, such as layers or
    /// the outline. Then its settings do not tell whether they can be met.
    pub fn is_followed_in_place(&self) -> bool {
        let Some(EntryData::Settings(before)) = self.last_data() else { return false };
        matches!(self.settings.change_from(before, &self.paint), Change::Update { .. })
    }

    /// Undoes the last gesture without a way to redo it, if it changed a setting: it turned out that no mesh
    /// can be made.
    ///
    /// A stroke is kept: its paint must not be lost. Nothing happens after an undo or redo either, as the
    /// last entry of the history is then not the change that failed.
    pub fn reject_last(&mut self) {
        let paints = matches!(self.last_data(), Some(EntryData::Paint(_)));
        let newest = self.version == self.last_version;
        if self.stroke.is_none() && !paints && newest && self.undo() {
            self.history.forget_undone();
        }
    }

    /// Returns to earlier settings: undoes or redoes the last gesture where that leads there, and otherwise
    /// sets them as a gesture of its own. Paint stays as it is.
    pub fn return_to(&mut self, settings: &Settings) {
        let leads_there =
            |entry: Option<&HistoryEntry>| entry.and_then(|e| e.data.settings()) == Some(settings);
        self.end_gesture();
        if self.settings == *settings || self.stroke.is_some() {
            return;
        }
        if leads_there(self.history.last_done()) {
            self.undo();
        } else if leads_there(self.history.last_undone()) {
            self.redo();
        } else if settings.check_paint(&self.paint).is_ok() {
            self.enter_settings("former settings", settings.clone());
            self.note_settings("former settings", false);
        }
    }

    /// Returns the pixels that changed since the last call.
    pub fn take_repainted(&mut self) -> Repainted {
        std::mem::replace(&mut self.repainted, Repainted::Within(Vec::new()))
    }

    /// Returns whether a stroke or a settings gesture has begun and not ended.
    pub fn is_in_gesture(&self) -> bool {
        self.stroke.is_some() || self.open_gesture.is_some()
    }

    /// Returns the edits since the last call, including those of the current stroke.
    pub fn take_edits(&mut self) -> Edits {
        std::mem::take(&mut self.edits)
    }

    fn exchange(&mut self, entry: &mut HistoryEntry) {
        std::mem::swap(&mut entry.version, &mut self.version);
        match &mut entry.data {
            EntryData::Paint(patches) => {
                for (layer, patch) in patches {
                    let Some(raster) = self.paint.get_mut(*layer) else { continue };
                    let areas = patch.exchange(raster);
                    self.note_repainted(*layer, areas);
                }
            }
            EntryData::Settings(settings) => {
                std::mem::swap(&mut **settings, &mut self.settings);
                self.edits.settings = true;
                self.revision += 1;
            }
        }
    }

    /// Adds an entry to the history, after its change was made.
    fn enter(&mut self, title: &'static str, data: EntryData) {
        let version = self.version;
        self.next_version();
        self.history.push(HistoryEntry { title, data, version }, &self.settings);
    }

    fn next_version(&mut self) {
        self.last_version += 1;
        self.version = self.last_version;
    }

    fn last_data(&self) -> Option<&EntryData> {
        self.history.last_done().map(|entry| &entry.data)
    }

    fn note_repainted(&mut self, layer: LayerId, areas: impl IntoIterator<Item = Repaint>) {
        for Repaint { area, before, change } in areas {
            self.edits.layers.insert(layer);
            if let Repainted::Within(earlier) = &mut self.repainted {
                earlier.push(PaintChange { layer, area, before, change });
            }
        }
        self.revision += 1;
    }
}
