//! Opening and exporting files, and the documents that come with the program.

use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::host::asset;
use meshbrush_kit::kit::Keymap;
use meshbrush_kit::kit::background::{Aim, Background, Outcome, cancelled, exported, listed};
use meshbrush_kit::kit::command::{Command, FileCommand, Opened, ShellCommand};
use meshbrush_kit::kit::session::Session;

use meshbrush_core::document::{
    Document, Example, ExampleData, ExampleMaking, Recording, SeaChart, Settings,
};
use meshbrush_core::domain::{MeshBoundary, NamedPolygon};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::{Layer, NodeDepths};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::raster::Raster;
use meshbrush_core::surface::{HeightSource, SurfaceRule};
use meshbrush_io::io::png::{Behind, decode};
use meshbrush_io::io::project::Project;
use meshbrush_io::io::recipe::{self, OpenedRecipe, RecipeFiles};
use meshbrush_io::io::{
    self, DEPTH, MeshData, MeshSource, NodeValues, Provenance, SURFACE, ThirdCoordinate, recording,
};
use meshbrush_kit::kit::view::{Space, View};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Extract, Fingerprint, MeshView};
use meshbrush_mesh::text::{Bytes, Grouped};
use meshbrush_render::render::export::ExportFormat;
use meshbrush_render::render::look::Look;
use meshbrush_render::render::space_look::SpaceLook;
use meshbrush_render::scene::NodeHeights;
use meshbrush_ui::widgets::format;

/// Width and height in kilometres of the terrain that comes with the program: 403 × 344 pixels of 3″ at 36.6°
/// N.
const TERRAIN_KM: DVec2 = DVec2::new(30.0, 31.8);

/// The sea between Greece and Turkey, as a file.
pub const AEGEAN_SEA: &str = "aegean_sea.geojson";
const CELTIC_SEA: &str = "celtic_sea.geojson";
const CELTIC_DEPTHS: &str = "celtic_sea_depths.tif";
const SLOPE: &str = "jacksboro_slope.png";
const HEIGHTS: &str = "jacksboro_heights.tif";

/// Returns the files of an example.
pub fn data_of(example: Example) -> &'static [&'static str] {
    match example {
        Example::Terrain | Example::Layers => &[SLOPE],
        Example::Heights => &[HEIGHTS],
        Example::Aegean => &[AEGEAN_SEA],
        Example::CelticSea => &[CELTIC_SEA, CELTIC_DEPTHS],
        _ => &[],
    }
}

/// Returns the files of an example that are not here yet: a page fetches them.
pub fn missing_for(example: Example) -> Vec<&'static str> {
    data_of(example).iter().copied().filter(|file| asset(file).is_none()).collect()
}

/// Returns a file of an example that is here.
fn present(file: &str) -> &'static [u8] {
    asset(file).expect("whoever opens an example fetches what is missing for it")
}

/// Returns the slope of a real terrain as risk.
pub fn terrain_slope() -> Raster {
    let bounds = Rect::new(DVec2::ZERO, TERRAIN_KM);
    decode(Cursor::new(present(SLOPE)), bounds, Behind::Black)
        .expect("the picture is part of the program: a test opens it")
}

/// Returns the sea between Greece and Turkey.
fn aegean_sea() -> Vec<NamedPolygon> {
    io::geojson::read_named_from(present(AEGEAN_SEA), Path::new(AEGEAN_SEA))
        .expect("the outline is part of the program: a test opens it")
}

/// Returns the Celtic Sea and its depths.
fn celtic_sea() -> SeaChart {
    SeaChart {
        sea: io::geojson::read_named_from(present(CELTIC_SEA), Path::new(CELTIC_SEA))
            .expect("the outline is part of the program: a test opens it"),
        depths: io::geotiff::decode(Cursor::new(present(CELTIC_DEPTHS)))
            .expect("the depths are part of the program: a test opens them")
            .raster,
    }
}

/// The data that comes with the program.
struct Assets;

impl ExampleData for Assets {
    fn slope(&self) -> Raster {
        terrain_slope()
    }

    fn heights(&self) -> Raster {
        io::geotiff::decode(Cursor::new(present(HEIGHTS)))
            .expect("the heights are part of the program: a test opens them")
            .raster
    }

    fn sea(&self) -> Vec<NamedPolygon> {
        aegean_sea()
    }

    fn chart(&self) -> SeaChart {
        celtic_sea()
    }
}

/// Returns an empty document.
pub fn new_document() -> Document {
    Document::new(Settings::default(), None).expect("the default settings are valid: a test opens them")
}

