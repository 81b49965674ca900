//! What the JavaScript of a page can do with the program.

use std::any::Any;
use std::cell::RefMut;
use std::sync::Arc;

use eframe::egui::mutex::Mutex;
use eframe::egui::{Context, ThemePreference, Ui};
use eframe::wgpu;
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

use super::{files, link};
use crate::app::command::{Command, FigureCommand, FileCommand, Opened, StepCommand, ViewCommand};
use crate::app::{App, set_up_gpu};
use meshbrush_core::document::{Document, Example};
use meshbrush_io::io::disk;
use meshbrush_io::io::link as links;
use meshbrush_io::io::project::{self, Project};
use meshbrush_study::report::ReportFigure;

/// The window as eframe holds it in a page, which can be found again.
struct InPage(App, Arc<DeviceProblem>);

/// A sentence about an error of the graphics device that nothing else handles, until it is reported.
#[derive(Default)]
struct DeviceProblem(Mutex<Option<String>>);

impl DeviceProblem {
    /// Notes the errors of the device from now on.
    fn of(cc: &eframe::CreationContext<'_>) -> Arc<Self> {
        let problem = Arc::<Self>::default();
        if let Some(state) = &cc.wgpu_render_state {
            let (of_errors, of_loss) = (problem.clone(), problem.clone());
            state.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
                of_errors.note(format!(
                    "The browser could not draw ({error}). Make the mesh coarser or load the page again"
                ));
            }));
            state.device.set_device_lost_callback(move |_, reason| {
                of_loss.note(format!(
                    "The browser has lost its graphics device ({reason}). Load the page again"
                ));
            });
        }
        problem
    }

    fn note(&self, problem: String) {
        let unsaved = "unsaved work is kept in the storage of the browser and is then offered";
        self.0.lock().get_or_insert(format!("{problem}: {unsaved}."));
    }
}

impl eframe::App for InPage {
    fn as_any_mut(&mut self) -> Option<&mut dyn Any> {
        Some(self)
    }

    fn logic(&mut self, ctx: &Context, frame: &mut eframe::Frame) {
        if let Some(problem) = self.1.0.lock().take() {
            self.0.send(Command::File(FileCommand::Fail(problem)));
        }
        self.0.logic(ctx, frame);
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        self.0.ui(ui, frame);
        files::hand_over();
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.0.save(storage);
    }

    fn on_exit(&mut self) {
        self.0.on_exit();
    }
}

/// The program in a canvas of a page.
#[wasm_bindgen]
pub struct Meshbrush(eframe::WebRunner);

