use std::sync::Arc;

use super::field_price::FieldPrice;
use super::pricer::Price;
use super::{CountEstimate, Document, Follower, Settings};
use crate::field::Transfer;
use crate::geometry::Rect;
use crate::layers::SizeField;
use crate::mesh::Progress;

/// Computes in slices how other limits of h̄, or another curve from risk to diameter, would change the number
/// of triangles, without changing document or mesh.
///
/// By the area rule the answer is exact up to [`Price::MOST`] triangles, and an estimate beyond. Under the
/// vertex rule there is none: every edit rebuilds the mesh.
#[derive(Clone, Debug, Default)]
pub struct TransferPricer {
    question: Option<TransferQuestion>,
    work: Option<Box<TransferWork>>,
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
    /// Returns the change outside the area of the question: the same kind of price as that everywhere.
    /// `None` where either is not known.
    pub fn elsewhere(self) -> Option<Price> {
        match (self.here, self.everywhere) {
            (Price::Change(here), Price::Change(everywhere)) => Some(Price::Change(everywhere - here)),
            (Price::Change(here), Price::About(everywhere)) => Some(Price::About(everywhere - here)),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct TransferQuestion {
    transfer: Transfer,
    area: Rect,
    document: u64,
    mesh: u64,
}

#[derive(Clone, Debug)]
struct TransferWork {
    here: FieldPrice,
    price_here: Option<Price>,
    everywhere: SizePrice,
}

impl TransferPricer {
    /// Asks for the price of other limits, and how much of it is due to an area in world units; or for none.
    /// Asking the same again keeps the price.
    ///
    /// There is a price only while the follower is in step with its document and no stroke is being painted.
    pub fn ask(&mut self, question: Option<(Transfer, Rect)>, document: &Document, follower: &Follower) {
        let question = question.filter(|_| is_answerable(document, follower)).map(|(transfer, area)| {
            let (document, mesh) = (document.revision(), follower.revision());
            TransferQuestion { transfer, area, document, mesh }
        });
        if question != self.question {
            (self.question, self.price) = (question, None);
            self.work = question.and_then(|question| TransferWork::new(question, document, follower));
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
            (self.price, self.work) = (Some(price), None);
        }
        self.progress()
    }
}

impl TransferWork {
    /// Returns the work with nothing counted; `None` where the area is outside the domain's rectangle.
    fn new(question: TransferQuestion, document: &Document, follower: &Follower) -> Option<Box<Self>> {
        let settings = Settings { transfer: question.transfer, ..document.settings().clone() };
        let everywhere = SizePrice::new(&settings, follower)?;
        let here = FieldPrice::new(everywhere.field.clone(), &question.area, follower)?;
        Some(Box::new(Self { here, price_here: None, everywhere }))
    }

    /// Counts more triangles. Returns the price once it is known.
    fn advance(&mut self, document: &Document, follower: &Follower, budget: usize) -> Option<TransferPrice> {
        let Some(here) = self.price_here else {
            self.price_here = self.here.advance(document, follower, budget);
            return None;
        };
        let everywhere = self.everywhere.advance(document, follower, budget)?;
        Some(TransferPrice { here, everywhere })
    }
}

/// Computes in slices how other settings of the size would change the number of triangles of a document:
/// limits, gradation or layers, on the same coarse grid.
///
/// Exact up to [`Price::MOST`] triangles, and an estimate beyond.
#[derive(Clone, Debug, Default)]
pub struct SizePricer {
    /// The settings, and the revisions of document and mesh for which the price is valid.
    question: Option<(Settings, [u64; 2])>,
    work: Option<Box<SizePrice>>,
    price: Option<Price>,
}

impl SizePricer {
    /// Asks for the price of other settings, or for none. Asking the same again keeps the price.
    ///
    /// There is a price only while the follower is in step with its document, no stroke is being painted, and
    /// the settings leave the coarse grid as it is. Under the vertex rule there is none.
    pub fn ask(&mut self, settings: Option<&Settings>, document: &Document, follower: &Follower) {
        let settings = settings.filter(|_| is_answerable(document, follower));
        let revisions = [document.revision(), follower.revision()];
        let is_same = match (&self.question, settings) {
            (None, None) => true,
            (Some((asked, of)), Some(settings)) => *of == revisions && asked == settings,
            _ => false,
        };
        if !is_same {
            self.question = settings.map(|settings| (settings.clone(), revisions));
            self.price = None;
            self.work = settings.and_then(|settings| SizePrice::new(settings, follower)).map(Box::new);
        }
    }

    /// Returns the price, once known.
    pub fn price(&self) -> Option<Price> {
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
            (self.price, self.work) = (Some(price), None);
        }
        self.progress()
    }
}

/// The count of a price in the whole domain, and the estimate if that would take too long.
#[derive(Clone, Debug)]
struct SizePrice {
    field: Arc<SizeField>,
    count: FieldPrice,
    estimate: Option<CountEstimate>,
    settings: Settings,
}

impl SizePrice {
    fn new(settings: &Settings, follower: &Follower) -> Option<Self> {
        let lattice = follower.field().lattice();
        if settings.lattice().ok()? != *lattice || settings.domain != follower.settings().domain {
            return None;
        }
        let field = Arc::new(follower.field().with_spec(settings.field_spec()));
        let count = FieldPrice::new(field.clone(), &lattice.bounds(), follower)?;
        Some(Self { field, count, estimate: None, settings: settings.clone() })
    }

    fn advance(&mut self, document: &Document, follower: &Follower, budget: usize) -> Option<Price> {
        let Some(estimate) = &mut self.estimate else {
            let price = self.count.advance(document, follower, budget)?;
            if let Price::MoreThan(_) | Price::Many = price {
                let (field, mesh) = (self.field.clone(), follower.mesh());
                self.estimate = Some(CountEstimate::of_field(field, &self.settings, mesh));
                return None;
            }
            return Some(price);
        };
        if estimate.advance(document, follower, budget) == Progress::More {
            return None;
        }
        Some(Price::About(estimate.triangles() as i64 - follower.mesh().triangle_count() as i64))
    }
}

/// Returns whether prices can be computed: the mesh is that of the document, by the area rule.
fn is_answerable(document: &Document, follower: &Follower) -> bool {
    document.stroke().is_none() && document.settings().is_updated_in_place() && follower.is_in_step(document)
}
