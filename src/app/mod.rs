//! The window: panels, canvas, painting and commands.
//!
//! The app holds a few small structs: the [`Session`] (document and mesh), the [`Tools`], the [`View`], and what lasts no
//! longer than a gesture. Panels read them and send [`Command`]s; `logic` carries these out.

mod background;
mod busy;
mod canvas;
mod catalog;
pub mod command;
mod cutting;
mod files;
mod hints;
mod journal;
mod keys;
mod logic;
mod panels;
mod project;
mod screenshots;
pub mod readout;
pub mod session;
pub mod theme;
pub mod tools;
pub mod view;
pub mod widgets;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{self, Context, Frame, Theme, ThemePreference, Ui, vec2};
use eframe::egui_wgpu;
use glam::DVec2;

pub use canvas::CANVAS_NAME;
use canvas::{CanvasGpu, Gesture, OverlayColors};
use catalog::catalog;
use command::Command;
pub use screenshots::write as write_screenshots;
use session::Session;
use tools::{Tool, Tools};
use view::View;
use widgets::{CommandPalette, PaletteItem};

use crate::colormap::Ground;
use crate::document::Example;
use crate::domain::BoundaryTreatment;
use crate::mesh::TriangleId;
use crate::render::gpu::device_descriptor;

/// Names the program to the desktop, and its folder there.
const APP_ID: &str = "meshbrush";
/// Name under which the window's own storage keeps the theme.
const THEME_KEY: &str = "theme";
/// Most of a frame's time that goes into bringing the mesh up to date.
const FRAME_BUDGET: Duration = Duration::from_millis(7);
/// As much as the work takes, for pictures that are to be the same every time.
const ALL_THE_TIME: Duration = Duration::from_secs(3600);
/// Size of the window at first, in points.
const WINDOW_SIZE: [f32; 2] = [1440.0, 900.0];
/// Size below which the panels no longer fit, in points.
const SMALLEST_SIZE: [f32; 2] = [900.0, 600.0];

/// The program in its window.
pub struct App {
    session: Session,
    project: project::ProjectFile,
    /// Only where the window is a real one.
    journal: Option<journal::JournalKeeper>,
    tools: Tools,
    view: View,
    theme: ThemePreference,
    commands: Vec<Command>,
    gpu: Option<CanvasGpu>,
    overlay_colors: OverlayColors,
    files: files::Files,
    background: background::Background,
    palette: CommandPalette,
    hints: hints::Hints,
    busy: busy::Busy,
    field_texts: panels::FieldTexts,
    /// The tool whose section stood first in the last frame.
    panel_of: Tool,
    about: bool,
    /// Whether everything that differs from run to run is left out: pictures are to be the same every time.
    reproducible: bool,

    gesture: Gesture,
    /// Where the canvas was in the last frame.
    canvas_rect: egui::Rect,
    /// What floated over the canvas in the last frame and takes clicks.
    floats: Vec<egui::Rect>,
    pointer_world: Option<DVec2>,
    last_painted: Option<DVec2>,
    /// Corners so far of the polygon to cut the domain with, in world units.
    outline: Vec<DVec2>,
    /// Cuts of the domain that are being made.
    cutter: cutting::Cutter,
    /// How the outline was met before the report's way was chosen.
    last_fitted: Option<BoundaryTreatment>,
    hovered_neighbour: Option<TriangleId>,
}

impl App {
    /// The app on its first example. Without a `render_state` (in tests) the canvas stays empty.
    ///
    /// # Errors
    /// When the graphics driver cannot draw a mesh.
    pub fn new(ctx: &Context, render_state: Option<&egui_wgpu::RenderState>) -> Result<Self, String> {
        theme::install(ctx);
        let theme = ThemePreference::Dark;
        ctx.set_theme(theme);
        let document = files::example(Example::ALL[0]);
        let session = Session::new(document).map_err(|error| error.to_string())?;
        let settings = session.document().settings();
        let extent = settings.domain.bounds.size().max_element();
        let tools = Tools::for_domain(extent, settings.transfer.h_min);
        let gpu = render_state.map(CanvasGpu::new).transpose().map_err(|error| error.to_string())?;
        Ok(Self {
            project: project::ProjectFile::new(session.document().version()),
            journal: None,
            session,
            tools,
            view: View::default(),
            theme,
            commands: Vec::new(),
            gpu,
            overlay_colors: OverlayColors::default(),
            files: files::Files::default(),
            background: background::Background::new(ctx),
            palette: CommandPalette::default(),
            hints: hints::Hints::default(),
            busy: busy::Busy::default(),
            field_texts: panels::FieldTexts::default(),
            panel_of: Tool::Brush,
            about: false,
            reproducible: false,
            gesture: Gesture::None,
            canvas_rect: egui::Rect::NOTHING,
            floats: Vec::new(),
            pointer_world: None,
            last_painted: None,
            outline: Vec::new(),
            cutter: cutting::Cutter::default(),
            last_fitted: None,
            hovered_neighbour: None,
        })
    }

    /// Remembers from run to run what a person would miss: recent files, and work that was not saved.
    fn keep_in(&mut self, cc: &eframe::CreationContext<'_>) {
        if let Some(storage) = cc.storage {
            self.project.remember(storage);
            self.theme = eframe::get_value(storage, THEME_KEY).unwrap_or(self.theme);
            cc.egui_ctx.set_theme(self.theme);
        }
        if let Some(folder) = eframe::storage_dir(APP_ID) {
            self.keep_journal_in(folder.join("journals"), &cc.egui_ctx);
        }
    }

