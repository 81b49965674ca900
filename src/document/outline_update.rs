//! Another outline for the shown mesh, followed in place.

use super::Settings;
use crate::domain::{DomainOnLattice, DomainOnLatticeBuilder, RegionComparison};
use crate::field::RefinementRule;
use crate::geometry::{Lattice, LatticeRect, Rect};
use crate::mesh::Progress;

/// Compares a domain with that of the shown mesh, and indexes it on the lattice of that mesh, in slices. Then
/// the mesh can follow it where the two differ.
#[derive(Clone, Debug)]
pub(super) struct OutlineUpdate {
    /// The settings with the new domain.
    pub(super) settings: Settings,
    lattice: Lattice,
    comparison: RegionComparison,
    index: DomainOnLatticeBuilder,
}

impl OutlineUpdate {
    /// Whether a mesh can follow in place from one domain to the other: only where nothing else differs that
    /// changes the mesh, and where the mesh is fitted, so that triangles outside stay in it, marked.
    pub(super) fn is_possible(shown: &Settings, wanted: &Settings) -> bool {
        let fits = wanted.boundary.diameter().is_some() && wanted.rule == RefinementRule::Area;
        let has_outlines = shown.domain.formula().is_none() && wanted.domain.formula().is_none();
        let (domain, boundary_marks) = (wanted.domain.clone(), wanted.boundary_marks.clone());
        let (pins, paths) = (wanted.pins.clone(), wanted.paths.clone());
        let otherwise_equal = Settings { domain, boundary_marks, pins, paths, ..shown.clone() } == *wanted;
        fits && has_outlines && shown.domain.bounds == wanted.domain.bounds && otherwise_equal
    }

    /// The work from the outline of the shown mesh to the wanted one, where that is possible.
    pub(super) fn new(shown: &Settings, wanted: &Settings, lattice: &Lattice) -> Option<Self> {
        let (before, after) = (shown.domain.as_region()?, wanted.domain.as_region()?);
        Some(Self {
            settings: wanted.clone(),
            lattice: *lattice,
            comparison: RegionComparison::new(before, after),
            index: DomainOnLatticeBuilder::new(&wanted.domain, wanted.boundary, lattice),
        })
    }

    /// One slice of work: about `budget` edges.
    pub(super) fn advance(&mut self, budget: usize) -> Progress {
        match self.comparison.advance(budget) {
            Progress::More => Progress::More,
            Progress::Done => self.index.advance(budget),
        }
    }

    /// Once done: the domain on the lattice, and the rectangles in which the mesh may have to change.
    pub(super) fn finish(self) -> (DomainOnLattice, Vec<LatticeRect>) {
        let on_lattice = |area: &Rect| {
            // Corners are moved to the nearest lattice point: by a step at most.
            let rect = self.lattice.rect_around(area)?;
            Some(rect.expanded(1, self.lattice.extent()))
        };
        (self.index.finish(), self.comparison.areas().iter().filter_map(on_lattice).collect())
    }
}
