//! The gestures that can be undone and redone, and the memory that they keep alive.

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use super::{PathCost, Settings};
use crate::domain::Line;
use crate::geometry::NumberMap;
use crate::layers::{Layer, LayerId};
use crate::paint::Patch;

/// The data of one gesture that the document does not have now: before undo the old data, after it the new
/// data. Undo and redo exchange it with the document's own.
#[derive(Clone, Debug)]
pub(super) enum EntryData {
    /// Pixels of some layers.
    Paint(Vec<(LayerId, Patch)>),
    /// Settings.
    Settings(Box<Settings>),
}

impl EntryData {
    /// Returns the bytes of this entry alone, without the data that its settings share with others.
    fn own_bytes(&self) -> usize {
        match self {
            Self::Paint(patches) => patches.iter().map(|(_, patch)| patch.bytes()).sum(),
            Self::Settings(settings) => own_bytes(settings),
        }
    }

    pub(super) fn settings(&self) -> Option<&Settings> {
        match self {
            Self::Paint(_) => None,
            Self::Settings(settings) => Some(settings),
        }
    }
}

pub(super) fn own_bytes(settings: &Settings) -> usize {
    let layers: usize = settings.layers.iter().map(|layer| size_of_val(layer) + name_bytes(layer)).sum();
    size_of::<Settings>() + settings.name.capacity() + layers
}

/// Returns the bytes of the names of a layer and of the file that its data come from.
fn name_bytes(layer: &Layer) -> usize {
    layer.name.capacity() + layer.kind.file_name().map_or(0, str::len)
}

/// Data behind an `Arc`, which other settings may share: its address and its size in bytes.
pub(super) type SharedData = (usize, usize);

pub(super) fn shared_data(settings: &Settings) -> impl Iterator<Item = SharedData> + '_ {
    let outline = settings.domain.region().map(|region| (Arc::as_ptr(region).addr(), region.bytes()));
    let marks = (Arc::as_ptr(&settings.boundary_marks).addr(), settings.boundary_marks.bytes());
    let pins = (Arc::as_ptr(&settings.pins).addr(), size_of_val(&settings.pins[..]));
    let lines = (Arc::as_ptr(&settings.lines).addr(), settings.lines.iter().map(Line::bytes).sum());
    let paths = (Arc::as_ptr(&settings.paths).addr(), settings.paths.bytes());
    let layers = settings.layers.iter().flat_map(Layer::shared_data);
    let background = settings
        .background
        .as_ref()
        .map(|background| (Arc::as_ptr(&background.picture).addr(), background.picture.rgba.len()));
    let kept_out = settings.paths.keep_out.iter().map(|kept_out| kept_out.mask.shared_data());
    let domain = settings.domain.formula().map(|formula| (formula.address(), formula.bytes()));
    let cost = match &settings.paths.cost {
        PathCost::Formula(formula) => Some((formula.address(), formula.bytes())),
        PathCost::Weighted(_) => None,
    };
    layers
        .chain(domain)
        .chain(cost)
        .chain(outline)
        .chain([marks, lines, pins, paths])
        .chain(kept_out)
        .chain(background)
}

/// One gesture, done or undone.
#[derive(Clone, Debug)]
pub(super) struct HistoryEntry {
    /// The name of the edit, for display only.
    pub(super) title: &'static str,
    pub(super) data: EntryData,
    /// The version of the document that undo or redo returns to.
    pub(super) version: u64,
}

/// Gestures that can be undone and redone, back to the start of the document. Neither mesh nor field is kept:
/// they are derived.
///
/// Its memory is bounded by [`Self::MAX_BYTES`]; the oldest gestures are dropped first.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// The oldest first.
    done: VecDeque<HistoryEntry>,
    /// The one undone last is the last.
    undone: Vec<HistoryEntry>,
    memory: Memory,
}

impl History {
    /// Most bytes that the gestures keep alive: old pixels, outlines, pictures and formulas. The last gesture
    /// is kept at any size.
    pub const MAX_BYTES: usize = 256 << 20;

