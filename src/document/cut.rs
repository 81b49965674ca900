//! Another outline for the shown mesh, on its way there.

use crate::domain::{BoundaryTreatment, DomainLaying, DomainOnLattice, RegionComparison};
use crate::field::RefinementRule;
use crate::geometry::{Lattice, LatticeRect};
use crate::mesh::Progress;

use super::Settings;

/// A domain of another outline: compared with that of the shown mesh, and laid on its lattice, in slices. Then the mesh can follow
/// it in place.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    /// The settings with the new domain.
    pub(super) settings: Settings,
    lattice: Lattice,
    comparison: RegionComparison,
    laying: DomainLaying,
}

impl Cut {
    /// Whether a mesh can follow in place from one domain to the other: only where nothing else differs, and where what lies outside
    /// stays in the mesh, marked.
    pub(super) fn is_possible(shown: &Settings, wanted: &Settings) -> bool {
        let fits = matches!(wanted.boundary, BoundaryTreatment::Fitted { .. })
            && wanted.rule == RefinementRule::Area;
        let has_outlines = shown.domain.formula().is_none() && wanted.domain.formula().is_none();
        let otherwise_equal = Settings { domain: wanted.domain.clone(), ..shown.clone() } == *wanted;
        fits && has_outlines && shown.domain.bounds == wanted.domain.bounds && otherwise_equal
    }

    /// Begins to cut, where that is possible.
    pub(super) fn begin(shown: &Settings, wanted: &Settings, lattice: &Lattice) -> Option<Self> {
        let (before, after) = (shown.domain.as_region()?, wanted.domain.as_region()?);
        Some(Self {
            settings: wanted.clone(),
            lattice: *lattice,
            comparison: RegionComparison::new(before, after),
            laying: DomainLaying::new(&wanted.domain, wanted.boundary, lattice),
        })
    }

    /// About so many edges.
    pub(super) fn advance(&mut self, visits: usize) -> Progress {
        match self.comparison.advance(visits) {
            Progress::More => Progress::More,
            Progress::Done => self.laying.advance(visits),
        }
    }

    /// Once done: the domain, laid, and where the mesh may have to change.
    pub(super) fn finished(self) -> (DomainOnLattice, Vec<LatticeRect>) {
        let round = |area| {
            // Corners are moved to the nearest lattice point.
            let rect = self.lattice.rect_around(area)?;
            Some(rect.expanded(1, self.lattice.extent()))
        };
        (self.laying.finished(), self.comparison.areas().iter().filter_map(round).collect())
    }
}
