//! The window: panels, canvas, painting and commands.
//!
//! The app holds a few structs: the [`Session`] (document and mesh), the document's file, the [`Tools`], the
//! [`View`], the [`Canvas`] and the open dialog. Everything that happens is a [`Command`]; `frame` says when
//! commands run and when things are drawn, `execute` what a command does. Tools, panels and export formats
//! are tables with a file for each entry.

mod canvas;
mod catalog;
mod contours;
#[cfg(not(target_family = "wasm"))]
mod desktop;
mod dialogs;
mod execute;
mod features;
mod file_kinds;
mod files;
mod frame;
mod frame_log;
mod help;
mod kept;
mod kept_keys;
mod keys;
mod link;
mod next_document;
mod panels;
mod parts;

mod replacing;
mod screenshots;
mod software_window;
mod spare_memory;
#[cfg(test)]
mod tests;
#[cfg(target_family = "wasm")]
mod web;

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::{Context, Ui};
use eframe::egui_wgpu;

use canvas::{Canvas, CanvasGpu};
#[cfg(not(target_family = "wasm"))]
use desktop as host;
use dialogs::{Dialogs, ExportMeasurer};
use features::ROWS;
use frame_log::FrameLog;
use host::journal;
pub use host::run;
use journal::JournalKeeper;
use kept::StoredBrush;
use meshbrush_kit::kit::background::Background;
use meshbrush_kit::kit::clock::{Duration, Instant};
use meshbrush_kit::kit::command::HelpTopic;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::jobs::Jobs;
use meshbrush_kit::kit::platform::IS_PAGE;
use meshbrush_kit::kit::project::ProjectFile;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::threads::Threads;
use meshbrush_kit::kit::tools::Tools;
use meshbrush_kit::kit::view::View;
use meshbrush_kit::kit::{Features, Keymap, all_tools};
pub use screenshots::{write as write_screenshots, write_manual as write_manual_pictures, write_tour};
use spare_memory::SpareMemory;
#[cfg(target_family = "wasm")]
use web as host;

use meshbrush_core::document::{Document, Example};
use meshbrush_render::render::gpu::device_descriptor;
use meshbrush_ui::{theme, widgets};

