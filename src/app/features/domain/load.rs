//! Reads domains and outlines from files.

use std::path::Path;
use std::sync::Arc;

use super::{DomainCommand, OutlineChange};
use meshbrush_core::document::{Document, OutlineError, Setting, Settings};
use meshbrush_core::domain::{BoundaryMarks, BoundaryPieces, DepthContour, OutlineOnEarth};
use meshbrush_core::earth::{Coordinates, ProjectionChoice};
use meshbrush_core::layers::{LayerId, LayerKind, Mask};
use meshbrush_core::raster::Raster;
use meshbrush_io::io::geojson::Outline;
use meshbrush_io::io::recipe::{self, OutlineSource};
use meshbrush_io::io::{self, FileCoordinates, Meter};
use meshbrush_kit::kit::background::{Aim, Background, Outcome, name_of};
use meshbrush_kit::kit::command::{Command, Opened, ShellCommand};
use meshbrush_kit::kit::seen_shapes;
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::format;

/// The plane in which polygons become a domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DomainPlane {
    /// That of the coordinates in the file, in its unit.
    OfFile,
    /// That of a projection, in metres: the file's own, or one that suits its longitudes and latitudes.
    Metres,
}

/// Reads polygons, and opens a document with them as its domain.
pub fn load_domain(background: &mut Background, path: &Path, plane: DomainPlane) {
    open_outline(background, path, move |file, outline| {
        opened(file, None, document_of(file, outline, plane, None))
    });
}

/// Reads polygons, and opens a document with them as its domain: at once where their coordinates leave no
/// choice, and else after a question.
pub fn choose_plane(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let shapes = match io::shape_format::read_own_shapes(&file, None, meter) {
            Ok(shapes) => shapes,
            Err(error) => return Outcome::not_read(error),
        };
        // Lines are coasts: there is no domain of their own.
        if are_longitudes(&shapes.coordinates) || shapes.shapes.polygons.is_empty() {
            let asked = Arc::new(seen_shapes(&file, &shapes));
            return Outcome::PartRead(vec![Command::from(ShellCommand::AskRole(asked))]);
        }
        match io::shape_format::read_outline(&file, meter) {
            Ok(outline) => open_unasked(&file, outline),
            Err(error) => Outcome::not_read(error),
        }
    });
}

/// Reads land or coasts, and opens a document whose domain is the water beside them: in metres where the file
/// says where on the Earth it is. A note says how the water was found.
pub fn load_sea(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match sea_of(&file, meter) {
        Ok((document, note)) => opened(&file, Some(Command::from(ShellCommand::Tell(note))), Ok(document)),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Returns a document on the water beside the land of a file, and a note on it.
fn sea_of(file: &Path, meter: &Meter) -> Result<(Document, String), String> {
    let read = io::shape_format::read_own_shapes(file, None, meter).map_err(|error| error.to_string())?;
    let sea = recipe::sea_of_land(file, &read, None, None, None).map_err(|error| error.to_string())?;
    let (OutlineSource { outline, frame }, name) = (sea.source, name_of(file));
    let plane = match outline.coordinates.on_earth(None) {
        Some(_) => DomainPlane::Metres,
        None => DomainPlane::OfFile,
    };
    let document = document_of(file, outline, plane, frame.map(|frame| frame.rect))?;
    let side = sea.decided.map_or_else(String::new, |side| format!(": {}", side.text()));
    let note = format!(
        "The domain is the water in a frame around the land of {name}{side}. Cut it to size with the tool Domain."
    );
    Ok((document, note))
}

/// Reads polygons, and opens a document with them as its domain: in metres where that is possible. A note
/// says which coordinates were chosen.
pub fn load_first(background: &mut Background, path: &Path) {
    open_outline(background, path, open_unasked);
}

/// Opens polygons in metres where that is possible, and else in the coordinates of their file. A note says
/// which were chosen.
fn open_unasked(file: &Path, outline: Outline) -> Outcome {
    let name = name_of(file);
    let unit = outline.coordinates.unit();
    if outline.coordinates.on_earth(None).is_none() {
        let note = format!(
            "{name} names no coordinate system that is known here, so the document has no unit. Set one with “Unit” in the tab Domain."
        );
        let note = (unit == LengthUnit::None).then_some(Command::from(ShellCommand::Tell(note)));
        return opened(file, note, document_of(file, outline, DomainPlane::OfFile, None));
    }
    let are_longitudes = are_longitudes(&outline.coordinates);
    match document_of(file, outline.clone(), DomainPlane::Metres, None) {
        Ok(document) => {
            let plane = document.settings().domain.projection.map_or("", |plane| plane.kind().name());
            let note = match are_longitudes {
                true => ShellCommand::Offer(
                    format!(
                        "{name} has longitudes and latitudes. It was opened in metres, in a {plane} plane."
                    ),
                    "Open in degrees",
                    Box::new(Command::from(DomainCommand::Open(file.to_owned()))),
                ),
                false => {
                    ShellCommand::Tell(format!("{name} is in metres, and was opened in a {plane} plane."))
                }
            };
            opened(file, Some(Command::from(note)), Ok(document))
        }
        Err(problem) => {
            let note =
                format!("{name} was opened in its own coordinates, as metres do not suit it. {problem}");
            opened(
                file,
                Some(Command::from(ShellCommand::Tell(note))),
                document_of(file, outline, DomainPlane::OfFile, None),
            )
        }
    }
}

/// Reads the polygons of a file, and goes on with them.
fn open_outline(
    background: &mut Background,
    path: &Path,
    open: impl FnOnce(&Path, Outline) -> Outcome + Send + 'static,
) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match io::shape_format::read_outline(&file, meter) {
        Ok(outline) => open(&file, outline),
        Err(error) => Outcome::not_read(error),
    });
}

