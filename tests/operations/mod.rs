//! Operations on a document, made from any source of choices, and what must hold after each.
//!
//! `tests/document.rs` makes them from random numbers, `fuzz/` from the bytes of a fuzzer; what that finds is
//! kept as bytes in `tests/document.rs`.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, dvec2};
use meshbrush::internals::build::BuildError;
use meshbrush::internals::document::{Document, Follower, MeshChange, Setting, Settings, Stage};
use meshbrush::internals::domain::{BoundaryTreatment, CutShape, Domain, DomainShape, corners};
use meshbrush::internals::field::{Formula, RefinementRule, Transfer};
use meshbrush::internals::geometry::{LatticePoint, Rect};
use meshbrush::internals::io::project::{self, Project};
use meshbrush::internals::layers::{
    Combine, Layer, LayerId, LayerKind, Quantity, RasterReading, RasterSource,
};
use meshbrush::internals::mesh::{Cleaning, KeptParts, NodeId, Progress, Triangle};
use meshbrush::internals::outline::DerivedMesh;
use meshbrush::internals::paint::{Brush, DiameterChange, Medium};
use meshbrush::internals::raster::{Raster, RasterPyramid};

/// Where operations come from: random numbers, or the bytes of a fuzzer.
pub trait Choices {
    /// One of `0..count`; `count` is 256 at most.
    fn below(&mut self, count: usize) -> usize;
    /// From 0 to 1.
    fn share(&mut self) -> f64;
}

/// Choices from bytes, one each; zeros once they are used up.
pub struct Bytes<'a>(pub &'a [u8]);

impl Bytes<'_> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn next(&mut self) -> u8 {
        self.0.split_off_first().copied().unwrap_or(0)
    }
}

impl Choices for Bytes<'_> {
    fn below(&mut self, count: usize) -> usize {
        usize::from(self.next()) % count
    }

    /// Parts of 256: places of nodes, and of lines between pixels, come up often.
    fn share(&mut self) -> f64 {
        match self.next() {
            255 => 1.0,
            byte => f64::from(byte) / 256.0,
        }
    }
}

/// How large the meshes are.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// The smallest diameter asked for, and a tenth of the largest.
    pub diameter: f64,
    /// The tightest budget.
    pub triangles: usize,
}

/// Something done to a document or to the follower of one.
#[derive(Clone, Debug)]
pub enum Operation {
    /// A whole stroke.
    Stroke(Brush, Vec<DVec2>),
    /// The beginning of one.
    Begin(Brush, DVec2),
    /// Its next point; nothing without a current stroke.
    Draw(DVec2),
    End,
    CancelStroke,
    Undo,
    Redo,
    ClearPaint,
    /// Adds a shape to the domain, or takes it away.
    Cut(CutShape, bool),
    Set(Setting),
    /// Changes the stack of layers.
    Layers(LayerEdit),
    EndGesture,
    /// The current work is cancelled.
    CancelUpdate,
    /// The project is saved and opened, and the opened document replaces it, without history.
    Reopen,
}

impl Operation {
    pub fn choose(choices: &mut impl Choices, scale: Scale) -> Self {
        match choices.below(46) {
            0..14 => Self::stroke(choices),
            14 => Self::Begin(brush(choices), point(choices)),
            15 => Self::Draw(point(choices)),
            16 => Self::End,
            17 => Self::CancelStroke,
            18..21 => Self::Undo,
            21 | 22 => Self::Redo,
            23 => match choices.below(3) {
                0 => Self::ClearPaint,
                1 => Self::CancelUpdate,
                _ => Self::EndGesture,
            },
            24..28 => Self::Cut(cut_shape(choices), choices.below(3) == 0),
            36 => Self::Reopen,
            37.. => Self::Layers(LayerEdit::choose(choices, scale)),
            _ => Self::Set(setting(choices, scale)),
        }
    }

