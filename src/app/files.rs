//! Files: asked for by a dialog, read and exported.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use eframe::egui::{self, Context, Key};
use glam::DVec2;

use super::App;
use super::background::{Aim, Finish, cancelled, name_of, not_read, not_written, told};
use super::command::Command;
use super::readout::target_at;
use super::widgets::{ActionButton, ButtonKind, TextRow, dialog, dialog_title, format};
use crate::document::{Base, Document, Example, Setting, Settings};
use crate::domain::{Domain, Polygon};
use crate::geometry::Rect;
use crate::io::png::{Behind, decode};
use crate::io::project::ENDING;
use crate::io::{self, Cancelled, MeshData, Meter};
use crate::mesh::Extract;
use crate::raster::Raster;
use crate::render::export::ExportFormat;

/// Width and height in kilometres of the terrain that comes with the program: 403 × 344 pixels of 3″ at 36.6° N.
const TERRAIN_KM: DVec2 = DVec2::new(30.0, 31.8);

/// Nodes whose h̄ is looked up between two looks at the meter: some milliseconds' worth.
const NODES_BETWEEN_LOOKS: usize = 1 << 16;

/// The slope of a real terrain as risk.
pub fn terrain_slope() -> Raster {
    let picture = include_bytes!("../../assets/jacksboro_slope.png");
    let bounds = Rect::new(DVec2::ZERO, TERRAIN_KM);
    decode(Cursor::new(picture), bounds, Behind::Black)
        .expect("the picture is part of the program: a test opens it")
}

/// The sea between Greece and Turkey.
fn aegean_sea() -> Vec<Polygon> {
    let file = include_bytes!("../../assets/aegean_sea.geojson");
    io::geojson::from_bytes(file, Path::new("aegean_sea.geojson"))
        .expect("the outline is part of the program: a test opens it")
}

/// A document that comes with the program.
pub fn example(example: Example) -> Document {
    example.document(terrain_slope, aegean_sea)
}

/// What a file is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileRequest {
    /// Any file that can be opened.
    Open,
    /// Where to save the document.
    Save,
    /// A picture to take as risk.
    OpenImage,
    /// Polygons to mesh.
    OpenDomain,
    /// Where to write the mesh.
    Export,
}

impl FileRequest {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open",
            Self::Save => "Save project",
            Self::OpenImage => "Open picture as risk",
            Self::OpenDomain => "Open domain",
            Self::Export => "Export mesh",
        }
    }

    fn verb(self) -> &'static str {
        match self {
            Self::Open | Self::OpenImage | Self::OpenDomain => "Open",
            Self::Save => "Save",
            Self::Export => "Export",
        }
    }

    fn hint(self) -> &'static str {
        match self {
            Self::Open => "path of a .meshbrush, a .geojson or a greyscale .png",
            Self::Save => "path ending in .meshbrush",
            Self::OpenImage => "path of a greyscale .png",
            Self::OpenDomain => "path of a .geojson with polygons",
            Self::Export => "ending in .vtu .msh .obj .stl .node .2dm .csv .svg .png",
        }
    }

    fn command(self, path: PathBuf) -> Command {
        match self {
            Self::Open => Command::Open(path),
            Self::Save => Command::SaveAs(path),
            Self::OpenImage => Command::OpenImage(path),
            Self::OpenDomain => Command::OpenDomain(path),
            Self::Export => Command::ExportAs(path),
        }
    }
}

/// Files being asked for.
pub struct Files {
    /// Paths that somebody chose in the desktop's own dialog.
    sender: Sender<(FileRequest, PathBuf)>,
    receiver: Receiver<(FileRequest, PathBuf)>,
    /// The question on the screen, and the path typed so far.
    asking: Option<(FileRequest, String)>,
}

impl Default for Files {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver, asking: None }
    }
}

impl Files {
    /// Asks for a path in a field, which always works; from there the desktop's own dialog can be opened.
    pub fn ask(&mut self, request: FileRequest) {
        self.asking = Some((request, String::new()));
    }

