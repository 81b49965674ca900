//! The changes of a document, as a journal keeps them: each an archive of what differs from the state before,
//! the first one from nothing.
//!
//! - `settings.change`: the text of `settings.json` after the change. It begins with as many bytes of the
//!   text before as the first 64-bit number says (little-endian), and ends with as many as the second one
//!   says; the bytes after the two numbers are those between.
//! - `raster.N`, `background.png`, `domain.N` and so on: data that no part before has, as in a project.
//! - `paint.N.ID`: how the paint of a layer changed. The layer has the quantity that the first byte says (0
//!   for risk, 1 for diameters, 2 for errors), and begins as the layer whose identifier follows (32 bits), if
//!   the byte before that is 1: usually itself, or the layer of which it is a copy. Otherwise it begins
//!   blank. The grid and the changed tiles follow as [`painted::write_changes`] writes them. Parts are
//!   applied in the order of their numbers N, which have six digits. A part without bytes says that the
//!   layer has no paint any more.

use std::collections::{BTreeMap, HashMap};
use std::io::{self, BufWriter, Read, Write};
use std::sync::Arc;

use super::archive::{Archive, ArchivePart, ArchiveWriter, BUFFER, Packing, Unpacking};
use super::limits::Limits;
use super::painted;
use super::part_names::{PartData, PartNames};
use super::part_reader::{PartReader, in_part};
use super::settings::Saved;
use super::tiled::ChangedTiles;
use super::{Flaw, Meter, PAINT, PlacedFlaw, Project, SETTINGS};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::{Layer, LayerId, PaintLayers, Quantity};
use meshbrush_core::raster::{PixelGrid, Tile, TiledRaster, ValueRanges};

const SETTINGS_CHANGE: &str = "settings.change";
const QUANTITIES: [Quantity; 3] = [Quantity::Risk, Quantity::Diameter, Quantity::Error];

/// The document after the changes that were written so far.
#[derive(Debug)]
pub(in super::super) struct Recorded {
    settings: Settings,
    text: Vec<u8>,
    names: PartNames,
    /// The pixels of the layers of these settings.
    paint: PaintLayers,
}

/// What differs between two states of a document. It shares pixels with them, so that another thread can
/// write it.
#[derive(Debug)]
pub(in super::super) struct Change {
    text: Option<TextChange>,
    new: Vec<(String, PartData)>,
    paint: Vec<PaintChange>,
}

/// The middle of a text, and how many bytes before and after it stay.
#[derive(Debug, PartialEq, Eq)]
struct TextChange {
    start: usize,
    end: usize,
    middle: Vec<u8>,
}

#[derive(Debug)]
struct PaintChange {
    layer: LayerId,
    /// Absent if nothing is left of the paint.
    tiles: Option<TileChanges>,
}

#[derive(Debug)]
struct TileChanges {
    quantity: Quantity,
    /// The layer that it is like before the change.
    like: Option<LayerId>,
    grid: PixelGrid,
    tiles: ChangedTiles,
}

impl Recorded {
    /// Returns the state of a project, and the change that leads there from nothing.
    ///
    /// # Errors
    /// Fails when the settings cannot be written.
    pub fn begin(project: Project) -> io::Result<(Self, Change)> {
        let nothing = (Vec::new(), PartNames::default(), PaintLayers::default());
        let (text, names, paint) = nothing;
        let mut recorded = Self { settings: project.settings.clone(), text, names, paint };
        let change = recorded.advance(Some(project.settings), &project.paint)?;
        Ok((recorded, change))
    }

    /// Goes on to a later state, whose settings are the same if none are given.
    ///
    /// # Errors
    /// Fails when the settings cannot be written.
    pub fn advance(&mut self, settings: Option<Settings>, paint: &PaintLayers) -> io::Result<Change> {
        let (mut text, mut new) = (None, Vec::new());
        if let Some(settings) = settings {
            new = self.names.add(&settings);
            let mut written = Vec::new();
            super::settings::write(&mut written, &settings, &self.names)?;
            text = TextChange::between(&self.text, &written);
            (self.settings, self.text) = (settings, written);
        }
        let paint = painted_by(&self.settings, paint);
        let changes = paint_changes(&self.settings, &self.paint, &paint);
        self.paint = paint;
        Ok(Change { text, new, paint: changes })
    }

    /// Returns the change that leads from nothing to this state. Later changes can follow it, and those
    /// before are no longer needed.
    pub fn begin_again(&mut self) -> Change {
        Change {
            text: TextChange::between(&[], &self.text),
            new: self.names.keep_only(&self.settings),
            paint: paint_changes(&self.settings, PaintLayers::blank(), &self.paint),
        }
    }
}

impl Change {
    /// Returns whether nothing differs.
    pub fn is_empty(&self) -> bool {
        self.text.is_none() && self.new.is_empty() && self.paint.is_empty()
    }

