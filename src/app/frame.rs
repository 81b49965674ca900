//! One frame: first everything changes, then everything is drawn.
//!
//! ```text
//! advance   what jobs have sent
//!           outcomes of work on files ─┐
//!           commands sent before ──────┤
//!           keys, dropped files ───────┼─→ commands, run one by one ─→ cuts, stroke, mesh, price, journal
//!           pointer on the canvas ─────┘
//! draw      panels ─→ canvas ─→ dialogs; they read a FrameState and send commands for the next frame
//! ```
//!
//! `advance` also runs while the window is hidden or the canvas has no room. The pointer acts on the canvas
//! where it was in the last frame, and the mesh that it changed is drawn in the same frame.

use crate::app::features::report::Report;
use crate::app::features::stepping::Stepping;
use meshbrush_kit::kit::clock::{Duration, Instant};

use eframe::egui::{self, Context, Event, Frame, Key, KeyboardShortcut, Modifiers, Popup, Ui};

use super::App;
use super::canvas::Toast;
use super::catalog::catalog;
use super::dialogs::FileFacts;
use super::features::{LAYER_KINDS, stepping};
use super::host;
use super::journal::JournalKeeper;
use super::keys::{KeyPress, Receiver};
use super::{help, journal, keys, panels, replacing};
use meshbrush_core::document::Settings;
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_kit::kit::platform::IS_PAGE;
use meshbrush_kit::kit::presentation;
use meshbrush_kit::kit::readout::Readout;
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu, NO_LIMIT, shortcut_text};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::{degrees, shown_keys};

/// The least time of a frame that goes into updating the mesh, and the most into the price of a stroke.
const FRAME_BUDGET: Duration = Duration::from_millis(7);
/// The most time for the price in a frame while the pointer moves and no GPU draws: frames should be short
/// then. The price is completed once the pointer rests.
const PRICE_BUDGET_IN_MOTION: Duration = Duration::from_millis(2);
/// The share of a frame's time, and the most time, for work on the mesh where drawing is slow, for example
/// without a GPU. A fixed 7 ms of a frame of 100 ms would leave the mesh far behind.
const SLOW_FRAME_SHARE: (f32, Duration) = (1.0 / 3.0, Duration::from_millis(40));
/// The share and the most time for work on the mesh where drawing is slow and the pointer draws nothing. The
/// mesh should be complete soon, and nobody waits for the next frame.
const SLOW_FRAME_SHARE_AT_REST: (f32, Duration) = (0.6, Duration::from_millis(60));
/// The most time for jobs and the mesh together in a page, and the least for the mesh: drawing comes after
/// them, and a browser does nothing else meanwhile.
const MOST_IN_PAGE: Duration = Duration::from_millis(14);
const LEAST_IN_PAGE: Duration = Duration::from_millis(4);
/// Where frames do the work of jobs, one that has worked this long already leaves the mesh to the next one.
const LONG_BEFORE_MESH: Duration = Duration::from_millis(12);

/// Returns whether a command moves the focus between parts of the window.
fn is_for_parts(command: &Command) -> bool {
    matches!(command.get(), Some(ShellCommand::FocusPart(_)))
}

impl App {
    /// The first half of a frame: everything that changes.
    pub(super) fn advance(&mut self, ctx: &Context) {
        let began = Instant::now();
        self.jobs.begin_frame(ctx.input(|input| input.time));
        // Commands of the last frame come first: they may open another document. What a file becomes is done
        // before the next file is looked at, for the same reason.
        self.run_commands(ctx);
        while self.finish_next_work() {
            self.run_commands(ctx);
        }
        self.jobs.take_problems().into_iter().for_each(|problem| self.session.report(problem));
        if let Some(problem) = self.journal.as_mut().and_then(JournalKeeper::offer_next) {
            self.session.report(problem);
        }
        let close = self.project.handle_close_request(&mut self.session, &self.background, ctx);
        self.commands.extend(close);
        self.take_chosen_file();
        self.take_input(ctx);
        self.run_commands(ctx);
        self.project.forget_saving(&self.background, self.dialogs.asks_for_file());
        self.project.set_window_title(&self.session, ctx);
        self.follow(ctx, began);
        self.record_edits();
        self.background.keep_awake();
    }

