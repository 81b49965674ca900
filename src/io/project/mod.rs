//! `.meshbrush`: a document in one file.
//!
//! A ZIP archive, so that every tool can inspect it, with these parts in this order:
//!
//! - `settings.json`: `format`, `version`, the program that wrote it, and all settings; numbers read back
//!   exactly.
//! - `domain.geojson`, if the domain has polygons: their corners in world units.
//! - `base.risk`, if the base field is a picture, or `base.diameter`, if it is a grid of target diameters:
//!   32-bit floats, row by row from the lowest.
//! - `background.png`, if there is a picture behind the mesh.
//! - `paint.tiles`: the painted tiles of 64 × 64 pixels. Each has its column and row (16 bits each,
//!   little-endian), a byte with bit 0 for risk and bit 1 for diameter, and the pixels of each of these.
//!
//! Pixels are stored as four planes of bytes, the most significant bytes of all numbers first, which packs to
//! half the size. Tiles are ordered by column, then row; blank tiles are omitted. The CRC-32 of the archive
//! detects damage. There are no dates: equal documents give equal bytes, and saving a project that was just
//! opened gives the same file. The history is not saved.
//!
//! The version grows whenever an older program could not read the file correctly, which includes any new
//! field. A program reads all versions up to its own.

mod archive;
mod pixels;
mod saved_background;
mod settings;
pub mod tiled;

use std::fs::File;
use std::io::{self, Cursor, Read, Write};
use std::path::Path;

use super::error::{Flaw, PlacedFlaw, ReadError};
use super::{Meter, geojson, png};
use crate::document::{Background, Base, Document, Picture, Settings};
use crate::domain::Polygon;
use crate::geometry::Rect;
use crate::paint::{PaintRasters, Tiles};
use crate::raster::Raster;
use archive::{Archive, ArchiveWriter, Part, Unpacking};
use settings::{Parts, Saved};

/// The extension of project files.
pub const ENDING: &str = "meshbrush";

/// The version that is written, and the newest that is read.
const VERSION: u64 = 1;
const FORMAT: &str = "Meshbrush project";

const SETTINGS: &str = "settings.json";
const DOMAIN: &str = "domain.geojson";
const BASE_RISK: &str = "base.risk";
const BASE_DIAMETER: &str = "base.diameter";
const BACKGROUND: &str = "background.png";
const PAINT: &str = "paint.tiles";

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
/// It has copies of the painted tiles only, so making one is quick enough for a frame, and another thread can
/// write it.
#[derive(Clone, Debug, PartialEq)]
pub struct Project {
    /// Everything except paint.
    pub settings: Settings,
    /// The paint by tiles. Other tiles are blank.
    pub tiles: Tiles,
}

impl Project {
    /// The current state of a document, the current stroke included.
    pub fn of(document: &Document) -> Self {
        Self { settings: document.settings().clone(), tiles: document.paint().painted_tiles() }
    }

    /// The document, with an empty history.
    ///
    /// # Errors
    /// A sentence for a person, when the settings are out of range.
    pub fn into_document(self) -> Result<Document, String> {
        let settings = self.settings.checked().map_err(|error| error.to_string())?;
        let mut layers = PaintRasters::blank(settings.domain.bounds, settings.raster_size());
        layers.put_tiles(&self.tiles);
        Document::new(settings, Some(layers)).map_err(|error| error.to_string())
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
type ToWrite<'a> = (&'static str, Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>);

fn parts(project: &Project) -> Vec<ToWrite<'_>> {
    let Project { settings, tiles } = project;
    let mut parts: Vec<ToWrite> = vec![(
        SETTINGS,
        Box::new(|out| {
            serde_json::to_writer_pretty(&mut *out, &Saved::of(settings))?;
            writeln!(out)
        }),
    )];
    if let Some(region) = settings.domain.region() {
        parts.push((DOMAIN, Box::new(|out| geojson::write(out, region.polygons()))));
    }
    match &settings.base {
        Base::RiskImage { raster, .. } => {
            parts.push((BASE_RISK, Box::new(|out| pixels::write_raster(out, raster))));
        }
        Base::DiameterGrid { raster, .. } => {
            parts.push((BASE_DIAMETER, Box::new(|out| pixels::write_raster(out, raster))));
        }
        Base::Constant(_) | Base::Formula(_) => {}
    }
    if let Some(Background { picture, .. }) = &settings.background {
        parts.push((BACKGROUND, Box::new(|mut out| png::write(&mut out, picture.size, &picture.rgba))));
    }
    parts.push((PAINT, Box::new(|out| pixels::write_tiles(out, tiles))));
    parts
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
    let settings =
        saved.into_settings(&mut Packed { archive: &archive, meter }).map_err(|flaw| match flaw.place {
            super::Place::Part(..) => flaw,
            _ => flaw.within(SETTINGS),
        })?;
    part(&archive, PAINT)?;
    let tiles =
        unpacked_tiles(&archive, settings.raster_size(), meter).map_err(|flaw| in_part(flaw, PAINT))?;
    Ok(Project { settings, tiles })
}

/// Writes an archive of tiles alone, blank ones included.
///
/// # Errors
/// Errors of `out`.
pub(super) fn write_tiles(out: &mut dyn Write, tiles: &Tiles) -> io::Result<()> {
    let tiles: ToWrite = (PAINT, Box::new(|out| pixels::write_tiles(out, tiles)));
    write_parts(out, &[tiles], &Meter::default())
}

/// Reads an archive of tiles of rasters with `size` = [columns, rows].
///
/// # Errors
/// When it is damaged, or a tile lies outside the rasters.
pub(super) fn read_tiles(bytes: &[u8], size: [u32; 2]) -> Result<Tiles, Flaw> {
    unpacked_tiles(&Archive::open(bytes)?, size, &Meter::default())
}

fn unpacked_tiles(archive: &Archive, size: [u32; 2], meter: &Meter) -> Result<Tiles, Flaw> {
    let part = archive.part(PAINT).ok_or(Flaw::Damaged)?;
    let mut unpacking = part.unpack(pixels::most_tile_bytes(size), meter)?;
    let tiles = pixels::read_tiles(&mut unpacking, size)?;
    unpacking.finish()?;
    Ok(tiles)
}

fn part<'b, 'a>(archive: &'b Archive<'a>, name: &'static str) -> Result<&'b Part<'a>, PlacedFlaw> {
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
    /// The pixels of a raster of [columns, rows], which are a part of their own.
    fn raster(
        &self,
        name: &'static str,
        [columns, rows]: [u32; 2],
        read: impl FnOnce(&mut Unpacking) -> Result<Raster, Flaw>,
    ) -> Result<Raster, PlacedFlaw> {
        let bytes = 4 * u64::from(columns) * u64::from(rows);
        let raster = part(self.archive, name)?.unpack(bytes, self.meter).and_then(|mut unpacking| {
            let raster = read(&mut unpacking)?;
            unpacking.finish()?;
            Ok(raster)
        });
        raster.map_err(|flaw| in_part(flaw, name))
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

    fn risks(&mut self, bounds: Rect, size: [u32; 2]) -> Result<Raster, PlacedFlaw> {
        self.raster(BASE_RISK, size, |unpacking| pixels::read_risks(unpacking, bounds, size))
    }

    fn diameters(&mut self, bounds: Rect, size: [u32; 2]) -> Result<Raster, PlacedFlaw> {
        self.raster(BASE_DIAMETER, size, |unpacking| pixels::read_diameters(unpacking, bounds, size))
    }
}
