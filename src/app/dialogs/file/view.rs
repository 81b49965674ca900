//! How the file dialog looks, and its keys.

use std::path::{Path, PathBuf};

use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::text_edit::TextEditState;
use eframe::egui::{
    self, Context, EventFilter, Key, Modifiers, Rect, Response, RichText, Ui, UiBuilder, vec2,
};

use super::{Contents, FileDialog, export_doubts};

use crate::app::dialogs::pictures;
use meshbrush_core::document::Settings;
use meshbrush_io::io::FolderEntry;
use meshbrush_kit::kit::background::{ProgressRow, WorkId};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::file_coordinates::FileCoordinates;
use meshbrush_kit::kit::mesh_export::ExportFigures;
use meshbrush_kit::kit::view::View;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_render::render::export::ExportFormat;
use meshbrush_ui::theme::{font, metrics, tokens};
use meshbrush_ui::widgets::{
    ActionButton, ButtonKind, FileRow, Icon, TextError, TextRow, ToolButton, bytes_row, dialog, dialog_title,
    dropdown_row, format,
};

const WIDTH: f32 = 600.0;
/// Height of the list, and above the choices for a picture.
const LIST: f32 = 264.0;
const SHORT_LIST: f32 = 120.0;

/// The facts about the document, and about files that are being read, that the dialog shows.
pub struct FileFacts<'a> {
    /// Triangles that an export writes.
    pub triangles: usize,
    /// What an export writes, or why it cannot be written, once it is measured.
    pub figures: Option<&'a Result<ExportFigures, String>>,
    /// The settings of the document.
    pub settings: &'a Settings,
    /// What the canvas shows, and how exported pictures look.
    pub view: &'a View,
    /// Files that are being read.
    pub reads: &'a [ProgressRow],
}

/// The answer of [`FileDialog::show`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileAnswer {
    /// The dialog is still open.
    Open,
    /// The dialog was closed.
    Closed,
    /// This path was given.
    Chosen(PathBuf),
    /// Cancel the reading of the file that was given.
    CancelWork(WorkId),
}

/// The keys that move in the list, taken from the text field.
struct ListKeys {
    steps: i64,
    enter: bool,
    tab: bool,
    up: bool,
}

impl ListKeys {
    fn take(ui: &Ui) -> Self {
        ui.input_mut(|input| Self {
            up: input.consume_key(Modifiers::ALT, Key::ArrowUp),
            steps: input.count_and_consume_key(Modifiers::NONE, Key::ArrowDown) as i64
                - input.count_and_consume_key(Modifiers::NONE, Key::ArrowUp) as i64,
            enter: input.consume_key(Modifiers::NONE, Key::Enter),
            tab: input.key_pressed(Key::Tab) && input.modifiers.is_none(),
        })
    }
}

impl FileDialog {
    /// Shows the dialog. Call it every frame until it is closed.
    pub fn show(&mut self, ctx: &Context, facts: &FileFacts<'_>, commands: &mut Vec<Command>) -> FileAnswer {
        let folder = self.typed().0;
        self.listing.show(&folder);
        let shown = dialog(ctx, "file", |ui| self.contents(ui, facts, commands));
        if shown.should_close() && shown.inner == FileAnswer::Open { FileAnswer::Closed } else { shown.inner }
    }

    fn contents(&mut self, ui: &mut Ui, facts: &FileFacts<'_>, commands: &mut Vec<Command>) -> FileAnswer {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 64.0));
        dialog_title(ui, self.request.title);
        ui.add_space(8.0);
        let rows = self.rows();
        let enabled = !self.is_waiting();
        let chosen = ui.add_enabled_ui(enabled, |ui| {
            self.folder_row(ui);
            ui.add_space(4.0);
            let clicked = self.list(ui, &rows);
            ui.add_space(8.0);
            let entered = self.text_row(ui, &rows);
            self.format_row(ui);
            self.coordinates_row(ui, facts, commands);
            self.figure_rows(ui, facts);
            if self.writes_picture() {
                pictures::rows(ui, facts.view, commands);
            }
            clicked.or(entered)
        });
        if let Some(path) = chosen.inner {
            return FileAnswer::Chosen(path);
        }
        ui.add_space(12.0);
        self.bottom_row(ui, facts)
    }