    pub fn stroke(choices: &mut impl Choices) -> Self {
        let brush = brush(choices);
        let count = 1 + choices.below(3);
        Self::Stroke(brush, (0..count).map(|_| point(choices)).collect())
    }

    /// Does it; what the document refuses must leave it as it was.
    pub fn apply(self, document: &mut Document) {
        match self {
            Self::Stroke(brush, points) => {
                document.begin_stroke(brush);
                points.into_iter().for_each(|point| document.extend_stroke(point));
                document.finish_stroke();
            }
            Self::Begin(brush, point) => {
                document.begin_stroke(brush);
                document.extend_stroke(point);
            }
            Self::Draw(point) => document.extend_stroke(point),
            Self::End => document.finish_stroke(),
            Self::CancelStroke => document.cancel_stroke(),
            Self::Undo => _ = document.undo(),
            Self::Redo => _ = document.redo(),
            Self::ClearPaint => document.clear_paint(),
            Self::Cut(cut_shape, adds) => {
                if let Some(domain) = document.settings().domain.reshaped(&cut_shape, adds) {
                    Self::Set(Setting::Domain(domain)).apply(document);
                }
            }
            Self::Set(setting) => {
                let before = document.settings().clone();
                if document.set(setting).is_err() {
                    assert_eq!(document.settings(), &before);
                }
            }
            Self::Layers(edit) => edit.apply(document),
            Self::EndGesture => document.end_gesture(),
            Self::CancelUpdate => {}
            Self::Reopen => *document = reopened(document),
        }
    }
}

/// The document as it comes back from a file.
fn reopened(document: &Document) -> Document {
    let mut bytes = Vec::new();
    project::write(&mut bytes, &Project::of(document)).unwrap();
    let project = project::from_bytes(&bytes, Path::new("edits.meshbrush")).unwrap();
    let opened = project.into_document().unwrap();
    assert_eq!(opened.settings(), document.settings());
    // Pixels of deleted layers are there for undo alone.
    let mut paint = document.paint().clone();
    let deleted = |id: &LayerId| document.settings().layer(*id).is_none();
    let ids: Vec<_> = paint.iter().map(|(id, _)| id).filter(deleted).collect();
    ids.into_iter().for_each(|id| _ = paint.remove(id));
    assert!(*opened.paint() == paint, "paint was lost");
    assert!(!opened.clone().undo(), "history is not saved");
    opened
}

fn brush(choices: &mut impl Choices) -> Brush {
    let media =
        [Medium::Risk(1.0), Medium::Risk(1.0), Medium::Diameter(0.01, DiameterChange::Finer), Medium::Eraser];
    Brush {
        medium: media[choices.below(media.len())],
        radius: 0.02 + 0.1 * choices.share(),
        hardness: choices.share(),
        strength: choices.share(),
    }
}

/// In the unit square, now and then beyond.
fn point(choices: &mut impl Choices) -> DVec2 {
    let point = dvec2(choices.share(), choices.share());
    match choices.below(64) {
        0 => 3.0 * point - 1.0,
        1 => dvec2(f64::NAN, point.y),
        _ => point,
    }
}

fn cut_shape(choices: &mut impl Choices) -> CutShape {
    let mut at = || dvec2(choices.share(), choices.share());
    let (a, b, c) = (at(), at(), at());
    match choices.below(4) {
        0 => CutShape::Ring(corners(&Rect::spanning(a, b))),
        1 => CutShape::Ring(vec![a, b, c]),
        n => CutShape::Stroke { path: [a, b][..n - 1].to_vec(), radius: 0.02 + 0.15 * choices.share() },
    }
}

