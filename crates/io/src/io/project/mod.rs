//! `.meshbrush`: a document in one file.
//!
//! A ZIP archive, so that every tool can inspect it, with these parts in this order:
//!
//! - `settings.json`: `format`, `version`, the program that wrote it, and all settings; numbers read back
//!   exactly.
//! - `domain.N`, if the domain has polygons.
//! - `raster.N` for each raster that layers read: 32-bit floats, row by row from the lowest, NaN where there
//!   is no value.
//! - `shapes.N`, `threats.N` and `polygons.N` for shapes, threats, masks and keep-out regions of more than
//!   20 points, `points.N` for more than 20 pins: 64-bit floats ([`lists`]). Fewer are in `settings.json`.
//! - `background.png`, if there is a picture behind the mesh.
//! - `paint.ID` for each paint layer with paint: its tiles of 32 × 32 pixels.
//!
//! Parts of a kind are numbered from 0 in the order of the layers. Layers have the vocabulary of recipes
//! ([`super::layers`]). All limits are in [`limits`]: writing and reading check them alike.
//!
//! Pixels are stored as four planes of bytes, the most significant bytes of all numbers first, which packs to
//! half the size. Tiles are ordered by column, then row; blank tiles are omitted. The CRC-32 of the archive
//! detects damage. There are no dates: equal documents give equal bytes, and saving a project that was just
//! opened gives the same file. The history is not saved.
//!
//! # How the format grows
//!
//! - A program refuses a file of a newer version, with a sentence that names both versions.
//! - A new key is optional, is left out where it has its default value, and keeps the version. A program that
//!   does not know the key refuses only the files that use it, as it refuses every unknown key: a document is
//!   never read in part.
//! - A key or part that changes its meaning, is removed, or becomes required raises the version. A program
//!   goes on reading all versions before its own.

mod archive;
mod changes;
pub(super) mod embedded;
mod limits;
mod lists;
mod packing;
mod painted;
mod part_names;
mod part_reader;
mod paths;
mod pixels;
mod saved_background;
mod saved_cut;
mod settings;
mod stored_layers;
mod stored_lines;
mod tiled;

use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::path::Path;

use super::error::{Flaw, PlacedFlaw, ReadError};
use super::{FileStamp, Meter};
use crate::io::disk::File;
use archive::{Archive, ArchivePart, ArchiveWriter};
pub(super) use changes::{Change, Recorded, Replay};
use limits::Limits;
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::layers::{Layer, LayerId, PaintLayers, Quantity};
use meshbrush_mesh::text::Bytes;
pub use packing::ProjectPacking;
use part_names::PartData;
pub(super) use part_names::PartNames;
use part_reader::{PartReader, in_part, part};
use settings::Saved;

/// The extension of project files.
pub const ENDING: &str = "meshbrush";

/// The version that is written, and the newest that is read.
const VERSION: u64 = 1;
const FORMAT: &str = "Meshbrush project";

const SETTINGS: &str = "settings.json";
const BACKGROUND: &str = "background.png";
/// The name of the parts with paint in error messages.
const PAINT: &str = "paint";

/// The saved part of a document.
///
/// It shares the painted tiles, so making one takes no time, and another thread can write it.
#[derive(Clone, Debug, PartialEq)]
pub struct Project {
    /// Everything except paint.
    pub settings: Settings,
    /// The painted pixels.
    pub paint: PaintLayers,
}

impl Project {
    /// Returns the current state of a document, the current stroke included.
    pub fn of(document: &Document) -> Self {
        Self { settings: document.settings().clone(), paint: document.paint().clone() }
    }

    /// Returns the document, with an empty history.
    ///
    /// # Errors
    /// Fails with a sentence for a person when the settings are out of range.
    pub fn into_document(self) -> Result<Document, String> {
        Document::new(self.settings, Some(self.paint)).map_err(|error| error.to_string())
    }
}

/// Reads a document.
///
/// # Errors
/// Fails when the file cannot be read, is not a project, is cut off or damaged, was written by a newer
/// program, or has values that no document can have.
pub fn read(path: &Path) -> Result<Document, ReadError> {
    read_metered(path, &Meter::default())
}

/// Reads a project as [`read`] does. The bytes of the file are counted when they are read, and again when
/// they are unpacked.
///
/// # Errors
/// Fails as [`read`] does, and when the work was cancelled.
pub fn read_metered(path: &Path, meter: &Meter) -> Result<Document, ReadError> {
    read_stamped(path, meter).map(|(document, _)| document)
}

