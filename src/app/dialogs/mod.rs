//! The dialogs: the command palette, the questions for a path and for a place, About.

mod go_to;
mod path;
mod request;
mod system;

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use eframe::egui::Context;

use super::catalog::{CatalogItem, catalog, shortcut_text};
use super::command::Command;
use super::frame::FrameState;
use super::widgets::{self, ActionButton, PaletteAnswer, PaletteItem, dialog, dialog_title};
pub use request::FileRequest;

/// A dialog over the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialog {
    /// The list of all commands.
    Palette,
    /// What the program is.
    About,
    /// The question for a place on the canvas.
    GoTo,
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
            if let Some(path) = system::ask(request) {
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
    pub fn show(&self, ctx: &Context, state: &FrameState<'_>, commands: &mut Vec<Command>) {
        match self.open {
            Some(Dialog::Palette) => palette(ctx, &catalog(state), commands),
            Some(Dialog::About) => about(ctx, commands),
            Some(Dialog::GoTo) => go_to::ask(ctx, state, commands),
            Some(Dialog::Path(request)) => path::ask(ctx, request, commands),
            None => {}
        }
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
