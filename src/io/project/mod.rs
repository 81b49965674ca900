//! `.meshbrush`: a document in one file.
//!
//! A ZIP archive, so that every tool can inspect it, with these parts in this order:
//!
//! - `settings.json`: `format`, `version`, the program that wrote it, and all settings; numbers read back
//!   exactly.
//! - `domain.geojson`, if the domain has polygons: their corners in world units.
//! - `raster.ID` for each layer that reads a raster: 32-bit floats, row by row from the lowest.
//! - `background.png`, if there is a picture behind the mesh.
//! - `paint.ID` for each paint layer with paint: its tiles of 32 × 32 pixels.
//!
//! Version 1 had one base field (`base.risk` or `base.diameter`) and two rasters of paint (`paint.tiles`) in
//! place of the layers.
//!
//! Pixels are stored as four planes of bytes, the most significant bytes of all numbers first, which packs to
//! half the size. Tiles are ordered by column, then row; blank tiles are omitted. The CRC-32 of the archive
//! detects damage. There are no dates: equal documents give equal bytes, and saving a project that was just
//! opened gives the same file. The history is not saved.
//!
//! The version grows whenever an older program could not read the file correctly, which includes any new
//! field. A program reads all versions up to its own.

mod archive;
mod old_tiles;
mod old_version;
mod painted;
mod pixels;
mod saved_background;
mod settings;
mod stored_layers;
mod tiled;

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Cursor, Read, Write};
use std::path::Path;
use std::sync::Arc;

use super::error::{Flaw, PlacedFlaw, ReadError};
use super::{Meter, geojson, png};
use crate::document::{Background, Document, Picture, Settings};
use crate::domain::Polygon;
use crate::geometry::Rect;
use crate::layers::{LayerId, LayerKind, PaintLayers, Quantity, RasterReading};
use crate::raster::{Raster, RasterPyramid, TiledRaster};
use archive::{Archive, ArchiveWriter, Part};
use old_version::OLD_PAINT;
use settings::{Parts, Saved};

/// The extension of project files.
pub const ENDING: &str = "meshbrush";

/// The version that is written, and the newest that is read.
const VERSION: u64 = 2;
const FORMAT: &str = "Meshbrush project";

const SETTINGS: &str = "settings.json";
const DOMAIN: &str = "domain.geojson";
/// What errors call the parts with the pixels of rasters.
const RASTER: &str = "raster";
const BASE_RISK: &str = "base.risk";
const BASE_DIAMETER: &str = "base.diameter";
const BACKGROUND: &str = "background.png";
/// What errors call the parts with paint.
const PAINT: &str = "paint";
const OLD_TILES: &str = "paint.tiles";

/// Largest file read: twice the size of the largest picture.
const MOST_BYTES: u64 = 512 << 20;
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
    /// The current state of a document, the current stroke included.
    pub fn of(document: &Document) -> Self {
        Self { settings: document.settings().clone(), paint: document.paint().clone() }
    }

    /// The document, with an empty history.
    ///
    /// # Errors
    /// A sentence for a person, when the settings are out of range.
    pub fn into_document(self) -> Result<Document, String> {
        Document::new(self.settings, Some(self.paint)).map_err(|error| error.to_string())
    }
}

/// Reads a document.
///
/// # Errors
/// When the file cannot be read, is not a project, is cut off or damaged, was written by a newer program, or
/// has values that no document can have.
pub fn read(path: &Path) -> Result<Document, ReadError> {
    read_metered(path, &Meter::default())
}