    /// Whether a path is being asked for.
    pub fn is_asking(&self) -> bool {
        self.asking.is_some()
    }

    /// Takes in what was chosen, and shows the question for a path.
    pub fn update(&mut self, ctx: &Context, commands: &mut Vec<Command>) {
        while let Ok((request, path)) = self.receiver.try_recv() {
            self.asking = None;
            // The desktop's own dialog has asked already.
            commands.push(match request {
                FileRequest::Save => Command::SaveTo(path),
                // About the files beside it, it knew nothing.
                FileRequest::Export
                    if ExportFormat::of(&path).is_ok_and(|format| format.files(&path).len() == 1) =>
                {
                    Command::Export(path)
                }
                _ => request.command(path),
            });
        }
        if let Some((request, mut path)) = self.asking.take() {
            match self.question_ui(ctx, request, &mut path) {
                Answer::Open => self.asking = Some((request, path)),
                Answer::Given => commands.push(request.command(PathBuf::from(path.trim()))),
                Answer::Dropped => {}
            }
        }
    }

    fn question_ui(&mut self, ctx: &Context, request: FileRequest, path: &mut String) -> Answer {
        let shown = dialog(ctx, "path", |ui| {
            ui.set_width(440.0);
            dialog_title(ui, request.title());
            ui.add_space(8.0);
            let field = TextRow::formula("Path", path).hint(request.hint()).show(ui);
            if !field.lost_focus() && path.is_empty() {
                field.request_focus();
            }
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            ui.add_space(12.0);
            let buttons = self.buttons_ui(ui, request, path);
            if entered && !path.trim().is_empty() { Answer::Given } else { buttons }
        });
        if shown.should_close() { Answer::Dropped } else { shown.inner }
    }

    fn buttons_ui(&mut self, ui: &mut egui::Ui, request: FileRequest, path: &str) -> Answer {
        ui.horizontal(|ui| {
            if ui.add(ActionButton::new("Browse…")).clicked() {
                self.browse(request, ui.ctx());
            }
            let right = egui::Layout::right_to_left(egui::Align::Center);
            ui.with_layout(right, |ui| {
                let named = !path.trim().is_empty();
                let go = ActionButton::new(request.verb()).kind(ButtonKind::Main);
                if ui.add_enabled_ui(named, |ui| ui.add(go)).inner.clicked() {
                    return Answer::Given;
                }
                if ui.add(ActionButton::new("Cancel")).clicked() { Answer::Dropped } else { Answer::Open }
            })
            .inner
        })
        .inner
    }

    /// Opens the desktop's own dialog, off the window's thread. Where there is none, nothing happens.
    fn browse(&mut self, request: FileRequest, ctx: &Context) {
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        thread::spawn(move || {
            let dialog = rfd::FileDialog::new().set_title(request.title());
            let path = match request {
                FileRequest::Open => dialog
                    .add_filter("Projects, domains, pictures", &[ENDING, "geojson", "json", "png"])
                    .pick_file(),
                FileRequest::Save => dialog
                    .add_filter("Projects", &[ENDING])
                    .set_file_name(format!("mesh.{ENDING}"))
                    .save_file(),
                FileRequest::OpenImage => dialog.add_filter("Pictures", &["png"]).pick_file(),
                FileRequest::OpenDomain => dialog.add_filter("Polygons", &["geojson", "json"]).pick_file(),
                FileRequest::Export => dialog
                    .add_filter("Meshes and pictures", &ExportFormat::endings().collect::<Vec<_>>())
                    .set_file_name("mesh.vtu")
                    .save_file(),
            };
            if let Some(path) = path {
                // The window may have closed in the meantime.
                let _ = sender.send((request, path));
            }
            ctx.request_repaint();
        });
    }
}

