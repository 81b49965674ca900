//! `.meshbrush`: a document in one file.
//!
//! A ZIP archive, so that every tool can inspect it, with these parts in this order:
//!
//! - `settings.json`: `format`, `version`, the program that wrote it, and all settings; numbers read back
//!   exactly.
//! - `domain.geojson`, if the domain has polygons: their corners in world units.
//! - `raster.N` for each raster that layers read, numbered from 0 in the order of the layers: 32-bit floats,
//!   row by row from the lowest, NaN where there is no value.
//! - `background.png`, if there is a picture behind the mesh.
//! - `paint.ID` for each paint layer with paint: its tiles of 32 × 32 pixels.
//!
//! Layers have the vocabulary of recipes ([`super::layers`]). Threats, shapes and masks are in
//! `settings.json`.
//!
//! Version 1 had one base field (`base.risk` or `base.diameter`) and two rasters of paint (`paint.tiles`) in
//! place of the layers. Version 2 had no pins, paths and corridors. In version 3 the curve from risk to
//! diameter ended at the smallest diameter, and paths had no names.
//!
//! Pixels are stored as four planes of bytes, the most significant bytes of all numbers first, which packs to
//! half the size. Tiles are ordered by column, then row; blank tiles are omitted. The CRC-32 of the archive
//! detects damage. There are no dates: equal documents give equal bytes, and saving a project that was just
//! opened gives the same file. The history is not saved.
//!
//! The version grows whenever an older program could not read the file correctly, which includes any new
//! field or word: a test keeps the list of all of them. A program reads all versions up to its own.

mod archive;
pub(super) mod embedded;
#[cfg(test)]
mod keys;
mod old_tiles;
mod old_version;
mod packing;
mod painted;
mod part_names;
mod paths;
mod pixels;
mod saved_background;
mod settings;
mod stored_layers;
mod tiled;

use std::borrow::Cow;
use std::io::{self, Cursor, Read, Write};
use std::path::Path;
use std::sync::Arc;

use super::error::{Flaw, PlacedFlaw, ReadError};
use super::{FileStamp, Meter, geojson, png};
use crate::io::disk::File;
use archive::{Archive, ArchivePart, ArchiveWriter};
use meshbrush_core::document::{Document, Picture, Settings};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{Layer, LayerId, PaintLayers, Quantity, RasterReading};
use meshbrush_core::raster::{Raster, RasterPyramid, TiledRaster};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::excerpt;
use old_version::OLD_PAINT;
pub use packing::ProjectPacking;
use painted::Allowance;
use part_names::NewParts;
pub(super) use part_names::PartNames;
use settings::{Parts, Saved};

/// The extension of project files.
pub const ENDING: &str = "meshbrush";

/// The version that is written, and the newest that is read.
const VERSION: u64 = 11;
const FORMAT: &str = "Meshbrush project";

const SETTINGS: &str = "settings.json";
const DOMAIN: &str = "domain.geojson";
/// The name of a part with the pixels of a raster in error messages.
const RASTER: &str = "raster";
const BASE_RISK: &str = "base.risk";
const BASE_DIAMETER: &str = "base.diameter";
const BACKGROUND: &str = "background.png";
/// The name of the parts with paint in error messages.
const PAINT: &str = "paint";
const OLD_TILES: &str = "paint.tiles";

