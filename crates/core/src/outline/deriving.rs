//! Derives a mesh in slices.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::band::Band;
use super::changes::{FittedBand, OutlineChanges};
use super::corners::TurningCorners;
use super::derived_follower::IslandMaking;
use super::fitting::Fitting;
use super::follower_making::FollowerMaking;
use super::islands::DerivedIslands;
use super::lengths::SharedTargets;
use super::line::OutlineOnLattice;
use super::{DerivedFollower, DerivedMesh, OutlineFollower};
use crate::domain::{DomainOnLattice, RegionOnLattice};
use crate::mesh::{Cleaning, Mesh, MeshPatch, Progress};

/// Number of triangles that a follower takes in per step.
const AT_ONCE: usize = 4096;

/// The work of [`DerivedMesh::new`], and of a [`DerivedFollower`] where that is asked for: both from one
/// derivation.
pub struct MeshDerivation {
    mesh: Arc<Mesh>,
    domain: DomainOnLattice,
    targets: Option<SharedTargets>,
    cleaning: Cleaning,
    follows: bool,
    step: DerivationStep,
    derived: Option<DerivedMesh>,
    islands: DerivedIslands,
    follower: Option<DerivedFollower>,
}

/// The corners of an outline, and the band on it.
type FittedOutline = (Arc<TurningCorners>, Box<FittedBand>);

enum DerivationStep {
    Begin,
    Band(Arc<TurningCorners>),
    Fit(Arc<TurningCorners>, Box<Fitting>),
    Change(Arc<TurningCorners>, Box<FittedBand>),
    Measure(Arc<TurningCorners>, Box<FittedBand>, MeshPatch),
    Clean(Option<OutlineChanges>, Option<FittedOutline>),
    Follow(Arc<TurningCorners>, Box<FittedBand>, Option<Box<FollowerMaking>>),
    Islands(Box<IslandMaking>),
    Done,
}

impl MeshDerivation {
    /// Begins to derive a mesh; `follows` asks for what keeps it in step with the mesh, where that is
    /// possible ([`DerivedFollower::can_follow`]).
    pub fn new(
        mesh: Arc<Mesh>,
        domain: DomainOnLattice,
        targets: Option<SharedTargets>,
        cleaning: Cleaning,
        follows: bool,
    ) -> Self {
        let (step, islands) = (DerivationStep::Begin, DerivedIslands::default());
        let follows = follows && DerivedFollower::can_follow(&domain);
        Self { mesh, domain, targets, cleaning, follows, step, derived: None, islands, follower: None }
    }

    /// Takes one step, which takes some milliseconds on a long coast.
    pub fn advance(&mut self) -> Progress {
        self.advance_by(AT_ONCE)
    }

    /// Takes one step, in which a follower takes in at most `triangles` triangles, or one island.
    pub fn advance_by(&mut self, triangles: usize) -> Progress {
        self.step = match std::mem::replace(&mut self.step, DerivationStep::Done) {
            DerivationStep::Done => return Progress::Done,
            DerivationStep::Clean(changes, fitted) => self.clean(changes, fitted),
            DerivationStep::Islands(making) => match making.advance(&self.mesh, triangles.max(1)) {
                ControlFlow::Continue(making) => DerivationStep::Islands(Box::new(making)),
                ControlFlow::Break(follower) => {
                    self.follower = Some(follower);
                    DerivationStep::Done
                }
            },
            step => match self.domain.region_on_outline() {
                None => DerivationStep::Clean(None, None),
                Some(region) => match self.fit(region, step, triangles) {
                    ControlFlow::Continue(step) => step,
                    ControlFlow::Break(outline) => {
                        let islands = std::mem::take(&mut self.islands);
                        self.with_islands(Some(outline), islands)
                    }
                },
            },
        };
        if matches!(self.step, DerivationStep::Done) { Progress::Done } else { Progress::More }
    }

    /// Takes a step for the nodes on an outline. Returns what keeps these in step at the end.
    fn fit(
        &self,
        region: &RegionOnLattice,
        step: DerivationStep,
        triangles: usize,
    ) -> ControlFlow<OutlineFollower, DerivationStep> {
        let targets = self.targets.as_ref().map(SharedTargets::targets);
        let lattice = self.mesh.lattice();
        let with = |corners: &Arc<TurningCorners>| {
            OutlineOnLattice::with_corners(lattice, region, targets, corners.clone())
        };
        ControlFlow::Continue(match step {
            DerivationStep::Begin => {
                DerivationStep::Band(OutlineOnLattice::new(lattice, region, targets).corners)
            }
            DerivationStep::Band(corners) => {
                let band = Band::new(&self.mesh, region);
                let zone = vec![true; band.points.len()];
                DerivationStep::Fit(corners, Box::new(Fitting::new(band, zone)))
            }
            DerivationStep::Fit(corners, fitting) => {
                match fitting.advance(&self.mesh, &with(&corners), &mut |_, _| {}) {
                    ControlFlow::Continue(fitting) => DerivationStep::Fit(corners, Box::new(fitting)),
                    ControlFlow::Break(fitted) => DerivationStep::Change(corners, Box::new(fitted)),
                }
            }
            DerivationStep::Change(corners, fitted) => {
                let patch = fitted.patch(&self.mesh, &with(&corners));
                DerivationStep::Measure(corners, fitted, patch)
            }
            DerivationStep::Measure(corners, fitted, patch) => {
                let changes = fitted.with_patch(patch, &with(&corners));
                DerivationStep::Clean(Some(changes), self.follows.then_some((corners, fitted)))
            }
            DerivationStep::Follow(corners, fitted, making) => {
                let outline = with(&corners);
                let begin = || Box::new(FollowerMaking::new(&self.mesh, &self.domain, &outline, &fitted));
                let making = making.unwrap_or_else(begin);
                let making = making.advance(&self.mesh, &outline, &fitted, triangles.max(1))?;
                DerivationStep::Follow(corners, fitted, Some(Box::new(making)))
            }
            step @ (DerivationStep::Clean(..) | DerivationStep::Islands(_) | DerivationStep::Done) => step,
        })
    }

    /// Cleans the mesh with its nodes on the outline, and goes on with what follows them.
    fn clean(&mut self, changes: Option<OutlineChanges>, fitted: Option<FittedOutline>) -> DerivationStep {
        let targets = self.targets.as_ref().map(SharedTargets::targets);
        let (derived, islands) =
            DerivedMesh::cleaned(&self.mesh, &self.domain, changes, targets, &self.cleaning);
        self.derived = Some(derived);
        match fitted {
            Some((corners, fitted)) => {
                self.islands = islands;
                DerivationStep::Follow(corners, fitted, None)
            }
            None if self.follows => self.with_islands(None, islands),
            None => DerivationStep::Done,
        }
    }

    fn with_islands(&self, outline: Option<OutlineFollower>, islands: DerivedIslands) -> DerivationStep {
        DerivationStep::Islands(Box::new(IslandMaking::new(&self.mesh, &self.domain, outline, islands)))
    }

    /// Takes the mesh, once it is derived.
    pub fn take_derived(&mut self) -> Option<DerivedMesh> {
        self.derived.take()
    }

    /// Takes what keeps the mesh in step, once it is known: after the mesh.
    pub fn take_follower(&mut self) -> Option<DerivedFollower> {
        self.follower.take()
    }

    /// Returns the mesh that another one is derived from.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }
}