    /// Keeps unsaved work in a folder from now on, and offers what earlier runs left there.
    pub fn keep_journal_in(&mut self, folder: PathBuf, ctx: &Context) {
        self.journal = Some(journal::JournalKeeper::new(folder, ctx));
    }

    /// From now on shows the same on every machine: no times, and the mesh drawn in software.
    fn be_reproducible(&mut self) {
        self.reproducible = true;
        if let Some(gpu) = &mut self.gpu {
            gpu.draw_in_software();
        }
    }

    /// Document and mesh, for tests.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The tool in hand and the brush, for tests.
    pub fn tools(&self) -> &Tools {
        &self.tools
    }

    /// Whether the outline is being cut, for tests.
    pub fn is_cutting(&self) -> bool {
        !self.cutter.is_idle()
    }

    /// What is shown and how, for tests.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Sends a command, to be carried out in the next frame.
    pub fn send(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Whether a dialog is open, which takes the keys.
    fn asks_something(&self) -> bool {
        let restoring = self.journal.as_ref().is_some_and(|keeper| keeper.is_asking());
        self.palette.is_open()
            || self.about
            || self.files.is_asking()
            || self.project.is_asking()
            || restoring
    }

    fn title(&self) -> String {
        let edited = if self.is_edited() { " — edited" } else { "" };
        format!("{}{edited}", self.document_name())
    }

    fn palette_ui(&mut self, ctx: &Context) {
        if !self.palette.is_open() {
            return;
        }
        let entries = catalog(self);
        let keys: Vec<String> = entries
            .iter()
            .map(|e| e.shortcut.as_ref().map(keys::shortcut_text).unwrap_or_default())
            .collect();
        let items: Vec<_> = (entries.iter().zip(&keys))
            .map(|(entry, keys)| PaletteItem { title: &entry.title, keys, enabled: entry.enabled })
            .collect();
        if let Some(chosen) = self.palette.show(ctx, &items) {
            self.commands.push(entries[chosen].command.clone());
        }
    }

    fn about_ui(&mut self, ctx: &Context) {
        if !self.about {
            return;
        }
        let shown = widgets::dialog(ctx, "about", |ui| {
            ui.set_width(380.0);
            widgets::dialog_title(ui, "Meshbrush");
            ui.label(concat!("Version ", env!("CARGO_PKG_VERSION")));
            ui.add_space(8.0);
            ui.label(
                "Paint where detail matters; the mesh follows the brush. Local bisection refinement of triangulated \
                 grids by Maubach's method: always conforming, always right-angled.",
            );
            ui.add_space(8.0);
            ui.add(widgets::ActionButton::new("Close")).clicked()
        });
        if shown.inner || shown.should_close() {
            self.about = false;
        }
    }
}

impl App {
    /// One frame.
    fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.view.ground = if ctx.theme() == Theme::Dark { Ground::Dark } else { Ground::Light };
        self.follow_keys(&ctx);
        self.recovery_ui(&ctx);
        self.take_in_background();
        self.project_ui(&ctx);
        self.files.update(&ctx, &mut self.commands);
        self.palette_ui(&ctx);
        self.about_ui(&ctx);
        self.panels_ui(ui);
        egui::CentralPanel::default().frame(Frame::NONE).show(ui, |ui| self.canvas_ui(ui));
        self.follow_journal();
        self.background.keep_awake();
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.project.store(storage);
        eframe::set_value(storage, THEME_KEY, &self.theme);
    }

    fn on_exit(&mut self) {
        self.wait_for_writing();
        // Where the desktop takes the window away, nobody was asked.
        let remove = self.may_leave();
        if let Some(keeper) = &mut self.journal {
            keeper.end(remove);
        }
    }

    fn raw_input_hook(&mut self, ctx: &Context, raw_input: &mut egui::RawInput) {
        self.catch_tab(ctx, raw_input);
    }
}

/// Opens the window, on a file or on the first example, and stays in it until it is closed.
///
/// # Errors
/// A sentence, when there is no display or no usable graphics driver.
pub fn run(file: Option<PathBuf>) -> Result<(), String> {
    let mut options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Meshbrush")
            .with_app_id(APP_ID)
            .with_icon(window_icon())
            .with_inner_size(WINDOW_SIZE)
            .with_min_inner_size(vec2(SMALLEST_SIZE[0], SMALLEST_SIZE[1])),
        ..eframe::NativeOptions::default()
    };
    if let egui_wgpu::WgpuSetup::CreateNew(setup) = &mut options.wgpu_options.wgpu_setup {
        setup.device_descriptor = Arc::new(device_descriptor);
    }
    let create = |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        let mut app = App::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref())?;
        app.commands.extend(file.map(Command::Open));
        app.keep_in(cc);
        Ok(Box::new(app))
    };
    eframe::run_native(APP_ID, options, Box::new(create)).map_err(failure_to_open)
}

fn window_icon() -> egui::IconData {
    let icon = include_bytes!("../../assets/icon.png");
    eframe::icon_data::from_png_bytes(icon).unwrap_or_default()
}

/// What to tell where nothing can be drawn.
const NO_DRIVER: &str = "There is no usable graphics driver. Install a Vulkan or OpenGL driver, for example the package \
                         mesa-vulkan-drivers, or use the command line: meshbrush mesh --help.";

/// What to tell somebody whose window did not open.
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

#[cfg(test)]
mod tests;
