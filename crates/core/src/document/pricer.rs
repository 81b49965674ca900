use std::sync::{Arc, Weak};

use super::pace::questions_per_thread;
use super::pending::Pending;
use super::rebuild_price::{RebuildPrice, price_between};
use super::{Document, Follower};
use crate::build::RefinementCriterion;
use crate::geometry::Rect;
use crate::layers::{LayerId, PaintChange, PaintLayers, SizeField};
use crate::mesh::{Forecast, Mesh, Progress};
use crate::paint::{Medium, Preview, Repaint, StrokePlan};

/// Computes in slices how a planned stroke would change the number of triangles, without changing document or
/// mesh.
///
/// The stroke is painted on a copy of the paint, which shares all tiles that it does not touch. Then the
/// update is performed on sets of nodes; where every edit rebuilds the mesh (close to a surface, or under the
/// vertex rule), another one is made and counted. The answer is exact.
#[derive(Clone, Debug, Default)]
pub struct Pricer {
    question: Option<StrokeQuestion>,
    work: PricerState,
    /// What the last price was counted in: its memory is used again.
    counted: Option<Forecast>,
    /// The mesh that was made for the last price: its memory is used again.
    spare: Option<Mesh>,
    answers: Answers,
}

/// What a field has answered, with the pixels that the last stroke would paint.
#[derive(Clone, Debug, Default)]
struct Answers {
    planned: Pending,
    /// What the last stroke would change.
    changes: Vec<PaintChange>,
    /// The field, which is not kept longer than its document, and the revision of the document.
    of: (Weak<SizeField>, u64),
}

impl Answers {
    /// Keeps the answers that are the same with another stroke.
    fn plan(&mut self, changes: Vec<PaintChange>, field: &Arc<SizeField>, document: u64) {
        let (of, revision) = &self.of;
        if of.ptr_eq(&Arc::downgrade(field)) && *revision == document {
            self.planned.forget(&self.changes, field);
        } else {
            self.planned.anything();
        }
        self.planned.paint(true, &changes, field);
        (self.changes, self.of) = (changes, (Arc::downgrade(field), document));
    }
}

/// A planned stroke, and what its price depends on: the price is valid as long as none of this changes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StrokeQuestion {
    plan: StrokePlan,
    layer: LayerId,
    document: u64,
    mesh: u64,
}

#[derive(Clone, Debug, Default)]
enum PricerState {
    #[default]
    Idle,
    /// The stroke is painted.
    Painting(Box<Preview>),
    /// The triangles are counted, `paint` being what would be painted.
    Counting(Box<StrokeCount>),
    /// The mesh after the stroke is made.
    Making(Box<RebuildPrice>),
    Known(Price),
}

#[derive(Clone, Debug)]
struct StrokeCount {
    forecast: Forecast,
    paint: PaintLayers,
}

/// The effect of a stroke on the number of triangles.
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
    /// About this number would be added, or removed where it is below zero: an estimate, as counting them all
    /// would take too long.
    About(i64),
    /// More than [`Self::MOST`] triangles would be added and others removed, or the other way around.
    Many,
    /// The stroke asks for triangles finer than the lattice.
    TooFine,
}

/// Why a stroke changes no triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoChange {
    /// There is no layer for the brush, or it is locked or hidden: [`Document::layer_for`] says which.
    NoLayer,
    /// The stroke does not reach the domain's rectangle.
    OutsideField,
    /// The pixels are already painted so; for the eraser: nothing is painted there.
    PaintedAlready,
    /// The target diameter of the stroke is not below the diameter of the coarse grid.
    CoarserThanGrid,
    /// Another layer decides h̄ where the stroke ends.
    LayerDecides(LayerId),
    /// h̄ changes, but the triangles there suit it: they are as fine already, or their neighbours need them.
    TrianglesFit,
}

impl Price {
    /// Returns the number of triangles by which the mesh grows, as far as it is known.
    pub fn change(self) -> i64 {
        match self {
            Self::Change(change) | Self::MoreThan(change) | Self::About(change) => change,
            Self::Nothing(_) | Self::Many | Self::TooFine => 0,
        }
    }