fn opened(file: &Path, note: Option<Command>, document: Result<Document, String>) -> Outcome {
    match document {
        Ok(document) => {
            let opened = Opened { document: Arc::new(document), home: None };
            Outcome::Opened { path: file.to_owned(), opened, note: note.map(Box::new) }
        }
        Err(problem) => Outcome::NotRead(problem),
    }
}

/// Returns whether a choice between degrees and metres is left to a person.
fn are_longitudes(coordinates: &FileCoordinates) -> bool {
    matches!(coordinates.on_earth(None), Some(Coordinates::Geographic | Coordinates::OnDatum(_)))
}

/// Reads polygons, and adds them to the domain of the document.
pub fn load_outline(session: &Session, background: &mut Background, path: &Path) {
    let (file, settings) = (path.to_owned(), session.document().settings().clone());
    let plane = settings.domain.projection.map(io::DocumentPlane::from);
    background.start(Aim::Read, path, move |meter| {
        let polygons = match io::shape_format::read_polygons(&file, plane.as_ref(), meter) {
            Ok(polygons) => polygons,
            Err(error) => return Outcome::not_read(error),
        };
        match settings.with_outline(&polygons) {
            Ok(setting) => {
                let change =
                    OutlineChange { name: name_of(&file), before: settings.domain, setting, news: None };
                Outcome::Read {
                    path: file,
                    commands: vec![Command::from(DomainCommand::SetOutline(Box::new(change)))],
                }
            }
            Err(error) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

/// Finds the contour of a layer of depths, and makes it the domain of the document.
pub fn load_contour(session: &Session, background: &mut Background, layer: LayerId, contour: DepthContour) {
    let settings = session.document().settings().clone();
    let Some(layer) = settings.layer(layer).cloned() else { return };
    let (LayerKind::Depth(depths), name) = (layer.kind, layer.name) else { return };
    let find = move |settings: &Settings| {
        let setting = settings.with_contour(&depths, &contour)?;
        let unknown = unknown_in(depths.source().raster.raster(), settings);
        let land = match unknown {
            0 => String::new(),
            1 => " One pixel without a value in it counts as land.".to_owned(),
            count => format!(" {} pixels without a value in it count as land.", format::count(count)),
        };
        let closed = if is_closed_by(settings, &setting) { NOTHING_OPEN } else { "" };
        Ok((setting, format!("is the contour of {}.{land}{closed}", depths.source().name)))
    };
    find_outline(background, settings, name, find);
}

/// Finds where the raster of a layer of a surface has values, and makes that the domain of the document.
pub fn load_area_of_values(session: &Session, background: &mut Background, layer: LayerId) {
    let settings = session.document().settings().clone();
    let Some(layer) = settings.layer(layer).cloned() else { return };
    let Some(source) = layer.kind.raster_source().cloned() else { return };
    let find = move |settings: &Settings| {
        let setting = settings.with_values_of(source.raster.raster())?;
        Ok((setting, format!("is the area in which {} has values.", source.name)))
    };
    find_outline(background, settings, layer.name, find);
}

/// What is said where a domain has no open side any more.
const NOTHING_OPEN: &str =
    " Nothing of its boundary is open: the section Boundary of the tab Domain opens parts of it.";

/// Returns whether something of the boundary is open before a change, and nothing after it.
fn is_closed_by(settings: &Settings, change: &Setting) -> bool {
    let Setting::Outline { domain, boundary_marks } = change else { return false };
    let has_open = |domain, marks| {
        let pieces = BoundaryPieces::of_domain(domain, marks);
        pieces.is_none_or(|pieces| pieces.list().iter().any(|piece| piece.boundary_type().is_open()))
    };
    has_open(&settings.domain, &settings.boundary_marks) && !has_open(domain, boundary_marks)
}

/// Returns how many pixels with their centres in the bounds of a document have no value: those in its frame,
/// where it has one that is open all around.
fn unknown_in(raster: &Raster, settings: &Settings) -> u64 {
    let ([columns, rows], centers) = (raster.size(), raster.pixel_centers());
    let pieces = BoundaryPieces::of_domain(&settings.domain, &BoundaryMarks::default());
    let is_frame =
        pieces.is_some_and(|pieces| pieces.list().iter().all(|piece| piece.boundary_type().is_open()));
    let frame =
        settings.domain.region().filter(|_| is_frame).and_then(|region| Mask::new(region.polygons()).ok());
    let bounds = settings.domain.bounds;
    let is_in = |at| bounds.contains(at) && frame.as_ref().is_none_or(|frame| frame.contains(at));
    let is_unknown = |x: u32, y: u32| raster.get(x, y).is_nan() && is_in(centers(x, y));
    (0..rows).map(|y| (0..columns).filter(|&x| is_unknown(x, y)).count() as u64).sum()
}

/// Finds an outline with the end of a sentence about it, and makes it the domain of the document.
fn find_outline(
    background: &mut Background,
    settings: Settings,
    name: String,
    find: impl FnOnce(&Settings) -> Result<(Setting, String), OutlineError> + Send + 'static,
) {
    let shown = name.clone();
    background.start(Aim::Read, Path::new(&shown), move |_| match find(&settings) {
        Ok((setting, what)) => {
            let news = Some(format!("The domain was replaced: it {what}"));
            let change = OutlineChange { name, before: settings.domain, setting, news };
            Outcome::PartRead(vec![Command::from(DomainCommand::SetOutline(Box::new(change)))])
        }
        Err(error) => Outcome::NotRead(format!("{name}: {error}")),
    });
}

/// Returns a new document on the polygons of a file, which were cut by `frame` in its coordinates.
fn document_of(
    path: &Path,
    mut outline: Outline,
    plane: DomainPlane,
    frame: Option<Rect>,
) -> Result<Document, String> {
    let mut on_earth = OutlineOnEarth { file: outline.coordinates.on_earth(None), projection: None, frame };
    if plane == DomainPlane::Metres {
        let projected = outline.projected(ProjectionChoice::OwnOrAutomatic, None);
        let projected = projected.map_err(|error| format!("{}: {error}", path.display()))?;
        (outline, on_earth.projection) = (projected.0, Some(projected.1));
    }
    let (domain, marks) = BoundaryMarks::domain_of(&outline.polygons, None, &on_earth)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (unit, boundary_marks) = (outline.coordinates.unit(), Arc::new(marks));
    let settings = Settings { unit, boundary_marks, ..Settings::for_domain(name, domain) };
    Document::new(settings, None).map_err(|error| format!("{}: {error}", path.display()))
}