/// Returns a document that comes with the program, of which nothing is [missing](missing_for).
pub fn example(example: Example) -> Document {
    example.document(&Assets)
}

/// Makes the document of an example, of which nothing is [missing](missing_for), in slices, and then shows
/// it.
pub fn open_example_in_slices(background: &mut Background, example: Example) {
    let begin = move || Some(example.making(&Assets));
    let slice = move |making: &mut ExampleMaking| {
        let opened = Opened { document: Arc::new(making.advance()?), home: None };
        Some(Outcome::PartRead(vec![Command::from(FileCommand::ShowExample(example, opened))]))
    };
    background.start_in_slices(Aim::Read, Path::new(example.name()), begin, slice);
}

/// Reads a recipe, which is shown as a document without a file once it is read.
pub fn open_recipe(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match recipe::open(&file, meter) {
        Ok(OpenedRecipe { document, notes }) => {
            let opened = Opened { document: Arc::new(document), home: None };
            let notes = (!notes.is_empty()).then(|| Command::from(ShellCommand::Tell(notes.join(" "))));
            let commands = [Command::from(FileCommand::Show(opened))].into_iter().chain(notes).collect();
            Outcome::Read { path: file, commands }
        }
        Err(error) => Outcome::not_read(error),
    });
}

/// Most bytes of a file of keys.
const MOST_BYTES_OF_KEYS: u64 = 1_000_000;

/// Writes the keys that were changed.
pub fn export_keys(keymap: &Keymap, background: &mut Background, path: &Path) {
    let (text, file) = (keymap.to_text(), path.to_owned());
    background.start(Aim::Export, path, move |meter| {
        let written = io::write_file_metered(&file, meter, |out| out.write_all(text.as_bytes()));
        exported(written, meter, &file, || format!("The changed keys were written to {}.", file.display()))
    });
}

/// Reads changed keys in place of those of the window.
pub fn import_keys(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |_| {
        let read = io::read_text(&file, MOST_BYTES_OF_KEYS).map_err(|error| format!("{error}."));
        match read.and_then(|text| Keymap::parse(&text)) {
            Ok(keymap) => Outcome::PartRead(vec![
                Command::from(ShellCommand::SetKeys(keymap)),
                Command::from(ShellCommand::Tell(format!("The keys of {} are in use.", file.display()))),
            ]),
            Err(problem) => Outcome::NotRead(format!("{} could not be read. {problem}", file.display())),
        }
    });
}

