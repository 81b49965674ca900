//! The dialogs: the command palette, the question for a path, About.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use eframe::egui::{self, Context, Id, Key, Ui};

use super::catalog::{CatalogItem, shortcut_text};
use super::command::Command;
use super::widgets::{
    self, ActionButton, ButtonKind, PaletteAnswer, PaletteItem, TextRow, dialog, dialog_title,
};
use crate::io::project::ENDING;
use crate::render::export::ExportFormat;

/// Why a path is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileRequest {
    /// To open any file that can be opened.
    Open,
    /// To save the document.
    Save,
    /// To open a picture as risk.
    OpenImage,
    /// To open polygons as a domain.
    OpenDomain,
    /// To write the mesh.
    Export,
}

impl FileRequest {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open",
            Self::Save => "Save project",
            Self::OpenImage => "Open picture as risk",
            Self::OpenDomain => "Open domain",
            Self::Export => "Export mesh",
        }
    }

    fn verb(self) -> &'static str {
        match self {
            Self::Open | Self::OpenImage | Self::OpenDomain => "Open",
            Self::Save => "Save",
            Self::Export => "Export",
        }
    }

    fn hint(self) -> String {
        match self {
            Self::Open => "path of a .meshbrush, a .geojson or a greyscale .png".into(),
            Self::Save => "path ending in .meshbrush".into(),
            Self::OpenImage => "path of a greyscale .png".into(),
            Self::OpenDomain => "path of a .geojson with polygons".into(),
            Self::Export => {
                let endings: Vec<String> =
                    ExportFormat::endings().map(|ending| format!(".{ending}")).collect();
                format!("ending in {}", endings.join(" "))
            }
        }
    }

    /// What to do with a path that was typed.
    fn command(self, path: PathBuf) -> Command {
        match self {
            Self::Open => Command::Open(path),
            Self::Save => Command::SaveAs(path),
            Self::OpenImage => Command::OpenImage(path),
            Self::OpenDomain => Command::OpenDomain(path),
            Self::Export => Command::ExportAs(path),
        }
    }

    /// What to do with a path from the desktop's own dialog, which has asked already whether to replace the
    /// file.
    fn command_after_browsing(self, path: PathBuf) -> Command {
        // It has not asked about the files beside it.
        let alone = ExportFormat::of(&path).is_ok_and(|format| format.files(&path).len() == 1);
        match self {
            Self::Save => Command::SaveTo(path),
            Self::Export if alone => Command::Export(path),
            _ => self.command(path),
        }
    }
}

/// A dialog over the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialog {
    /// The list of all commands.
    Palette,
    /// What the program is.
    About,
    /// The question for a path.
    Path(FileRequest),
}

/// The open dialog, and answers from the desktop's own.
pub struct Dialogs {
    open: Option<Dialog>,
    sender: Sender<(FileRequest, PathBuf)>,
    receiver: Receiver<(FileRequest, PathBuf)>,
}

impl Default for Dialogs {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self { open: None, sender, receiver }
    }
}

impl Dialogs {
    /// Opens a dialog.
    pub fn open(&mut self, dialog: Dialog) {
        self.open = Some(dialog);
    }

    /// Closes it.
    pub fn close(&mut self) {
        self.open = None;
    }

    /// Whether a dialog is open.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Whether a path is being asked for.
    pub fn asks_for_path(&self) -> bool {
        matches!(self.open, Some(Dialog::Path(_)))
    }

    /// Opens the desktop's own file dialog on another thread. On a desktop without one, nothing happens.
    pub fn browse(&self, request: FileRequest, ctx: &Context) {
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        thread::spawn(move || {
            if let Some(path) = browse(request) {
                // The window may have closed in the meantime.
                let _ = sender.send((request, path));
            }
            ctx.request_repaint();
        });
    }

    /// What to do with the paths chosen in the desktop's own dialog.
    pub fn take_browsed(&self) -> Vec<Command> {
        let chosen = self.receiver.try_iter();
        chosen
            .flat_map(|(request, path)| [Command::CloseDialog, request.command_after_browsing(path)])
            .collect()
    }

    /// Shows the open dialog.
    pub fn show(&self, ctx: &Context, catalog: &[CatalogItem], commands: &mut Vec<Command>) {
        match self.open {
            Some(Dialog::Palette) => palette(ctx, catalog, commands),
            Some(Dialog::About) => about(ctx, commands),
            Some(Dialog::Path(request)) => ask_for_path(ctx, request, commands),
            None => {}
        }
    }
}

