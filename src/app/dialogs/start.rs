//! The page of a new document: what it can start from.

use std::path::PathBuf;

use eframe::egui::{Context, RichText, Ui};

use crate::app::features::domain::OPEN_DOMAIN;
use crate::app::features::layers::OPEN_VALUES;
use crate::app::features::picture::OPEN_PICTURE;
use crate::app::file_kinds::ADD_DATA;
use meshbrush_core::document::Example;
use meshbrush_kit::kit::background::name_of;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_kit::kit::{FileRequest, FrameState};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{ActionButton, ButtonKind, dialog, dialog_title};

const WIDTH: f32 = 520.0;
/// Width of the buttons that a sentence is beside, in points.
const BUTTONS: f32 = 150.0;
/// Most recent files.
const MOST_RECENT: usize = 5;

/// The files that a document can start from: a button, a sentence, and the file to ask for.
static FILES: [(&str, &str, FileRequest); 4] = [
    ("Coast…", "Polygons (.geojson) become the domain, with nodes on their outline.", &OPEN_DOMAIN),
    ("Terrain or depths…", "A grid (.asc) gives the extent, and a curve its diameters.", &OPEN_VALUES),
    ("Picture…", "A map or a drawing (.png) to trace lies behind the mesh.", &OPEN_PICTURE),
    ("Any data…", "A grid, a picture, shapes or a table; you are asked what it is to be.", &ADD_DATA),
];

/// Shows the page over an empty document.
pub fn show(ctx: &Context, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let shown = dialog(ctx, "new document", |ui| {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 64.0));
        dialog_title(ui, "New document");
        ui.add_space(8.0);
        contents(ui, state)
    });
    if shown.inner.is_some() || shown.should_close() {
        commands.push(Command::from(ShellCommand::CloseDialog));
    }
    commands.extend(shown.inner.flatten());
}

/// Returns what to do, once that was decided: nothing more for the rectangle, which is open already.
fn contents(ui: &mut Ui, state: &FrameState<'_>) -> Option<Option<Command>> {
    let mut chosen = None;
    let rectangle = ActionButton::new("Rectangle").kind(ButtonKind::Main);
    let sentence = "A square to paint on; the panel Domain gives it other bounds.";
    if row(ui, rectangle, sentence) {
        chosen = Some(None);
    }
    for (title, sentence, request) in FILES {
        if row(ui, ActionButton::new(title), sentence) {
            chosen = Some(Some(Command::from(FileCommand::Ask(request))));
        }
    }
    let recent: Vec<&PathBuf> = state.project.recent().iter().take(MOST_RECENT).collect();
    if !recent.is_empty() {
        heading(ui, "Recent files");
        ui.horizontal_wrapped(|ui| {
            for path in recent {
                if ui.add(ActionButton::new(&name_of(path))).clicked() {
                    chosen = Some(Some(Command::from(FileCommand::Open(path.clone()))));
                }
            }
        });
    }
    heading(ui, "Examples");
    ui.horizontal_wrapped(|ui| {
        for example in Example::ALL {
            if ui.add(ActionButton::new(example.name())).clicked() {
                chosen = Some(Some(Command::from(FileCommand::OpenExample(example))));
            }
        }
    });
    chosen
}

/// Shows a button with a sentence beside it. Returns whether it was clicked.
fn row(ui: &mut Ui, button: ActionButton<'_>, sentence: &str) -> bool {
    ui.horizontal(|ui| {
        let place = ui.allocate_ui(eframe::egui::vec2(BUTTONS, 24.0), |ui| {
            ui.set_width(BUTTONS);
            let response = ui.add(button);
            if ui.memory(|memory| memory.focused().is_none()) {
                response.request_focus();
            }
            response.clicked()
        });
        ui.label(RichText::new(sentence).color(tokens(ui).label));
        place.inner
    })
    .inner
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(12.0);
    ui.label(RichText::new(text).font(font::caption()).color(tokens(ui).label));
    ui.add_space(2.0);
}