    /// Counting stops at this number of triangles added or removed.
    pub const MOST: usize = 500_000;
}

impl Pricer {
    /// Asks for the price of a stroke, or for none. Asking for the same stroke again keeps the price.
    ///
    /// There is a price only while the follower is in step with its document and no stroke is being painted.
    pub fn ask(&mut self, plan: Option<StrokePlan>, document: &Document, follower: &Follower) {
        let answerable = document.stroke().is_none() && follower.is_in_step(document);
        let Some(plan) = plan.filter(|plan| answerable && plan.is_finite()) else {
            (self.question, self.work) = (None, PricerState::Idle);
            return;
        };
        let Ok(layer) = document.layer_for(&plan.brush.medium) else {
            (self.question, self.work) = (None, PricerState::Known(Price::Nothing(NoChange::NoLayer)));
            return;
        };
        let question =
            StrokeQuestion { plan, layer, document: document.revision(), mesh: follower.revision() };
        if self.question != Some(question) {
            (self.question, self.work) = (Some(question), begin(question, document));
        }
    }

    /// Returns the price of the stroke, once known.
    pub fn price(&self) -> Option<Price> {
        if let PricerState::Known(price) = self.work { Some(price) } else { None }
    }

    /// Whether the price is still being computed.
    pub fn progress(&self) -> Progress {
        match self.work {
            PricerState::Idle | PricerState::Known(_) => Progress::Done,
            PricerState::Painting(_) | PricerState::Counting(_) | PricerState::Making(_) => Progress::More,
        }
    }

    /// One slice of work: about `budget` pixels or triangles. Document and follower must not have changed
    /// since [`Self::ask`].
    pub fn advance(&mut self, document: &Document, follower: &Follower, budget: usize) -> Progress {
        let Some(question) = self.question else { return Progress::Done };
        self.work = match std::mem::take(&mut self.work) {
            PricerState::Painting(preview) => self.paint_more(preview, question, document, follower, budget),
            PricerState::Counting(counting) => self.count_more(counting, question, follower, budget),
            PricerState::Making(making) => self.make_more(making, question, follower, budget),
            settled @ (PricerState::Idle | PricerState::Known(_)) => settled,
        };
        self.progress()
    }

    fn paint_more(
        &mut self,
        mut preview: Box<Preview>,
        question: StrokeQuestion,
        document: &Document,
        follower: &Follower,
        budget: usize,
    ) -> PricerState {
        if !preview.advance(budget) {
            return PricerState::Painting(preview);
        }
        let (raster, changed) = preview.finish();
        if changed.is_empty() {
            return PricerState::Known(Price::Nothing(NoChange::OutsideField));
        }
        let is_same = match document.paint().get(question.layer) {
            Some(before) => *before == raster,
            None => raster.is_blank(),
        };
        if is_same {
            return PricerState::Known(Price::Nothing(NoChange::PaintedAlready));
        }
        let mut paint = document.paint().clone();
        paint.insert(question.layer, raster);
        if !document.settings().is_updated_in_place() {
            let making = RebuildPrice::new(paint, follower, self.spare.take());
            return making.map_or(PricerState::Idle, |making| PricerState::Making(Box::new(making)));
        }
        self.count(question, paint, &changed, follower)
    }

    /// Begins to count the triangles after a stroke, `paint` being what would be painted.
    fn count(
        &mut self,
        question: StrokeQuestion,
        paint: PaintLayers,
        changed: &[Repaint],
        follower: &Follower,
    ) -> PricerState {
        let (field, layer) = (follower.field(), question.layer);
        let painted: Vec<PaintChange> = changed
            .iter()
            .map(|&Repaint { area, before, change }| PaintChange { layer, area, before, change })
            .collect();
        self.answers.plan(painted, &follower.shared_field(), question.document);
        let Answers { planned, changes, .. } = &self.answers;
        let affected = planned.changed_areas(changes, field, &paint);
        let limits = follower.settings().limits();
        let forecast = match self.counted.take() {
            Some(memory) => Forecast::for_changes_in(memory, affected, &limits),
            None => Forecast::for_changes(affected, &limits),
        };
        match forecast {
            None if changed.iter().all(|repaint| !meets(&repaint.area, field)) => {
                PricerState::Known(Price::Nothing(NoChange::OutsideField))
            }
            None => PricerState::Known(Price::Nothing(why_nothing(question, &paint, follower))),
            Some(forecast) => PricerState::Counting(Box::new(StrokeCount { forecast, paint })),
        }
    }

