//! Runs the commands. A match arm is one call into the module that owns the data; no `match` has a wildcard,
//! so that a command without an arm does not compile.

#![deny(clippy::wildcard_enum_match_arm)]

mod files;

use eframe::egui::Context;

use super::App;
use super::dialogs::{Dialog, fill_in_place};
use super::features::LAYER_KINDS;
use super::help::{missing_pictures, stop_editing_keys};
use super::panels::ask_for_menu;
use super::{files as file_work, parts};
use crate::app::canvas::overlay_of_picture;
use crate::app::features::statistics::Statistics;
use crate::app::features::stepping::Stepping;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, ShellCommand, ViewCommand};
use meshbrush_kit::kit::notices::Offer;
use meshbrush_kit::kit::{Ctx, EditRecorder, Features, PictureOverlays, Tool};

impl App {
    /// Runs one command.
    pub(super) fn execute(&mut self, command: Command, ctx: &Context) {
        let Some(command) = self.project.ask_before_leaving(command, &mut self.session, &self.background)
        else {
            return;
        };
        self.run(command, ctx);
        if self.tools.take_selection() {
            let tool = self.tools.chosen();
            self.view.dock.follow_tool(tool.name, tool.tab);
            self.put_down(ctx);
        }
    }

    /// Runs one command: one of the window itself, or else of a feature.
    fn run(&mut self, command: Command, egui: &Context) {
        if let Some(command) = command.get::<FileCommand>() {
            self.execute_on_files(command.clone(), egui);
        } else if let Some(command) = command.get::<EditCommand>() {
            self.execute_on_document(command.clone());
        } else if let Some(command) = command.get::<ViewCommand>() {
            self.view.execute(command.clone(), egui);
        } else if let Some(command) = command.get::<ShellCommand>() {
            self.execute_on_shell(command.clone(), egui);
        } else {
            let (features, mut ctx) = self.features_in_context(egui);
            let is_run = features.run(&command, &mut ctx);
            debug_assert!(is_run, "nothing runs {command:?}");
        }
    }

    /// Puts down what was begun with a tool. Returns whether there was something.
    fn put_down(&mut self, ctx: &Context) -> bool {
        let (features, mut of_window) = self.features_in_context(ctx);
        features.put_down(&mut of_window)
    }

