//! Opening and exporting files, and the documents that come with the program.

use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::background::{Aim, Background, Outcome, cancelled, name_of};
use super::command::{Command, LayerCommand, Opened, OutlineChange};
use super::session::Session;
use super::tools::ThreatsTool;
use super::view::View;
use super::widgets::format;
use crate::document::{self, Document, Example, Setting, Settings, extent};
use crate::domain::{BoundaryMarks, MeshBoundary, NamedPolygon, Polygon};
use crate::geometry::Rect;
use crate::io::png::{Behind, decode};
use crate::io::project::Project;
use crate::io::recipe::{self, RecipeFiles};
use crate::io::{self, Cancelled, MeshData, MeshSource, Meter, Provenance};
use crate::layers::{LayerKind, Mask, RasterReading, RasterSource, TargetsInOrder, Threats};
use crate::mesh::Extract;
use crate::outline::DerivedMesh;
use crate::raster::{Raster, RasterPyramid};
use crate::render::export::ExportFormat;

/// Width and height in kilometres of the terrain that comes with the program: 403 × 344 pixels of 3″ at 36.6°
/// N.
const TERRAIN_KM: DVec2 = DVec2::new(30.0, 31.8);

/// The sea between Greece and Turkey, as a file.
pub const AEGEAN_SEA: &[u8] = include_bytes!("../../assets/aegean_sea.geojson");

/// Nodes whose h̄ is computed between two checks of the meter: some milliseconds of work.
const NODES_BETWEEN_CHECKS: usize = 1 << 16;

/// The slope of a real terrain as risk.
pub fn terrain_slope() -> Raster {
    let picture = include_bytes!("../../assets/jacksboro_slope.png");
    let bounds = Rect::new(DVec2::ZERO, TERRAIN_KM);
    decode(Cursor::new(picture), bounds, Behind::Black)
        .expect("the picture is part of the program: a test opens it")
}

/// The sea between Greece and Turkey.
fn aegean_sea() -> Vec<NamedPolygon> {
    io::geojson::read_named_from(AEGEAN_SEA, Path::new("aegean_sea.geojson"))
        .expect("the outline is part of the program: a test opens it")
}

/// An empty document.
pub fn new_document() -> Document {
    Document::new(Settings::default(), None).expect("the default settings are valid: a test opens them")
}

/// A document that comes with the program.
pub fn example(example: Example) -> Document {
    example.document(terrain_slope, aegean_sea)
}

/// Reads a picture and adds it as a layer of risk.
pub fn load_image(session: &Session, background: &mut Background, path: &Path) {
    let bounds = session.document().settings().domain.bounds;
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match risk_of(&file, bounds, meter) {
        Ok(raster) => {
            let kind = raster_layer(&file, raster, RasterReading::Risk);
            let commands = vec![Command::Layer(LayerCommand::Add(Box::new(kind))), Command::EndGesture];
            Outcome::Read { path: file, commands }
        }
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads a picture to be shown behind the mesh. A world file beside it says where it lies; without one it
/// covers the bounds of the domain.
pub fn load_background(session: &Session, background: &mut Background, path: &Path) {
    let bounds = session.document().settings().domain.bounds;
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let read = io::png::read_picture(&file, meter).and_then(|picture| {
            let placed = io::world_file::bounds_beside(&file, picture.size)?;
            Ok((picture, placed.unwrap_or(bounds)))
        });
        match read {
            Ok((picture, bounds)) => {
                let (name, picture) = (name_of(&file), Arc::new(picture));
                let opacity = document::Background::USUAL_OPACITY;
                let shown = document::Background { name, picture, bounds, opacity };
                Outcome::PartRead(vec![Command::Set(Setting::Background(Some(shown))), Command::EndGesture])
            }
            Err(error) => Outcome::not_read(error),
        }
    });
}