fn setting(choices: &mut impl Choices, scale: Scale) -> Setting {
    let diameter = scale.diameter * (1.0 + 9.0 * choices.share());
    match choices.below(16) {
        0 | 1 => Setting::SmallestDiameter(diameter),
        2 => Setting::LargestDiameter(8.0 * diameter),
        3 => Setting::TransferShape(0.5 + 2.0 * choices.share()),
        4 | 5 => Setting::Spacing([0.3, 0.25, 0.2, 0.15][choices.below(4)]),
        6 | 7 => Setting::RefinementRule(if choices.below(4) == 0 {
            RefinementRule::Vertex
        } else {
            RefinementRule::Area
        }),
        8 => Setting::Gradation([None, Some(0.5 + choices.share())][choices.below(2)]),
        9 => Setting::Cleaning(cleaning(choices.share())),
        10 => Setting::MaxTriangles(scale.triangles * [1, 4, 20, 100][choices.below(4)]),
        11 | 12 => Setting::Bounds(bounds(choices)),
        13 => Setting::Domain(inside(choices)),
        14 if choices.below(4) == 0 => Setting::Boundary(BoundaryTreatment::Report),
        14 if diameter < 4.0 * scale.diameter => {
            Setting::Boundary(BoundaryTreatment::Fitted { diameter: 2.0 * diameter })
        }
        14 => Setting::Boundary(BoundaryTreatment::OnOutline { diameter: 2.0 * diameter }),
        _ => impossible(choices),
    }
}

fn cleaning(share: f64) -> Cleaning {
    let parts = match share {
        ..0.3 => KeptParts::All,
        ..0.6 => KeptParts::Largest,
        _ => KeptParts::Share(share - 0.6),
    };
    Cleaning { parts, keeps_pinches: (100.0 * share) % 2.0 < 1.0 }
}

/// A change of the stack of layers. Layers are counted from the bottom, round and round.
#[derive(Clone, Debug)]
pub enum LayerEdit {
    Add(Box<LayerKind>, Combine),
    Delete(usize),
    /// Moves one to the place of another.
    Move(usize, usize),
    Show(usize, bool),
    Combine(usize, Combine),
    /// Gives a layer of numbers others, as the drag of a control does.
    Replace(usize, Box<LayerKind>),
    /// The brush paints on it from now on, if it can.
    Activate(usize),
}

impl LayerEdit {
    fn choose(choices: &mut impl Choices, scale: Scale) -> Self {
        let place = choices.below(8);
        match choices.below(10) {
            0..3 => Self::Add(Box::new(layer_kind(choices, scale)), combine(choices)),
            3 => Self::Delete(place),
            4 => Self::Move(place, choices.below(8)),
            5 | 6 => Self::Show(place, choices.below(3) > 0),
            7 => Self::Combine(place, combine(choices)),
            8 => Self::Replace(place, Box::new(layer_kind(choices, scale))),
            _ => Self::Activate(place),
        }
    }

    fn apply(self, document: &mut Document) {
        let mut layers = document.settings().layers.clone();
        let count = layers.len().max(1);
        match self {
            // More layers say no more, and take longer.
            Self::Add(..) if count > 6 => return,
            Self::Add(kind, combine) => {
                let id = document.unused_layer_id();
                layers.push(Layer { combine, ..Layer::new(id, kind.label(), *kind) });
            }
            Self::Move(from, to) if !layers.is_empty() => {
                let layer = layers.remove(from % count);
                layers.insert(to % count, layer);
            }
            Self::Delete(place) if !layers.is_empty() => _ = layers.remove(place % count),
            Self::Activate(place) => {
                return layers
                    .get(place % count)
                    .into_iter()
                    .for_each(|layer| document.activate_layer(layer.id));
            }
            Self::Move(..) | Self::Delete(_) => return,
            Self::Show(place, _) | Self::Combine(place, _) | Self::Replace(place, _) => {
                let Some(layer) = layers.get_mut(place % count) else { return };
                self.change(layer);
            }
        }
        Operation::Set(Setting::Layers(layers)).apply(document);
    }

    /// Changes one layer. Paint stays paint: it has pixels.
    fn change(self, layer: &mut Layer) {
        match self {
            Self::Show(_, visible) => layer.visible = visible,
            Self::Combine(_, combine) => layer.combine = combine,
            Self::Replace(_, kind) if layer.paints().is_none() && !matches!(*kind, LayerKind::Paint(_)) => {
                layer.kind = *kind
            }
            _ => {}
        }
    }
}