/// Reads a project as [`read_metered`] does, and returns also the stamp of the file's bytes.
///
/// # Errors
/// Fails as [`read_metered`] does.
pub fn read_stamped(path: &Path, meter: &Meter) -> Result<(Document, FileStamp), ReadError> {
    let bytes = || -> Result<Vec<u8>, PlacedFlaw> {
        let mut bytes = Vec::new();
        let file = File::open(path)?;
        meter.expect(2 * file.length()?);
        let most = Limits::PROJECT.file;
        let mut file = meter.count(file.take(most + 1));
        (&mut file).take(archive::FIRST_BYTES.len() as u64).read_to_end(&mut bytes)?;
        if bytes != archive::FIRST_BYTES {
            return Ok(bytes); // another kind of file, however long: these bytes suffice to refuse it
        }
        file.read_to_end(&mut bytes)?;
        if bytes.len() as u64 > most {
            let limit = Bytes(most as usize);
            return Err(
                Flaw::Syntax(format!("the file is larger than {limit}, the limit for a project.")).into()
            );
        }
        Ok(bytes)
    };
    let project = bytes().and_then(|bytes| {
        let project = parse(&bytes, meter)?;
        meter.check()?;
        Ok((project, FileStamp::from_bytes(&bytes)))
    });
    let (project, stamp) = project.map_err(|flaw| flaw.in_file(path))?;
    let document = project.into_document();
    let document = document.map_err(|problem| PlacedFlaw::from(Flaw::Syntax(problem)).in_file(path))?;
    Ok((document, stamp))
}

/// Reads a project from bytes. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<Project, ReadError> {
    parse(bytes, &Meter::default()).map_err(|flaw| flaw.in_file(name))
}

/// Writes a project.
///
/// # Errors
/// Fails with the errors of `out`, and when a part is beyond its limit.
pub fn write(out: &mut dyn Write, project: &Project) -> io::Result<()> {
    let mut names = PartNames::default();
    let new = names.add(&project.settings);
    write_parts(out, &parts(project, &names, &new), &Meter::default())
}

/// Writes a project as [`write()`] does, and counts the bytes before packing.
///
/// # Errors
/// Fails as [`write()`] does, and when the work was cancelled.
pub fn write_metered(out: &mut dyn Write, project: &Project, meter: &Meter) -> io::Result<()> {
    let mut names = PartNames::default();
    let new = names.add(&project.settings);
    let parts = parts(project, &names, &new);
    // Packing takes far longer than this pass, which finds the number of bytes.
    let size = Meter::default();
    for (_, write) in &parts {
        write(&mut size.count(io::sink()))?;
        meter.check()?;
    }
    meter.expect(size.done());
    write_parts(out, &parts, meter)
}

/// A part of the archive: its name, and a function that writes its bytes.
type ToWrite<'a> = (Cow<'static, str>, Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>);

fn parts<'a>(project: &'a Project, names: &'a PartNames, new: &'a [(String, PartData)]) -> Vec<ToWrite<'a>> {
    let Project { settings, paint } = project;
    let mut parts: Vec<ToWrite> =
        vec![(SETTINGS.into(), Box::new(|out| settings::write(out, settings, names)))];
    for (name, data) in new {
        parts.push((name.clone().into(), Box::new(|out| data.write(out))));
    }
    for (id, raster) in
        paint.iter().filter(|(id, raster)| settings.layer(*id).is_some() && !raster.is_blank())
    {
        parts.push((paint_part(id).into(), Box::new(|out| painted::write(out, raster))));
    }
    parts
}

/// Returns the part with the pixels of a paint layer.
fn paint_part(id: LayerId) -> String {
    format!("paint.{}", id.0)
}

fn write_parts(out: &mut dyn Write, parts: &[ToWrite], meter: &Meter) -> io::Result<()> {
    let mut archive = ArchiveWriter::new(out, Limits::PROJECT);
    for (name, write) in parts {
        archive.add(name, meter, write)?;
    }
    archive.finish().map(|_| ())
}

fn parse(bytes: &[u8], meter: &Meter) -> Result<Project, PlacedFlaw> {
    let archive = Archive::open(bytes, Limits::PROJECT)?;
    let text = part(&archive, SETTINGS)?.bytes(meter);
    let text = text.map_err(|flaw| in_part(flaw, SETTINGS))?;
    let saved = Saved::parse(&text).map_err(|flaw| flaw.within(SETTINGS))?;
    let names = &mut PartNames::default();
    let parts = &mut PartReader { archive: &archive, names, meter, polygons: None };
    let settings = saved.into_settings(parts).map_err(|flaw| match flaw.place {
        super::PlaceInFile::Part(..) => flaw,
        _ => flaw.within(SETTINGS),
    })?;
    let paint = paint(&archive, &settings, meter)?;
    Ok(Project { settings, paint })
}

/// Returns the pixels of the paint layers.
fn paint(archive: &Archive, settings: &Settings, meter: &Meter) -> Result<PaintLayers, PlacedFlaw> {
    let mut paint = PaintLayers::default();
    for (id, quantity, part) in paint_parts(archive, settings) {
        let mut unpacking = part.unpack(meter);
        let raster = painted::read(&mut unpacking, quantity);
        let raster = raster.and_then(|raster| unpacking.finish().map(|()| raster));
        paint.insert(id, raster.map_err(|flaw| in_part(flaw, PAINT))?);
    }
    Ok(paint)
}

/// Returns the parts with paint, and the layers that they belong to.
fn paint_parts<'b, 'a>(
    archive: &'b Archive<'a>,
    settings: &'b Settings,
) -> impl Iterator<Item = (LayerId, Quantity, &'b ArchivePart<'a>)> {
    let part = |layer: &Layer| Some((layer.id, layer.paints()?, archive.part(&paint_part(layer.id))?));
    settings.layers.iter().filter_map(part)
}