#[wasm_bindgen]
impl Meshbrush {
    /// Returns the program before it has a canvas.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self(eframe::WebRunner::new())
    }

    /// Opens the window in a canvas, on the document of the link in the address of the page if there is one.
    ///
    /// # Errors
    /// Fails with a sentence where the browser can draw in no way.
    pub async fn start(&self, canvas: HtmlCanvasElement) -> Result<(), JsValue> {
        let mut options = eframe::WebOptions::default();
        set_up_gpu(&mut options.wgpu_options);
        disk::keep_in_memory();
        let create = |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
            let mut app = App::in_window(cc, None)?;
            app.open_link(&link());
            Ok(Box::new(InPage(app, DeviceProblem::of(cc))))
        };
        self.0.start(canvas, options, Box::new(create)).await.map_err(|problem| {
            let problem = problem.as_string().unwrap_or_default();
            JsValue::from(format!(
                "This browser can draw neither with WebGPU nor with WebGL 2 ({problem}). Allow one of them in its settings, or use \
                 another browser."
            ))
        })
    }

    /// Leaves the canvas alone in the page, or with the strip of the tool; `dark` is the theme of the page.
    /// While steps of the refinement are shown, their controls are below the canvas.
    pub fn embed(&self, strip: bool, dark: bool) {
        if let Some(mut app) = self.app() {
            (app.view.surrounds, app.view.strip) = (false, strip);
            let theme = if dark { ThemePreference::Dark } else { ThemePreference::Light };
            app.send(Command::View(ViewCommand::Theme(theme)));
            app.jobs.wake();
        }
    }

    /// Opens a figure of the report by its number, at its step; Figure 3 is the halves of a triangle. Returns
    /// whether there is one.
    #[wasm_bindgen(js_name = openFigure)]
    pub fn open_figure(&self, number: usize) -> bool {
        let figure = ReportFigure::ALL.get(number.wrapping_sub(1)).copied();
        let command = figure.map(|figure| Command::Figure(FigureCommand::Open(figure)));
        command.is_some_and(|command| self.send(command))
    }

    /// Moves by so many steps of the refinement, where they are shown.
    pub fn step(&self, by: i32) -> bool {
        self.send(Command::Steps(StepCommand::Move(by as isize)))
    }

    /// Returns what tells meshes apart, as `meshbrush mesh` prints it; `undefined` while the mesh does not
    /// follow the document yet.
    pub fn fingerprint(&self) -> Option<String> {
        let app = self.app()?;
        let session = &app.session;
        let rests = session.follower().is_in_step(session.document()) && session.document().is_stroke_drawn();
        rests.then(|| session.mesh().fingerprint().to_string())
    }

    /// Returns the number of triangles of the mesh.
    pub fn triangles(&self) -> Option<usize> {
        Some(self.app()?.session.triangle_count())
    }

    /// Returns the message that the window shows.
    pub fn message(&self) -> Option<String> {
        Some(self.app()?.session.notices().shown()?.text.clone())
    }

    /// Returns the names of the examples.
    pub fn examples() -> Vec<String> {
        Example::ALL.iter().map(|example| example.name().to_owned()).collect()
    }

    /// Opens an example by its name. Returns whether there is one.
    #[wasm_bindgen(js_name = openExample)]
    pub fn open_example(&self, name: &str) -> bool {
        let example = Example::ALL.into_iter().find(|example| example.name() == name);
        example.is_some_and(|example| self.send(Command::File(FileCommand::OpenExample(example))))
    }

    /// Opens a file by its name and contents, as if it were dropped. Files that it names must have been given
    /// with `addFile` before.
    pub fn open(&self, name: &str, contents: Vec<u8>) -> bool {
        self.send(Command::File(FileCommand::AddData(files::keep(name, contents))))
    }

    /// Keeps a file that others name: a raster of a recipe.
    #[wasm_bindgen(js_name = addFile)]
    pub fn add_file(&self, name: &str, contents: Vec<u8>) {
        files::keep(name, contents);
    }

    /// Returns the document as the contents of a project file.
    ///
    /// # Errors
    /// Fails before the program has started, and where the document cannot be packed.
    pub fn project(&self) -> Result<Vec<u8>, JsError> {
        let mut bytes = Vec::new();
        project::write(&mut bytes, &self.document()?)?;
        Ok(bytes)
    }

    /// Returns the document as the part of a link after `#`.
    ///
    /// # Errors
    /// Fails before the program has started, and with a sentence where the document is too large for a link.
    pub fn link(&self) -> Result<String, JsError> {
        links::write(&self.document()?).map_err(|problem| JsError::new(&problem))
    }

    /// Ends the program and gives its memory back to the page.
    pub fn stop(&self) {
        self.0.destroy();
    }

    fn app(&self) -> Option<RefMut<'_, App>> {
        Some(RefMut::map(self.0.app_mut::<InPage>()?, |page| &mut page.0))
    }

    fn document(&self) -> Result<Project, JsError> {
        let app = self.app().ok_or_else(|| JsError::new("The program has not started yet."))?;
        Ok(Project::of(app.session.document()))
    }

    fn send(&self, command: Command) -> bool {
        let Some(mut app) = self.app() else { return false };
        app.send(command);
        app.jobs.wake();
        true
    }
}

impl App {
    /// Shows the document of a link, if there is one; a link that cannot be read leaves an empty document.
    fn open_link(&mut self, link: &str) {
        if link.is_empty() {
            return;
        }
        let read = links::read(link).and_then(Project::into_document);
        let (document, problem): (Document, _) = match read {
            Ok(document) => (document, None),
            Err(problem) => (crate::app::files::new_document(), Some(problem)),
        };
        let opened = Opened { document: Arc::new(document), home: None };
        self.send(Command::File(FileCommand::Show(opened)));
        if let Some(problem) = problem {
            self.send(Command::File(FileCommand::Fail(problem)));
        }
    }
}
