use super::{Document, Follower};
use crate::build::RefinementCriterion;
use crate::field::{RefinementRule, TargetField};
use crate::mesh::{Forecast, Progress};
use crate::paint::{Preview, StrokePlan};
use crate::raster::{MaxMipmap, PixelRect};

/// Computes in slices how a planned stroke would change the number of triangles, without changing document or
/// mesh.
///
/// By the area rule the answer is exact. Under the vertex rule there is none: every edit rebuilds the mesh.
#[derive(Clone, Debug)]
pub struct Pricer {
    question: Option<Question>,
    work: Work,
    /// The levels that pixels would ask for: those of the field, except where the stroke's are written.
    levels: MaxMipmap<u8>,
    /// The revision of the document from which the levels were copied.
    levels_of: Option<u64>,
    /// Where levels of this stroke, or of earlier ones, may be written.
    written: Vec<PixelRect>,
}

/// A planned stroke, and what its price depends on: the price is valid as long as none of this changes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Question {
    plan: StrokePlan,
    document: u64,
    mesh: u64,
}

#[derive(Clone, Debug)]
enum Work {
    Idle,
    /// The stroke's levels are written where they differ; those of the stroke before are restored.
    Writing {
        preview: Preview,
        left: Vec<PixelRect>,
        effect: Effect,
    },
    Counting(Box<Forecast>),
    Known(Price),
}

/// What a stroke does to the pixels under it.
#[derive(Clone, Copy, Debug)]
struct Effect {
    /// Bounds of all pixels that would ask for another level.
    levels_changed: PixelRect,
    /// Whether it reaches any pixel.
    reaches: bool,
    /// Whether it changes the paint of any pixel.
    paints: bool,
    /// Whether the base field alone asks for the level of each pixel whose paint changes.
    base_decides: bool,
    /// Whether no pixel whose paint changes asks for more than the coarse grid.
    coarse: bool,
}

impl Effect {
    const NONE: Self =
        Self { levels_changed: NO_PIXELS, reaches: false, paints: false, base_decides: true, coarse: true };

    /// Why a stroke with this effect changes no triangle.
    fn no_change(&self) -> NoChange {
        match self {
            Self { reaches: false, .. } => NoChange::OutsideField,
            Self { paints: false, .. } => NoChange::PaintedAlready,
            Self { levels_changed, .. } if !levels_changed.is_empty() => NoChange::TrianglesFit,
            Self { coarse: true, .. } => NoChange::CoarserThanGrid,
            Self { base_decides: true, .. } => NoChange::BaseDecides,
            _ => NoChange::OtherPaintDecides,
        }
    }
}

/// What a stroke would do to the number of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Price {
    /// The number of new triangles; below zero where triangles are removed. It is zero where as many are
    /// added as removed.
    Change(i64),
    /// No triangle changes, and why.
    Nothing(NoChange),
    /// More than this number would be added, or removed where it is below zero: counting them all would take
    /// too long.
    MoreThan(i64),
    /// More than [`Self::MOST`] triangles would be added and others removed, or the other way around.
    Many,
    /// The stroke asks for triangles finer than the lattice.
    TooFine,
}

/// Why a stroke changes no triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoChange {
    /// It reaches no pixel of the field.
    OutsideField,
    /// The pixels are already painted so; for the eraser: nothing is painted there.
    PaintedAlready,
    /// Its target diameter is not below that of the coarse grid.
    CoarserThanGrid,
    /// The base field asks for a smaller diameter.
    BaseDecides,
    /// The other kind of paint asks for a smaller diameter.
    OtherPaintDecides,
    /// h̄ changes, but the triangles there suit it: they are as fine already, or their neighbours need them.
    TrianglesFit,
}

impl Price {
    /// Counting stops at this number of triangles added or removed.
    pub const MOST: usize = 500_000;

    /// The change in the number of triangles, or the part of it that was counted.
    pub fn change(&self) -> i64 {
        match *self {
            Self::Change(change) | Self::MoreThan(change) => change,
            Self::Nothing(_) | Self::Many | Self::TooFine => 0,
        }
    }
}

const NO_PIXELS: PixelRect = PixelRect { min: [0, 0], max: [0, 0] };

impl Default for Pricer {
    fn default() -> Self {
        let levels = MaxMipmap::filled([1, 1], 0);
        Self { question: None, work: Work::Idle, levels, levels_of: None, written: Vec::new() }
    }
}

impl Pricer {
    /// Asks for the price of a stroke, or for none. Asking for the same stroke again keeps the price.
    ///
    /// There is a price only while the follower is in step with its document and no stroke is being painted.
    pub fn ask(&mut self, plan: Option<StrokePlan>, document: &Document, follower: &Follower) {
        let answerable = document.stroke().is_none()
            && document.settings().rule == RefinementRule::Area
            && follower.is_in_step(document);
        let question = plan.filter(|plan| answerable && plan.is_finite()).map(|plan| Question {
            plan,
            document: document.revision(),
            mesh: follower.revision(),
        });
        if question == self.question {
            return;
        }
        self.question = question;
        self.work = question.map_or(Work::Idle, |question| self.begin(question, document, follower));
    }

