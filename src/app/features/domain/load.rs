//! Reads domains and outlines from files.

use std::path::Path;
use std::sync::Arc;

use super::{DomainCommand, OutlineChange};
use crate::app::background::{Aim, Background, Outcome, name_of};
use crate::app::command::{Command, Opened};
use crate::app::session::Session;
use meshbrush_core::document::{Document, OutlineError, Setting, Settings};
use meshbrush_core::domain::{BoundaryMarks, DepthContour, OutlineOnEarth};
use meshbrush_core::earth::ProjectionChoice;
use meshbrush_core::layers::{LayerId, LayerKind};
use meshbrush_io::io::{self, Meter};

/// Reads polygons, and opens a document with them as its domain; in metres, in the plane of a projection that
/// is chosen, or as they are.
pub fn load_domain(background: &mut Background, path: &Path, projection: Option<ProjectionChoice>) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match domain_of(&file, projection, meter) {
        Ok(document) => {
            let opened = Opened { document: Arc::new(document), home: None };
            Outcome::Opened { path: file, opened }
        }
        Err(problem) => Outcome::NotRead(problem),
    });
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
                let change = OutlineChange { name: name_of(&file), before: settings.domain, setting };
                Outcome::Read {
                    path: file,
                    commands: vec![Command::Domain(DomainCommand::SetOutline(Box::new(change)))],
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
    find_outline(background, settings, name, move |settings| settings.with_contour(&depths, &contour));
}

/// Finds where the raster of a layer of a surface has values, and makes that the domain of the document.
pub fn load_area_of_values(session: &Session, background: &mut Background, layer: LayerId) {
    let settings = session.document().settings().clone();
    let Some(layer) = settings.layer(layer).cloned() else { return };
    let Some(source) = layer.kind.raster_source().cloned() else { return };
    let find = move |settings: &Settings| settings.with_values_of(source.raster.raster());
    find_outline(background, settings, layer.name, find);
}

/// Finds an outline, and makes it the domain of the document.
fn find_outline(
    background: &mut Background,
    settings: Settings,
    name: String,
    find: impl FnOnce(&Settings) -> Result<Setting, OutlineError> + Send + 'static,
) {
    let shown = name.clone();
    background.start(Aim::Read, Path::new(&shown), move |_| match find(&settings) {
        Ok(setting) => {
            let change = OutlineChange { name, before: settings.domain, setting };
            Outcome::PartRead(vec![Command::Domain(DomainCommand::SetOutline(Box::new(change)))])
        }
        Err(error) => Outcome::NotRead(format!("{name}: {error}")),
    });
}

/// Returns a new document on the polygons of a file.
fn domain_of(path: &Path, choice: Option<ProjectionChoice>, meter: &Meter) -> Result<Document, String> {
    let mut outline = io::shape_format::read_outline(path, meter).map_err(|error| error.to_string())?;
    let mut on_earth =
        OutlineOnEarth { file: outline.coordinates.on_earth(None), projection: None, frame: None };
    if let Some(choice) = choice {
        let projected =
            outline.projected(choice, None).map_err(|error| format!("{}: {error}", path.display()))?;
        (outline, on_earth.projection) = (projected.0, Some(projected.1));
    }
    let (domain, marks) = BoundaryMarks::domain_of(&outline.polygons, None, &on_earth)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (unit, boundary_marks) = (outline.coordinates.unit(), Arc::new(marks));
    let settings = Settings { unit, boundary_marks, ..Settings::for_domain(name, domain) };
    Document::new(settings, None).map_err(|error| format!("{}: {error}", path.display()))
}