/// Writes the mesh on the screen with h̄ at its nodes, or a picture of all of it in the colours of the view,
/// in space where the view is.
///
/// # Errors
/// Fails with a sentence when it is clear at once that nothing can be written there.
pub fn export(
    session: &Session,
    view: &View,
    background: &mut Background,
    path: &Path,
) -> Result<(), String> {
    let format = ExportFormat::from_path(path).map_err(|error| format!("{error}."))?;
    let blocked =
        |file: &PathBuf| Some(format!("{} could not be written: {}.", file.display(), io::obstacle(file)?));
    if let Some(problem) = format.files(path).iter().find_map(blocked) {
        return Err(problem);
    }
    let (mesh, domain) = (session.follower().shared_mesh(), session.follower().domain().clone());
    let (field, settings) = (session.follower().field().clone(), session.follower().settings().clone());
    let (paint, rule) = (session.document().paint().clone(), settings.rule);
    let surface = session.follower().surface().cloned();
    let look = view.picture_of(session.document().settings());
    let is_picture = matches!(format, ExportFormat::Png | ExportFormat::Svg);
    let space = is_picture.then_some(view.space).filter(|space| space.is_on);
    let file = path.to_owned();
    background.start(Aim::Export, path, move |meter| {
        let write = || -> std::io::Result<(Vec<PathBuf>, usize)> {
            let extract = DerivedMesh::new(&mesh, &domain, &settings.derived_cleaning()).extract(&mesh);
            let target_diameter = if format.has_targets() {
                field.targets_at_nodes(rule, &paint, &extract, || meter.check())?
            } else {
                Vec::new()
            };
            let in_space = |space| look_in_space(&space, surface.as_deref(), &settings.layers, &extract);
            let look = Look { space: space.and_then(in_space), ..look };
            let boundary = &MeshBoundary::new(&extract, &settings.domain, &settings.boundary_marks);
            let parts = &extract.part_numbers();
            let quantities = match format.wants_node_data() {
                true => values_at_nodes(&settings.layers, surface.as_deref(), extract.view())?,
                false => Vec::new(),
            };
            let (target_diameter, quantities) = (&target_diameter, &quantities[..]);
            let heights = quantities.iter().find(|values| values.name == SURFACE).map(|it| &*it.values);
            // A model in space has lengths along all axes.
            let is_model = format.third_coordinate() == ThirdCoordinate::Model && heights.is_some();
            let provenance = &provenance_of(&settings, mesh.fingerprint(), is_model);
            let data = MeshData { target_diameter, quantities, heights, boundary, parts, provenance };
            let nodes = settings.domain.nodes_in(&Coordinates::Geographic, &extract).filter(|_| !is_model);
            let placed = nodes.map(|nodes| extract.with_coordinates(nodes));
            let placed = placed.as_ref().unwrap_or(&extract);
            let files = format.write(&file, &mesh, placed, &data, &look, meter)?;
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

/// Returns the origin of a mesh, with its coordinates: those of the plane in models.
fn provenance_of(settings: &Settings, fingerprint: Fingerprint, is_model: bool) -> Provenance {
    let source = MeshSource::Document(&settings.name);
    let provenance = Provenance::new(source, fingerprint, "x, y").with_unit(settings.unit);
    match settings.domain.projection {
        Some(plane) if is_model => provenance.in_plane(&plane),
        plane => provenance.in_coordinates(&Coordinates::Geographic, plane),
    }
}

/// Returns how a picture of a mesh looks in space; `None` where no layer has heights.
fn look_in_space(
    space: &Space,
    surface: Option<&SurfaceRule>,
    layers: &[Layer],
    extract: &Extract,
) -> Option<SpaceLook> {
    let heights = HeightSource::new(surface, layers)?.at_nodes(extract.lattice(), extract.nodes());
    Some(space.picture(NodeHeights::new(&heights, &[])?, extract.lattice()))
}

/// Returns the depths and the heights of surfaces at the nodes of a mesh, where layers have them.
fn values_at_nodes(
    layers: &[Layer],
    surface: Option<&SurfaceRule>,
    mesh: MeshView,
) -> std::io::Result<Vec<NodeValues>> {
    let depths = NodeDepths::of(layers, mesh).transpose().map_err(std::io::Error::other)?;
    let depths = depths.map(|depths| (DEPTH, depths.depths));
    let heights = surface.map(|rule| (SURFACE, rule.samples().filled_heights(mesh)));
    let values = |(name, values): (&str, Vec<f64>)| NodeValues { name: name.into(), values };
    Ok(depths.into_iter().chain(heights).map(values).collect())
}

/// Returns the document as a recipe at a path, which gets its ending if it has none.
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

/// Does the edits since the document was opened again, and writes each with the fingerprint of the mesh
/// after it.
///
/// # Errors
/// Fails with a sentence when there were more edits than are recorded.
pub fn export_test(session: &mut Session, background: &mut Background, path: &Path) -> Result<(), String> {
    let document = session.document_mut();
    document.end_stroke();
    document.end_gesture();
    let Some(recording) = document.recording().filter(|recording| !recording.is_full()).cloned() else {
        let most = Bytes(Recording::MAX_BYTES);
        return Err(format!(
            "This session cannot be exported as a test: its edits need more than {most}. Save the document and open it \
             again: a test begins with the document as it was opened."
        ));
    };
    let file = path.to_owned();
    background.start(Aim::Export, path, move |meter| {
        let write = |out: &mut dyn Write| recording::write(out, &recording, meter);
        exported(io::write_file_metered(&file, meter, write), meter, &file, || {
            let edits = match recording.edits().len() {
                1 => "1 edit".into(),
                count => format!("{} edits", Grouped(count)),
            };
            format!("{edits} written to {}; “meshbrush replay” verifies them.", file.display())
        })
    });
    Ok(())
}

/// Writes the document as a recipe, with the files that it names beside it.
pub fn save_recipe(session: &Session, background: &mut Background, path: &Path) {
    let (recipe, file) = (recipe_of(session, path), path.to_owned());
    background.start(Aim::Export, path, move |meter| match recipe.write(meter) {
        Ok(()) => {
            let written: Vec<PathBuf> = recipe.paths().map(Path::to_owned).collect();
            let left_out = recipe.left_out().map_or(String::new(), |sentence| format!(" {sentence}"));
            Outcome::Exported(format!("Saved as a recipe: {}.{left_out}", listed(&written)))
        }
        Err(_) if meter.is_cancelled() => Outcome::Exported(cancelled(Aim::Export, &file)),
        Err(error) => Outcome::NotWritten(format!("{} could not be written: {error}.", file.display())),
    });
}
