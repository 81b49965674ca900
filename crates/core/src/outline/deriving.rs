//! Derives a mesh in slices.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::band::Band;
use super::changes::{FittedBand, OutlineChanges};
use super::corners::TurningCorners;
use super::fitting::Fitting;
use super::follower_making::FollowerMaking;
use super::lengths::SharedTargets;
use super::line::OutlineOnLattice;
use super::{DerivedMesh, OutlineFollower};
use crate::domain::DomainOnLattice;
use crate::mesh::{Cleaning, Mesh, MeshPatch, Progress};

/// Number of triangles that a follower takes in per step.
const AT_ONCE: usize = 4096;

/// The work of [`DerivedMesh::new`], and of [`OutlineFollower::new`] where that is asked for: both from one
/// derivation.
pub struct MeshDerivation {
    mesh: Arc<Mesh>,
    domain: DomainOnLattice,
    targets: Option<SharedTargets>,
    cleaning: Cleaning,
    follows: bool,
    step: DerivationStep,
    derived: Option<DerivedMesh>,
    follower: Option<OutlineFollower>,
}

enum DerivationStep {
    Begin,
    Band(Arc<TurningCorners>),
    Fit(Arc<TurningCorners>, Box<Fitting>),
    Change(Arc<TurningCorners>, Box<FittedBand>),
    Measure(Arc<TurningCorners>, Box<FittedBand>, MeshPatch),
    Clean(Option<OutlineChanges>, Option<(Arc<TurningCorners>, Box<FittedBand>)>),
    Follow(Arc<TurningCorners>, Box<FittedBand>, Option<Box<FollowerMaking>>),
    Done,
}

impl MeshDerivation {
    /// Begins to derive a mesh; `follows` asks for its nodes on the outline, to be kept in step with the
    /// mesh.
    pub fn new(
        mesh: Arc<Mesh>,
        domain: DomainOnLattice,
        targets: Option<SharedTargets>,
        cleaning: Cleaning,
        follows: bool,
    ) -> Self {
        let step = DerivationStep::Begin;
        Self { mesh, domain, targets, cleaning, follows, step, derived: None, follower: None }
    }

    /// Takes one step, which takes some milliseconds on a long coast.
    pub fn advance(&mut self) -> Progress {
        self.advance_by(AT_ONCE)
    }

    /// Takes one step, in which a follower takes in at most `triangles` triangles.
    pub fn advance_by(&mut self, triangles: usize) -> Progress {
        let targets = self.targets.as_ref().map(SharedTargets::targets);
        let lattice = self.mesh.lattice();
        self.step = match (
            std::mem::replace(&mut self.step, DerivationStep::Done),
            self.domain.region_on_outline(),
        ) {
            (DerivationStep::Done, _) => return Progress::Done,
            (DerivationStep::Clean(changes, fitted), _) => {
                let derived =
                    DerivedMesh::cleaned(&self.mesh, &self.domain, changes, targets, &self.cleaning);
                self.derived = Some(derived);
                fitted.map_or(DerivationStep::Done, |(corners, fitted)| {
                    DerivationStep::Follow(corners, fitted, None)
                })
            }
            (_, None) => DerivationStep::Clean(None, None),
            (DerivationStep::Begin, Some(region)) => {
                DerivationStep::Band(OutlineOnLattice::new(lattice, region, targets).corners)
            }
            (DerivationStep::Band(corners), Some(region)) => {
                let band = Band::new(&self.mesh, region);
                let zone = vec![true; band.points.len()];
                DerivationStep::Fit(corners, Box::new(Fitting::new(band, zone)))
            }
            (DerivationStep::Fit(corners, fitting), Some(region)) => {
                let outline = OutlineOnLattice::with_corners(lattice, region, targets, corners.clone());
                match fitting.advance(&self.mesh, &outline, &mut |_, _| {}) {
                    ControlFlow::Continue(fitting) => DerivationStep::Fit(corners, Box::new(fitting)),
                    ControlFlow::Break(fitted) => DerivationStep::Change(corners, Box::new(fitted)),
                }
            }
            (DerivationStep::Change(corners, fitted), Some(region)) => {
                let outline = OutlineOnLattice::with_corners(lattice, region, targets, corners.clone());
                let patch = fitted.patch(&self.mesh, &outline);
                DerivationStep::Measure(corners, fitted, patch)
            }
            (DerivationStep::Measure(corners, fitted, patch), Some(region)) => {
                let outline = OutlineOnLattice::with_corners(lattice, region, targets, corners.clone());
                let changes = fitted.with_patch(patch, &outline);
                DerivationStep::Clean(Some(changes), self.follows.then_some((corners, fitted)))
            }
            (DerivationStep::Follow(corners, fitted, making), Some(region)) => {
                let outline = OutlineOnLattice::with_corners(lattice, region, targets, corners.clone());
                let begin = || Box::new(FollowerMaking::new(&self.mesh, &self.domain, &outline, &fitted));
                match making.unwrap_or_else(begin).advance(&self.mesh, &outline, &fitted, triangles.max(1)) {
                    ControlFlow::Continue(making) => {
                        DerivationStep::Follow(corners, fitted, Some(Box::new(making)))
                    }
                    ControlFlow::Break(follower) => {
                        self.follower = Some(follower);
                        DerivationStep::Done
                    }
                }
            }
        };
        if matches!(self.step, DerivationStep::Done) { Progress::Done } else { Progress::More }
    }

    /// Takes the mesh, once it is derived.
    pub fn take_derived(&mut self) -> Option<DerivedMesh> {
        self.derived.take()
    }

    /// Takes the nodes on the outline, once they are known: after the mesh.
    pub fn take_follower(&mut self) -> Option<OutlineFollower> {
        self.follower.take()
    }

    /// Returns the mesh that another one is derived from.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }
}
