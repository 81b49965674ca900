use std::sync::Arc;

use super::pace::questions_per_thread;
use super::pricer::{Price, price_of};
use super::{Document, Follower, Settings};
use crate::build::RefinementCriterion;
use crate::geometry::Rect;
use crate::layers::{LevelCachePool, SizeField};
use crate::mesh::{Census, Forecast, Mesh, Progress};

/// Counts in slices how another size field on the lattice of a mesh would change the number of triangles, in
/// an area or everywhere: exactly up to [`Price::MOST`].
#[derive(Clone, Debug)]
pub(super) struct FieldPrice {
    field: Arc<SizeField>,
    /// What the field has answered.
    known: LevelCachePool,
    forecast: Forecast,
}

impl FieldPrice {
    /// Returns the work with nothing counted; `None` where the area, in world units, is outside the rectangle
    /// of the domain.
    pub(super) fn new(field: Arc<SizeField>, area: &Rect, follower: &Follower) -> Option<Self> {
        let area = follower.field().lattice().rect_around(area)?;
        let forecast = Forecast::new(area, &follower.settings().limits());
        Some(Self { field, known: LevelCachePool::default(), forecast })
    }

    /// Looks at up to `visits` more triangles. Returns the price once it is known.
    pub(super) fn advance(
        &mut self,
        document: &Document,
        follower: &Follower,
        visits: usize,
    ) -> Option<Price> {
        let domain = follower.domain();
        let criterion = RefinementCriterion::by_area(domain, &self.field, document.paint());
        let is_in_domain = |corners, _| !domain.excludes_at(corners);
        let rule = criterion.shared_with(&self.known, questions_per_thread(visits, &self.field));
        let progress = self.forecast.advance(follower.mesh(), &rule, is_in_domain, visits);
        price_of(progress, &self.forecast)
    }
}

/// Estimates in slices how many triangles the mesh of a document would have with other settings, in a time
/// that does not grow with that number: for what would take too long to count.
///
/// The estimate is within a third of the true number, and mostly within a twentieth.
#[derive(Clone, Debug)]
pub struct CountEstimate {
    field: Arc<SizeField>,
    census: Census,
    settings: Settings,
}

impl CountEstimate {
    /// Creates an estimate for settings, with nothing counted; `None` where they have another coarse grid
    /// than the mesh of the follower.
    pub fn new(settings: &Settings, follower: &Follower) -> Option<Self> {
        let lattice = follower.field().lattice();
        let has_same_grid = settings.lattice().is_ok_and(|wanted| wanted == *lattice)
            && settings.domain == follower.settings().domain
            && settings.boundary == follower.settings().boundary;
        has_same_grid.then(|| {
            let field = follower.field().with_spec(settings.field_spec());
            Self::of_field(Arc::new(field), settings, follower.mesh())
        })
    }

    /// Creates an estimate for the size field of some settings.
    pub(super) fn of_field(field: Arc<SizeField>, settings: &Settings, mesh: &Mesh) -> Self {
        let census = Census::new(mesh, &settings.limits());
        Self { field, census, settings: settings.clone() }
    }

    /// Looks at up to `visits` more triangles. The coarse grid of the follower must be that of
    /// [`Self::new`].
    pub fn advance(&mut self, document: &Document, follower: &Follower, visits: usize) -> Progress {
        let (domain, rule) = (follower.domain(), self.settings.rule);
        let criterion = RefinementCriterion::new(domain, &self.field, rule, Some(document.paint()));
        let exceeds = |corners, level| criterion.asks_to_bisect(corners, level);
        let is_in_domain = |corners, _| !domain.excludes_at(corners);
        self.census.advance(follower.mesh(), exceeds, is_in_domain, visits)
    }

    /// Returns about how many triangles the domain would have, once done.
    pub fn triangles(&self) -> u64 {
        self.census.triangles().round() as u64
    }
}
