//! Operations on a document, made from any source of choices, and what must hold after each.
//!
//! `tests/model/document.rs` makes them from random numbers, `fuzz/` from the bytes of a fuzzer; what that
//! finds is kept as bytes in `tests/model/document.rs`.

mod driver;
mod kinds;
mod layers;
mod prices;
mod settings;

use std::path::Path;

pub use driver::Driver;
use glam::{DVec2, dvec2};
pub use layers::LayerEdit;
use meshbrush_core::document::{Document, DrawnPart, DrawnShape, Setting, Settings};
use meshbrush_core::domain::{BoundaryTreatment, CutShape, corners};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::LayerId;
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_io::io::project::{self, Project};
use meshbrush_mesh::geometry::Rect;
pub use settings::domains;
use settings::setting;

/// Where operations come from: random numbers, or the bytes of a fuzzer.
pub trait Choices {
    /// Returns one of `0..count`; `count` is 256 at most.
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

    /// Returns the parts of 256: places of nodes, and of lines between pixels, come up often.
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
    /// The smallest diameter asked for in all of the domain, and a tenth of the largest.
    pub diameter: f64,
    /// The smallest diameter asked for anywhere.
    pub smallest: f64,
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
    /// Returns to the settings of some gestures before; paint stays.
    ReturnTo(usize),
    ClearPaint,
    /// Adds a shape to the domain, or takes it away.
    Cut(CutShape, bool),
    /// Draws on a mask, a keep-out region or shapes. Layers are counted as in [`LayerEdit`].
    DrawByHand(DrawnKind, usize, DrawnShape, bool),
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
        match choices.below(47) {
            0..14 => Self::stroke(choices, scale),
            14 => {
                let brush = brush(choices, scale);
                Self::Begin(Brush { radius: brush.radius.max(0.02), ..brush }, point(choices))
            }
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
            28..31 => Self::draw(choices),
            36 => Self::Reopen,
            46 => Self::ReturnTo(1 + choices.below(3)),
            37.. => Self::Layers(LayerEdit::choose(choices, scale)),
            _ => Self::Set(setting(choices, scale)),
        }
    }

    fn draw(choices: &mut impl Choices) -> Self {
        let kind = [DrawnKind::Mask, DrawnKind::KeepOut, DrawnKind::Shapes][choices.below(3)];
        let (place, adds) = (choices.below(8), choices.below(3) > 0);
        let mut at = || dvec2(choices.share(), choices.share());
        let (a, b) = (at(), at());
        let shape = match choices.below(4) {
            0 if kind == DrawnKind::Shapes => DrawnShape::Point(a),
            1 if kind == DrawnKind::Shapes => DrawnShape::Line(vec![a, a.lerp(b, 0.3)]),
            _ => DrawnShape::Area(cut_shape(choices)),
        };
        Self::DrawByHand(kind, place, shape, adds)
    }

    pub fn stroke(choices: &mut impl Choices, scale: Scale) -> Self {
        let brush = brush(choices, scale);
        let (count, first) = (choices.below(3), point(choices));
        // A small brush makes a short stroke: tiles are painted one by one.
        let reach = if brush.radius < 0.02 { 20.0 * brush.radius } else { 1.0 };
        let next = |_| if reach < 1.0 { first + reach * (point(choices) - 0.5) } else { point(choices) };
        Self::Stroke(brush, std::iter::once(first).chain((0..count).map(next)).collect())
    }

    /// Does it; what the document refuses must leave it as it was.
    pub fn apply(self, document: &mut Document) {
        match self {
            Self::Stroke(brush, points) => {
                document.begin_stroke(on_a_layer(brush, document));
                points.into_iter().for_each(|point| document.extend_stroke(point));
                document.finish_stroke();
            }
            Self::Begin(brush, point) => {
                document.begin_stroke(on_a_layer(brush, document));
                document.extend_stroke(point);
            }
            Self::Draw(point) => document.extend_stroke(point),
            Self::End => document.finish_stroke(),
            Self::CancelStroke => document.cancel_stroke(),
            Self::Undo => _ = document.undo(),
            Self::Redo => _ = document.redo(),
            Self::ReturnTo(gestures) => {
                let mut earlier = document.clone();
                (0..gestures).for_each(|_| _ = earlier.undo());
                let (wanted, paint) = (earlier.settings().clone(), document.paint().clone());
                document.return_to(&wanted);
                assert_eq!(*document.paint(), paint, "paint stays");
            }
            Self::ClearPaint => document.clear_paint(),
            Self::Cut(cut_shape, adds) => {
                if let Some(domain) = document.settings().domain.reshaped(&cut_shape, adds) {
                    Self::Set(Setting::Domain(domain)).apply(document);
                }
            }
            Self::DrawByHand(kind, place, shape, adds) => {
                let part = kind.part(document, place);
                let drawing = part.and_then(|part| part.drawing(document.settings()));
                if let (Some(part), Some(drawing)) = (part, drawing)
                    && let Ok(Some(edited)) = drawing.edited(&shape, adds)
                {
                    let setting = part.setting(document.settings(), edited).unwrap();
                    Self::Set(setting).apply(document);
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

/// What is drawn on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawnKind {
    Mask,
    KeepOut,
    Shapes,
}

impl DrawnKind {
    /// Returns a part of a document of this kind; `None` where there is none at this place.
    fn part(self, document: &Document, place: usize) -> Option<DrawnPart> {
        let layers = &document.settings().layers;
        let regions = document.settings().paths.keep_out.len();
        match self {
            Self::Mask => layers.get(place % layers.len().max(1)).map(|layer| DrawnPart::Mask(layer.id)),
            Self::KeepOut => Some(DrawnPart::KeepOut(place % (regions.min(3) + 1))),
            Self::Shapes => {
                let mut parts = layers.iter().map(|layer| DrawnPart::Shapes(layer.id));
                parts.find(|part| part.drawing(document.settings()).is_some())
            }
        }
    }
}

/// Returns the document as it comes back from a file.
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

/// Returns a brush of risk in place of one of errors where no layer takes errors.
fn on_a_layer(brush: Brush, document: &Document) -> Brush {
    match brush.medium {
        Medium::Error(_) if document.layer_for(&brush.medium).is_err() => {
            Brush { medium: Medium::Risk(1.0), ..brush }
        }
        _ => brush,
    }
}

/// Where diameters much smaller than that of the domain are asked for, risk is not painted: it would ask for
/// them in all of the brush.
fn brush(choices: &mut impl Choices, scale: Scale) -> Brush {
    let finest = DiameterChange::Finer;
    let (risk, error) = (Medium::Risk(1.0), Medium::Error(0.5 + 0.4 * choices.share()));
    let media = [risk, risk, Medium::Diameter(0.01, finest), Medium::Eraser, error];
    let (medium, share) = (media[choices.below(media.len())], choices.share());
    let (hardness, strength) = (choices.share(), choices.share());
    if scale.smallest == scale.diameter {
        return Brush { medium, radius: 0.02 + 0.1 * share, hardness, strength };
    }
    let radius = 0.1 * (40.0 * scale.smallest).powf(share);
    let change = [DiameterChange::Finer, DiameterChange::Coarser, DiameterChange::Any][choices.below(3)];
    let medium = match medium {
        Medium::Eraser => medium,
        _ => Medium::Diameter(radius * (0.2 + choices.share()), change),
    };
    Brush { medium, radius, hardness, strength }
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

/// A thousand triangles, so that a fuzzer gets through thousands of edits a second.
const SMALL: Scale = Scale { diameter: 0.04, smallest: 0.04, triangles: 200 };
/// Most operations of one run: a longer one says no more, and less of it can be searched.
const MOST_OPERATIONS: usize = 48;

/// A document edited as the bytes say, the follower cut where they say.
pub fn run_bytes(bytes: &[u8]) {
    let mut choices = Bytes(bytes);
    let domain = domains()[choices.below(4)].clone();
    let transfer = Transfer::between(SMALL.diameter, Settings::default().transfer.h_max);
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
