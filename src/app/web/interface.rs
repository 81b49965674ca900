//! What the JavaScript of a page can do with the program.

use std::any::Any;
use std::cell::RefMut;
use std::sync::Arc;

use eframe::egui::mutex::Mutex;
use eframe::egui::{Context, ThemePreference, Ui};
use eframe::wgpu;
use glam::DVec2;
use js_sys::Function;
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

use super::events::{Herald, Listeners};
use super::{files, link};
use crate::app::features::report::FigureCommand;
use crate::app::features::stepping::StepCommand;
use crate::app::{App, set_up_gpu};
use meshbrush_core::document::Example;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_io::io::project::{self, Project};
use meshbrush_io::io::{disk, png};
use meshbrush_kit::kit::command::{BrushCommand, Command, FileCommand, ViewCommand};
use meshbrush_render::render::software;
use meshbrush_render::scene::Camera;
use meshbrush_study::report::ReportFigure;

/// The longest side of a picture, in pixels.
const LARGEST_SIDE: u32 = 8192;

/// The window as eframe holds it in a page, which can be found again.
struct InPage(App, Arc<DeviceProblem>, Herald);

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
            self.0.send(Command::from(FileCommand::Fail(problem)));
        }
        self.0.logic(ctx, frame);
        self.2.tell(&self.0);
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
pub struct Meshbrush(eframe::WebRunner, Listeners);

