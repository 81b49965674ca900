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
use super::geojson;
use crate::document::{Base, Document, Settings};
use crate::domain::Polygon;
use crate::geometry::Rect;
use crate::paint::{Layers, Tiles};
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
        Self { settings: document.settings().clone(), tiles: document.layers().painted_tiles() }
    }

    /// The document, without history.
    ///
    /// # Errors
    /// A sentence, when the settings cannot be met.
    pub fn into_document(self) -> Result<Document, String> {
        let settings = self.settings.checked().map_err(|error| error.to_string())?;
        let mut layers = Layers::blank(settings.domain.bounds, settings.raster_size());
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
    let bytes = || -> Result<Vec<u8>, PlacedFlaw> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MOST_BYTES {
            let limit = MOST_BYTES >> 20;
            return Err(
                Flaw::Syntax(format!("a project has at most {limit} MiB, and this file is larger.")).into()
            );
        }
        Ok(bytes)
    };
    let project = bytes().and_then(|bytes| parse(&bytes)).map_err(|flaw| flaw.in_file(path))?;
    project.into_document().map_err(|problem| PlacedFlaw::from(Flaw::Syntax(problem)).in_file(path))
}

/// As [`read`], from bytes; the file is then called `name`.
///
/// # Errors
/// As [`read`].
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<Project, ReadError> {
    parse(bytes).map_err(|flaw| flaw.in_file(name))
}

/// Writes a project.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut dyn Write, project: &Project) -> io::Result<()> {
    let Project { settings, tiles } = project;
    let mut archive = ArchiveWriter::new(out);
    archive.add(SETTINGS, |out| {
        serde_json::to_writer_pretty(&mut *out, &Saved::of(settings))?;
        writeln!(out)
    })?;
    if let Some(region) = settings.domain.region() {
        archive.add(DOMAIN, |out| geojson::write(out, region.polygons()))?;
    }
    if let Base::RiskImage { raster, .. } = &settings.base {
        archive.add(BASE, |out| pixels::write_raster(out, raster))?;
    }
    archive.add(PAINT, |out| pixels::write_tiles(out, tiles))?;
    archive.finish()
}

fn parse(bytes: &[u8]) -> Result<Project, PlacedFlaw> {
    let archive = Archive::open(bytes)?;
    let text = part(&archive, SETTINGS)?.bytes(MOST_SETTINGS).map_err(|flaw| in_part(flaw, SETTINGS))?;
    let saved = Saved::parse(&text).map_err(|flaw| flaw.within(SETTINGS))?;
    let settings = saved.into_settings(&mut Packed(&archive)).map_err(|flaw| match flaw.place {
        super::Place::Part(..) => flaw,
        _ => flaw.within(SETTINGS),
    })?;
    part(&archive, PAINT)?;
    let tiles = read_tiles(bytes, settings.raster_size()).map_err(|flaw| in_part(flaw, PAINT))?;
    Ok(Project { settings, tiles })
}

/// Writes nothing but tiles, blank ones too.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_tiles(out: &mut dyn Write, tiles: &Tiles) -> io::Result<()> {
    let mut archive = ArchiveWriter::new(out);
    archive.add(PAINT, |out| pixels::write_tiles(out, tiles))?;
    archive.finish()
}

/// Reads tiles of layers with the given columns and rows.
///
/// # Errors
/// When they are damaged, or do not fit.
pub(super) fn read_tiles(bytes: &[u8], size: [u32; 2]) -> Result<Tiles, Flaw> {
    let archive = Archive::open(bytes)?;
    let part = archive.part(PAINT).ok_or(Flaw::Damaged)?;
    let mut unpacking = part.unpack(pixels::most_tile_bytes(size))?;
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
struct Packed<'b, 'a>(&'b Archive<'a>);

impl Parts for Packed<'_, '_> {
    fn polygons(&mut self) -> Result<Vec<Polygon>, PlacedFlaw> {
        let text = part(self.0, DOMAIN)?.bytes(MOST_POLYGONS).map_err(|flaw| in_part(flaw, DOMAIN))?;
        geojson::parse(&text[..]).map_err(|flaw| flaw.within(DOMAIN))
    }

    fn risks(&mut self, bounds: Rect, size: [u32; 2]) -> Result<Raster, PlacedFlaw> {
        let bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
        let raster = part(self.0, BASE)?.unpack(bytes).and_then(|mut unpacking| {
            let raster = pixels::read_risks(&mut unpacking, bounds, size)?;
            unpacking.finish()?;
            Ok(raster)
        });
        raster.map_err(|flaw| in_part(flaw, BASE))
    }
}
