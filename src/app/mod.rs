//! The window: panels, canvas, painting and commands.
//!
//! The app holds a few structs: the [`Session`] (document and mesh), the document's file, the [`Tools`], the
//! [`View`], the [`Canvas`] and the open dialog. Everything that happens is a [`Command`]; `frame` says when
//! commands run and when things are drawn, `execute` what a command does. Tools, panels and export formats
//! are tables with a file for each entry.

mod ages;
mod background;
mod boundary;
mod brake;
mod busy;
mod canvas;
mod catalog;
pub mod command;
mod contours;
mod cuts;
mod derivation;
mod dialogs;
mod dock;
mod document_id;
mod execute;
mod features;
mod file_kinds;
mod files;
mod frame;
mod frame_log;
mod heights;
mod help;
mod home;
mod jobs;
mod journal;
mod kept_keys;
mod keys;
mod kit;
mod layer_edits;
mod notices;
mod panels;
mod parts;
mod presentation;
mod project;

pub mod readout;
mod replacing;
mod screenshots;
pub mod session;
mod size_change;
mod slices;
mod software_window;
mod space;
#[cfg(test)]
mod tests;
pub mod theme;
mod threads;
pub mod tools;
pub mod view;
pub mod widgets;

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{self, Context, Ui, vec2};
use eframe::egui_wgpu;

use background::Background;
use canvas::{Canvas, CanvasGpu};
use command::{Command, FileCommand};
use dialogs::Dialogs;
use features::Features;
use frame_log::FrameLog;
use help::HelpTopic;
use jobs::Jobs;
use journal::JournalKeeper;
use kit::Keymap;
use project::ProjectFile;
pub use screenshots::{write as write_screenshots, write_manual as write_manual_pictures, write_tour};
use session::Session;
use threads::Threads;
use tools::Tools;
use view::View;

use meshbrush_core::document::{Document, Example};
use meshbrush_render::render::gpu::device_descriptor;

/// How long a window that is being closed waits for files that are being written.
const LAST_WAIT: Duration = Duration::from_secs(5);
/// Identifies the window to the desktop: the name of the desktop entry in `packaging`.
const APP_ID: &str = "org.meshbrush.Meshbrush";
/// The name of the program's folder among the user's data.
const DATA_FOLDER: &str = "meshbrush";
/// Key of the theme in the window's own storage.
const THEME_KEY: &str = "theme";
/// Key of the number of threads in the window's own storage, where they are limited.
const THREADS_KEY: &str = "threads";
/// The title of the report, for texts that a person reads.
const REPORT: &str = "Mesh Generation via Local Bisection Refinement of Triangulated Grids";
/// Initial size of the window, in points: it fits a screen of 1440 × 900 with its frame.
const FIRST_SIZE: [f32; 2] = [1360.0, 800.0];
/// Size of the window in screenshots, in points.
const WINDOW_SIZE: [f32; 2] = [1440.0, 900.0];
/// Size below which the panels no longer fit, in points. A screen of 1920 × 1080 pixels at 200 % has
/// 960 × 540 points, less the frame and the bar of the desktop.
const SMALLEST_SIZE: [f32; 2] = [800.0, 460.0];

/// The program in its window.
pub struct App {
    session: Session,
    project: ProjectFile,
    tools: Tools,
    view: View,
    canvas: Canvas,
    features: Features,
    /// Keys that differ from those that entries have by themselves.
    keymap: Keymap,
    /// The text of stored keys that could not be read.
    unread_keys: Option<String>,
    threads: Threads,
    dialogs: Dialogs,
    /// The contents of the help window, while it is open.
    help: Option<HelpTopic>,
    jobs: Jobs,
    background: Background,
    /// Absent in tests and screenshots.
    journal: Option<JournalKeeper>,
    /// Commands for the next frame.
    commands: Vec<Command>,
    /// Whether the file that the program was started with is being read.
    starts_with_file: bool,
    /// The time of the last input that was handled.
    input_time: Option<f64>,
    /// Whether to leave out what differs from run to run: pictures must be the same every time.
    reproducible: bool,
    frame_log: FrameLog,
}

impl App {
    /// Returns the app on its first example. Without a `render_state` (in tests) the canvas stays empty.
    ///
    /// # Errors
    /// Fails when the graphics driver cannot draw a mesh.
    pub fn new(ctx: &Context, render_state: Option<&egui_wgpu::RenderState>) -> Result<Self, String> {
        Self::with_document(ctx, render_state, files::example(Example::ALL[0]))
    }

    /// Returns the app on a file, which is being read: until then the canvas stays empty.
    fn with_file(
        ctx: &Context,
        render_state: Option<&egui_wgpu::RenderState>,
        file: PathBuf,
    ) -> Result<Self, String> {
        let mut app = Self::with_document(ctx, render_state, files::new_document())?;
        app.starts_with_file = true;
        app.send(Command::File(FileCommand::Open(file)));
        Ok(app)
    }