    fn count_more(
        &mut self,
        mut counting: Box<StrokeCount>,
        question: StrokeQuestion,
        follower: &Follower,
        budget: usize,
    ) -> PricerState {
        let StrokeCount { forecast, paint } = &mut *counting;
        let domain = follower.domain();
        let (field, known) = self.answers.planned.field(follower.field());
        let criterion = RefinementCriterion::by_area(domain, field, paint);
        let is_in_domain = |corners, _| !domain.excludes_at(corners);
        let fewest = questions_per_thread(budget, field);
        let progress =
            forecast.advance(follower.mesh(), &criterion.shared_with(known, fewest), is_in_domain, budget);
        let price = match price_of(progress, forecast) {
            None => return PricerState::Counting(counting),
            Some(Price::Change(0)) if forecast.added() == 0 && forecast.removed() == 0 => {
                Price::Nothing(why_nothing(question, paint, follower))
            }
            Some(price) => price,
        };
        self.counted = Some(counting.forecast);
        PricerState::Known(price)
    }

    fn make_more(
        &mut self,
        mut making: Box<RebuildPrice>,
        question: StrokeQuestion,
        follower: &Follower,
        budget: usize,
    ) -> PricerState {
        match making.advance(budget) {
            Err(price) => return PricerState::Known(price),
            Ok(Progress::More) => return PricerState::Making(making),
            Ok(Progress::Done) => {}
        }
        let (after, paint) = making.finish();
        let price = price_between(follower.mesh(), &after, || why_nothing(question, &paint, follower));
        self.spare = Some(after);
        PricerState::Known(price)
    }
}

fn begin(StrokeQuestion { plan, layer, .. }: StrokeQuestion, document: &Document) -> PricerState {
    let settings = document.settings();
    let (h_max, bounds) = (settings.transfer.h_max, settings.domain.bounds);
    let blank;
    let raster = match document.paint().get(layer) {
        Some(raster) => raster,
        None => {
            blank = settings.blank_raster(layer);
            &blank
        }
    };
    PricerState::Painting(Box::new(Preview::new(&plan, h_max, bounds, raster)))
}

/// Returns whether a rectangle in world units has a point of the lattice of a field.
fn meets(area: &Rect, field: &SizeField) -> bool {
    area.intersection(&field.lattice().bounds()).is_some()
}

/// Returns the price after a slice of a forecast; `None` while counting goes on.
pub(super) fn price_of<E>(progress: Result<Progress, E>, forecast: &Forecast) -> Option<Price> {
    let [added, removed] = [forecast.added(), forecast.removed()];
    match progress {
        Err(_) => Some(Price::TooFine),
        Ok(Progress::Done) => Some(Price::Change(forecast.change())),
        Ok(Progress::More) if added.max(removed) <= Price::MOST => None,
        Ok(Progress::More) if removed == 0 => Some(Price::MoreThan(Price::MOST as i64)),
        Ok(Progress::More) if added == 0 => Some(Price::MoreThan(-(Price::MOST as i64))),
        Ok(Progress::More) => Some(Price::Many),
    }
}

/// Returns why a stroke that changes pixels changes no triangle, judged where it ends.
fn why_nothing(question: StrokeQuestion, paint: &PaintLayers, follower: &Follower) -> NoChange {
    // h̄ says nothing about errors.
    if let Medium::Error(_) = question.plan.brush.medium {
        return NoChange::TrianglesFit;
    }
    let decision = follower.field().decision_at(paint, question.plan.to);
    if decision.target >= follower.field().longest() {
        return NoChange::CoarserThanGrid;
    }
    match decision.layer {
        Some(layer) if layer != question.layer => NoChange::LayerDecides(layer),
        _ => NoChange::TrianglesFit,
    }
}