    /// The folder above, the home folder, and the folders that lead to the one that is listed.
    fn folder_row(&mut self, ui: &mut Ui) {
        let folder = self.typed().0;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            if ToolButton::small(Icon::UP, "Folder above").key("Alt+↑").show(ui).clicked()
                && let Some(parent) = folder.parent()
            {
                self.enter(parent.to_owned());
            }
            if ToolButton::small(Icon::HOME, "Home folder").show(ui).clicked()
                && let Some(home) = self.home.clone()
            {
                self.enter(home);
            }
            ui.add_space(4.0);
            if let Some(chosen) = crumbs(ui, &folder) {
                self.enter(chosen);
            }
        });
    }

    /// Shows the entries of the folder; answers the file that was double-clicked.
    fn list(&mut self, ui: &mut Ui, rows: &[FolderEntry]) -> Option<PathBuf> {
        let height = if self.writes_picture() { SHORT_LIST } else { LIST };
        let (_, place) = ui.allocate_space(vec2(ui.available_width(), height));
        ui.painter().rect_filled(place, metrics::RADIUS_CONTROL, tokens(ui).well);
        let inner = place.shrink(4.0);
        let mut child = ui.new_child(UiBuilder::new().max_rect(inner));
        if rows.is_empty() {
            let text = self.empty_text();
            child.centered_and_justified(|ui| ui.label(RichText::new(text).color(tokens(ui).faint)));
            return None;
        }
        let mut chosen = None;
        egui::ScrollArea::vertical().auto_shrink(false).show_viewport(&mut child, |ui, viewport| {
            ui.set_height(metrics::ROW * rows.len() as f32);
            let top = ui.max_rect().top();
            let first = (viewport.min.y / metrics::ROW).floor().max(0.0) as usize;
            let last = ((viewport.max.y / metrics::ROW).ceil().max(0.0) as usize).min(rows.len());
            for (i, row) in rows.iter().enumerate().take(last).skip(first) {
                let at = egui::pos2(inner.left(), top + metrics::ROW * i as f32);
                let rect = Rect::from_min_size(at, vec2(inner.width() - 8.0, metrics::ROW));
                if self.list_row(ui, rect, row, i) {
                    chosen = Some(i);
                }
            }
        });
        rows.get(chosen?).and_then(|_| self.accept())
    }

    /// Returns why no entry is shown.
    fn empty_text(&self) -> String {
        match self.listing.contents() {
            Contents::Reading => "Reading the folder…".into(),
            Contents::Failed(problem) => problem.clone(),
            Contents::Read(_) if !self.typed().1.is_empty() => {
                format!("Nothing here begins with “{}”", self.typed().1)
            }
            Contents::Read(_) if self.request.writes() => "No files of this kind in this folder".into(),
            Contents::Read(_) => {
                let endings: Vec<String> =
                    (self.request.endings)().iter().map(|ending| format!(".{ending}")).collect();
                format!("No files of this kind in this folder: {}", endings.join(" "))
            }
        }
    }

    /// Shows a row of the list. Returns whether its file was double-clicked.
    fn list_row(&mut self, ui: &mut Ui, rect: Rect, entry: &FolderEntry, index: usize) -> bool {
        let name = entry.name.to_string_lossy();
        let bytes = (!entry.is_folder).then_some(entry.bytes);
        let selected = self.selected == Some(index);
        let response = FileRow { name: &name, bytes, selected }.show(ui, rect);
        // After a quick click elsewhere, egui counts a double click as a triple one.
        if (response.double_clicked() || response.triple_clicked()) && !entry.is_folder {
            return true;
        }
        if response.clicked() {
            self.choose(entry);
            self.selected = (!entry.is_folder && !self.is_typed).then_some(index);
        }
        false
    }

    /// Shows the text and the keys that act on it; answers the path when Enter was pressed.
    fn text_row(&mut self, ui: &mut Ui, rows: &[FolderEntry]) -> Option<PathBuf> {
        let keys = if ui.is_enabled() { Some(ListKeys::take(ui)) } else { None };
        let before = self.text.clone();
        let error = self.problem.as_deref().map(|message| TextError { message, at: None });
        let response =
            TextRow::new("Path", &mut self.text).hint("name, or path from / or ~").error(error).show(ui);
        if self.text != before {
            (self.is_typed, self.selected, self.problem) = (true, None, None);
            self.follow_ending();
        }
        if let Some(note) = self.listing.note() {
            ui.label(RichText::new(note).font(font::caption()).color(tokens(ui).faint));
        }
        self.keep_focus(ui, &response);
        self.act(ui, &response, keys?, rows)
    }

    /// Puts the cursor into the text at first, and selects a proposed name.
    fn keep_focus(&mut self, ui: &Ui, response: &Response) {
        if ui.memory(|memory| memory.focused().is_none()) {
            response.request_focus();
        }
        if self.selects_text && response.has_focus() {
            self.selects_text = false;
            let end = CCursor::new(self.text.chars().count());
            set_selection(ui.ctx(), response.id, CCursorRange::two(CCursor::default(), end));
        }
    }

    fn act(&mut self, ui: &Ui, response: &Response, keys: ListKeys, rows: &[FolderEntry]) -> Option<PathBuf> {
        if keys.up
            && let Some(parent) = self.typed().0.parent()
        {
            self.enter(parent.to_owned());
        }
        if keys.steps != 0 && !rows.is_empty() {
            let from = self.selected.map_or(if keys.steps > 0 { -1 } else { 0 }, |at| at as i64);
            self.selected = Some((from + keys.steps).rem_euclid(rows.len() as i64) as usize);
        }
        if response.has_focus() && keys.tab && self.complete(rows) {
            let end = CCursor::new(self.text.chars().count());
            set_selection(ui.ctx(), response.id, CCursorRange::one(end));
        }
        self.hold_tab(ui, response, rows);
        let selected = self.selected.and_then(|index| rows.get(index)).filter(|_| keys.enter);
        if let Some(entry) = selected {
            self.choose(entry);
            self.selected = None;
            return if entry.is_folder { None } else { self.accept() };
        }
        if keys.enter && !self.text.trim().is_empty() { self.accept() } else { None }
    }

    /// Keeps the focus in the text while Tab can complete it.
    fn hold_tab(&self, ui: &Ui, response: &Response, rows: &[FolderEntry]) {
        let completes = self.is_typed && !self.text.trim().is_empty() && !rows.is_empty();
        let filter = EventFilter {
            tab: completes,
            horizontal_arrows: true,
            vertical_arrows: true,
            ..Default::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    }

    /// Returns whether the file is a picture of the mesh.
    fn writes_picture(&self) -> bool {
        matches!(self.export_format(), Some(ExportFormat::Png | ExportFormat::Svg))
    }

    /// The format of a file that is written in one of several.
    fn format_row(&mut self, ui: &mut Ui) {
        let formats = (self.request.formats)();
        if formats.is_empty() {
            return;
        }
        let name = |(ending, purpose): &(&'static str, &str)| (*ending, format!(".{ending}   {purpose}"));
        let names: Vec<(&'static str, String)> = formats.iter().map(name).collect();
        let choices: Vec<(&'static str, &str)> =
            names.iter().map(|(ending, name)| (*ending, name.as_str())).collect();
        if dropdown_row(ui, "Format", &mut self.ending, &choices).changed() {
            self.follow_format();
        }
    }

    /// The coordinates of a mesh in the plane of a projection.
    fn coordinates_row(&self, ui: &mut Ui, facts: &FileFacts<'_>, commands: &mut Vec<Command>) {
        let Some(format) = self.export_format().filter(|format| format.mesh().is_some()) else { return };
        let is_model = FileCoordinates::Geographic.is_plane(format, has_heights(facts.settings));
        if facts.settings.domain.projection.is_none() || is_model {
            return;
        }
        let mut coordinates = facts.view.file_coordinates;
        if dropdown_row(ui, "Coordinates", &mut coordinates, &FileCoordinates::ALL).changed() {
            commands.push(Command::from(ViewCommand::FileCoordinates(coordinates)));
        }
    }

    /// What an export of the mesh writes, and what a person may miss in it.
    fn figure_rows(&self, ui: &mut Ui, facts: &FileFacts<'_>) {
        let Some(format) = self.export_format() else { return };
        let written = written(format, facts, &self.path());
        let written = format!("{written}{}", coordinates_in(format, facts));
        let doubts = export_doubts::sentences(format, facts.settings, facts.figures);
        let [quiet, plain] = [tokens(ui).label, tokens(ui).text];
        let rows = [(written, quiet)].into_iter().chain(doubts.map(|doubt| (doubt, plain)));
        for (sentence, color) in rows {
            ui.horizontal(|ui| {
                ui.add_space(metrics::LABEL_WIDTH);
                ui.add(egui::Label::new(RichText::new(sentence).font(font::caption()).color(color)).wrap());
            });
        }
    }

    /// Shows the progress of reading, and the buttons.
    fn bottom_row(&mut self, ui: &mut Ui, facts: &FileFacts<'_>) -> FileAnswer {
        let reading = facts.reads.iter().find(|_| self.is_waiting() && !self.request.writes());
        if let Some(row) = reading {
            let cancelled = bytes_row(ui, &row.what, row.meter.done(), row.meter.total());
            return if cancelled { FileAnswer::CancelWork(row.id) } else { FileAnswer::Open };
        }
        let right = egui::Layout::right_to_left(egui::Align::Center);
        ui.with_layout(right, |ui| {
            let named = !self.text.trim().is_empty() && !self.is_waiting();
            let go = ActionButton::new(self.request.verb()).kind(ButtonKind::Main);
            if ui.add_enabled_ui(named, |ui| ui.add(go)).inner.clicked() {
                return self.accept().map_or(FileAnswer::Open, FileAnswer::Chosen);
            }
            let cancelled = ui.add(ActionButton::new("Cancel")).clicked();
            if cancelled { FileAnswer::Closed } else { FileAnswer::Open }
        })
        .inner
    }
}

/// Describes the contents of an export: `188,102 triangles, about 14 MB`.
fn written(format: ExportFormat, facts: &FileFacts<'_>, path: &Path) -> String {
    let triangles = facts.triangles;
    let count = format::count(triangles as u64);
    let files = match format.files_of(path, !facts.settings.lines.is_empty()).len() {
        1 => String::new(),
        files => format!(" in {files} files"),
    };
    if let Some(Ok(figures @ ExportFigures { bytes: Some(bytes), .. })) = facts.figures {
        let ready = if figures.is_ready() { " It keeps all rules of its solver." } else { "" };
        return format!("{}, {}{files}.{ready}", cells_and_nodes(figures), format::file_size(*bytes));
    }
    // No more digits than the estimate is worth.
    let about = |bytes: u64| format::rounded(bytes as f64, 2) as u64;
    match format.approximate_bytes(triangles).map(about) {
        Some(bytes) => format!("{count} triangles, about {}{files}.", format::file_size(bytes)),
        None => {
            let width = format::count(facts.view.picture.size().width.into());
            format!("{count} triangles as a picture, {width} pixels wide.")
        }
    }
}

/// Returns the number of cells and of nodes: `20,869 squares, 9,760 triangles, 26,000 nodes`.
fn cells_and_nodes(figures: &ExportFigures) -> String {
    let ExportFigures { triangles, squares, nodes, .. } = *figures;
    let [squares_text, triangles_text, nodes] =
        [squares, triangles - 2 * squares, nodes].map(|count| format::count(count as u64));
    match squares {
        0 => format!("{triangles_text} triangles, {nodes} nodes"),
        _ => format!("{squares_text} squares, {triangles_text} triangles, {nodes} nodes"),
    }
}

/// Returns whether files of a document have the heights of a surface.
fn has_heights(settings: &Settings) -> bool {
    settings.surfaces().next().is_some()
}

/// Says what the coordinates in an export of a document are, in a sentence after a space; nothing where they
/// have no unit, and about a picture.
fn coordinates_in(format: ExportFormat, facts: &FileFacts<'_>) -> &'static str {
    let settings = facts.settings;
    let is_plane = facts.view.file_coordinates.is_plane(format, has_heights(settings));
    match (settings.domain.projection.is_some(), settings.unit) {
        _ if matches!(format, ExportFormat::Svg | ExportFormat::Png) => "",
        (true, _) if !is_plane => " Coordinates are longitudes and latitudes in degrees.",
        (true, _) => " Coordinates are metres in the plane of the document.",
        (false, LengthUnit::Degree) => " Coordinates are in degrees.",
        (false, LengthUnit::Metre) => " Coordinates are in metres.",
        (false, LengthUnit::Kilometre) => " Coordinates are in kilometres.",
        (false, LengthUnit::None) => "",
    }
}

/// Shows the folders on the way to `folder`, as far as they fit, from the right. Returns the one that was
/// clicked.
fn crumbs(ui: &mut Ui, folder: &Path) -> Option<PathBuf> {
    let mut room = ui.available_width() - 16.0;
    let mut shown: Vec<(&Path, String)> = Vec::new();
    for step in folder.ancestors() {
        let name = step.file_name().map_or("/".into(), |name| name.to_string_lossy().into_owned());
        room -= 8.0 * name.chars().count() as f32 + 24.0;
        if room < 0.0 && !shown.is_empty() {
            break;
        }
        shown.push((step, name));
    }
    let mut chosen = None;
    for (step, name) in shown.iter().rev() {
        let color = if *step == folder { tokens(ui).value } else { tokens(ui).label };
        let button = egui::Button::new(RichText::new(name).color(color)).frame_when_inactive(false);
        if ui.add(button).clicked() {
            chosen = Some((*step).to_owned());
        }
        if *step != folder && name != "/" {
            ui.label(RichText::new("/").color(tokens(ui).faint));
        }
    }
    chosen
}

fn set_selection(ctx: &Context, id: egui::Id, range: CCursorRange) {
    let mut state = TextEditState::load(ctx, id).unwrap_or_default();
    state.cursor.set_char_range(Some(range));
    state.store(ctx, id);
}