    fn with_document(
        ctx: &Context,
        render_state: Option<&egui_wgpu::RenderState>,
        document: Document,
    ) -> Result<Self, String> {
        theme::install(ctx);
        ctx.add_plugin(widgets::VanishedButtons::default());
        let mut view = View::default();
        view.set_theme(view.theme, ctx);
        let session = Session::new(document).map_err(|error| error.to_string())?;
        let settings = session.document().settings();
        let extent = settings.domain.bounds.size().max_element();
        let tools = Tools::for_domain(extent, settings.transfer.h_min);
        view.dock.follow_tool(tools.tool);
        let jobs = Jobs::new(ctx);
        let gpu = render_state.map(CanvasGpu::new).transpose().map_err(|error| error.to_string())?;
        Ok(Self {
            project: ProjectFile::new(session.document().version()),
            session,
            tools,
            view,
            canvas: Canvas::new(gpu, &jobs),
            features: Features::default(),
            keymap: Keymap::default(),
            unread_keys: None,
            threads: Threads::default(),
            dialogs: Dialogs::default(),
            help: None,
            background: Background::new(ctx, &jobs),
            jobs,
            journal: None,
            commands: Vec::new(),
            starts_with_file: false,
            input_time: None,
            reproducible: false,
            frame_log: FrameLog::from_environment(),
        })
    }

    /// Keeps recent files, the theme and unsaved work from run to run.
    fn keep_in(&mut self, cc: &eframe::CreationContext<'_>) {
        if let Some(storage) = cc.storage {
            self.project.load(storage);
            self.dialogs.load(storage);
            self.view.dock.load(storage);
            let theme = eframe::get_value(storage, THEME_KEY).unwrap_or(self.view.theme);
            self.view.set_theme(theme, &cc.egui_ctx);
            presentation::end_last(storage, &cc.egui_ctx);
            self.load_keys(storage);
            if let Some(Some(count)) = eframe::get_value(storage, THREADS_KEY) {
                self.limit_threads(count);
            }
        }
        if let Some(folder) = eframe::storage_dir(DATA_FOLDER) {
            self.keep_journal_in(folder.join("journals"));
            self.project.keep_claims_in(folder.join("open"));
        }
    }

    /// Keeps unsaved work in a folder from now on, and offers what earlier runs left there.
    fn keep_journal_in(&mut self, folder: PathBuf) {
        self.journal = Some(JournalKeeper::new(folder, &self.jobs));
    }

    /// Computes on so many threads from now on, or on as many as there may be.
    fn limit_threads(&mut self, count: NonZeroUsize) {
        self.threads = Threads::new(count);
        self.background.limit_threads(count);
    }

    /// Shows the same on every machine from now on: no times, and the mesh drawn in software.
    fn be_reproducible(&mut self) {
        self.reproducible = true;
        self.jobs.wait_for_all();
        self.canvas.draw_in_software();
    }

    /// Sends a command, to be run in the next frame.
    fn send(&mut self, command: Command) {
        self.commands.push(command);
    }
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &Context, _frame: &mut eframe::Frame) {
        self.advance(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.draw(ui);
        self.frame_log.note(&self.session);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.project.store(storage);
        self.dialogs.store(storage);
        self.store_keys(storage);
        eframe::set_value(storage, THEME_KEY, &self.view.theme);
        self.view.dock.store(storage);
        presentation::store(self.view.presentation, storage);
        eframe::set_value(storage, THREADS_KEY, &self.threads.limit());
    }

    fn on_exit(&mut self) {
        let deadline = Instant::now() + LAST_WAIT;
        let left = || deadline.saturating_duration_since(Instant::now());
        while !left().is_zero() && self.background.wait_for_writing(left()) {
            while self.finish_next_work() {}
        }
        // Where the desktop closes the window, the user was not asked.
        let remove = self.project.may_leave(&self.session);
        if let Some(keeper) = &mut self.journal {
            keeper.end(remove, &self.jobs);
        }
    }
}

/// Opens the window on a file or on the first example, and returns when it is closed.
///
/// # Errors
/// Fails with a sentence when there is no display or no usable graphics driver.
pub fn run(file: Option<PathBuf>) -> Result<(), String> {
    let mut options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Meshbrush")
            .with_app_id(APP_ID)
            .with_icon(window_icon())
            .with_inner_size(FIRST_SIZE)
            .with_min_inner_size(vec2(SMALLEST_SIZE[0], SMALLEST_SIZE[1])),
        persistence_path: eframe::storage_dir(DATA_FOLDER).map(|folder| folder.join("app.ron")),
        ..eframe::NativeOptions::default()
    };
    if let egui_wgpu::WgpuSetup::CreateNew(setup) = &mut options.wgpu_options.wgpu_setup {
        setup.device_descriptor = Arc::new(device_descriptor);
    }
    let create = |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        let (ctx, render_state) = (&cc.egui_ctx, cc.wgpu_render_state.as_ref());
        let mut app = match file {
            Some(file) => App::with_file(ctx, render_state, file)?,
            None => App::new(ctx, render_state)?,
        };
        if let Some(window) = app.canvas.software_window() {
            ctx.add_plugin(window);
        }
        app.dialogs.use_system();
        app.keep_in(cc);
        Ok(Box::new(app))
    };
    eframe::run_native(APP_ID, options, Box::new(create)).map_err(failure_to_open)
}

fn window_icon() -> egui::IconData {
    let icon = include_bytes!("../../assets/icon.png");
    eframe::icon_data::from_png_bytes(icon).unwrap_or_default()
}

/// The message where nothing can be drawn.
const NO_DRIVER: &str = "There is no usable graphics driver. Install a Vulkan or OpenGL driver, for example the package \
                         mesa-vulkan-drivers, or use the command line: meshbrush mesh --help.";

/// Returns the message when the window did not open.
fn failure_to_open(error: eframe::Error) -> String {
    match error {
        eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => {
            "There is no display to open a window on. Set DISPLAY or WAYLAND_DISPLAY, or use the command line: \
             meshbrush mesh --help."
                .into()
        }
        eframe::Error::Wgpu(_) => NO_DRIVER.into(),
        other => format!("The window could not be opened: {other}."),
    }
}