    /// Turns the input of this frame into commands, once: egui keeps the input while the window is hidden.
    ///
    /// The commands of an event run before the next event is handled. So a click after a key uses the tool
    /// that the key selected, also where a slow frame brings both.
    fn take_input(&mut self, ctx: &Context) {
        let time = ctx.input(|input| input.time);
        if self.input_time.replace(time) == Some(time) {
            return;
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        self.commands.extend(host::take_dropped(&dropped, &mut self.background, &self.jobs));
        self.commands.extend(host::take_pen());
        let events = ctx.input(|input| input.events.clone());
        let mut used_keys = Vec::new();
        for (index, event) in events.iter().enumerate() {
            self.run_commands(ctx);
            if self.run_key(event, ctx) {
                used_keys.push(index);
            }
            let session = &self.session;
            self.canvas.take_event(event, ctx, &mut self.view, &self.tools, session, &mut self.commands);
        }
        // Widgets must not act on these keys again.
        for index in used_keys.into_iter().rev() {
            ctx.input_mut(|input| input.events.remove(index));
        }
        self.run_commands(ctx);
        self.canvas.take_state(ctx, &mut self.view, &self.tools, &self.session, &mut self.commands);
    }

    /// Runs the command of a key, or says that it cannot be run now. Returns whether the key belongs to an
    /// entry: widgets must not act on it, too.
    pub(super) fn run_key(&mut self, event: &Event, ctx: &Context) -> bool {
        let press = match *event {
            Event::Key { key, physical_key, pressed: true, modifiers, .. } => {
                KeyPress { key, physical_key, modifiers }
            }
            // Ctrl+C reaches the window as this event only.
            Event::Copy => KeyPress { key: Key::C, physical_key: None, modifiers: Modifiers::COMMAND },
            _ => return false,
        };
        // A menu or a dialog takes Escape and Enter itself.
        if self.asks_something() || Popup::is_any_open(ctx) || help::takes_next_key(ctx) {
            return false;
        }
        let mut catalog = catalog(&self.state(None));
        if self.help.is_some() {
            // Nothing behind the help receives keys.
            let escape = Command::from(ShellCommand::Escape);
            catalog.retain(|item| {
                item.menu == Menu::Help || item.command == escape || is_for_parts(&item.command)
            });
        }
        let receiver = Receiver::of(ctx, self.canvas.id());
        let Some(entry) = keys::entry_of(press, receiver, &catalog) else { return false };
        let pressed = shortcut_text(&KeyboardShortcut::new(press.modifiers, press.key));
        let now = ctx.input(|input| input.time);
        if !entry.enabled {
            self.canvas.tell(Toast::new(format!("{pressed}: “{}” is not possible now", entry.title), now));
            return true;
        }
        let before = self.tools.clone();
        self.commands.push(entry.command.clone());
        self.run_commands(ctx);
        if self.tools.differs_in_choice(&before) {
            self.canvas.tell(Toast::new(format!("{pressed}: {}", self.done(entry)), now));
        }
        true
    }

    /// Returns the effect of an entry that was just run: its title, with on or off where it is a switch.
    fn done(&self, entry: &CatalogItem) -> String {
        let now = catalog(&self.state(None)).into_iter().find(|item| item.id == entry.id);
        match now {
            Some(now) if entry.checked && !now.checked => format!("{} – off", now.title),
            _ => entry.title.clone(),
        }
    }

    /// Runs all commands, and those that they send.
    fn run_commands(&mut self, ctx: &Context) {
        while !self.commands.is_empty() {
            for command in std::mem::take(&mut self.commands) {
                self.execute(command, ctx);
            }
        }
    }

    /// Brings the mesh and the price of a stroke closer to the document, until the time of the frame, which
    /// began then, is spent.
    fn follow(&mut self, ctx: &Context, began: Instant) {
        // With a time limit, what is shown on the way would depend on the machine's speed.
        let [budget, price_budget] =
            if self.reproducible { [NO_LIMIT; 2] } else { [self.mesh_budget(ctx), self.price_budget(ctx)] };
        let jobs = &self.jobs;
        let start = Instant::now();
        let deadline = if IS_PAGE { (began + budget).max(start + LEAST_IN_PAGE) } else { start + budget };
        let cuts = self.session.advance_cuts(jobs);
        let bounds = self.session.document().settings().domain.bounds;
        self.tools.follow_extent(bounds.size().max_element());
        let is_late =
            self.jobs.is_without_threads() && !self.reproducible && began.elapsed() > LONG_BEFORE_MESH;
        self.leaves_mesh = is_late && !self.leaves_mesh;
        let follows = self.leaves_mesh || self.session.follow(&self.threads, deadline);
        let derives = self.session.advance_derivation(jobs);
        let derives = derives | self.session.find_heights(self.view.space.is_on, jobs);
        // Pieces of the boundary can be gone to by their names.
        let derives = derives | (self.dialogs.asks_for_place() && self.session.find_boundary(jobs));
        self.view.follow_heights(&self.session);
        let (features, mut of_window) = self.features_in_context(ctx);
        let features_work = features.follow(&mut of_window);
        let plan = self.canvas.planned_stroke(ctx, &self.tools, bounds);
        let plan = plan.filter(|_| !self.asks_something());
        let prices = self.session.price_stroke(plan, start + price_budget);
        let prices = prices | self.session.price_setting(start + price_budget);
        self.canvas.note_work(&self.session);
        if cuts || follows || derives || features_work || prices {
            ctx.request_repaint();
        }
    }

    /// Returns how much time of this frame goes into the mesh.
    fn mesh_budget(&self, ctx: &Context) -> Duration {
        let draws = ctx.input(|input| input.pointer.any_down());
        let (share, most) = if draws { SLOW_FRAME_SHARE } else { SLOW_FRAME_SHARE_AT_REST };
        let most = if IS_PAGE { most.min(MOST_IN_PAGE) } else { most };
        let frame_time = ctx.input(|input| input.stable_dt);
        Duration::from_secs_f32(share * frame_time.clamp(0.0, 1.0)).clamp(FRAME_BUDGET, most)
    }

    /// Returns how much time of this frame goes into the price of a stroke.
    fn price_budget(&self, ctx: &Context) -> Duration {
        let is_moving = ctx.input(|input| input.pointer.is_moving());
        if is_moving && self.canvas.draws_in_software() { PRICE_BUDGET_IN_MOTION } else { FRAME_BUDGET }
    }

    /// The second half of a frame: everything that is drawn.
    pub(super) fn draw(&mut self, ui: &mut Ui) {
        let readout = self.session.readout(self.view.quantity);
        let mut commands = Vec::new();
        let entries = catalog(&self.state(None));
        let keys = entries.iter().filter_map(|item| Some((item.id.clone(), item.shown_keys()?)));
        shown_keys::publish(ui.ctx(), keys.collect());
        let Settings { unit, domain, .. } = self.session.document().settings();
        let latitude = (*unit == LengthUnit::Degree).then(|| domain.bounds.center().y);
        degrees::publish_latitude(ui.ctx(), latitude);
        if let Some(panel) = self.view.revealed_panel.and_then(panels::named) {
            self.view.dock.choose(panel.tab);
        }
        let status = panels::show(ui, &self.state(readout.as_ref()), &entries, &mut commands);
        self.view.revealed_panel = None;
        egui::CentralPanel::default()
            .frame(Frame::NONE)
            .show(ui, |ui| self.draw_canvas(ui, readout.as_ref(), &mut commands));
        if let Some(place) = status {
            panels::show_status(ui, place, &self.state(readout.as_ref()));
        }
        self.draw_dialogs(ui.ctx(), &mut commands);
        if self.view.presentation.is_some() {
            presentation::paint_pointer_ring(ui.ctx());
        }
        if !commands.is_empty() {
            // They run in the next frame.
            ui.ctx().request_repaint();
            self.commands.extend(commands);
        }
    }

    fn draw_canvas(&mut self, ui: &mut Ui, readout: Option<&Readout>, commands: &mut Vec<Command>) {
        let Some(response) = self.canvas.layout(ui, &mut self.view, self.session.mesh().lattice()) else {
            return;
        };
        let shows_step =
            self.features.get::<Stepping>().steps().is_some_and(|steps| steps.player().is_some());
        if !self.starts_with_file && !shows_step {
            self.canvas.draw_mesh(ui, &mut self.session, &self.view, commands);
        } else {
            self.canvas.draw_ground(ui);
        }
        let files = self.background.rows(self.project.is_leaving());
        let state = self.state(readout);
        if shows_step {
            stepping::paint(ui, &response, &state, self.features.get::<Report>().figure());
        } else {
            self.canvas.draw_marks(ui, &response, &state);
        }
        let floats = self.canvas.draw_floats(ui, &response, &state, &files, commands);
        self.canvas.note_floats(floats);
    }

    fn draw_dialogs(&mut self, ctx: &Context, commands: &mut Vec<Command>) {
        if self.dialogs.asks_for_file() {
            let reads: Vec<_> = self.background.rows(true).into_iter().filter(|row| row.reads).collect();
            let format = self.dialogs.export_format();
            if let Some(format) = format {
                self.export_figures.follow(&self.session, &self.view, format, &self.jobs);
            }
            let facts = FileFacts {
                triangles: self.session.triangle_count(),
                figures: format.and_then(|format| self.export_figures.of(&self.session, &self.view, format)),
                settings: self.session.document().settings(),
                view: &self.view,
                reads: &reads,
            };
            self.dialogs.show_file(ctx, &facts, commands);
        }
        let state = self.state(None);
        if let Some(keeper) = &self.journal {
            journal::question(ctx, keeper, &self.project, commands);
        }
        replacing::questions(ctx, &state, self.dialogs.asks_for_file(), commands);
        if let Some(topic) = self.help {
            help::show(ctx, topic, &catalog(&state), &self.keymap, commands);
        }
        if self.dialogs.is_open() {
            self.dialogs.show(ctx, &state, commands);
        }
    }

    pub(super) fn state<'a>(&'a self, readout: Option<&'a Readout>) -> FrameState<'a> {
        FrameState {
            session: &self.session,
            project: &self.project,
            tools: &self.tools,
            view: &self.view,
            keymap: &self.keymap,
            features: &self.features,
            layer_kinds: &LAYER_KINDS,
            threads: &self.threads,
            pointer: self.canvas.pointer(),
            readout,
            reproducible: self.reproducible,
        }
    }

    /// Returns whether a dialog or a question is open, which takes the keys.
    pub(super) fn asks_something(&self) -> bool {
        let restoring = self.journal.as_ref().is_some_and(|keeper| keeper.is_asking());
        self.dialogs.is_open() || self.project.is_asking() || restoring
    }
}
