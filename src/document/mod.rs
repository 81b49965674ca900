//! What the user edits: settings and paint, with every edit's inverse. Field and mesh are derived from it by a
//! [`Follower`] and never saved.

mod cut;
mod edits;
mod examples;
mod follower;
mod history;
mod job;
mod pricer;
mod setting;
mod settings;
mod stage;

use glam::DVec2;

pub use edits::Edits;
pub use examples::Example;
pub use follower::{Follower, MeshChange};
pub use history::History;
pub use pricer::{Price, Pricer};
pub use setting::Setting;
pub use settings::{Base, LEAST_MEMORY, MAX_COARSE_TRIANGLES, RESOLUTIONS, Settings, SettingsError};
pub use stage::{FollowError, Stage};

use crate::mesh::Progress;
use crate::paint::{Brush, PaintRasters, Stroke};
use crate::raster::PixelRect;
use history::{Change, Entry};

/// The ground state: the only thing that is edited, undone and saved.
#[derive(Clone, Debug)]
pub struct Document {
    settings: Settings,
    layers: PaintRasters,
    history: History,
    stroke: Option<Stroke>,
    /// Whether the stroke under way ends where it leads by now.
    lifted: bool,
    /// A settings gesture still going on: its title. Further changes with that title join it.
    open_gesture: Option<&'static str>,
    repainted: Repainted,
    edits: Edits,
    revision: u64,
    version: u64,
    /// The highest version so far.
    last_version: u64,
}

/// Pixels that changed since the follower last asked.
#[derive(Clone, Debug, PartialEq)]
pub enum Repainted {
    /// Those in the rectangles; there may be none.
    Within(Vec<PixelRect>),
    /// The layers as such were replaced.
    Everything,
}

impl Document {
    /// A document with the given settings and paint, and no history.
    ///
    /// # Errors
    /// When the settings cannot be met.
    pub fn new(settings: Settings, layers: Option<PaintRasters>) -> Result<Self, SettingsError> {
        let settings = settings.checked()?;
        let (bounds, size) = (settings.domain.bounds, settings.raster_size());
        let layers = match layers {
            Some(layers) if layers.risk.size() == size && layers.risk.bounds() == bounds => layers,
            Some(layers) => layers.resampled(bounds, size),
            None => PaintRasters::blank(bounds, size),
        };
        Ok(Self {
            settings,
            layers,
            history: History::default(),
            stroke: None,
            lifted: false,
            open_gesture: None,
            repainted: Repainted::Everything,
            edits: Edits::everything(),
            revision: 0,
            version: 0,
            last_version: 0,
        })
    }

    /// The settings in force.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The paint.
    pub fn layers(&self) -> &PaintRasters {
        &self.layers
    }

    /// What can be undone and redone.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Grows with every change.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Names the document as it is: undo brings the former version back. A stroke counts once it has ended.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// The stroke under way.
    pub fn stroke(&self) -> Option<&Stroke> {
        self.stroke.as_ref()
    }

    /// Puts the brush down. A stroke already under way ends first.
    pub fn begin_stroke(&mut self, brush: Brush) {
        self.end_stroke();
        self.end_gesture();
        self.stroke = Some(Stroke::new(brush, self.settings.transfer.h_max));
        self.lifted = false;
    }

    /// Draws the stroke under way on to a point in world units.
    pub fn draw_to(&mut self, point: DVec2) {
        self.lead_to(point);
        while self.draw_on(usize::MAX) == Progress::More {}
    }

    /// Leads the stroke under way on to a point in world units; [`Self::draw_on`] then draws it.
    pub fn lead_to(&mut self, point: DVec2) {
        if let Some(stroke) = &mut self.stroke {
            stroke.lead_to(&self.layers, point);
        }
    }

