//! Opening and exporting files, and the documents that come with the program.

use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec2;

use super::host::asset;
use meshbrush_kit::kit::Keymap;
use meshbrush_kit::kit::background::{Aim, Background, Outcome, cancelled, exported, listed};
use meshbrush_kit::kit::command::{Command, FileCommand, Opened, ShellCommand};
use meshbrush_kit::kit::export_set::ExportSet;
use meshbrush_kit::kit::mesh_export::{MeshExport, OverlayMaker, WrittenExport};
use meshbrush_kit::kit::session::Session;

use meshbrush_core::document::{
    Document, Example, ExampleData, ExampleMaking, Recording, SeaChart, Settings,
};
use meshbrush_core::domain::NamedPolygon;
use meshbrush_core::raster::Raster;
use meshbrush_io::io::png::{Behind, decode};
use meshbrush_io::io::project::Project;
use meshbrush_io::io::recipe::{self, OpenedRecipe, RecipeFiles};
use meshbrush_io::io::{self, recording};
use meshbrush_kit::kit::view::View;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Bytes, Grouped};
use meshbrush_render::render::export::ExportFormat;
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
    background.start_in_slices(Aim::Read, Path::new(example.name()), begin, move |state, _| slice(state));
}

/// Reads a recipe, which is shown as a document without a file once it is read.
pub fn open_recipe(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match recipe::open(&file, meter) {
        Ok(OpenedRecipe { document, mut notes, outputs }) => {
            notes.extend(ExportSet::of_recipe(outputs.clone()).unheard_keys());
            let opened = Opened { document: Arc::new(document), home: None };
            let exports = Command::from(FileCommand::SetExports(outputs));
            let notes = (!notes.is_empty()).then(|| Command::from(ShellCommand::Tell(notes.join(" "))));
            let commands =
                [Command::from(FileCommand::Show(opened)), exports].into_iter().chain(notes).collect();
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

/// Writes the mesh on the screen with h̄ at its nodes, or a picture of all of it in the colours of the view
/// or of an overlay, in space where the view is.
///
/// # Errors
/// Fails with a sentence when it is clear at once that nothing can be written there.
pub fn export(
    session: &Session,
    view: &View,
    overlay: Option<OverlayMaker>,
    background: &mut Background,
    path: &Path,
) -> Result<(), String> {
    let format = ExportFormat::from_path(path).map_err(|error| format!("{error}."))?;
    let blocked =
        |file: &PathBuf| Some(format!("{} could not be written: {}.", file.display(), io::obstacle(file)?));
    let has_lines = !session.document().settings().lines.is_empty();
    if let Some(problem) = format.files_of(path, has_lines).iter().find_map(blocked) {
        return Err(problem);
    }
    let mesh = MeshExport::of(session, view, format).with_overlay(overlay);
    let file = path.to_owned();
    background.start(Aim::Export, path, move |meter| match mesh.write(&file, meter) {
        Ok(WrittenExport { files, cells, notes }) => {
            let [squares, triangles] = cells.map(|count| format::count(count as u64));
            let squares = if cells[0] > 0 { format!("{squares} squares and ") } else { String::new() };
            let notes: String = notes.iter().map(|note| format!(" {note}")).collect();
            Outcome::Exported(format!("{squares}{triangles} triangles written to {}.{notes}", listed(&files)))
        }
        Err(_) if meter.is_cancelled() => Outcome::Exported(cancelled(Aim::Export, &file)),
        Err(error) => Outcome::NotWritten(format!("{} could not be written: {error}.", file.display())),
    });
    Ok(())
}

/// Returns the document as a recipe at a path, which gets its ending if it has none.
pub fn recipe_of(session: &Session, exports: &ExportSet, path: &Path) -> RecipeFiles {
    let has_ending = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(recipe::ENDING));
    let path = if has_ending {
        path.to_owned()
    } else {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".{}", recipe::ENDING));
        name.into()
    };
    let outputs = exports.for_recipe_in(path.parent().unwrap_or(Path::new("")));
    RecipeFiles::with_outputs(&Project::of(session.document()), &path, outputs)
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
pub fn save_recipe(session: &Session, exports: &ExportSet, background: &mut Background, path: &Path) {
    let (recipe, file) = (recipe_of(session, exports, path), path.to_owned());
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