/// How long a window that is being closed waits for files that are being written.
const LAST_WAIT: Duration = Duration::from_secs(5);
/// Key of the theme in the window's own storage.
const THEME_KEY: &str = "theme";
/// Key of the number of threads in the window's own storage, where they are limited.
const THREADS_KEY: &str = "threads";
/// The title of the report, for texts that a person reads.
const REPORT: &str = "Mesh Generation via Local Bisection Refinement of Triangulated Grids";
/// The message where nothing can be drawn.
const NO_DRIVER: &str = "There is no usable graphics driver. Install a Vulkan or OpenGL driver, for example the package \
                         mesa-vulkan-drivers, or use the command line: meshbrush mesh --help.";
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
    /// The brush as the window's own storage has it.
    stored_brush: Option<StoredBrush>,
    /// What the files of an export will have in them.
    export_figures: ExportMeasurer,
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
    /// Absent in tests and screenshots.
    spare_memory: Option<SpareMemory>,
    /// Commands for the next frame.
    commands: Vec<Command>,
    /// Whether the file that the program was started with is being read.
    starts_with_file: bool,
    /// Whether this frame left the mesh to the next one, because it had worked for long before.
    leaves_mesh: bool,
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

    /// Returns the app in a window of the system, on a file or on its first example.
    fn in_window(cc: &eframe::CreationContext<'_>, file: Option<PathBuf>) -> Result<Self, String> {
        let (ctx, render_state) = (&cc.egui_ctx, cc.wgpu_render_state.as_ref());
        let mut app = match file {
            Some(file) => Self::with_file(ctx, render_state, file)?,
            None => Self::new(ctx, render_state)?,
        };
        // In a page the browser draws the panels: it shows pictures of the whole window late.
        let window = if IS_PAGE { None } else { app.canvas.software_window() };
        if let Some(window) = window {
            ctx.add_plugin(window);
        }
        app.dialogs.use_system();
        app.keep_in(cc);
        app.spare_memory = Some(SpareMemory::default());
        Ok(app)
    }

    /// Returns the app on a file, which is being read: until then the canvas stays empty.
    fn with_file(
        ctx: &Context,
        render_state: Option<&egui_wgpu::RenderState>,
        file: PathBuf,
    ) -> Result<Self, String> {
        let mut app = Self::with_document(ctx, render_state, files::new_document())?;
        app.starts_with_file = true;
        app.send(Command::from(FileCommand::OpenFirst(file)));
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
        let tools = Tools::for_domain(all_tools(ROWS), extent, settings.transfer.h_min);
        view.dock.follow_tool(tools.tool.name, tools.tool.tab);
        let jobs = Jobs::new(ctx);
        let gpu = render_state.map(CanvasGpu::new).transpose().map_err(|error| error.to_string())?;
        Ok(Self {
            project: ProjectFile::new(session.document().version()),
            session,
            tools,
            view,
            canvas: Canvas::new(gpu, &jobs),
            features: features::all(),
            keymap: Keymap::default(),
            unread_keys: None,
            threads: Threads::default(),
            dialogs: Dialogs::default(),
            help: None,
            background: Background::new(ctx, &jobs),
            jobs,
            journal: None,
            spare_memory: None,
            stored_brush: None,
            export_figures: ExportMeasurer::default(),
            commands: Vec::new(),
            starts_with_file: false,
            leaves_mesh: false,
            input_time: None,
            reproducible: false,
            frame_log: FrameLog::from_environment(),
        })
    }

    /// Keeps recent files, the theme and unsaved work from run to run.
    fn keep_in(&mut self, cc: &eframe::CreationContext<'_>) {
        if let Some(storage) = cc.storage {
            kept::load_recent(&mut self.project, storage);
            self.dialogs.load(storage);
            kept::load_tab(&mut self.view.dock, storage);
            kept::load_coordinates(&mut self.view, storage);
            kept::load_file_coordinates(&mut self.view, storage);
            kept::load_pictures(&mut self.view, storage);
            kept::load_courant(&mut self.features, storage);
            let theme = eframe::get_value(storage, THEME_KEY).unwrap_or(self.view.theme);
            self.view.set_theme(theme, &cc.egui_ctx);
            kept::end_last_presentation(storage, &cc.egui_ctx);
            self.load_keys(storage);
            self.load_brush(storage);
            if let Some(Some(count)) = eframe::get_value(storage, THREADS_KEY) {
                self.limit_threads(count);
            }
        }
        if let Some(folder) = host::data_folder() {
            self.keep_journal_in(folder.join("journals"));
            self.project.keep_claims_in(folder.join("open"));
        }
    }

    /// Takes the brush of the last run.
    fn load_brush(&mut self, storage: &dyn eframe::Storage) {
        kept::load_brush(&mut self.tools, storage);
        self.stored_brush = Some(StoredBrush::of(&self.tools));
    }

    /// Keeps the brush once it has changed, also if the program is killed: what else is in the storage is
    /// written at times, and at the end.
    fn store_brush(&mut self, storage: &mut dyn eframe::Storage) {
        if self.stored_brush.as_ref().is_none_or(|stored| stored.differs_from(&self.tools)) {
            self.stored_brush = Some(StoredBrush::of(&self.tools));
            kept::store_brush(&self.tools, storage);
            storage.flush();
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

/// Opens a device with all that its adapter can do.
fn set_up_gpu(wgpu: &mut egui_wgpu::WgpuConfiguration) {
    if let egui_wgpu::WgpuSetup::CreateNew(setup) = &mut wgpu.wgpu_setup {
        setup.device_descriptor = Arc::new(device_descriptor);
    }
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &Context, frame: &mut eframe::Frame) {
        self.advance(ctx);
        if let Some(spare_memory) = &mut self.spare_memory {
            spare_memory.note_frame(ctx, &self.session, &self.jobs);
        }
        if let Some(storage) = frame.storage_mut().filter(|_| !ctx.input(|input| input.pointer.any_down())) {
            self.store_brush(storage);
        }
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.draw(ui);
        self.frame_log.note(&self.session);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        kept::store_recent(&self.project, storage);
        self.dialogs.store(storage);
        self.store_keys(storage);
        eframe::set_value(storage, THEME_KEY, &self.view.theme);
        kept::store_tab(&self.view.dock, storage);
        kept::store_coordinates(&self.view, storage);
        kept::store_file_coordinates(&self.view, storage);
        kept::store_pictures(&self.view, storage);
        kept::store_courant(&self.features, storage);
        kept::store_presentation(self.view.presentation, storage);
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
