//! Puts the nodes of a band on the outline, one stage after the other.

use std::ops::ControlFlow;

use super::band::{Band, signs};
use super::changes::{FittedBand, moved, patch};
use super::corners::{Pin, pins};
use super::division::Division;
use super::flat::{drop_flat, pinched};
use super::guard::Guard;
use super::line::OutlineOnLattice;
use super::patchwork::Patchwork;
use super::smooth::Smoother;
use super::snap::{Crossings, OutlineSide, snapped};
use super::stages::{DerivationAction, Watch, without_outside};
use super::stencil::NodePlacement;
use crate::geometry::{LatticePoint, NumberSet};
use crate::mesh::{Mesh, MeshPatch};

/// Number of rounds of flips and moves that improve the angles.
const ROUNDS: usize = 8;

/// A band on its way to a [`FittedBand`]. All steps take about the same time, many milliseconds for long
/// coasts.
pub(super) struct Fitting {
    band: Band,
    /// The nodes that are moved, and near which edges are flipped, beginning with the retreat.
    zone: Vec<bool>,
    stage: FittingStage,
}

/// What is done next.
enum FittingStage {
    Snap,
    Place(Placing),
    Pin(NodePlacement),
    Retreat(NodePlacement, Vec<Pin>),
    Divide(NodePlacement, Vec<Pin>),
    /// After this number of steps of [`FittedPieces::improved`].
    Improve(Box<FittedPieces>, usize),
}

/// The pieces of the triangles, with what they were made of.
struct FittedPieces {
    patchwork: Patchwork,
    pins: Vec<Pin>,
    placement: NodePlacement,
}

impl Fitting {
    pub(super) fn new(band: Band, zone: Vec<bool>) -> Self {
        Self { band, zone, stage: FittingStage::Snap }
    }

    /// Takes the next step, and tells `watch` of a stage that it completes.
    pub(super) fn advance(
        self,
        mesh: &Mesh,
        outline: &OutlineOnLattice,
        watch: Watch<'_>,
    ) -> ControlFlow<FittedBand, Self> {
        let Self { band, zone, stage } = self;
        let OutlineOnLattice { region, angles, corners, .. } = outline;
        let as_patch = |patchwork: &Patchwork| patch(mesh, &band, patchwork, angles);
        let with_cuts = |placement: &NodePlacement| as_patch(&Patchwork::new(&band, placement, angles));
        let stage = match stage {
            FittingStage::Snap => {
                watch(DerivationAction::RemoveByCorners, &|| {
                    without_outside(mesh, &signs(mesh, region), Vec::new())
                });
                FittingStage::Place(Placing::new(&band, outline))
            }
            FittingStage::Place(placing) => match placing.advance(&band, outline) {
                ControlFlow::Continue(placing) => FittingStage::Place(placing),
                ControlFlow::Break(placement) => {
                    watch(DerivationAction::MoveToOutline, &|| {
                        let moved = moved(&band, placement.goals.iter());
                        without_outside(mesh, &signs(mesh, region), moved)
                    });
                    watch(DerivationAction::CutEdges, &|| with_cuts(&placement));
                    FittingStage::Pin(placement)
                }
            },
            FittingStage::Pin(mut placement) => {
                let pins = pins(mesh, &band, &placement, corners, angles);
                corners.spread_actions(mesh, &band, &mut placement, angles);
                pins.iter().for_each(|pin| pin.apply(&mut placement));
                watch(DerivationAction::MoveToCorners, &|| with_cuts(&placement));
                FittingStage::Retreat(placement, pins)
            }
            FittingStage::Retreat(mut placement, mut pins) => {
                if retreat(&band, &zone, &mut placement, &mut pins, outline) {
                    watch(DerivationAction::Retreat, &|| with_cuts(&placement));
                    FittingStage::Divide(placement, pins)
                } else {
                    FittingStage::Retreat(placement, pins)
                }
            }
            FittingStage::Divide(placement, pins) => {
                let patchwork = Patchwork::in_zone(&band, &placement, angles, zone.clone());
                FittedPieces { patchwork, pins, placement }.halved(mesh, &band, outline, watch, &as_patch)
            }
            FittingStage::Improve(pieces, step) => match pieces.improved(step, outline, watch, &as_patch) {
                (pieces, Some(step)) => FittingStage::Improve(Box::new(pieces), step),
                (FittedPieces { patchwork, pins, placement }, None) => {
                    return ControlFlow::Break(FittedBand { band, patchwork, pins, placement });
                }
            },
        };
        ControlFlow::Continue(Self { band, zone, stage })
    }
}

impl FittedPieces {
    /// Halves the edges that are too long. Where that fails, nodes retreat, or corners are given up, and the
    /// pieces are to be found again.
    fn halved(
        self,
        mesh: &Mesh,
        band: &Band,
        outline: &OutlineOnLattice,
        watch: Watch<'_>,
        as_patch: &dyn Fn(&Patchwork) -> MeshPatch,
    ) -> FittingStage {
        let Self { mut patchwork, mut pins, mut placement } = self;
        let division = division(mesh, (band, &patchwork), outline, (&mut placement, &mut pins));
        let Some(division) = division else { return FittingStage::Retreat(placement, pins) };
        if !division.is_empty() {
            division.apply(band, &mut patchwork, &outline.angles);
            watch(DerivationAction::HalveEdges, &|| as_patch(&patchwork));
        }
        FittingStage::Improve(Box::new(Self { patchwork, pins, placement }), 0)
    }