fn combine(choices: &mut impl Choices) -> Combine {
    [Combine::Finest, Combine::Finest, Combine::Floor, Combine::Replace][choices.below(4)]
}

fn layer_kind(choices: &mut impl Choices, scale: Scale) -> LayerKind {
    let diameter = scale.diameter * (1.0 + 9.0 * choices.share());
    let targets = [
        "0.1 + 0.2 * x",
        "if(abs(x - y) < 0.1, 0.1, inf)",
        "if(hypot(x - 0.5, y - 0.4) < 0.3, 0.15, inf)",
        "x - 0.3",
        "1 / (x - y)",
    ];
    let formula = |text: &str| Formula::parse(text).unwrap();
    match choices.below(10) {
        0 => LayerKind::constant(8.0 * diameter),
        1..4 => LayerKind::target(formula(targets[choices.below(targets.len())])),
        4 => LayerKind::risk(formula("exp(-30 * hypot(x - 0.6, y - 0.3))")),
        5 | 6 => LayerKind::Paint([Quantity::Risk, Quantity::Diameter][choices.below(2)]),
        _ => raster(choices, diameter),
    }
}

/// A raster over a part of the domain, or beyond it, with a pixel that has no value.
fn raster(choices: &mut impl Choices, diameter: f64) -> LayerKind {
    let corner = dvec2(choices.share(), choices.share()) - 0.4;
    let bounds = Rect::new(corner, corner + 0.2 + choices.share());
    let size = [1 + choices.below(9) as u32, 1 + choices.below(9) as u32];
    let is_risk = choices.below(2) == 0;
    let value = |share: f64| if is_risk { share } else { diameter * (0.5 + 4.0 * share) };
    let count = (size[0] * size[1]) as usize;
    let mut values: Vec<f32> = (0..count).map(|_| value(choices.share()) as f32).collect();
    values[choices.below(count)] = f32::NAN;
    let raster = Arc::new(RasterPyramid::new(Raster::from_values(bounds, size, values)));
    let reading = if is_risk { RasterReading::Risk } else { RasterReading::Diameter };
    LayerKind::Raster { source: RasterSource { name: "random".into(), raster }, reading }
}

fn bounds(choices: &mut impl Choices) -> Rect {
    let size = dvec2(0.4 + choices.share(), 0.4 + choices.share());
    let min = dvec2(choices.share(), choices.share()) - 0.5;
    if choices.below(2) == 0 { Rect::UNIT } else { Rect::new(min, min + size) }
}

/// A hole and a bite out of the rim, a strip, two parts that do not touch, nothing at all.
const INSIDES: [&str; 4] =
    ["not(hypot(x - 0.4, y - 0.6) < 0.2 or x + y > 1.7)", "abs(x - y) < 0.4", "x < 0.25 or x > 0.7", "x > 9"];

fn inside(choices: &mut impl Choices) -> Domain {
    let chosen = choices.below(1 + 2 * INSIDES.len()).checked_sub(1).and_then(|n| INSIDES.get(n));
    let formula = chosen.map(|text| Formula::parse(text).unwrap());
    Domain { bounds: Rect::UNIT, shape: formula.map_or(DomainShape::Whole, DomainShape::Formula) }
}

/// What no document can meet.
fn impossible(choices: &mut impl Choices) -> Setting {
    let bad = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300][choices.below(5)];
    match choices.below(6) {
        0 => Setting::Spacing(bad),
        1 => Setting::SmallestDiameter(bad),
        2 => Setting::TransferShape(bad),
        3 => Setting::Gradation(Some(if bad == 1e-300 { -bad } else { bad })),
        4 => Setting::Layers(Layer::usual(LayerKind::constant(if bad == 1e-300 { 0.0 } else { bad }))),
        _ => Setting::Bounds(Rect::new(DVec2::ZERO, dvec2(bad, 1.0))),
    }
}