    /// Writes the archive, packed in little time. The meter counts bytes before packing.
    ///
    /// # Errors
    /// Fails with the errors of the output, and when the work was cancelled.
    pub fn write(&self, out: &mut dyn Write, meter: &Meter) -> io::Result<()> {
        let mut archive = ArchiveWriter::new(out, Limits::PROJECT);
        let mut add = |name: &str, write: &dyn Fn(&mut dyn Write) -> io::Result<()>| {
            let mut packing = Packing::quick();
            let mut buffered = BufWriter::with_capacity(BUFFER, meter.count(&mut packing));
            write(&mut buffered)?;
            buffered.flush()?;
            drop(buffered);
            archive.add_packed(name, packing)
        };
        if let Some(text) = &self.text {
            add(SETTINGS_CHANGE, &|out| text.write(out))?;
        }
        for (name, data) in &self.new {
            add(name, &|out| data.write(out))?;
        }
        for (n, change) in self.paint.iter().enumerate() {
            add(&format!("{PAINT}.{n:06}.{}", change.layer.0), &|out| change.write(out))?;
        }
        archive.finish().map(|_| ())
    }
}

impl TextChange {
    /// Returns the change between two texts, if they differ.
    fn between(before: &[u8], after: &[u8]) -> Option<Self> {
        let equal = |(a, b): &(&u8, &u8)| a == b;
        let start = before.iter().zip(after).take_while(equal).count();
        if start == before.len() && start == after.len() {
            return None;
        }
        let rests = before[start..].iter().rev().zip(after[start..].iter().rev());
        let end = rests.take_while(equal).count();
        Some(Self { start, end, middle: after[start..after.len() - end].to_vec() })
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for count in [self.start, self.end] {
            out.write_all(&(count as u64).to_le_bytes())?;
        }
        out.write_all(&self.middle)
    }

    /// Changes the text before into that after, as [`Self::write`] wrote it.
    fn apply(written: &[u8], text: &mut Vec<u8>) -> Result<(), Flaw> {
        let counts = written.split_at_checked(16).map(|(counts, middle)| (counts.split_at(8), middle));
        let ((start, end), middle) = counts.ok_or(Flaw::Damaged)?;
        let [start, end] = [start, end].map(|count| {
            let bytes = count.first_chunk().copied().unwrap_or_default();
            usize::try_from(u64::from_le_bytes(bytes)).ok()
        });
        let (start, end) = (start.ok_or(Flaw::Damaged)?, end.ok_or(Flaw::Damaged)?);
        let end = text.len().checked_sub(end).filter(|&end| start <= end).ok_or(Flaw::Damaged)?;
        text.splice(start..end, middle.iter().copied());
        Ok(())
    }
}

/// Returns the pixels of the layers that are painted on. There can be others: those of deleted layers, which
/// may come back under identifiers that layers of other kinds have now.
fn painted_by(settings: &Settings, paint: &PaintLayers) -> PaintLayers {
    paint.of_layers(settings.layers.iter().filter(|layer| layer.paints().is_some()).map(|layer| layer.id))
}

/// Returns the changes between the paint of layers before and after, in the order in which they are applied.
fn paint_changes(settings: &Settings, before: &PaintLayers, after: &PaintLayers) -> Vec<PaintChange> {
    let mut current: BTreeMap<LayerId, &TiledRaster> = before.iter().collect();
    let mut origins = None;
    let mut changes = Vec::new();
    for layer in &settings.layers {
        let Some((quantity, raster)) = layer.paints().zip(after.get(layer.id)) else { continue };
        let can_be_like =
            |other: &&TiledRaster| other.grid() == raster.grid() && other.blank() == raster.blank();
        let own = current.get(&layer.id).copied().filter(can_be_like);
        let like = match own {
            Some(own) => Some((layer.id, own)),
            None if raster.tile_count() == 0 => None,
            None => {
                let origins = origins.get_or_insert_with(|| Origins::of(&current));
                origins.of_most(raster).and_then(|id| Some((id, current.get(&id).copied()?)))
            }
        };
        let like = like.filter(|(_, other)| can_be_like(other));
        let tiles = painted::changes(like.map(|(_, other)| other), raster);
        if own.is_none() || !tiles.is_empty() {
            let (like, grid) = (like.map(|(id, _)| id), *raster.grid());
            let tiles = Some(TileChanges { quantity, like, grid, tiles });
            changes.push(PaintChange { layer: layer.id, tiles });
        }
        current.insert(layer.id, raster);
        origins.iter_mut().for_each(|origins| origins.add(layer.id, raster));
    }
    // At the end: until then others can begin like them.
    let gone = before.iter().map(|(id, _)| id).filter(|id| after.get(*id).is_none());
    changes.extend(gone.map(|layer| PaintChange { layer, tiles: None }));
    changes
}

/// The last layer that has each tile. A copied layer shares its tiles with the original.
#[derive(Default)]
struct Origins(HashMap<*const Tile, LayerId>);

impl Origins {
    fn of(layers: &BTreeMap<LayerId, &TiledRaster>) -> Self {
        let mut origins = Self::default();
        layers.iter().for_each(|(id, raster)| origins.add(*id, raster));
        origins
    }

    fn add(&mut self, id: LayerId, raster: &TiledRaster) {
        self.0.extend(raster.tiles().map(|(_, tile)| (Arc::as_ptr(tile), id)));
    }