/// Asks with the desktop's own dialog, and waits for the answer.
fn browse(request: FileRequest) -> Option<PathBuf> {
    let dialog = rfd::FileDialog::new().set_title(request.title());
    match request {
        FileRequest::Open => {
            dialog.add_filter("Projects, domains, pictures", &[ENDING, "geojson", "json", "png"]).pick_file()
        }
        FileRequest::Save => {
            dialog.add_filter("Projects", &[ENDING]).set_file_name(format!("mesh.{ENDING}")).save_file()
        }
        FileRequest::OpenImage => dialog.add_filter("Pictures", &["png"]).pick_file(),
        FileRequest::OpenDomain => dialog.add_filter("Polygons", &["geojson", "json"]).pick_file(),
        FileRequest::Export => dialog
            .add_filter("Meshes and pictures", &ExportFormat::endings().collect::<Vec<_>>())
            .set_file_name("mesh.vtu")
            .save_file(),
    }
}

fn palette(ctx: &Context, catalog: &[CatalogItem], commands: &mut Vec<Command>) {
    let keys: Vec<String> =
        catalog.iter().map(|item| item.shortcut.as_ref().map(shortcut_text).unwrap_or_default()).collect();
    let items: Vec<_> = (catalog.iter().zip(&keys))
        .map(|(item, keys)| PaletteItem { title: &item.title, keys, enabled: item.enabled })
        .collect();
    match widgets::command_palette(ctx, &items) {
        PaletteAnswer::Open => {}
        PaletteAnswer::Closed => commands.push(Command::CloseDialog),
        PaletteAnswer::Chosen(index) => {
            commands.extend([Command::CloseDialog, catalog[index].command.clone()]);
        }
    }
}

fn about(ctx: &Context, commands: &mut Vec<Command>) {
    let shown = dialog(ctx, "about", |ui| {
        ui.set_width(380.0);
        dialog_title(ui, "Meshbrush");
        ui.label(concat!("Version ", env!("CARGO_PKG_VERSION")));
        ui.add_space(8.0);
        ui.label(
            "Paint where detail matters; the mesh follows the brush. Local bisection refinement of triangulated grids by \
             Maubach's method: always conforming, always right-angled.",
        );
        ui.add_space(8.0);
        ui.add(ActionButton::new("Close")).clicked()
    });
    if shown.inner || shown.should_close() {
        commands.push(Command::CloseDialog);
    }
}

/// How the question for a path was answered.
#[derive(Clone, Copy, PartialEq)]
enum PathAnswer {
    None,
    Given,
    Cancelled,
}

/// Asks for a path in a text field, which always works; from there the desktop's own dialog can be opened.
///
/// The text typed so far is in egui's memory.
fn ask_for_path(ctx: &Context, request: FileRequest, commands: &mut Vec<Command>) {
    let id = Id::unique("path typed so far");
    let mut path = ctx.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let shown = dialog(ctx, "path", |ui| {
        ui.set_width(440.0);
        dialog_title(ui, request.title());
        ui.add_space(8.0);
        let field = TextRow::formula("Path", &mut path).hint(&request.hint()).show(ui);
        if !field.lost_focus() && path.is_empty() {
            field.request_focus();
        }
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.add_space(12.0);
        let buttons = path_buttons(ui, request, &path, commands);
        if entered && !path.trim().is_empty() { PathAnswer::Given } else { buttons }
    });
    let answer = if shown.should_close() { PathAnswer::Cancelled } else { shown.inner };
    if answer == PathAnswer::None {
        ctx.data_mut(|data| data.insert_temp(id, path));
        return;
    }
    ctx.data_mut(|data| data.remove::<String>(id));
    commands.push(Command::CloseDialog);
    if answer == PathAnswer::Given {
        commands.push(request.command(PathBuf::from(path.trim())));
    }
}

fn path_buttons(ui: &mut Ui, request: FileRequest, path: &str, commands: &mut Vec<Command>) -> PathAnswer {
    ui.horizontal(|ui| {
        if ui.add(ActionButton::new("Browse…")).clicked() {
            commands.push(Command::Browse(request));
        }
        let right = egui::Layout::right_to_left(egui::Align::Center);
        ui.with_layout(right, |ui| {
            let named = !path.trim().is_empty();
            let go = ActionButton::new(request.verb()).kind(ButtonKind::Main);
            if ui.add_enabled_ui(named, |ui| ui.add(go)).inner.clicked() {
                return PathAnswer::Given;
            }
            let cancelled = ui.add(ActionButton::new("Cancel")).clicked();
            if cancelled { PathAnswer::Cancelled } else { PathAnswer::None }
        })
        .inner
    })
    .inner
}