    /// Draws at most one straight piece of the way on which the stroke under way was led, and about `pixels` of it. A stroke that was
    /// lifted ends with the last.
    pub fn draw_on(&mut self, pixels: usize) -> Progress {
        let Some(stroke) = &mut self.stroke else { return Progress::Done };
        let area = stroke.advance(&mut self.layers, pixels);
        let progress = if stroke.is_laid_down() { Progress::Done } else { Progress::More };
        if let Some(area) = area {
            self.note_repainted([area]);
        }
        if self.lifted && progress == Progress::Done {
            self.end_stroke();
        }
        progress
    }

    /// Whether the stroke under way, if there is one, is drawn as far as it was led.
    pub fn is_drawn(&self) -> bool {
        self.stroke.as_ref().is_none_or(Stroke::is_laid_down)
    }

    /// Lifts the brush: the stroke ends once it is drawn as far as it was led.
    pub fn lift(&mut self) {
        self.lifted = true;
        if self.is_drawn() {
            self.end_stroke();
        }
    }

    /// Ends the stroke under way, drawn as far as it was led: it becomes one entry of the history.
    pub fn end_stroke(&mut self) {
        self.lifted = false;
        while self.draw_on(usize::MAX) == Progress::More {}
        if let Some(stroke) = self.stroke.take() {
            let title = match stroke.brush().medium {
                crate::paint::Medium::Eraser => "erase",
                _ => "paint",
            };
            let patch = stroke.finish();
            if !patch.is_empty() {
                self.enter(title, Change::Paint(patch));
            }
        }
    }

    /// Gives up the stroke under way, as if it had never begun.
    pub fn cancel_stroke(&mut self) {
        if let Some(stroke) = self.stroke.take() {
            let areas = stroke.finish().exchange(&mut self.layers);
            self.note_repainted(areas);
        }
    }

    /// Puts another document's settings and paint in the place of this one's, as one gesture.
    pub fn replace_with(&mut self, title: &'static str, other: Self) {
        self.end_stroke();
        self.end_gesture();
        self.replace(title, other.settings, other.layers);
    }

    /// Takes all paint away.
    pub fn clear_paint(&mut self) {
        self.end_stroke();
        self.end_gesture();
        if !self.layers.is_blank() {
            let blank = PaintRasters::blank(self.settings.domain.bounds, self.settings.raster_size());
            self.replace("clear paint", self.settings.clone(), blank);
        }
    }

    /// Changes one setting. Changes of the same setting are one gesture until [`Self::end_gesture`].
    ///
    /// # Errors
    /// When the new settings cannot be met. The document is then as before.
    pub fn set(&mut self, setting: Setting) -> Result<(), SettingsError> {
        let title = setting.title();
        let mut settings = self.settings.clone();
        setting.apply(&mut settings);
        if settings == self.settings {
            return Ok(());
        }
        let settings = settings.checked()?;
        self.end_stroke();
        let (bounds, size) = (settings.domain.bounds, settings.raster_size());
        let joins = self.open_gesture == Some(title);
        if bounds != self.settings.domain.bounds || size != self.layers.risk.size() {
            let layers = self.layers_before_gesture(joins).resampled(bounds, size);
            if joins && matches!(self.last_change(), Some(Change::Everything(_))) {
                self.settings = settings;
                self.layers = layers;
                self.note_replaced();
            } else {
                self.replace(title, settings, layers);
            }
        } else {
            let old = std::mem::replace(&mut self.settings, settings);
            self.edits.settings = true;
            if !joins {
                self.enter(title, Change::Settings(Box::new(old)));
            }
            self.revision += 1;
        }
        self.open_gesture = Some(title);
        if joins {
            self.next_version();
        }
        Ok(())
    }

    /// Ends a settings gesture, such as the drag of a slider: the next change is an entry of its own.
    pub fn end_gesture(&mut self) {
        self.open_gesture = None;
    }

