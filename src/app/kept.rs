//! What the window's own storage keeps of the parts of the window from run to run.

use std::path::PathBuf;

use eframe::egui::Context;
use eframe::{Storage, get_value, set_value};

use crate::app::features::statistics::Statistics;
use meshbrush_kit::kit::coordinates::CoordinateStyle;
use meshbrush_kit::kit::dock::Dock;
use meshbrush_kit::kit::file_coordinates::FileCoordinates;
use meshbrush_kit::kit::picture_choices::{KeptPictures, PictureChoices};
use meshbrush_kit::kit::presentation::Presentation;
use meshbrush_kit::kit::project::ProjectFile;
use meshbrush_kit::kit::tools::{
    BrushPreset, KeptBrush, KeptPreset, PenResponse, Tools, kept_pen, pen_of_kept,
};
use meshbrush_kit::kit::view::View;
use meshbrush_kit::kit::{Features, Tab};

/// Name under which the storage keeps the coordinates that places are written in.
const COORDINATES_KEY: &str = "coordinates";
/// Name under which the storage keeps the tab of the lower dock.
const TAB_KEY: &str = "tab";
/// Name under which it keeps the Courant number of time steps.
const COURANT_KEY: &str = "courant number";
/// Name under which it keeps the brush.
const BRUSH_KEY: &str = "brush";
/// Name under which it keeps what the pressure of a pen changes.
const PEN_KEY: &str = "pen";
/// Name under which it keeps the presets of brushes.
const PRESETS_KEY: &str = "brush presets";
/// Name under which it keeps the coordinates of exported meshes.
const FILE_COORDINATES_KEY: &str = "coordinates of exported meshes";
/// Name under which it keeps the choices for exported pictures.
const PICTURES_KEY: &str = "exported pictures";
/// Name under which it keeps the recent files.
const RECENT_KEY: &str = "recent files";
/// Name under which it keeps the zoom factor before the presentation, where the run ends with one.
const ZOOM_KEY: &str = "zoom factor before the presentation";

/// The brush, the pen and the presets as they are in the storage.
pub struct StoredBrush {
    brush: KeptBrush,
    pen: PenResponse,
    presets: Vec<BrushPreset>,
}

impl StoredBrush {
    /// Returns what is in the storage once that of these tools is.
    pub fn of(tools: &Tools) -> Self {
        Self { brush: tools.kept_brush(), pen: tools.pen.response, presets: tools.presets().to_vec() }
    }

    /// Returns whether the tools have changed since.
    pub fn differs_from(&self, tools: &Tools) -> bool {
        self.brush != tools.kept_brush() || self.pen != tools.pen.response || self.presets != tools.presets()
    }
}

/// Takes the brush, the response to a pen and the presets of the last run.
pub fn load_brush(tools: &mut Tools, storage: &dyn Storage) {
    if let Some(kept) = get_value(storage, BRUSH_KEY) {
        tools.take_brush(kept);
    }
    if let Some(pen) = get_value(storage, PEN_KEY).and_then(pen_of_kept) {
        tools.pen.response = pen;
    }
    let kept: Option<Vec<KeptPreset>> = get_value(storage, PRESETS_KEY);
    if let Some(kept) = kept {
        tools.take_presets(kept.into_iter().filter_map(BrushPreset::of_kept).collect());
    }
}

/// Keeps them for the next run.
pub fn store_brush(tools: &Tools, storage: &mut dyn Storage) {
    set_value(storage, BRUSH_KEY, &tools.kept_brush());
    set_value(storage, PEN_KEY, &kept_pen(&tools.pen.response));
    let presets: Vec<KeptPreset> = tools.presets().iter().map(BrushPreset::kept).collect();
    set_value(storage, PRESETS_KEY, &presets);
}

/// Shows the tab of the last run.
pub fn load_tab(dock: &mut Dock, storage: &dyn Storage) {
    let tab: Option<String> = get_value(storage, TAB_KEY);
    if let Some(tab) = tab.as_deref().and_then(Tab::named) {
        dock.choose(tab);
    }
}

/// Keeps the tab for the next run.
pub fn store_tab(dock: &Dock, storage: &mut dyn Storage) {
    set_value(storage, TAB_KEY, &dock.tab().name());
}

/// Shows time steps for the Courant number of the last run.
pub fn load_courant(features: &mut Features, storage: &dyn Storage) {
    if let Some(number) = get_value(storage, COURANT_KEY) {
        features.get_mut::<Statistics>().set_courant(number);
    }
}

/// Keeps the Courant number for the next run.
pub fn store_courant(features: &Features, storage: &mut dyn Storage) {
    set_value(storage, COURANT_KEY, &features.get::<Statistics>().courant());
}

/// Writes places as in the last run.
pub fn load_coordinates(view: &mut View, storage: &dyn Storage) {
    let name: Option<String> = get_value(storage, COORDINATES_KEY);
    if let Some(style) = name.as_deref().and_then(CoordinateStyle::named) {
        view.coordinates = style;
    }
}

/// Keeps the coordinates of places for the next run.
pub fn store_coordinates(view: &View, storage: &mut dyn Storage) {
    set_value(storage, COORDINATES_KEY, &view.coordinates.name());
}

/// Takes the coordinates of exported meshes of the last run.
pub fn load_file_coordinates(view: &mut View, storage: &dyn Storage) {
    let word: Option<String> = get_value(storage, FILE_COORDINATES_KEY);
    if let Some(coordinates) = word.as_deref().and_then(FileCoordinates::of_word) {
        view.file_coordinates = coordinates;
    }
}

/// Keeps them for the next run.
pub fn store_file_coordinates(view: &View, storage: &mut dyn Storage) {
    set_value(storage, FILE_COORDINATES_KEY, &view.file_coordinates.word());
}

/// Takes the choices for exported pictures of the last run.
pub fn load_pictures(view: &mut View, storage: &dyn Storage) {
    let kept: Option<KeptPictures> = get_value(storage, PICTURES_KEY);
    if let Some(choices) = kept.and_then(PictureChoices::of_kept) {
        view.picture = choices;
    }
}

/// Keeps them for the next run.
pub fn store_pictures(view: &View, storage: &mut dyn Storage) {
    set_value(storage, PICTURES_KEY, &view.picture.kept());
}

/// Loads the list of recent files.
pub fn load_recent(project: &mut ProjectFile, storage: &dyn Storage) {
    project.set_recent(get_value(storage, RECENT_KEY).unwrap_or_default());
}

/// Stores it.
pub fn store_recent(project: &ProjectFile, storage: &mut dyn Storage) {
    // A path that is not valid Unicode cannot be stored.
    let named: Vec<&PathBuf> = project.recent().iter().filter(|path| path.to_str().is_some()).collect();
    set_value(storage, RECENT_KEY, &named);
}

/// Keeps what ends a presentation: egui keeps the size of text and lines from run to run.
pub fn store_presentation(presentation: Option<Presentation>, storage: &mut dyn Storage) {
    set_value(storage, ZOOM_KEY, &presentation.map(|presentation| presentation.zoom_factor()));
}

/// Ends the presentation with which the last run ended, if it did.
pub fn end_last_presentation(storage: &dyn Storage, ctx: &Context) {
    if let Some(Some(zoom_factor)) = get_value(storage, ZOOM_KEY) {
        ctx.set_zoom_factor(zoom_factor);
    }
}