#[wasm_bindgen]
impl Meshbrush {
    /// Returns the program before it has a canvas.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self(eframe::WebRunner::new(), Listeners::default())
    }

    /// Opens the window in a canvas, on the document of the link in the address of the page if there is one.
    ///
    /// # Errors
    /// Fails with a sentence where the browser can draw in no way.
    pub async fn start(&self, canvas: HtmlCanvasElement) -> Result<(), JsValue> {
        let mut options = eframe::WebOptions::default();
        set_up_gpu(&mut options.wgpu_options);
        disk::keep_in_memory();
        let herald = Herald::new(self.1.clone());
        let create = move |cc: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
            let mut app = App::in_window(cc, None)?;
            let link = link();
            if !link.is_empty() {
                app.open_link(&link);
            }
            Ok(Box::new(InPage(app, DeviceProblem::of(cc), herald)))
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
            app.send(Command::from(ViewCommand::Theme(theme)));
            app.jobs.wake();
        }
    }

    /// Opens a figure of the report by its number, at its step; Figure 3 is the halves of a triangle. Returns
    /// whether there is one.
    #[wasm_bindgen(js_name = openFigure)]
    pub fn open_figure(&self, number: usize) -> bool {
        let figure = ReportFigure::ALL.get(number.wrapping_sub(1)).copied();
        let command = figure.map(|figure| Command::from(FigureCommand::Open(figure)));
        command.is_some_and(|command| self.send(command))
    }

    /// Moves by so many steps of the refinement, where they are shown.
    pub fn step(&self, by: i32) -> bool {
        self.send(Command::from(StepCommand::Move(by as isize)))
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
        example.is_some_and(|example| self.send(Command::from(FileCommand::OpenExample(example))))
    }

    /// Opens a file by its name and contents, as if it were dropped. Files that it names must have been given
    /// with `addFile` before.
    pub fn open(&self, name: &str, contents: Vec<u8>) -> bool {
        self.send(Command::from(FileCommand::AddData(files::keep(name, contents))))
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

    /// Returns the document, and how it is looked at, as the part of a link after `#`.
    ///
    /// # Errors
    /// Fails before the program has started, and with a sentence where the document is too large for a link.
    pub fn link(&self) -> Result<String, JsError> {
        let app = self.app().ok_or_else(not_started)?;
        app.link().map_err(|problem| JsError::new(&problem))
    }

    /// Paints a stroke with the brush or the eraser, whichever is selected, on the layer that is selected, as
    /// a pen does: x and y in world units and the pressure from 0 to 1, in turn. What the pressure changes is
    /// set in the window.
    ///
    /// # Errors
    /// Fails with a sentence before the program has started, and for points that are none.
    pub fn paint(&self, points: &[f64]) -> Result<(), JsError> {
        let (points, rest) = points.as_chunks::<3>();
        let is_point =
            |&[x, y, pressure]: &[f64; 3]| x.is_finite() && y.is_finite() && (0.0..=1.0).contains(&pressure);
        if points.is_empty() || !rest.is_empty() || !points.iter().all(is_point) {
            return Err(JsError::new(
                "A stroke is x, y and pressure in turn, for one point at least: finite numbers, and a pressure from 0 to 1.",
            ));
        }
        let mut app = self.app().ok_or_else(not_started)?;
        if app.tools.tool.brush.is_none() {
            let kind = app.tools.kind;
            app.send(Command::from(BrushCommand::Kind(kind)));
        }
        for (number, &[x, y, pressure]) in points.iter().enumerate() {
            let draw = if number == 0 { BrushCommand::BeginStroke } else { BrushCommand::DrawTo };
            app.send(Command::from(BrushCommand::Pen(Some(pressure))));
            app.send(Command::from(draw(DVec2::new(x, y))));
        }
        app.send(Command::from(BrushCommand::EndStroke));
        app.send(Command::from(BrushCommand::Pen(None)));
        app.jobs.wake();
        Ok(())
    }

    /// Returns the mesh as the canvas shows it in the plan, without marks, as the bytes of a PNG file of this
    /// size in pixels.
    ///
    /// # Errors
    /// Fails with a sentence before the program has started, and for a size that is impossible.
    pub fn picture(&self, width: u32, height: u32) -> Result<Vec<u8>, JsError> {
        if ![width, height].iter().all(|side| (1..=LARGEST_SIDE).contains(side)) {
            return Err(JsError::new(&format!(
                "A picture of {width} × {height} pixels is impossible: a side has 1 to {LARGEST_SIDE}."
            )));
        }
        let app = self.app().ok_or_else(not_started)?;
        let (session, view) = (&app.session, &app.view);
        let (mesh, settings) = (session.mesh(), session.follower().settings());
        let lattice = mesh.lattice();
        let area = view.camera.map_or(lattice.bounds(), |camera| camera.visible_world());
        let camera = Camera::fit(lattice, area, [width, height], 0.0);
        let style = view.style(settings, 0, 1.0);
        let targets = session.follower().edge_targets(session.document().paint());
        let (domain, cleaning) = (session.follower().domain(), settings.derived_cleaning());
        let derived = DerivedMesh::new(mesh, domain, targets, &cleaning);
        let extract = derived.extract(mesh);
        let picture = match extract.is_patched() {
            true => software::draw_extract(&extract, &camera, &style),
            false => software::draw(mesh, &camera, &style, None, &[]),
        };
        let mut bytes = Vec::new();
        png::write(&mut bytes, picture.size, &picture.rgba)?;
        Ok(bytes)
    }

    /// Calls a function of the page at an event; see `MeshbrushEvents`.
    ///
    /// # Errors
    /// Fails with a sentence for another name.
    #[wasm_bindgen(skip_typescript)]
    pub fn on(&self, event: &str, callback: Function) -> Result<(), JsError> {
        self.1.add(event, callback)
    }

    /// Ends that.
    ///
    /// # Errors
    /// Fails with a sentence for another name.
    #[wasm_bindgen(skip_typescript)]
    pub fn off(&self, event: &str, callback: &Function) -> Result<(), JsError> {
        self.1.remove(event, callback)
    }

    /// Ends the program and gives its memory back to the page.
    pub fn stop(&self) {
        self.0.destroy();
    }

    fn app(&self) -> Option<RefMut<'_, App>> {
        Some(RefMut::map(self.0.app_mut::<InPage>()?, |page| &mut page.0))
    }

    fn document(&self) -> Result<Project, JsError> {
        let app = self.app().ok_or_else(not_started)?;
        Ok(Project::of(app.session.document()))
    }

    fn send(&self, command: Command) -> bool {
        let Some(mut app) = self.app() else { return false };
        app.send(command);
        app.jobs.wake();
        true
    }
}

fn not_started() -> JsError {
    JsError::new("The program has not started yet.")
}