/// Largest file read: the limit of the archive.
const MOST_BYTES: u64 = u32::MAX as u64;
/// Most bytes of the settings: enough for a name for each of 300,000 islands.
const MOST_SETTINGS: u64 = 64 << 20;
/// Most bytes of the background picture, packed.
const MOST_BACKGROUND: u64 = 128 << 20;
/// Most bytes of the polygons, more than a million corners need.
const MOST_POLYGONS: u64 = 128 << 20;

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
        let mut file = meter.count(file.take(MOST_BYTES + 1));
        (&mut file).take(archive::FIRST_BYTES.len() as u64).read_to_end(&mut bytes)?;
        if bytes != archive::FIRST_BYTES {
            return Ok(bytes); // another kind of file, however long: these bytes suffice to refuse it
        }
        file.read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MOST_BYTES {
            let limit = MOST_BYTES >> 20;
            return Err(Flaw::Syntax(format!(
                "the file is larger than {limit} MiB, the limit for a project."
            ))
            .into());
        }
        Ok(bytes)
    };
    let project = bytes().and_then(|bytes| {
        let project = parse(&bytes, meter)?;
        meter.check()?;
        Ok((project, FileStamp::of(&bytes)))
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
/// Fails with the errors of `out`.
pub fn write(out: &mut dyn Write, project: &Project) -> io::Result<()> {
    write_named(out, project, &mut PartNames::default())
}

/// Writes a project without the rasters and pictures that have a name already, and names the others.
///
/// # Errors
/// Fails with the errors of `out`.
pub(super) fn write_named(out: &mut dyn Write, project: &Project, names: &mut PartNames) -> io::Result<()> {
    let new = names.add(&project.settings);
    write_parts(out, &parts(project, names, &new), &Meter::default())
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

fn parts<'a>(project: &'a Project, names: &'a PartNames, new: &'a NewParts) -> Vec<ToWrite<'a>> {
    let Project { settings, paint } = project;
    let mut parts: Vec<ToWrite> = vec![(
        SETTINGS.into(),
        Box::new(|out| {
            serde_json::to_writer_pretty(&mut *out, &Saved::of(settings, names))?;
            writeln!(out)
        }),
    )];
    if let Some(region) = settings.domain.region() {
        parts.push((DOMAIN.into(), Box::new(|out| geojson::write(out, region.polygons()))));
    }
    for (name, raster) in &new.rasters {
        parts.push((name.clone().into(), Box::new(|out| pixels::write_raster(out, raster.raster()))));
    }
    if let Some((name, picture)) = &new.picture {
        let write = |mut out: &mut dyn Write| png::write(&mut out, picture.size, &picture.rgba);
        parts.push((name.clone().into(), Box::new(write)));
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
    let mut archive = ArchiveWriter::new(out);
    for (name, write) in parts {
        archive.add(name, meter, write)?;
    }
    archive.finish().map(|_| ())
}

fn parse(bytes: &[u8], meter: &Meter) -> Result<Project, PlacedFlaw> {
    parse_named(bytes, &mut PartNames::default(), meter)
}

/// Reads a project that [`write_named`] wrote; `names` are the rasters and pictures read so far.
pub(super) fn parse_named(bytes: &[u8], names: &mut PartNames, meter: &Meter) -> Result<Project, PlacedFlaw> {
    let archive = Archive::open(bytes)?;
    let text = part(&archive, SETTINGS)?.bytes(MOST_SETTINGS, meter);
    let text = text.map_err(|flaw| in_part(flaw, SETTINGS))?;
    let saved = Saved::parse(&text).map_err(|flaw| flaw.within(SETTINGS))?;
    let old_paint_size = saved.old_paint_size().map_err(|flaw| flaw.within(SETTINGS))?;
    let packed = &mut Packed { archive: &archive, names, meter };
    let settings = saved.into_settings(packed).map_err(|flaw| match flaw.place {
        super::Place::Part(..) => flaw,
        _ => flaw.within(SETTINGS),
    })?;
    let paint = match old_paint_size {
        Some(size) => old_paint(&archive, size, settings.domain.bounds, meter)
            .map_err(|flaw| in_part(flaw, OLD_TILES))?,
        None => paint(&archive, &settings, meter)?,
    };
    Ok(Project { settings, paint })
}

/// Returns the pixels of the paint layers.
fn paint(archive: &Archive, settings: &Settings, meter: &Meter) -> Result<PaintLayers, PlacedFlaw> {
    let mut paint = PaintLayers::default();
    let mut allowance = Allowance::for_parts(paint_parts(archive, settings).map(|(_, _, part)| part));
    for (id, quantity, part) in paint_parts(archive, settings) {
        let raster = allowance.unpack(part, meter).and_then(|mut unpacking| {
            let raster = painted::read(&mut unpacking, quantity)?;
            unpacking.finish()?;
            Ok(raster)
        });
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

/// Returns the pixels of the paint in version 1.
fn old_paint(archive: &Archive, size: [u32; 2], bounds: Rect, meter: &Meter) -> Result<PaintLayers, Flaw> {
    let part = archive.part(OLD_TILES).ok_or(Flaw::Damaged)?;
    let mut unpacking = part.unpack(pixels::most_tile_bytes(size), meter)?;
    let tiles = pixels::read_tiles(&mut unpacking, size)?;
    unpacking.finish()?;
    let mut paint = PaintLayers::default();
    for (id, quantity) in OLD_PAINT.into_iter().zip([Quantity::Diameter, Quantity::Risk]) {
        let raster = tiled::from_old_tiles(&bounds, size, &tiles, quantity);
        if !raster.is_blank() {
            paint.insert(id, raster);
        }
    }
    Ok(paint)
}

/// Writes an archive of the tiles in which the paint of layers differs from an earlier state.
///
/// # Errors
/// Fails with the errors of `out`.
pub(super) fn write_paint_changes(
    out: &mut dyn Write,
    before: &PaintLayers,
    after: &PaintLayers,
) -> io::Result<()> {
    let mut parts: Vec<ToWrite> = Vec::new();
    for (id, raster) in after.iter() {
        let changes = painted::changes(before.get(id), raster);
        if !changes.is_empty() {
            let write = move |out: &mut dyn Write| painted::write_changes(out, raster, &changes);
            parts.push((paint_part(id).into(), Box::new(write)));
        }
    }
    write_parts(out, &parts, &Meter::default())
}

/// Reads such an archive into the paint of layers.
///
/// # Errors
/// Fails when it is damaged. Some of the changes may then be made.
pub(super) fn read_paint_changes(
    bytes: &[u8],
    settings: &Settings,
    paint: &mut PaintLayers,
) -> Result<(), Flaw> {
    let archive = Archive::open(bytes)?;
    let mut allowance = Allowance::for_parts(paint_parts(&archive, settings).map(|(_, _, part)| part));
    for (id, quantity, part) in paint_parts(&archive, settings) {
        let mut unpacking = allowance.unpack(part, &Meter::default())?;
        let (grid, changes) = painted::read_changes(&mut unpacking, quantity)?;
        unpacking.finish()?;
        let raster = paint.get_or_insert(id, || TiledRaster::new(grid, quantity.blank()));
        painted::apply(raster, changes);
    }
    Ok(())
}

fn part<'b, 'a>(archive: &'b Archive<'a>, name: &str) -> Result<&'b ArchivePart<'a>, PlacedFlaw> {
    let missing = || {
        let problem = match name {
            SETTINGS => format!("this is not a Meshbrush project: it has no {name}."),
            _ => format!("the project has no part {}. Use another copy.", excerpt(40, name)),
        };
        Flaw::Syntax(problem).into()
    };
    archive.part(name).ok_or_else(missing)
}

fn in_part(flaw: Flaw, part: &'static str) -> PlacedFlaw {
    PlacedFlaw::from(flaw).within(part)
}

/// Unpacks the parts that the settings refer to.
struct Packed<'b, 'a> {
    archive: &'b Archive<'a>,
    names: &'b mut PartNames,
    meter: &'b Meter,
}

impl Packed<'_, '_> {
    /// Unpacks `count` pixels with `read`. Errors call the part `what`.
    fn unpack<T>(
        &self,
        name: &str,
        what: &'static str,
        [columns, rows]: [u32; 2],
        read: impl FnOnce(&mut archive::Unpacking) -> Result<T, Flaw>,
    ) -> Result<T, PlacedFlaw> {
        let bytes = 4 * u64::from(columns) * u64::from(rows);
        let read = part(self.archive, name)?.unpack(bytes, self.meter).and_then(|mut unpacking| {
            let read = read(&mut unpacking)?;
            unpacking.finish()?;
            Ok(read)
        });
        read.map_err(|flaw| in_part(flaw, what))
    }
}

impl Parts for Packed<'_, '_> {
    fn polygons(&mut self) -> Result<Vec<Polygon>, PlacedFlaw> {
        let text = part(self.archive, DOMAIN)?.bytes(MOST_POLYGONS, self.meter);
        let text = text.map_err(|flaw| in_part(flaw, DOMAIN))?;
        geojson::parse(&text[..])
            .map(|outline| geojson::without_names(outline.polygons))
            .map_err(|flaw| flaw.within(DOMAIN))
    }

    fn background(&mut self, name: &str) -> Result<Arc<Picture>, PlacedFlaw> {
        if let Some(picture) = self.names.picture(name) {
            return Ok(picture.clone());
        }
        let bytes = part(self.archive, name)?.bytes(MOST_BACKGROUND, self.meter);
        let picture = bytes.and_then(|bytes| png::decode_picture(Cursor::new(bytes)));
        let picture = Arc::new(picture.map_err(|flaw| in_part(flaw, BACKGROUND))?);
        self.names.insert_picture(name, picture.clone());
        Ok(picture)
    }

    fn raster(&mut self, name: &str, bounds: Rect, size: [u32; 2]) -> Result<Arc<RasterPyramid>, PlacedFlaw> {
        if let Some(raster) = self.names.raster(name) {
            let is_alike = raster.raster().bounds() == bounds && raster.raster().size() == size;
            let problem = "two layers disagree about its size or place.";
            return match is_alike {
                true => Ok(raster.clone()),
                false => Err(in_part(Flaw::Syntax(problem.into()), RASTER)),
            };
        }
        let read = |input: &mut archive::Unpacking| pixels::read_values(input, bounds, size);
        let raster = Arc::new(RasterPyramid::new(self.unpack(name, RASTER, size, read)?));
        self.names.insert_raster(name, raster.clone());
        Ok(raster)
    }

    fn base(&mut self, bounds: Rect, size: [u32; 2], reading: &RasterReading) -> Result<Raster, PlacedFlaw> {
        let is_risk = *reading == RasterReading::Risk;
        let name = if is_risk { BASE_RISK } else { BASE_DIAMETER };
        self.unpack(name, name, size, |input| match is_risk {
            true => pixels::read_risks(input, bounds, size),
            false => pixels::read_diameters(input, bounds, size),
        })
    }
}