/// As [`read`]; the bytes of the file are counted when they are read, and again when they are unpacked.
///
/// # Errors
/// As [`read`], and when the work was cancelled.
pub fn read_metered(path: &Path, meter: &Meter) -> Result<Document, ReadError> {
    let bytes = || -> Result<Vec<u8>, PlacedFlaw> {
        let mut bytes = Vec::new();
        let file = File::open(path)?;
        meter.expect(2 * file.metadata()?.len());
        meter.count(file.take(MOST_BYTES + 1)).read_to_end(&mut bytes)?;
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
        Ok(project)
    });
    let project = project.map_err(|flaw| flaw.in_file(path))?;
    project.into_document().map_err(|problem| PlacedFlaw::from(Flaw::Syntax(problem)).in_file(path))
}

/// Reads a project from bytes. Errors call the file `name`.
///
/// # Errors
/// As [`read`].
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<Project, ReadError> {
    parse(bytes, &Meter::default()).map_err(|flaw| flaw.in_file(name))
}

/// Writes a project.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut dyn Write, project: &Project) -> io::Result<()> {
    write_parts(out, &parts(project), &Meter::default())
}

/// Writes a project as [`write()`] does, and counts the bytes before packing.
///
/// # Errors
/// As [`write()`], and when the work was cancelled.
pub fn write_metered(out: &mut dyn Write, project: &Project, meter: &Meter) -> io::Result<()> {
    let parts = parts(project);
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

fn parts(project: &Project) -> Vec<ToWrite<'_>> {
    let Project { settings, paint } = project;
    let mut parts: Vec<ToWrite> = vec![(
        SETTINGS.into(),
        Box::new(|out| {
            serde_json::to_writer_pretty(&mut *out, &Saved::of(settings))?;
            writeln!(out)
        }),
    )];
    if let Some(region) = settings.domain.region() {
        parts.push((DOMAIN.into(), Box::new(|out| geojson::write(out, region.polygons()))));
    }
    for layer in &settings.layers {
        if let LayerKind::Raster { source, .. } = &layer.kind {
            let raster = source.raster.raster();
            parts.push((raster_part(layer.id).into(), Box::new(|out| pixels::write_raster(out, raster))));
        }
    }
    if let Some(Background { picture, .. }) = &settings.background {
        parts
            .push((BACKGROUND.into(), Box::new(|mut out| png::write(&mut out, picture.size, &picture.rgba))));
    }
    for (id, raster) in
        paint.iter().filter(|(id, raster)| settings.layer(*id).is_some() && !raster.is_blank())
    {
        parts.push((paint_part(id).into(), Box::new(|out| painted::write(out, raster))));
    }
    parts
}

/// The part with the pixels of a raster.
fn raster_part(id: LayerId) -> String {
    format!("raster.{}", id.0)
}

/// The part with the pixels of a paint layer.
fn paint_part(id: LayerId) -> String {
    format!("paint.{}", id.0)
}

fn write_parts(out: &mut dyn Write, parts: &[ToWrite], meter: &Meter) -> io::Result<()> {
    let mut archive = ArchiveWriter::new(out);
    for (name, write) in parts {
        archive.add(name, meter, write)?;
    }
    archive.finish()
}

