use super::pricer::{Price, price_of};
use super::{Document, Follower};
use crate::build::RefinementCriterion;
use crate::field::{RefinementRule, Transfer};
use crate::geometry::Rect;
use crate::layers::{SizeField, SizeFieldSpec};
use crate::mesh::{Forecast, Progress};

/// Computes in slices how other limits of h̄, or another curve from risk to diameter, would change the number
/// of triangles, without changing document or mesh.
///
/// By the area rule the answer is exact. Under the vertex rule there is none: every edit rebuilds the mesh.
#[derive(Clone, Debug, Default)]
pub struct TransferPricer {
    question: Option<Question>,
    work: Option<Box<Work>>,
    price: Option<TransferPrice>,
}

/// The effect of other limits of h̄ on the number of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransferPrice {
    /// The change by what is asked for in the area of the question.
    pub here: Price,
    /// The change in the whole domain, this area included.
    pub everywhere: Price,
}

impl TransferPrice {
    /// Returns the change outside the area of the question; `None` where more triangles change than are
    /// counted.
    pub fn elsewhere(self) -> Option<i64> {
        match (self.here, self.everywhere) {
            (Price::Change(here), Price::Change(everywhere)) => Some(everywhere - here),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Question {
    transfer: Transfer,
    area: Rect,
    document: u64,
    mesh: u64,
}

#[derive(Clone, Debug)]
struct Work {
    field: SizeField,
    forecast: Forecast,
    /// The price in the area, once it is known; then the whole domain is counted.
    here: Option<Price>,
}

impl TransferPricer {
    /// Asks for the price of other limits, and how much of it is due to an area in world units; or for none.
    /// Asking the same again keeps the price.
    ///
    /// There is a price only while the follower is in step with its document and no stroke is being painted.
    pub fn ask(&mut self, question: Option<(Transfer, Rect)>, document: &Document, follower: &Follower) {
        let answerable = document.stroke().is_none()
            && document.settings().rule == RefinementRule::Area
            && follower.is_in_step(document);
        let question = question.filter(|_| answerable).map(|(transfer, area)| {
            let (document, mesh) = (document.revision(), follower.revision());
            Question { transfer, area, document, mesh }
        });
        if question != self.question {
            (self.question, self.price) = (question, None);
            self.work = question.and_then(|question| Work::new(question, document, follower));
        }
    }

    /// Returns the price, once known.
    pub fn price(&self) -> Option<TransferPrice> {
        self.price
    }

    /// Whether the price is still being computed.
    pub fn progress(&self) -> Progress {
        if self.work.is_some() { Progress::More } else { Progress::Done }
    }

    /// One slice of work: about `budget` triangles. Document and follower must not have changed since
    /// [`Self::ask`].
    pub fn advance(&mut self, document: &Document, follower: &Follower, budget: usize) -> Progress {
        if let Some(work) = &mut self.work
            && let Some(price) = work.advance(document, follower, budget)
        {
            match work.here {
                None => work.count_everywhere(price, follower),
                Some(here) => {
                    self.price = Some(TransferPrice { here, everywhere: price });
                    self.work = None;
                }
            }
        }
        self.progress()
    }
}

impl Work {
    /// Returns the work with nothing counted; `None` where the area is outside the domain's rectangle.
    fn new(question: Question, document: &Document, follower: &Follower) -> Option<Box<Self>> {
        let lattice = follower.field().lattice();
        let area = lattice.rect_around(&question.area)?;
        let spec = SizeFieldSpec { transfer: question.transfer, ..document.settings().field_spec() };
        let field = SizeField::new(spec, lattice);
        let forecast = Forecast::new(follower.mesh(), area, &follower.settings().limits());
        Some(Box::new(Self { field, forecast, here: None }))
    }

    fn count_everywhere(&mut self, here: Price, follower: &Follower) {
        self.here = Some(here);
        let lattice = follower.field().lattice();
        if let Some(all) = lattice.rect_around(&lattice.bounds()) {
            self.forecast = Forecast::new(follower.mesh(), all, &follower.settings().limits());
        }
    }

    /// Counts more triangles. Returns the price once it is known.
    fn advance(&mut self, document: &Document, follower: &Follower, budget: usize) -> Option<Price> {
        let domain = follower.domain();
        let criterion = RefinementCriterion::by_area(domain, &self.field, document.paint());
        let exceeds = |corners, level| criterion.exceeds_at(corners, level);
        let is_in_domain = |corners, _| !domain.excludes_at(corners);
        let progress = self.forecast.advance(follower.mesh(), exceeds, is_in_domain, budget);
        price_of(progress, &self.forecast)
    }
}