    /// Returns the layer with most of the tiles of a raster.
    fn of_most(&self, raster: &TiledRaster) -> Option<LayerId> {
        let mut counts = BTreeMap::<LayerId, usize>::new();
        for id in raster.tiles().filter_map(|(_, tile)| self.0.get(&Arc::as_ptr(tile))) {
            *counts.entry(*id).or_default() += 1;
        }
        counts.into_iter().max_by_key(|(_, count)| *count).map(|(id, _)| id)
    }
}

impl PaintChange {
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        self.tiles.as_ref().map_or(Ok(()), |tiles| tiles.write(out))
    }

    fn read(layer: LayerId, input: &mut Unpacking) -> Result<Self, Flaw> {
        let tiles = if input.left() == 0 { None } else { Some(TileChanges::read(input)?) };
        Ok(Self { layer, tiles })
    }

    fn apply(self, paint: &mut PaintLayers) -> Result<(), Flaw> {
        match self.tiles {
            Some(tiles) => tiles.apply(self.layer, paint),
            None => paint.remove(self.layer).map(drop).ok_or(Flaw::Damaged),
        }
    }
}

impl TileChanges {
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let quantity = QUANTITIES.iter().position(|quantity| *quantity == self.quantity);
        out.write_all(&[quantity.unwrap_or_default() as u8, u8::from(self.like.is_some())])?;
        out.write_all(&self.like.map_or(0, |id| id.0).to_le_bytes())?;
        painted::write_changes(out, &self.grid, &self.tiles)
    }

    fn read(input: &mut Unpacking) -> Result<Self, Flaw> {
        let mut head = [0; 6];
        input.read_exact(&mut head).map_err(|_| Flaw::Damaged)?;
        let [quantity, is_like, id @ ..] = head;
        let quantity = *QUANTITIES.get(usize::from(quantity)).ok_or(Flaw::Damaged)?;
        let like = (is_like == 1).then(|| LayerId(u32::from_le_bytes(id)));
        let (grid, tiles) = painted::read_changes(input, quantity)?;
        Ok(Self { quantity, like, grid, tiles })
    }

    fn apply(self, layer: LayerId, paint: &mut PaintLayers) -> Result<(), Flaw> {
        let blank = self.quantity.blank();
        if self.like != Some(layer) {
            let raster = match self.like {
                Some(other) => paint.get(other).cloned().ok_or(Flaw::Damaged)?,
                None => TiledRaster::new(self.grid, blank),
            };
            paint.insert(layer, raster);
        }
        let raster = paint.get_mut(layer).ok_or(Flaw::Damaged)?;
        if raster.blank() != blank || *raster.grid() != self.grid {
            return Err(Flaw::Damaged);
        }
        painted::apply(raster, self.tiles)
    }
}

/// Reads changes one after the other.
#[derive(Debug, Default)]
pub(in super::super) struct Replay<'a> {
    text: Vec<u8>,
    /// The last part with each name, of all changes.
    parts: Archive<'a>,
    paint: PaintLayers,
}

impl<'a> Replay<'a> {
    /// Goes on to the state after a change.
    ///
    /// # Errors
    /// Fails when the change is damaged. It may then be made in part.
    pub fn add(&mut self, bytes: &'a [u8]) -> Result<(), Flaw> {
        let mut archive = Archive::open(bytes, Limits::PROJECT)?;
        let meter = &Meter::default();
        let layer = |name: &str| Some(LayerId(name.strip_prefix(PAINT)?.rsplit('.').next()?.parse().ok()?));
        let read = |(id, part): (LayerId, ArchivePart<'a>)| {
            let mut unpacking = part.unpack(meter);
            let change = PaintChange::read(id, &mut unpacking)?;
            unpacking.finish().map(|()| change)
        };
        let changes: Vec<PaintChange> =
            archive.take_parts(layer).into_iter().map(read).collect::<Result<_, _>>()?;
        for (_, part) in archive.take_parts(|name| (name == SETTINGS_CHANGE).then_some(())) {
            TextChange::apply(&part.bytes(meter)?, &mut self.text)?;
        }
        changes.into_iter().try_for_each(|change| change.apply(&mut self.paint))?;
        self.parts.replace_parts(archive);
        Ok(())
    }

    /// Returns the state so far.
    ///
    /// # Errors
    /// Fails when the settings cannot be read, or a part that they need.
    pub fn project(&self) -> Result<Project, PlacedFlaw> {
        let saved = Saved::parse(&self.text).map_err(|flaw| flaw.within(SETTINGS))?;
        let (names, meter) = (&mut PartNames::default(), &Meter::default());
        let settings =
            saved.into_settings(&mut PartReader { archive: &self.parts, names, meter, polygons: None })?;
        let paint = painted_by(&settings, &self.paint);
        let is_of = |layer: &Layer| match (layer.paints(), paint.get(layer.id)) {
            (Some(quantity), Some(raster)) => raster.blank() == quantity.blank(),
            _ => true,
        };
        if !settings.layers.iter().all(is_of) {
            return Err(in_part(Flaw::Damaged, PAINT));
        }
        Ok(Project { settings, paint })
    }
}