    /// Adds a gesture that was just done, and drops those that can no longer be redone. `current` are the
    /// document's settings after it.
    pub(super) fn push(&mut self, entry: HistoryEntry, current: &Settings) {
        for undone in self.undone.drain(..) {
            self.memory.remove(&undone.data);
        }
        self.memory.add(&entry.data);
        self.done.push_back(entry);
        while self.done.len() > 1 && self.memory.bytes(current) > Self::MAX_BYTES {
            if let Some(oldest) = self.done.pop_front() {
                self.memory.remove(&oldest.data);
            }
        }
    }

    /// Returns all settings that undo and redo can return to.
    pub(super) fn all_settings(&self) -> impl Iterator<Item = &Settings> {
        self.done.iter().chain(&self.undone).filter_map(|entry| entry.data.settings())
    }

    pub(super) fn last_done(&self) -> Option<&HistoryEntry> {
        self.done.back()
    }

    pub(super) fn last_undone(&self) -> Option<&HistoryEntry> {
        self.undone.last()
    }

    /// Undoes the last gesture: `exchange` exchanges its data with the document's. Returns whether there was
    /// one.
    pub(super) fn undo(&mut self, exchange: impl FnOnce(&mut HistoryEntry)) -> bool {
        let Some(mut entry) = self.done.pop_back() else { return false };
        self.exchange(&mut entry, exchange);
        self.undone.push(entry);
        true
    }

    /// Redoes the gesture that was undone last, in the same way.
    pub(super) fn redo(&mut self, exchange: impl FnOnce(&mut HistoryEntry)) -> bool {
        let Some(mut entry) = self.undone.pop() else { return false };
        self.exchange(&mut entry, exchange);
        self.done.push_back(entry);
        true
    }

    fn exchange(&mut self, entry: &mut HistoryEntry, exchange: impl FnOnce(&mut HistoryEntry)) {
        self.memory.remove(&entry.data);
        exchange(entry);
        self.memory.add(&entry.data);
    }

    /// Drops the gesture that was undone last.
    pub(super) fn forget_undone(&mut self) {
        if let Some(undone) = self.undone.pop() {
            self.memory.remove(&undone.data);
        }
    }

    /// Returns a title of one or two words for the edit that undo would undo.
    pub fn undo_title(&self) -> Option<&'static str> {
        self.done.back().map(|entry| entry.title)
    }

    /// Returns a title of one or two words for the edit that redo would redo.
    pub fn redo_title(&self) -> Option<&'static str> {
        self.undone.last().map(|entry| entry.title)
    }

    /// Returns how many gestures can be undone.
    pub fn len(&self) -> usize {
        self.done.len()
    }

    /// Returns whether nothing can be undone.
    pub fn is_empty(&self) -> bool {
        self.done.is_empty()
    }
}

/// How much memory entries keep alive, updated as they come and go.
#[derive(Clone, Debug, Default)]
struct Memory {
    /// Bytes that belong to one entry each.
    own: usize,
    /// Data that entries share, by address. The address stays valid: an entry with an `Arc` to the data is in
    /// the history.
    shared: NumberMap<usize, SharedMemory>,
    /// Bytes of all shared data, each counted once.
    shared_bytes: usize,
}

#[derive(Clone, Copy, Debug)]
struct SharedMemory {
    bytes: usize,
    /// How many entries refer to it.
    references: usize,
}

impl Memory {
    fn add(&mut self, data: &EntryData) {
        self.own += data.own_bytes();
        for (address, bytes) in data.settings().into_iter().flat_map(shared_data) {
            let shared = self.shared.entry(address).or_insert(SharedMemory { bytes, references: 0 });
            if shared.references == 0 {
                self.shared_bytes += bytes;
            }
            shared.references += 1;
        }
    }

    fn remove(&mut self, data: &EntryData) {
        self.own -= data.own_bytes();
        for (address, _) in data.settings().into_iter().flat_map(shared_data) {
            let shared = self.shared.get_mut(&address).expect("what is removed was added before");
            shared.references -= 1;
            if shared.references == 0 {
                self.shared_bytes -= shared.bytes;
                self.shared.remove(&address);
            }
        }
    }