/// A square, a rectangle, a domain with a hole and a bite out of its rim by a formula, and a slanted one with
/// a hole.
pub fn domains() -> [Domain; 4] {
    let outline = vec![dvec2(0.0, 0.1), dvec2(0.9, 0.0), dvec2(1.0, 0.8), dvec2(0.3, 1.0)];
    let hole = vec![dvec2(0.3, 0.3), dvec2(0.6, 0.35), dvec2(0.5, 0.7)];
    [
        Domain::rectangle(Rect::UNIT),
        Domain::rectangle(Rect::new(DVec2::ZERO, dvec2(1.0, 0.7))),
        Domain { bounds: Rect::UNIT, shape: DomainShape::Formula(Formula::parse(INSIDES[0]).unwrap()) },
        Domain::of_polygons(&[vec![outline, hole]]).unwrap(),
    ]
}

/// A document and its follower, with a copy of the mesh that only hears of changed ranges, as the GPU does.
pub struct Driver {
    pub document: Document,
    pub follower: Follower,
    nodes: Vec<LatticePoint>,
    triangles: Vec<Triangle>,
    /// The document's revision when work was last given up: until the next the mesh may lag behind.
    given_up: Option<u64>,
    /// How often ranges of the shown mesh changed.
    pub changes_within: usize,
    /// How often the mesh was compared with one made from scratch.
    pub compared: usize,
}

impl Driver {
    pub fn new(settings: Settings) -> Self {
        let mut document = Document::new(settings, None).unwrap();
        let follower = Follower::new(&mut document).unwrap();
        let (nodes, triangles) = (Vec::new(), Vec::new());
        Self { document, follower, nodes, triangles, given_up: None, changes_within: 0, compared: 0 }
    }

    pub fn apply(&mut self, operation: Operation) {
        if matches!(operation, Operation::CancelUpdate) {
            self.follower.cancel(&self.document);
            self.given_up = Some(self.document.revision());
        }
        match operation {
            Operation::Reopen => self.reopen(),
            operation => operation.apply(&mut self.document),
        }
    }

    /// Saves and opens as the window does: with another follower, whose mesh must be the one at rest
    /// before.
    fn reopen(&mut self) {
        self.settle();
        let mut opened = self.document.clone();
        Operation::Reopen.apply(&mut opened);
        let follower = Follower::new(&mut opened);
        assert_eq!(follower.is_ok(), Follower::new(&mut self.document.clone()).is_ok());
        // Where paint cannot be met there is no mesh to open with.
        let Ok(follower) = follower else { return };
        if self.given_up != Some(self.document.revision()) {
            assert_eq!(follower.mesh().fingerprint(), self.follower.mesh().fingerprint());
        }
        (self.document, self.follower, self.given_up) = (opened, follower, None);
        self.check_stop();
    }

    /// One slice of work, and what must hold wherever the work stops.
    pub fn advance(&mut self, visits: usize) {
        self.work(visits);
        self.check_stop();
    }

    /// One slice of work, as in the window: of the stroke under way, or of what follows from it. True at
    /// rest.
    fn work(&mut self, visits: usize) -> bool {
        if self.document.advance_stroke(visits) == Progress::More {
            return false;
        }
        let stage = self.follower.advance(&mut self.document, visits).unwrap_or_else(|error| {
            self.refused(&error);
            Stage::Checking
        });
        stage.is_settled()
    }

    /// As the window does: a setting that cannot be met is taken back, paint stays.
    fn refused(&mut self, error: &BuildError) {
        assert!(error.to_string().ends_with('.'), "{error}");
        if self.document.settings() != self.follower.settings() {
            self.document.reject_last();
        }
    }