    fn begin(&mut self, question: Question, document: &Document, follower: &Follower) -> Work {
        // Strokes that were not restored pile up while the pointer moves: from some number on, a fresh copy
        // is cheaper.
        if self.levels_of != Some(question.document) || self.written.len() > 16 {
            self.levels = follower.field().levels().clone();
            self.levels_of = Some(question.document);
            self.written.clear();
        }
        let h_max = document.settings().transfer.h_max;
        let preview = Preview::new(&question.plan, h_max, document.paint());
        self.written.extend(preview.areas());
        Work::Writing { preview, left: self.written.clone(), effect: Effect::NONE }
    }

    /// The price of the stroke, once known.
    pub fn price(&self) -> Option<Price> {
        if let Work::Known(price) = self.work { Some(price) } else { None }
    }

    /// Whether the price is still being computed.
    pub fn progress(&self) -> Progress {
        match self.work {
            Work::Idle | Work::Known(_) => Progress::Done,
            Work::Writing { .. } | Work::Counting(_) => Progress::More,
        }
    }

    /// One slice of work: about `budget` pixels or triangles. Document and follower must not have changed
    /// since [`Self::ask`].
    pub fn advance(&mut self, document: &Document, follower: &Follower, budget: usize) -> Progress {
        let next = match &mut self.work {
            Work::Idle | Work::Known(_) => return Progress::Done,
            Work::Writing { preview, left, effect } => {
                let Some(area) = left.pop() else {
                    self.written = preview.areas().collect();
                    self.work = count(effect, follower);
                    return self.progress();
                };
                let (now, later) = area.split_after(budget);
                left.extend(later);
                write(&mut self.levels, preview, now, effect, document, follower);
                None
            }
            Work::Counting(forecast) => price_so_far(forecast, &self.levels, follower, budget),
        };
        if let Some(price) = next {
            self.work = Work::Known(price);
        }
        self.progress()
    }
}

/// Writes the levels that the pixels of `area` would ask for: with the stroke where it reaches, those of the
/// field elsewhere.
fn write(
    levels: &mut MaxMipmap<u8>,
    preview: &Preview,
    area: PixelRect,
    effect: &mut Effect,
    document: &Document,
    follower: &Follower,
) {
    let (field, paint) = (follower.field(), document.paint());
    levels.update(area, |x, y| {
        let before = field.levels().get(x, y);
        let Some(painted) = preview.pixel(paint, x, y) else { return before };
        effect.reaches = true;
        if painted == [paint.risk.get(x, y), paint.diameter.get(x, y)] {
            return before;
        }
        let after = field.level_with(x, y, painted);
        effect.note(field, [x, y], [before, after]);
        after
    });
}

impl Effect {
    /// Notes a pixel whose paint changes, with its levels before and after.
    fn note(&mut self, field: &TargetField, [x, y]: [u32; 2], [before, after]: [u8; 2]) {
        self.paints = true;
        if after != before {
            let pixel = PixelRect { min: [x, y], max: [x + 1, y + 1] };
            self.levels_changed = self.levels_changed.union(&pixel);
            return;
        }
        self.coarse &= after == 0;
        self.base_decides &= after == field.level_with(x, y, [0.0, f32::INFINITY]);
    }
}

fn count(effect: &Effect, follower: &Follower) -> Work {
    if effect.levels_changed.is_empty() {
        return Work::Known(Price::Nothing(effect.no_change()));
    }
    let area = follower.field().lattice_rect(effect.levels_changed);
    Work::Counting(Box::new(Forecast::new(follower.mesh(), area, &follower.settings().limits())))
}

fn price_so_far(
    forecast: &mut Forecast,
    levels: &MaxMipmap<u8>,
    follower: &Follower,
    budget: usize,
) -> Option<Price> {
    let domain = follower.domain();
    let criterion = RefinementCriterion::by_area(domain, follower.field());
    let exceeds = |corners, level| criterion.would_exceed(levels, corners, level);
    let is_in_domain = |corners, _| !domain.excludes_at(corners);
    let progress = forecast.advance(follower.mesh(), exceeds, is_in_domain, budget);
    let [added, removed] = [forecast.added(), forecast.removed()];
    match progress {
        Err(_) => Some(Price::TooFine),
        Ok(Progress::Done) if added == 0 && removed == 0 => Some(Price::Nothing(NoChange::TrianglesFit)),
        Ok(Progress::Done) => Some(Price::Change(forecast.change())),
        Ok(Progress::More) if added.max(removed) <= Price::MOST => None,
        Ok(Progress::More) if removed == 0 => Some(Price::MoreThan(Price::MOST as i64)),
        Ok(Progress::More) if added == 0 => Some(Price::MoreThan(-(Price::MOST as i64))),
        Ok(Progress::More) => Some(Price::Many),
    }
}