    /// Returns the bytes in all. Data that the current settings hold too costs nothing extra.
    fn bytes(&self, current: &Settings) -> usize {
        // Two layers may share a raster: it is held once.
        let held: BTreeSet<usize> = shared_data(current).map(|(address, _)| address).collect();
        let held = held.iter().filter_map(|address| self.shared.get(address));
        self.own + self.shared_bytes - held.map(|shared| shared.bytes).sum::<usize>()
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::document::{Document, PathPlan, Setting};
    use crate::domain::{Domain, DomainShape, Region, corners};
    use crate::field::{CostFormula, Formula};
    use crate::geometry::Rect;
    use crate::layers::{
        DistanceLayer, DistanceTo, LayerKind, Mask, Quantity, RasterLayer, RasterReading, RasterSource,
        ShapeList, Shapes, Threat, ThreatLaw, Threats,
    };
    use crate::raster::{Raster, RasterPyramid};

    /// Returns an outline of 4 corners.
    fn outline(side: f64) -> Setting {
        let square = vec![corners(&Rect::new(dvec2(0.0, 0.0), dvec2(side, side)))];
        let region = Arc::new(Region::new(&[square], Rect::UNIT));
        Setting::Domain(Domain { bounds: Rect::UNIT, shape: DomainShape::Region(region), projection: None })
    }

    fn picture(side: u32) -> Setting {
        let raster = Raster::filled(Rect::UNIT, [side, side], 0.5);
        let source = RasterSource { name: String::new(), raster: Arc::new(RasterPyramid::new(raster)) };
        Setting::Layers(Layer::stack([RasterLayer { source, reading: RasterReading::Risk }]))
    }

    fn formula(text: &str) -> Setting {
        Setting::Layers(Layer::stack([LayerKind::target(Formula::parse(text).unwrap())]))
    }

    /// Counts the memory of the shared data that the entries keep alive, from scratch.
    fn counted(document: &Document) -> usize {
        let History { done, undone, memory } = document.history();
        let settings = done.iter().chain(undone).filter_map(|entry| entry.data.settings());
        let mut data: NumberMap<usize, usize> = settings.flat_map(shared_data).collect();
        shared_data(document.settings()).for_each(|(address, _)| _ = data.remove(&address));
        let own: usize = done.iter().chain(undone).map(|entry| entry.data.own_bytes()).sum();
        assert_eq!(own, memory.own);
        data.values().sum()
    }

    fn bytes(document: &Document) -> usize {
        let memory = &document.history().memory;
        memory.bytes(document.settings()) - memory.own
    }

    #[test]
    fn shared_data_counts_once_and_not_while_the_document_holds_it() {
        let name = "x".repeat(10);
        let mut document = Document::new(Settings { name, ..Settings::default() }, None).unwrap();
        let mut set = |setting| {
            document.set(setting).unwrap();
            document.end_gesture();
            assert_eq!(bytes(&document), counted(&document));
            bytes(&document)
        };
        assert_eq!(set(outline(0.5)), 0, "the document holds the only outline");
        let one = set(outline(0.6));
        assert!((64..300).contains(&one), "four corners of 16 bytes each: {one}");
        assert_eq!(set(Setting::Spacing(0.1)), one);
        assert_eq!(set(Setting::Spacing(0.2)), one, "three entries share the second outline");
        let base = set(picture(100));
        assert!((one + 1..one + 200).contains(&base), "the formula of the base: {base}");
        let two = set(picture(10));
        assert!((40_000..48_000).contains(&(two - base)), "the pixels and their ranges: {}", two - base);
        set(formula("x + 1"));
        assert!((1..1000).contains(&(set(formula("x + 2")) - two - 400)), "the second picture and a formula");
        while document.undo() {
            assert_eq!(bytes(&document), counted(&document));
        }
        assert!(bytes(&document) > two, "undone gestures keep their data");
        while document.redo() {
            assert_eq!(bytes(&document), counted(&document));
        }
        document.undo();
        document.reject_last();
        document.set(Setting::Spacing(0.3)).unwrap();
        assert_eq!(bytes(&document), counted(&document));
    }

    #[test]
    fn data_that_two_layers_of_the_document_share_counts_once() {
        let Setting::Layers(mut layers) = picture(100) else { unreachable!("a picture is a layer") };
        layers.push(Layer { id: LayerId(1), ..layers[0].clone() });
        let settings = Settings { layers: layers.clone(), ..Settings::default() };
        let mut document = Document::new(settings, None).unwrap();
        for n in 0..4 {
            layers[1].visible = n % 2 == 1;
            document.set(Setting::Layers(layers.clone())).unwrap();
            document.end_gesture();
            assert_eq!(bytes(&document), counted(&document));
        }
        assert_eq!(document.history().len(), 4, "no gesture is dropped");
    }

    fn ring(corners: usize) -> Vec<glam::DVec2> {
        let angle = |n| std::f64::consts::TAU * n as f64 / corners as f64;
        (0..corners).map(|n| 0.5 + 0.4 * dvec2(angle(n).cos(), angle(n).sin())).collect()
    }

    /// Sets layers, with data of 20,000 corners or threats, and undoes them. Returns the bytes that undo
    /// keeps.
    fn kept_by_undo(layer: Layer) -> usize {
        let mut document = Document::new(Settings::default(), None).unwrap();
        document.record();
        for layers in [vec![layer], Vec::new()] {
            document.set(Setting::Layers(layers)).unwrap();
            document.end_gesture();
            assert_eq!(bytes(&document), counted(&document));
        }
        let recorded = document.recording().unwrap().bytes();
        assert!(recorded > bytes(&document), "the recording keeps the layer too: {recorded}");
        bytes(&document)
    }

    #[test]
    fn the_cost_of_paths_counts() {
        let mut document = Document::new(Settings::default(), None).unwrap();
        let mut set = |terms: usize| {
            let formula = CostFormula::parse(&format!("1{}", " + risk*x".repeat(terms))).unwrap();
            let plan = PathPlan { cost: PathCost::Formula(formula), ..PathPlan::default() };
            document.set(Setting::Paths(Arc::new(plan))).unwrap();
            document.end_gesture();
            assert_eq!(bytes(&document), counted(&document));
            bytes(&document)
        };
        let before = set(400);
        let kept = set(1) - before;
        assert!(kept > 400 * " + risk*x".len(), "the text and the program of the first formula: {kept}");
    }

    #[test]
    fn masks_threats_and_shapes_count() {
        const COUNT: usize = 20_000;
        let paint = || LayerKind::paint(Quantity::Risk);
        let mut masked = Layer::new(LayerId(7), "", paint());
        let least = kept_by_undo(masked.clone());
        masked.mask = Some(Mask::new(&[vec![ring(COUNT)]]).unwrap());
        let threat =
            |n: usize| Threat { at: dvec2(n as f64, 0.5), range: 0.1, peak: 0.5, law: ThreatLaw::ALL[0].0 };
        let threats = LayerKind::Threats(Threats::new((0..COUNT).map(threat).collect()).unwrap());
        let lines = ShapeList { lines: vec![ring(COUNT)], ..ShapeList::default() };
        let shapes = Shapes::new(lines, false).unwrap();
        let to = DistanceTo::Shapes { name: String::new(), shapes };
        let distance = LayerKind::Distance(DistanceLayer { to, at_zero: 0.01, slope: 0.1, range: 1.0 });
        let layers = [masked, Layer::new(LayerId(7), "", threats), Layer::new(LayerId(7), "", distance)];
        for layer in layers {
            let label = layer.kind.label();
            let kept = kept_by_undo(layer) - least;
            assert!((COUNT * 60..COUNT * 200).contains(&kept), "{label}: {kept}");
        }
    }

    #[test]
    fn undo_of_large_masks_is_bounded() {
        let mut document = Document::new(Settings::default(), None).unwrap();
        let mut layer = Layer::new(LayerId(7), "", LayerKind::paint(Quantity::Risk));
        let mut kept = Vec::new();
        for n in 0..60 {
            let mask = Mask::new(&[vec![ring(60_000 + n)]]).unwrap();
            kept.push(Arc::downgrade(mask.region()));
            layer.mask = Some(mask);
            document.set(Setting::Layers(vec![layer.clone()])).unwrap();
            document.end_gesture();
        }
        let each = layer.mask.as_ref().unwrap().shared_data().1;
        let alive = kept.iter().filter(|mask| mask.strong_count() > 0).count();
        assert!(60 * each > History::MAX_BYTES && alive * each <= History::MAX_BYTES + 2 * each, "{alive}");
        assert_eq!(document.history().len(), alive - 1);
    }
}