    fn check_stop(&mut self) {
        let change = self.follower.take_change();
        let mesh = self.follower.mesh();
        if change.is_some() {
            assert_eq!(mesh.violations(), []);
        }
        match change {
            Some(MeshChange::Replaced) => {
                self.nodes = mesh.raw_nodes().to_vec();
                self.triangles = mesh.raw_triangles().to_vec();
            }
            Some(MeshChange::Within(changes)) => {
                self.changes_within += 1;
                patch(&mut self.nodes, mesh.raw_nodes(), &changes.nodes);
                patch(&mut self.triangles, mesh.raw_triangles(), &changes.triangles);
            }
            None => {}
        }
        assert!(self.nodes == mesh.raw_nodes(), "a node changed and was not reported");
        assert!(self.triangles == mesh.raw_triangles(), "a triangle changed and was not reported");
    }

    /// Works on to rest, where the mesh must be the one made from scratch.
    pub fn settle(&mut self) {
        let settled = (0..1_000_000).any(|_| self.work(997));
        assert!(settled, "the follower never gets in step");
        self.check_stop();
        if self.given_up == Some(self.document.revision()) {
            return;
        }
        // Paint that cannot be met stays, and the mesh is then an earlier one.
        if let Ok(rebuilt) = Follower::new(&mut self.document.clone()) {
            assert_eq!(self.follower.mesh().fingerprint(), rebuilt.mesh().fingerprint());
            assert!(derived(&self.follower) == derived(&rebuilt), "the derived mesh is another");
            self.compared += 1;
        }
    }
}

/// The triangles that leave the program, as corners in any order.
fn derived(follower: &Follower) -> Vec<[LatticePoint; 3]> {
    let cleaning = follower.settings().derived_cleaning();
    let derived = DerivedMesh::new(follower.mesh(), follower.domain(), &cleaning);
    let extract = derived.extract(follower.mesh());
    assert_eq!(derived.violations(&extract), []);
    let corners = |corners: [usize; 3]| {
        let mut corners = corners.map(|node| extract.node(NodeId::from_index(node)));
        corners.sort_unstable_by_key(|p| [p.x, p.y]);
        corners
    };
    let mut triangles: Vec<_> = extract.cells().map(|cell| corners(cell.corners)).collect();
    triangles.sort_unstable_by_key(|corners| corners.map(|p| [p.x, p.y]));
    triangles
}

fn patch<T: Copy>(copy: &mut Vec<T>, now: &[T], ranges: &[Range<usize>]) {
    copy.truncate(now.len());
    for range in ranges {
        // New entries are in the ranges, which ascend.
        assert!(range.start <= copy.len(), "entries are new and were not reported");
        copy.extend_from_slice(&now[copy.len().min(range.end)..range.end]);
        copy[range.clone()].copy_from_slice(&now[range.clone()]);
    }
}

/// A thousand triangles, so that a fuzzer gets through thousands of edits a second.
const SMALL: Scale = Scale { diameter: 0.04, triangles: 200 };
/// Most operations of one run: a longer one says no more, and less of it can be searched.
const MOST_OPERATIONS: usize = 48;

/// A document edited as the bytes say, the follower cut where they say.
pub fn run_bytes(bytes: &[u8]) {
    let mut choices = Bytes(bytes);
    let domain = domains()[choices.below(4)].clone();
    let transfer = Transfer { h_min: SMALL.diameter, ..Settings::default().transfer };
    let mut driver = Driver::new(Settings {
        domain,
        max_triangles: 20 * SMALL.triangles,
        spacing: 0.2,
        boundary: BoundaryTreatment::OnOutline { diameter: 2.0 * SMALL.diameter },
        transfer,
        ..Settings::default()
    });
    for _ in 0..MOST_OPERATIONS {
        if choices.is_empty() {
            break;
        }
        driver.apply(Operation::choose(&mut choices, SMALL));
        match choices.below(4) {
            0 => driver.settle(),
            slices => {
                for _ in 1..slices {
                    driver.advance(1 + choices.below(256) * [1, 16][choices.below(2)]);
                }
            }
        }
    }
    driver.settle();
}