fn parse(bytes: &[u8], meter: &Meter) -> Result<Project, PlacedFlaw> {
    let archive = Archive::open(bytes)?;
    let text = part(&archive, SETTINGS)?.bytes(MOST_SETTINGS, meter);
    let text = text.map_err(|flaw| in_part(flaw, SETTINGS))?;
    let saved = Saved::parse(&text).map_err(|flaw| flaw.within(SETTINGS))?;
    let old_paint_size = saved.old_paint_size().map_err(|flaw| flaw.within(SETTINGS))?;
    let settings =
        saved.into_settings(&mut Packed { archive: &archive, meter }).map_err(|flaw| match flaw.place {
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

/// The pixels of the paint layers.
fn paint(archive: &Archive, settings: &Settings, meter: &Meter) -> Result<PaintLayers, PlacedFlaw> {
    let mut paint = PaintLayers::default();
    for layer in &settings.layers {
        let name = paint_part(layer.id);
        let (Some(quantity), Some(part)) = (layer.paints(), archive.part(&name)) else { continue };
        let raster = part.unpack(tiled::MOST_BYTES, meter).and_then(|mut unpacking| {
            let raster = painted::read(&mut unpacking, quantity)?;
            unpacking.finish()?;
            Ok(raster)
        });
        paint.insert(layer.id, raster.map_err(|flaw| in_part(flaw, PAINT))?);
    }
    Ok(paint)
}

/// The pixels of the paint in version 1.
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
/// Errors of `out`.
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
/// When it is damaged. Some of the changes may then be made.
pub(super) fn read_paint_changes(
    bytes: &[u8],
    settings: &Settings,
    paint: &mut PaintLayers,
) -> Result<(), Flaw> {
    let archive = Archive::open(bytes)?;
    for layer in &settings.layers {
        let part = archive.part(&paint_part(layer.id));
        let (Some(quantity), Some(part)) = (layer.paints(), part) else { continue };
        let mut unpacking = part.unpack(tiled::MOST_BYTES, &Meter::default())?;
        let (grid, changes) = painted::read_changes(&mut unpacking, quantity)?;
        unpacking.finish()?;
        let raster = paint.get_or_insert(layer.id, || TiledRaster::new(grid, tiled::blank(quantity)));
        painted::apply(raster, changes);
    }
    Ok(())
}

fn part<'b, 'a>(archive: &'b Archive<'a>, name: &str) -> Result<&'b Part<'a>, PlacedFlaw> {
    let missing = || Flaw::Syntax(format!("this is not a Meshbrush project: it has no {name}.")).into();
    archive.part(name).ok_or_else(missing)
}

fn in_part(flaw: Flaw, part: &'static str) -> PlacedFlaw {
    PlacedFlaw::from(flaw).within(part)
}

/// Unpacks the parts that the settings refer to.
struct Packed<'b, 'a> {
    archive: &'b Archive<'a>,
    meter: &'b Meter,
}

impl Packed<'_, '_> {
    /// The pixels of a raster of [columns, rows], which are a part of their own. Errors call it `what`.
    fn pixels(
        &self,
        name: &str,
        what: &'static str,
        bounds: Rect,
        size: [u32; 2],
        reading: &RasterReading,
    ) -> Result<Raster, PlacedFlaw> {
        let bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
        let raster = part(self.archive, name)?.unpack(bytes, self.meter).and_then(|mut unpacking| {
            let raster = match reading {
                RasterReading::Risk => pixels::read_risks(&mut unpacking, bounds, size)?,
                RasterReading::Diameter => pixels::read_diameters(&mut unpacking, bounds, size)?,
                RasterReading::Curve(_) => pixels::read_values(&mut unpacking, bounds, size)?,
            };
            unpacking.finish()?;
            Ok(raster)
        });
        raster.map_err(|flaw| in_part(flaw, what))
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

    fn background(&mut self) -> Result<Picture, PlacedFlaw> {
        let bytes = part(self.archive, BACKGROUND)?.bytes(MOST_BACKGROUND, self.meter);
        let picture = bytes.and_then(|bytes| png::decode_picture(Cursor::new(bytes)));
        picture.map_err(|flaw| in_part(flaw, BACKGROUND))
    }

    fn raster(
        &mut self,
        layer: LayerId,
        bounds: Rect,
        size: [u32; 2],
        reading: &RasterReading,
    ) -> Result<Arc<RasterPyramid>, PlacedFlaw> {
        let raster = self.pixels(&raster_part(layer), RASTER, bounds, size, reading)?;
        Ok(Arc::new(RasterPyramid::new(raster)))
    }

    fn base(&mut self, bounds: Rect, size: [u32; 2], reading: &RasterReading) -> Result<Raster, PlacedFlaw> {
        let name = if *reading == RasterReading::Risk { BASE_RISK } else { BASE_DIAMETER };
        self.pixels(name, name, bounds, size, reading)
    }
}
