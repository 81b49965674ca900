use glam::DVec2;

use super::{Document, Follower};
use crate::build::RefinementCriterion;
use crate::field::RefinementRule;
use crate::mesh::{Forecast, Progress};
use crate::paint::{Brush, Dab};
use crate::raster::{MaxMipmap, PixelRect};

/// Computes in slices how one dab would change the number of triangles, without changing document or mesh.
///
/// By the area rule the answer is exact. Under the vertex rule there is none: every edit rebuilds the mesh.
#[derive(Clone, Debug)]
pub struct Pricer {
    question: Option<Question>,
    work: Work,
    /// The levels that pixels would ask for: those of the field, except where the dab's are written.
    levels: MaxMipmap<u8>,
    /// The revision of the document from which the levels were copied.
    levels_of: Option<u64>,
    /// Where levels of this dab, or of earlier ones, may be written.
    written: Vec<PixelRect>,
}

/// A dab, and what its price depends on: the price is valid as long as none of this changes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Question {
    brush: Brush,
    at: DVec2,
    document: u64,
    mesh: u64,
}

#[derive(Clone, Debug)]
enum Work {
    Idle,
    /// The dab's levels are written where they differ; those of the dab before are restored.
    Writing {
        dab: Dab,
        left: Vec<PixelRect>,
        /// Bounds of all pixels so far that would ask for another level.
        changed: PixelRect,
    },
    Counting(Box<Forecast>),
    Known(Price),
}

/// What a dab would do to the number of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Price {
    /// The number of new triangles; below zero where triangles are removed.
    Change(i64),
    /// More than this number would be added, or removed where it is below zero: counting them all would take
    /// too long.
    MoreThan(i64),
    /// The dab asks for triangles finer than the lattice.
    TooFine,
}

impl Price {
    /// Counting stops at this number of triangles added or removed.
    pub const MOST: usize = 500_000;

    /// The change in the number of triangles, or the part of it that was counted.
    pub fn change(&self) -> i64 {
        match *self {
            Self::Change(change) | Self::MoreThan(change) => change,
            Self::TooFine => 0,
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
    /// Asks for the price of a dab of a brush at a point in world units, or for none. Asking for the same dab
    /// again keeps the price.
    ///
    /// There is a price only while the follower is in step with its document and no stroke is being painted.
    pub fn ask(&mut self, dab: Option<(Brush, DVec2)>, document: &Document, follower: &Follower) {
        let answerable = document.stroke().is_none()
            && document.settings().rule == RefinementRule::Area
            && follower.is_in_step(document);
        let question = dab.filter(|(_, at)| answerable && at.is_finite()).map(|(brush, at)| Question {
            brush,
            at,
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
        // Dabs that were not restored pile up while the pointer moves: from some number on, a fresh copy is
        // cheaper.
        if self.levels_of != Some(question.document) || self.written.len() > 4 {
            self.levels = follower.field().levels().clone();
            self.levels_of = Some(question.document);
            self.written.clear();
        }
        let h_max = document.settings().transfer.h_max;
        let dab = Dab::new(question.brush, h_max, question.at, document.paint());
        self.written.push(dab.area());
        let left = self.written.iter().copied().filter(|area| !area.is_empty()).collect();
        Work::Writing { dab, left, changed: NO_PIXELS }
    }

    /// The price of the dab, once known.
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
            Work::Writing { dab, left, changed } => {
                let Some(area) = left.pop() else {
                    self.written = vec![dab.area()];
                    self.work = count(*changed, follower);
                    return self.progress();
                };
                let (now, later) = area.split_after(budget);
                left.extend(later);
                write(&mut self.levels, dab, now, changed, document, follower);
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

/// Writes the levels that the pixels of `area` would ask for: with the dab where it reaches, those of the
/// field elsewhere.
fn write(
    levels: &mut MaxMipmap<u8>,
    dab: &Dab,
    area: PixelRect,
    changed: &mut PixelRect,
    document: &Document,
    follower: &Follower,
) {
    let field = follower.field();
    levels.update(area, |x, y| {
        let before = field.levels().get(x, y);
        if !dab.area().contains(x, y) {
            return before;
        }
        let after = field.level_with(x, y, dab.pixel(document.paint(), x, y));
        if after != before {
            *changed = changed.union(&PixelRect { min: [x, y], max: [x + 1, y + 1] });
        }
        after
    });
}

fn count(changed: PixelRect, follower: &Follower) -> Work {
    if changed.is_empty() {
        return Work::Known(Price::Change(0));
    }
    let area = follower.field().lattice_rect(changed);
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
        Ok(Progress::Done) => Some(Price::Change(forecast.change())),
        // A brush only refines and an eraser only coarsens, so the rest cannot cancel what is counted.
        Ok(Progress::More) if added > Price::MOST => Some(Price::MoreThan(Price::MOST as i64)),
        Ok(Progress::More) if removed > Price::MOST => Some(Price::MoreThan(-(Price::MOST as i64))),
        Ok(Progress::More) => None,
    }
}