    /// Takes back the last gesture, or the stroke under way.
    pub fn undo(&mut self) -> bool {
        if self.stroke.is_some() {
            self.cancel_stroke();
            return true;
        }
        self.end_gesture();
        let mut history = std::mem::take(&mut self.history);
        let did = history.undo(|entry| self.exchange(entry));
        self.history = history;
        did
    }

    /// Does the last undone gesture again.
    pub fn redo(&mut self) -> bool {
        self.end_stroke();
        self.end_gesture();
        let mut history = std::mem::take(&mut self.history);
        let did = history.redo(|entry| self.exchange(entry));
        self.history = history;
        did
    }

    /// Takes back the last gesture for good, if it changed a setting: it turned out that this cannot be met.
    ///
    /// Paint stays: whoever painted since then should not lose it. So does all else after an undo, which has led here: the last
    /// gesture is then another one.
    pub fn reject_last(&mut self) {
        let paints = matches!(self.last_change(), Some(Change::Paint(_)));
        let newest = self.version == self.last_version;
        if self.stroke.is_none() && !paints && newest && self.undo() {
            self.history.forget_undone();
        }
    }

    /// Forgets what could be undone: the document as it is becomes a starting point.
    pub fn forget_history(&mut self) {
        self.end_stroke();
        self.history = History::default();
    }

    /// What was repainted since this was last asked.
    pub fn take_repainted(&mut self) -> Repainted {
        std::mem::replace(&mut self.repainted, Repainted::Within(Vec::new()))
    }

    /// Whether a stroke, or a gesture with a setting, is still going on.
    pub fn is_in_gesture(&self) -> bool {
        self.stroke.is_some() || self.open_gesture.is_some()
    }

    /// What was edited since this was last asked, a stroke under way included.
    pub fn take_edits(&mut self) -> Edits {
        std::mem::take(&mut self.edits)
    }

    fn exchange(&mut self, entry: &mut Entry) {
        std::mem::swap(&mut entry.version, &mut self.version);
        match &mut entry.change {
            Change::Paint(patch) => {
                let areas = patch.exchange(&mut self.layers);
                self.note_repainted(areas);
            }
            Change::Settings(settings) => {
                std::mem::swap(&mut **settings, &mut self.settings);
                self.edits.settings = true;
                self.revision += 1;
            }
            Change::Everything(both) => {
                std::mem::swap(&mut both.0, &mut self.settings);
                std::mem::swap(&mut both.1, &mut self.layers);
                self.note_replaced();
            }
        }
    }

    fn replace(&mut self, title: &'static str, settings: Settings, layers: PaintRasters) {
        let settings = std::mem::replace(&mut self.settings, settings);
        let layers = std::mem::replace(&mut self.layers, layers);
        self.enter(title, Change::Everything(Box::new((settings, layers))));
        self.note_replaced();
    }

    /// Enters a gesture into the history.
    fn enter(&mut self, title: &'static str, change: Change) {
        let version = self.version;
        self.next_version();
        self.history.push(Entry { title, change, version });
    }

    fn next_version(&mut self) {
        self.last_version += 1;
        self.version = self.last_version;
    }

    fn last_change(&self) -> Option<&Change> {
        self.history.last_done().map(|entry| &entry.change)
    }

    /// The layers to resample from: in the middle of a gesture those before it, or each step would blur the paint.
    fn layers_before_gesture(&self, joins: bool) -> &PaintRasters {
        match self.last_change() {
            Some(Change::Everything(before)) if joins => &before.1,
            _ => &self.layers,
        }
    }

    fn note_repainted(&mut self, areas: impl IntoIterator<Item = PixelRect>) {
        for area in areas.into_iter().filter(|area| !area.is_empty()) {
            self.edits.add(area);
            if let Repainted::Within(earlier) = &mut self.repainted {
                earlier.push(area);
            }
        }
        self.revision += 1;
    }

    fn note_replaced(&mut self) {
        self.repainted = Repainted::Everything;
        self.edits = Edits::everything();
        self.revision += 1;
    }
}