    /// Returns the features, and what they see.
    pub(super) fn features_in_context<'a>(&'a mut self, egui: &'a Context) -> (&'a mut Features, Ctx<'a>) {
        let courant = self.features.get::<Statistics>().courant();
        let ctx = Ctx {
            session: &mut self.session,
            view: &mut self.view,
            tools: &mut self.tools,
            project: &mut self.project,
            journal: self.journal.as_mut().map(|keeper| keeper as &mut dyn EditRecorder),
            background: &mut self.background,
            layer_kinds: &LAYER_KINDS,
            jobs: &self.jobs,
            commands: &mut self.commands,
            egui,
            picture_overlay: PictureOverlays { maker: overlay_of_picture, courant },
            reproducible: self.reproducible,
        };
        (&mut self.features, ctx)
    }

    fn execute_on_document(&mut self, command: EditCommand) {
        match command {
            EditCommand::Undo => self.session.undo(),
            EditCommand::Redo => self.session.redo(),
            EditCommand::ClearPaint => self.session.document_mut().clear_paint(),
            EditCommand::Set(setting) => self.session.set(setting),
            EditCommand::EndGesture => self.session.end_gesture(),
            EditCommand::Consider(candidate) => self.session.consider(candidate),
            EditCommand::KeepMesh => _ = self.session.keep_mesh(),
            EditCommand::ApplyAnyway => self.session.apply_anyway(),
            EditCommand::CancelUpdate => self.session.cancel_update(),
        }
    }

    fn execute_on_shell(&mut self, command: ShellCommand, ctx: &Context) {
        match command {
            ShellCommand::Use(tool) => self.use_tool(tool),
            ShellCommand::Escape => self.escape(ctx),
            ShellCommand::Palette => self.dialogs.open(Dialog::Palette),
            ShellCommand::About => self.dialogs.open(Dialog::About),
            ShellCommand::AskPicture => self.dialogs.open(Dialog::Pictures),
            ShellCommand::AskPlace => self.dialogs.open(Dialog::GoTo),
            ShellCommand::AskPlaceNear(point) => {
                fill_in_place(ctx, self.view.typed_point(point));
                self.dialogs.open(Dialog::GoTo);
            }
            ShellCommand::AskRole(file) => self.dialogs.ask_role(file),
            ShellCommand::OpenMenu(menu) => ask_for_menu(ctx, menu),
            ShellCommand::MenuOfCanvas => {
                self.canvas.open_menu(ctx, &self.view, &self.tools, &self.session);
            }
            ShellCommand::CloseDialog => self.dialogs.close(),
            ShellCommand::ShowHelp(topic) => {
                stop_editing_keys(ctx);
                self.fetch(missing_pictures(topic), "A picture of the manual".into(), Vec::new());
                self.help = Some(topic);
            }
            ShellCommand::CloseHelp => {
                stop_editing_keys(ctx);
                self.help = None;
            }
            ShellCommand::LimitThreads(count) => self.limit_threads(count),
            ShellCommand::Report(failure) => self.session.report(failure),
            ShellCommand::Tell(news) => self.session.notices_mut().tell(news),
            ShellCommand::Offer(news, label, command) => {
                self.session.notices_mut().tell_with_offer(news, Offer { label, command: *command });
            }
            ShellCommand::DismissNotice => self.session.notices_mut().dismiss(),
            ShellCommand::FocusPart(by) => parts::focus(ctx, self.canvas.id(), by),
            ShellCommand::SetKeys(keymap) => self.keymap = keymap,
            ShellCommand::ExportKeysAs(path) => {
                let write = Command::from(ShellCommand::ExportKeys(path.clone()));
                self.commands.extend(self.project.ask_to_replace(vec![path], write));
            }
            ShellCommand::ExportKeys(path) => {
                file_work::export_keys(&self.keymap, &mut self.background, &path);
            }
            ShellCommand::ImportKeys(path) => file_work::import_keys(&mut self.background, &path),
            ShellCommand::Copy(text) => self.copy(text, ctx),
        }
    }

    /// Ends the steps. Else cancels what is in progress: the stroke, the edit that asks for very many
    /// triangles, the cut, or the rectangle or polygon. Else closes the help, or clears query and message.
    /// Else leaves the view in space.
    fn escape(&mut self, ctx: &Context) {
        if self.help.is_none() && self.features.get_mut::<Stepping>().leave(&mut self.tools) {
            return;
        }
        if self.session.document().stroke().is_some() {
            return self.session.document_mut().cancel_stroke();
        }
        if self.session.question().is_some() {
            self.session.keep_mesh();
            return;
        }
        let gesture_ended = self.canvas.end_gesture_on_escape();
        let in_gesture = self.session.document().is_in_gesture();
        if self.session.is_cutting() || (gesture_ended && in_gesture) {
            self.session.drop_cut();
        } else if !(self.put_down(ctx) || gesture_ended) && self.help.take().is_none() {
            if self.session.queried().is_none() && self.session.notices().shown().is_none() {
                self.view.leave_space();
            }
            self.session.query(None);
            self.session.notices_mut().dismiss();
        }
    }

    /// Selects a tool, for the mesh of the document.
    fn use_tool(&mut self, tool: Tool) {
        self.features.get_mut::<Stepping>().leave(&mut self.tools);
        self.tools.select(tool);
    }

    fn copy(&mut self, text: String, ctx: &Context) {
        self.session.tell(format!("Copied: {text}"));
        ctx.copy_text(text);
    }
}