/// Reads a grid and adds it as a layer of target diameters.
pub fn load_diameters(session: &Session, background: &mut Background, path: &Path) {
    let bounds = session.document().settings().domain.bounds;
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match diameters_of(&file, bounds, meter) {
        Ok(raster) => {
            let kind = raster_layer(&file, raster, RasterReading::Diameter);
            Outcome::PartRead(vec![Command::Layer(LayerCommand::Add(Box::new(kind))), Command::EndGesture])
        }
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads polygons as the mask of the selected layer.
pub fn load_mask(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let named = match io::geojson::read_named_metered(&file, meter) {
            Ok(named) => named,
            Err(error) => return Outcome::not_read(error),
        };
        let polygons: Vec<Polygon> = named.into_iter().map(|named| named.polygon).collect();
        match Mask::new(&polygons) {
            Ok(mask) => Outcome::PartRead(vec![Command::Layer(LayerCommand::Mask(layer, Some(mask)))]),
            Err(error) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

/// Reads a table of threats in place of those of the selected layer.
pub fn load_threats(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let list = match io::threats::read(&file, meter) {
            Ok(list) => list,
            Err(error) => return Outcome::not_read(error),
        };
        match Threats::new(list) {
            Ok(threats) => {
                let change = LayerCommand::SetKind(layer, Box::new(LayerKind::Threats(threats)));
                Outcome::PartRead(vec![Command::EndGesture, Command::Layer(change), Command::EndGesture])
            }
            Err((_, error)) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

/// Writes the threats of the selected layer as a table.
pub fn save_threats(session: &Session, background: &mut Background, path: &Path) {
    let Some((_, threats)) = ThreatsTool::layer(session.document()) else { return };
    let (threats, file) = (threats.clone(), path.to_owned());
    background.start(Aim::Export, path, move |meter| {
        let written = io::write_file_metered(&file, meter, |out| io::threats::write(out, threats.list()));
        match written {
            Ok(()) => {
                let count = format::count(threats.list().len() as u64);
                Outcome::Exported(format!("{count} threats written to {}.", file.display()))
            }
            Err(_) if meter.is_cancelled() => Outcome::Exported(cancelled(Aim::Export, &file)),
            Err(error) => Outcome::NotWritten(format!("{} could not be written: {error}.", file.display())),
        }
    });
}

fn raster_layer(file: &Path, raster: Raster, reading: RasterReading) -> LayerKind {
    let source = RasterSource { name: name_of(file), raster: Arc::new(RasterPyramid::new(raster)) };
    LayerKind::Raster { source, reading }
}

/// Target diameters by pixel; infinite where the grid has no value.
fn diameters_of(path: &Path, bounds: Rect, meter: &Meter) -> Result<Raster, String> {
    let grid = grid_within(path, bounds, meter)?;
    if let Some((x, y)) = grid.all().pixels().find(|&(x, y)| grid.get(x, y) <= 0.0) {
        let (value, at) = (grid.get(x, y), grid.pixel_center(x, y));
        return Err(format!(
            "{}: the target diameter is {value} at x = {}, y = {}; it must be positive.",
            path.display(),
            at.x,
            at.y
        ));
    }
    let values =
        grid.values().iter().map(|&value| if value.is_nan() { f32::INFINITY } else { value }).collect();
    Ok(Raster::from_values(grid.bounds(), grid.size(), values))
}

/// A grid that covers some of `bounds`.
fn grid_within(path: &Path, bounds: Rect, meter: &Meter) -> Result<Raster, String> {
    let grid = io::asc::read_metered(path, meter).map_err(|error| error.to_string())?;
    if grid.bounds().intersection(&bounds).is_none_or(|common| !common.is_proper()) {
        let (file, grid, document) = (path.display(), extent(&grid.bounds()), extent(&bounds));
        return Err(format!(
            "{file}: the grid lies outside this document: it covers {grid}, and the document {document}. Set the bounds in \
             the Domain panel first."
        ));
    }
    Ok(grid)
}

/// Risks by pixel: a picture over `bounds`, or a grid, which has a placement of its own.
fn risk_of(path: &Path, bounds: Rect, meter: &Meter) -> Result<Raster, String> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("asc")) {
        let picture = io::png::read_metered(path, bounds, Behind::Black, meter);
        return picture.map_err(|error| error.to_string());
    }
    let grid = grid_within(path, bounds, meter)?;
    let file = path.display();
    if let Some((x, y)) = grid.all().pixels().find(|&(x, y)| !is_risk(grid.get(x, y))) {
        let (value, at) = (grid.get(x, y), grid.pixel_center(x, y));
        return Err(format!(
            "{file}: the risk is {value} at x = {}, y = {}; it must lie from 0 to 1. If the values are target \
             diameters, use *Open grid as target diameter…* in the menu File; else scale them first.",
            at.x, at.y
        ));
    }
    let values = grid.values().iter().map(|&risk| if risk.is_nan() { 0.0 } else { risk }).collect();
    Ok(Raster::from_values(grid.bounds(), grid.size(), values))
}

/// Whether a pixel of a grid is a risk, or has no value.
fn is_risk(value: f32) -> bool {
    value.is_nan() || (0.0..=1.0).contains(&value)
}

/// Reads polygons, and opens a document with them as its domain.
pub fn load_domain(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match domain_of(&file, meter) {
        Ok(document) => {
            let opened = Opened { document: Arc::new(document), home: None };
            Outcome::Read { path: file, commands: vec![Command::Show(opened)] }
        }
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads polygons, and adds them to the domain of the document.
pub fn load_outline(session: &Session, background: &mut Background, path: &Path) {
    let (file, settings) = (path.to_owned(), session.document().settings().clone());
    background.start(Aim::Read, path, move |meter| {
        let polygons = match io::geojson::read_named_metered(&file, meter) {
            Ok(polygons) => polygons,
            Err(error) => return Outcome::not_read(error),
        };
        match settings.with_outline(&polygons) {
            Ok(setting) => {
                let change = OutlineChange { name: name_of(&file), before: settings.domain, setting };
                Outcome::Read { path: file, commands: vec![Command::SetOutline(Box::new(change))] }
            }
            Err(error) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

/// Writes the mesh on the screen with h̄ at its nodes, or a picture of all of it in the colours of the view.
///
/// # Errors
/// A sentence, when it is clear at once that nothing can be written there.
pub fn export(
    session: &Session,
    view: &View,
    background: &mut Background,
    path: &Path,
) -> Result<(), String> {
    let format = ExportFormat::of(path).map_err(|error| format!("{error}."))?;
    let blocked =
        |file: &PathBuf| Some(format!("{} could not be written: {}.", file.display(), io::obstacle(file)?));
    if let Some(problem) = format.files(path).iter().find_map(blocked) {
        return Err(problem);
    }
    let (mesh, domain) = (session.shared_mesh(), session.follower().domain().clone());
    let (field, settings) = (session.follower().field().clone(), session.follower().settings().clone());
    let (paint, rule) = (session.document().paint().clone(), settings.rule);
    let look = view.picture(session.document().settings());
    let file = path.to_owned();
    background.start(Aim::Export, path, move |meter| {
        let write = || -> std::io::Result<(Vec<PathBuf>, usize)> {
            let extract = DerivedMesh::new(&mesh, &domain, &settings.derived_cleaning()).extract(&mesh);
            let target_diameter = if format.wants_node_data() {
                let mut targets = TargetsInOrder::new(&field, &paint, rule);
                at_nodes(&extract, meter, |node| targets.at(node))?
            } else {
                Vec::new()
            };
            let boundary = MeshBoundary::new(&extract, &settings.domain, &settings.boundary_marks);
            let parts = extract.part_numbers();
            let (target_diameter, quantities) = (&target_diameter, &[][..]);
            let source = MeshSource::Document(&settings.name);
            let provenance = &Provenance::new(source, mesh.fingerprint(), "x, y").with_unit(settings.unit);
            let (boundary, parts) = (&boundary, &parts);
            let data = MeshData { target_diameter, quantities, boundary, parts, provenance };
            let files = format.write(&file, &mesh, &extract, &data, &look, meter)?;
            Ok((files, extract.triangles().len()))
        };
        match write() {
            Ok((files, triangles)) => {
                let triangles = format::count(triangles as u64);
                Outcome::Exported(format!("{triangles} triangles written to {}.", listed(&files)))
            }
            Err(_) if meter.is_cancelled() => Outcome::Exported(cancelled(Aim::Export, &file)),
            Err(error) => Outcome::NotWritten(format!("{} could not be written: {error}.", file.display())),
        }
    });
    Ok(())
}

/// The document as a recipe at a path, which gets its ending if it has none.
pub fn recipe_of(session: &Session, path: &Path) -> RecipeFiles {
    let has_ending = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(recipe::ENDING));
    let path = if has_ending {
        path.to_owned()
    } else {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".{}", recipe::ENDING));
        name.into()
    };
    RecipeFiles::new(&Project::of(session.document()), &path)
}

/// Writes the document as a recipe, with the files that it names beside it.
pub fn save_recipe(session: &Session, background: &mut Background, path: &Path) {
    let (recipe, file) = (recipe_of(session, path), path.to_owned());
    background.start(Aim::Export, path, move |meter| match recipe.write(meter) {
        Ok(()) => {
            let written: Vec<PathBuf> = recipe.paths().map(Path::to_owned).collect();
            Outcome::Exported(format!("Saved as a recipe: {}.", listed(&written)))
        }
        Err(_) if meter.is_cancelled() => Outcome::Exported(cancelled(Aim::Export, &file)),
        Err(error) => Outcome::NotWritten(format!("{} could not be written: {error}.", file.display())),
    });
}

/// A new document on the polygons of a file.
fn domain_of(path: &Path, meter: &Meter) -> Result<Document, String> {
    let outline = io::geojson::read_outline(path, meter).map_err(|error| error.to_string())?;
    let (domain, marks) = BoundaryMarks::domain_of(&outline.polygons)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (unit, boundary_marks) = (outline.unit, Arc::new(marks));
    let settings = Settings { unit, boundary_marks, ..Settings::for_domain(name, domain) };
    Document::new(settings, None).map_err(|error| format!("{}: {error}", path.display()))
}

/// A value at each node, unless it is cancelled.
fn at_nodes(
    extract: &Extract,
    meter: &Meter,
    mut value: impl FnMut(DVec2) -> f64,
) -> Result<Vec<f64>, Cancelled> {
    let mut values = Vec::with_capacity(extract.nodes().len());
    for (n, node) in extract.world_nodes().enumerate() {
        if n.is_multiple_of(NODES_BETWEEN_CHECKS) {
            meter.check()?;
        }
        values.push(value(node));
    }
    Ok(values)
}

/// Names of files, one after the other.
pub fn listed(files: &[PathBuf]) -> String {
    files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ")
}
