//! `.meshbrush`: a document in one file.
//!
//! A ZIP archive, so that every tool can look into it, with these parts in this order:
//!
//! | part | what | when |
//! |---|---|---|
//! | `settings.json` | `format`, `version`, who wrote it, and all settings, as text for a person; numbers read back exactly | always |
//! | `domain.geojson` | the polygons of the domain, in world units | the domain has some |
//! | `base.risk` | the base field's picture, 32-bit floats row by row from the lowest | the base is a picture |
//! | `paint.tiles` | painted tiles of 64 × 64 pixels: column and row (16 bits each, little-endian), a byte with bit 0 for risk and bit 1 for diameter, and the pixels of each of these | always |
//!
//! Pixels are four runs of bytes, the most significant bytes of all numbers first: they pack in half the room. Tiles stand in
//! order of column, then row; blank ones are left out. The archive's CRC-32 tells damage. There are no dates: the same document
//! gives the same bytes, and saving what was opened gives the file again. History is not saved.
//!
//! The version grows when an older program could no longer read the file as it is meant, which holds for any field that it
//! does not know. Programs read all versions up to their own.

mod archive;
mod pixels;
mod settings;

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;

use super::error::{Flaw, PlacedFlaw, ReadError};
use super::{Meter, geojson};
use crate::document::{Base, Document, Settings};
use crate::domain::Polygon;
use crate::geometry::Rect;
use crate::paint::{PaintRasters, Tiles};
use crate::raster::Raster;
use archive::{Archive, ArchiveWriter, Part};
use settings::{Parts, Saved};

/// What a project's file name ends in.
pub const ENDING: &str = "meshbrush";

/// The version that is written, and the newest that is read.
const VERSION: u64 = 1;
const FORMAT: &str = "Meshbrush project";

const SETTINGS: &str = "settings.json";
const DOMAIN: &str = "domain.geojson";
const BASE: &str = "base.risk";
const PAINT: &str = "paint.tiles";

/// Largest file read: twice what the largest picture takes.
const MOST_BYTES: u64 = 512 << 20;
/// Most bytes of settings; formulas are far shorter.
const MOST_SETTINGS: u64 = 1 << 20;
/// Most bytes of polygons: more than a million corners take.
const MOST_POLYGONS: u64 = 128 << 20;

/// What is saved of a document.
///
/// Only painted tiles are copied, so that one can be taken between two frames and written beside them.
#[derive(Clone, Debug, PartialEq)]
pub struct Project {
    /// Everything but paint.
    pub settings: Settings,
    /// Paint. What is not here is blank.
    pub tiles: Tiles,
}

impl Project {
    /// A document as it is now, a stroke under way included.
    pub fn of(document: &Document) -> Self {
        Self { settings: document.settings().clone(), tiles: document.paint().painted_tiles() }
    }

    /// The document, without history.
    ///
    /// # Errors
    /// A sentence, when the settings cannot be met.
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
/// When the file cannot be read, is no project, is cut off or damaged, was written by a newer program, or holds what no document
/// can have.
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
            return Err(
                Flaw::Syntax(format!("a project has at most {limit} MiB, and this file is larger.")).into()
            );
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

/// As [`read`], from bytes; the file is then called `name`.
///
/// # Errors
/// As [`read`].
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<Project, ReadError> {
    parse(bytes, &Meter::default()).map_err(|flaw| flaw.in_file(name))
}

/// Writes a project.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut dyn Write, project: &Project) -> io::Result<()> {
    write_parts(out, &parts(project), &Meter::default())
}

/// As [`write()`]; counted are the bytes before they are packed.
///
/// # Errors
/// As [`write()`], and when the work was cancelled.
pub fn write_metered(out: &mut dyn Write, project: &Project, meter: &Meter) -> io::Result<()> {
    let parts = parts(project);
    // Packing takes far longer than to see how much there is to pack.
    let size = Meter::default();
    for (_, write) in &parts {
        write(&mut size.count(io::sink()))?;
        meter.check()?;
    }
    meter.expect(size.done());
    write_parts(out, &parts, meter)
}

/// A part of the archive: its name, and how its bytes are written.
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
    if let Base::RiskImage { raster, .. } = &settings.base {
        parts.push((BASE, Box::new(|out| pixels::write_raster(out, raster))));
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

/// Writes nothing but tiles, blank ones too.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_tiles(out: &mut dyn Write, tiles: &Tiles) -> io::Result<()> {
    let tiles: ToWrite = (PAINT, Box::new(|out| pixels::write_tiles(out, tiles)));
    write_parts(out, &[tiles], &Meter::default())
}

/// Reads tiles of layers with the given columns and rows.
///
/// # Errors
/// When they are damaged, or do not fit.
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
    let missing = || Flaw::Syntax(format!("this is no Meshbrush project: there is no {name} in it.")).into();
    archive.part(name).ok_or_else(missing)
}

fn in_part(flaw: Flaw, part: &'static str) -> PlacedFlaw {
    PlacedFlaw::from(flaw).within(part)
}

/// The parts that settings ask for.
struct Packed<'b, 'a> {
    archive: &'b Archive<'a>,
    meter: &'b Meter,
}

impl Parts for Packed<'_, '_> {
    fn polygons(&mut self) -> Result<Vec<Polygon>, PlacedFlaw> {
        let text = part(self.archive, DOMAIN)?.bytes(MOST_POLYGONS, self.meter);
        let text = text.map_err(|flaw| in_part(flaw, DOMAIN))?;
        geojson::parse(&text[..]).map_err(|flaw| flaw.within(DOMAIN))
    }

    fn risks(&mut self, bounds: Rect, size: [u32; 2]) -> Result<Raster, PlacedFlaw> {
        let bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
        let raster = part(self.archive, BASE)?.unpack(bytes, self.meter).and_then(|mut unpacking| {
            let raster = pixels::read_risks(&mut unpacking, bounds, size)?;
            unpacking.finish()?;
            Ok(raster)
        });
        raster.map_err(|flaw| in_part(flaw, BASE))
    }
}
