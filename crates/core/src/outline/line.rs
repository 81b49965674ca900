//! An outline on the lattice of a mesh.

use std::sync::Arc;

use super::angles::Angles;
use super::corners::TurningCorners;
use super::lengths::{EdgeTargets, LengthRule};
use crate::domain::RegionOnLattice;
use crate::geometry::Lattice;

/// An outline, with what all nodes along it ask about.
pub(super) struct OutlineOnLattice<'a> {
    pub(super) region: &'a RegionOnLattice,
    pub(super) lattice: Lattice,
    pub(super) angles: Angles,
    pub(super) corners: Arc<TurningCorners>,
    pub(super) lengths: LengthRule<'a>,
}

impl<'a> OutlineOnLattice<'a> {
    pub(super) fn new(
        lattice: &Lattice,
        region: &'a RegionOnLattice,
        targets: Option<EdgeTargets<'a>>,
    ) -> Self {
        let angles = Angles::new(lattice.step());
        let corners = TurningCorners::new(region, lattice.extent(), &angles);
        Self::with_corners(lattice, region, targets, Arc::new(corners))
    }

    /// [`Self::new`], with the corners of the outline.
    pub(super) fn with_corners(
        lattice: &Lattice,
        region: &'a RegionOnLattice,
        targets: Option<EdgeTargets<'a>>,
        corners: Arc<TurningCorners>,
    ) -> Self {
        let angles = Angles::new(lattice.step());
        Self { region, lattice: *lattice, angles, corners, lengths: LengthRule::new(targets, angles) }
    }
}
