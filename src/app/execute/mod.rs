//! What each command does. A match arm is one call into the module that owns the data; no `match` has a
//! wildcard, so that a command without an arm does not compile.

#![deny(clippy::wildcard_enum_match_arm)]

mod corridor;
mod domain;
mod files;
mod keep_out;
mod layers;
mod painting;
mod steps;
mod paths;
mod query;
mod report;
mod threats;

use eframe::egui::Context;

use super::App;
use super::command::{Command, EditCommand, ShellCommand, StatisticsCommand};
use super::ctx::Feature;
use super::dialogs::Dialog;
use super::features::Features;
use super::tools::Tool;

impl App {
    /// Runs one command.
    pub(super) fn execute(&mut self, command: Command, ctx: &Context) {
        let Some(command) = self.project.ask_before_leaving(command, &mut self.session, &self.background)
        else {
            return;
        };
        match command {
            Command::File(command) => self.execute_on_files(command, ctx),
            Command::Edit(command) => self.execute_on_document(command),
            Command::Brush(command) => self.execute_on_brush(command),
            Command::Layer(command) => self.execute_on_layers(command, ctx),
            Command::Threats(command) => self.execute_on_threats(command),
            Command::Domain(command) => self.execute_on_domain(command),
            Command::Boundary(command) => self.run(|features| &mut features.boundary, command, ctx),
            Command::Picture(command) => self.run(|features| &mut features.picture, command, ctx),
            Command::Path(command) => self.execute_on_paths(command),
            Command::Pins(command) => self.run(|features| &mut features.pins, command, ctx),
            Command::Inspect(command) => self.execute_on_query(command, ctx),
            Command::Statistics(StatisticsCommand::Measure) => self.session.measure(&self.jobs),
            Command::Plots(command) => self.run(|features| &mut features.plots, command, ctx),
            Command::Figure(command) => self.execute_on_report(command, ctx),
            Command::Steps(command) => self.execute_on_steps(command, ctx),
            Command::View(command) => self.view.execute(command, ctx),
            Command::Shell(command) => self.execute_on_shell(command, ctx),
        }
    }

    /// Runs a command of a feature.
    fn run<F: Feature>(&mut self, feature: fn(&mut Features) -> &mut F, command: F::Command, ctx: &Context) {
        let (features, mut ctx) = self.features(ctx);
        feature(features).execute(command, &mut ctx);
    }

    fn execute_on_document(&mut self, command: EditCommand) {
        match command {
            EditCommand::Undo => self.keep_brush_share(|app| app.session.undo()),
            EditCommand::Redo => self.keep_brush_share(|app| app.session.redo()),
            EditCommand::ClearPaint => self.session.document_mut().clear_paint(),
            EditCommand::Set(setting) => self.session.set(setting),
            EditCommand::EndGesture => self.session.end_gesture(),
            EditCommand::CancelUpdate => self.session.cancel_update(),
        }
    }

    fn execute_on_shell(&mut self, command: ShellCommand, ctx: &Context) {
        match command {
            ShellCommand::Use(tool) => self.use_tool(tool),
            ShellCommand::Escape => self.escape(),
            ShellCommand::Palette => self.dialogs.open(Dialog::Palette),
            ShellCommand::About => self.dialogs.open(Dialog::About),
            ShellCommand::CloseDialog => self.dialogs.close(),
            ShellCommand::ShowHelp(topic) => self.help = Some(topic),
            ShellCommand::CloseHelp => self.help = None,
            ShellCommand::LimitThreads(count) => self.limit_threads(count),
            ShellCommand::Report(failure) => self.session.report(failure),
            ShellCommand::Tell(news) => self.session.notices_mut().tell(news),
            ShellCommand::DismissNotice => self.session.notices_mut().dismiss(),
            ShellCommand::Copy(text) => self.copy(text, ctx),
        }
    }

    /// Ends the steps. Else cancels what is in progress: the stroke, the cut, or the rectangle or polygon.
    /// Else closes the help, or clears query and message.
    fn escape(&mut self) {
        if self.help.is_none() && self.stepping.take().is_some() {
            return;
        }
        if self.session.document().stroke().is_some() {
            return self.session.document_mut().cancel_stroke();
        }
        let gesture_ended = self.canvas.end_gesture_on_escape();
        let in_gesture = self.session.document().is_in_gesture();
        if self.session.is_cutting() || (gesture_ended && in_gesture) {
            self.session.drop_cut();
        } else if gesture_ended || !self.tools.domain.corners.is_empty() || self.tools.path.pending.is_some()
        {
            self.tools.domain.corners.clear();
            self.tools.path.pending = None;
        } else if self.help.take().is_none() {
            self.ask(None);
            self.session.notices_mut().dismiss();
        }
    }

    /// Selects a tool, for the mesh of the document.
    fn use_tool(&mut self, tool: Tool) {
        self.stepping = None;
        self.tools.select(tool);
    }

    fn copy(&mut self, text: String, ctx: &Context) {
        self.session.tell(format!("Copied: {text}"));
        ctx.copy_text(text);
    }
}