    /// Takes a step for better angles: flips and moves in turn, and at last a pull to the outline. Returns
    /// the number of the next one.
    fn improved(
        mut self,
        step: usize,
        outline: &OutlineOnLattice,
        watch: Watch<'_>,
        as_patch: &dyn Fn(&Patchwork) -> MeshPatch,
    ) -> (Self, Option<usize>) {
        let OutlineOnLattice { region, lattice, angles, lengths, .. } = outline;
        let smoother = Smoother { region, angles, lengths, extent: lattice.extent() };
        let action = match step {
            step if step == 2 * ROUNDS => {
                smoother.pull(&mut self.patchwork);
                DerivationAction::PullToOutline
            }
            step if step % 2 == 0 => {
                self.patchwork.flip_edges(outline);
                DerivationAction::FlipEdges
            }
            _ => {
                smoother.smooth(&mut self.patchwork);
                DerivationAction::ShiftNodes
            }
        };
        watch(action, &|| as_patch(&self.patchwork));
        let next = (step < 2 * ROUNDS).then_some(step + 1);
        (self, next)
    }
}

/// Moves nodes onto the outline, all at once. Nodes at which the domain would touch itself stay.
struct Placing {
    crossings: Crossings,
    sides: Vec<OutlineSide>,
    goals: Vec<LatticePoint>,
    acted: Vec<bool>,
}

impl Placing {
    fn new(band: &Band, OutlineOnLattice { region, lattice, angles, .. }: &OutlineOnLattice) -> Self {
        let crossings = Crossings::new(band, region, lattice);
        let (sides, goals) = snapped(band, &crossings, angles);
        Self { crossings, sides, goals, acted: vec![false; band.points.len()] }
    }

    /// Moves the nodes, or finds out which of them must stay.
    fn advance(
        self,
        band: &Band,
        OutlineOnLattice { angles, .. }: &OutlineOnLattice,
    ) -> ControlFlow<NodePlacement, Self> {
        let Self { crossings, mut sides, mut goals, mut acted } = self;
        let mut placement = NodePlacement::new(band, &crossings, sides.clone(), goals.clone());
        drop_flat(band, &mut placement, angles, angles.limit());
        acted.iter_mut().zip(&placement.acted).for_each(|(all, now)| *all |= now);
        let pinched = pinched(band, &placement);
        if pinched.is_empty() {
            placement.acted[..acted.len()].copy_from_slice(&acted);
            return ControlFlow::Break(placement);
        }
        for v in pinched {
            let v = v as usize;
            (sides[v], goals[v], acted[v]) = (OutlineSide::from_inside(band.inside[v]), band.points[v], true);
        }
        ControlFlow::Continue(Self { crossings, sides, goals, acted })
    }
}

/// Lets nodes retreat where angles are too small. Corners with their nodes, the `pins`, where retreats do not
/// help are given up. Returns whether there were none; otherwise it must be called again.
fn retreat(
    band: &Band,
    zone: &[bool],
    placement: &mut NodePlacement,
    pins: &mut Vec<Pin>,
    OutlineOnLattice { angles, .. }: &OutlineOnLattice,
) -> bool {
    let pin_limits = pins.iter().map(|pin| (pin.node, pin.limit)).collect();
    let stuck = Guard { band, zone, angles, limit: angles.limit(), pin_limits }.run(placement);
    if stuck.is_empty() {
        return true;
    }
    give_up(&stuck, placement, pins);
    false
}

/// Gives up corners with their nodes, and begins the retreat from the start.
fn give_up(stuck: &[u32], placement: &mut NodePlacement, pins: &mut Vec<Pin>) {
    let is_stuck = |pin: &Pin| stuck.contains(&pin.node);
    pins.iter().filter(|pin| is_stuck(pin)).for_each(|pin| pin.undo(placement));
    pins.retain(|pin| !is_stuck(pin));
    placement.advance_all();
}

/// Returns the division of edges that are too long. Where it would fail, nodes retreat, or corners are given
/// up; then it returns `None`, and the pieces are to be found again.
fn division(
    mesh: &Mesh,
    (band, patchwork): (&Band, &Patchwork),
    outline: &OutlineOnLattice,
    (placement, pins): (&mut NodePlacement, &mut Vec<Pin>),
) -> Option<Division> {
    let mut excused = NumberSet::default();
    loop {
        let division = Division::new(mesh, (band, placement), patchwork, outline, &excused);
        let failing = division.failing(patchwork, outline, pins);
        let (mut back, mut stuck) = (Vec::new(), Vec::new());
        for pieces in &failing {
            let nodes = pieces.iter().flat_map(|&t| patchwork.triangles.corners[t as usize]);
            let can: Vec<u32> = nodes.clone().filter(|&v| placement.can_retreat(v)).collect();
            let pinned = nodes.filter(|v| pins.binary_search_by_key(v, |pin| pin.node).is_ok());
            let pinned: Vec<u32> = pinned.filter(|_| can.is_empty()).collect();
            if can.is_empty() && pinned.is_empty() {
                excused.extend(pieces);
            }
            back.extend(can);
            stuck.extend(pinned);
        }
        if !back.is_empty() {
            back.sort_unstable();
            back.dedup();
            back.into_iter().for_each(|v| placement.retreat(v));
            return None;
        }
        if !stuck.is_empty() {
            give_up(&stuck, placement, pins);
            return None;
        }
        if failing.is_empty() {
            return Some(division);
        }
    }
}
