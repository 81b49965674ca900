//! The question for a path.

use std::path::PathBuf;

use eframe::egui::{self, Context, Id, Key, Ui};

use super::FileRequest;
use crate::app::command::Command;
use crate::app::widgets::{ActionButton, ButtonKind, TextRow, dialog, dialog_title};

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
pub fn ask(ctx: &Context, request: FileRequest, commands: &mut Vec<Command>) {
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