impl App {
    /// Reads a picture and makes it the base field's risk.
    pub(super) fn load_image(&mut self, path: PathBuf) {
        let bounds = self.session.document().settings().domain.bounds;
        let file = path.clone();
        self.background.start(Aim::Read, &path, move |meter| {
            match io::png::read_metered(&file, bounds, Behind::Black, meter) {
                Ok(raster) => {
                    let base = Base::RiskImage { name: name_of(&file), raster: Arc::new(raster) };
                    commanded([Command::Set(Setting::Base(base)), Command::EndGesture])
                }
                Err(error) => not_read(error),
            }
        });
    }

    /// Reads polygons, and makes a document of them.
    pub(super) fn load_domain(&mut self, path: PathBuf) {
        let file = path.clone();
        self.background.start(Aim::Read, &path, move |meter| match domain_of(&file, meter) {
            Ok(settings) => commanded([Command::NewWith(Box::new(settings))]),
            Err(problem) => not_read(problem),
        });
    }

    /// Writes the mesh on the screen, with h̄ at its nodes, or a picture of all of it in the colours of the view.
    pub(super) fn export(&mut self, path: PathBuf) {
        let format = match ExportFormat::of(&path) {
            Ok(format) => format,
            Err(error) => return self.session.report(format!("{error}.")),
        };
        let blocked = |file: &PathBuf| {
            Some(format!("{} could not be written: {}.", file.display(), io::obstacle(file)?))
        };
        if let Some(problem) = format.files(&path).iter().find_map(blocked) {
            return self.session.report(problem);
        }
        let session = &self.session;
        let (mesh, field) = (session.shared_mesh(), session.follower().field().clone());
        let (layers, rule) = (session.document().paint().clone(), session.follower().settings().rule);
        let look = self.view.picture(session.document().settings());
        let file = path.clone();
        self.background.start(Aim::Export, &path, move |meter| {
            let write = || -> std::io::Result<Vec<PathBuf>> {
                let extract = mesh.extract();
                let target_diameter = if format.wants_node_data() {
                    at_nodes(&extract, meter, |node| target_at(node, &field, layers.as_paint(), rule))?
                } else {
                    Vec::new()
                };
                let data = MeshData { target_diameter: &target_diameter, quantities: &[] };
                format.write(&file, &mesh, &extract, &data, &look, meter)
            };
            let triangles = format::count(mesh.triangle_count() as u64);
            match write() {
                Ok(files) => told(format!("{triangles} triangles written to {}.", listed(&files))),
                Err(_) if meter.is_cancelled() => told(cancelled(Aim::Export, &file)),
                Err(error) => not_written(format!("{} could not be written: {error}.", file.display())),
            }
        });
    }
}

/// The settings of a new document on the polygons of a file.
fn domain_of(path: &Path, meter: &Meter) -> Result<Settings, String> {
    let polygons = io::geojson::read_metered(path, meter).map_err(|error| error.to_string())?;
    let domain = Domain::of_polygons(&polygons).map_err(|error| format!("{}: {error}", path.display()))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Settings::for_domain(name, domain))
}

/// A value at each node, as long as nobody cancels that.
fn at_nodes(extract: &Extract, meter: &Meter, value: impl Fn(DVec2) -> f64) -> Result<Vec<f64>, Cancelled> {
    let mut values = Vec::with_capacity(extract.nodes().len());
    for (n, node) in extract.world_nodes().enumerate() {
        if n.is_multiple_of(NODES_BETWEEN_LOOKS) {
            meter.check()?;
        }
        values.push(value(node));
    }
    Ok(values)
}

/// Sends commands.
fn commanded(commands: impl IntoIterator<Item = Command> + Send + 'static) -> Finish {
    Box::new(|app| app.commands.extend(commands))
}

/// How the question for a path stands.
#[derive(Clone, Copy, PartialEq)]
enum Answer {
    Open,
    Given,
    Dropped,
}

/// Names of files, one after the other.
pub fn listed(files: &[PathBuf]) -> String {
    files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ")
}
