//! What follows the refinement: triangles outside the domain are removed, and nodes move onto its outline.
//!
//! The rows of 𝒯 stay as Algorithm 12 leaves them. Triangles keep their numbers; the pieces of one that is
//! cut have its number, and nodes in cut edges follow those of 𝒩.

use std::collections::HashSet;
use std::ops::Range;

use super::pseudo_code::Algorithm;
use super::recording::{ReportRow, report_row};
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, MeshPatch, NodeId};
use crate::outline::{DerivationAction, DerivationStage};
use crate::text::Grouped;

/// A triangle as it is drawn at a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepTriangle {
    /// Its number, or that of the triangle that it is a piece of.
    pub number: u32,
    /// The numbers of its nodes.
    pub nodes: [u32; 3],
    /// The level of the triangle with that number.
    pub level: u8,
}

impl StepTriangle {
    /// Returns the triangle of a row of 𝒯.
    pub(super) fn of_row(number: u32, row: &ReportRow) -> Self {
        Self { number, nodes: [row[0], row[1], row[2]].map(|node| node as u32), level: row[7] as u8 }
    }

    /// Returns its nodes whatever comes first.
    fn sorted_nodes(&self) -> [u32; 3] {
        let mut nodes = self.nodes;
        nodes.sort_unstable();
        nodes
    }

    /// Returns the positions of its nodes.
    pub fn corners(&self, nodes: &[LatticePoint]) -> [LatticePoint; 3] {
        self.nodes.map(|node| nodes[node as usize - 1])
    }
}

/// What a stage does, and to how much.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageChange {
    /// What it does.
    pub action: DerivationAction,
    /// Triangles of which nothing is left.
    pub removed: u32,
    /// Triangles with other nodes than before.
    pub changed: u32,
    /// Nodes that are elsewhere.
    pub moved: u32,
    /// Nodes in cut edges.
    pub added: u32,
}

/// The mesh after a stage, and what is different from before.
#[derive(Clone, Debug)]
pub struct StepStage {
    /// What the stage does.
    pub change: StageChange,
    /// The nodes; the first one has number 1.
    pub nodes: Vec<LatticePoint>,
    /// The triangles, in the order of their numbers.
    pub triangles: Vec<StepTriangle>,
    /// The triangles with other nodes than before.
    pub changed: Vec<StepTriangle>,
    /// The numbers and corners of triangles of which nothing is left.
    pub removed: Vec<(u32, [LatticePoint; 3])>,
    /// The numbers of nodes that are elsewhere, with their former positions.
    pub moved: Vec<(u32, LatticePoint)>,
}

impl StepStage {
    /// Returns the stages of a mesh, each compared with the one before.
    pub(super) fn all(mesh: &Mesh, stages: Vec<DerivationStage>) -> Vec<Self> {
        let rows = mesh.raw_triangles().iter().map(report_row).zip(1..);
        let mut triangles: Vec<_> = rows.map(|(row, number)| StepTriangle::of_row(number, &row)).collect();
        let mut nodes = mesh.raw_nodes().to_vec();
        let mut found: Vec<Self> = Vec::new();
        for DerivationStage { action, patch } in stages {
            let stage = Self::compared(action, patched(mesh, &patch), (&nodes, &triangles));
            (nodes, triangles) = (stage.nodes.clone(), stage.triangles.clone());
            found.push(stage);
        }
        found
    }

    fn compared(
        action: DerivationAction,
        (nodes, triangles): (Vec<LatticePoint>, Vec<StepTriangle>),
        (former_nodes, former): (&[LatticePoint], &[StepTriangle]),
    ) -> Self {
        let key = |one: &StepTriangle| (one.number, one.sorted_nodes());
        let known: HashSet<_> = former.iter().map(key).collect();
        let left: HashSet<u32> = triangles.iter().map(|one| one.number).collect();
        let changed: Vec<_> = triangles.iter().filter(|one| !known.contains(&key(one))).copied().collect();
        let gone = former.iter().filter(|one| !left.contains(&one.number));
        let removed: Vec<_> = gone.map(|one| (one.number, one.corners(former_nodes))).collect();
        let both = former_nodes.iter().zip(&nodes).zip(1..);
        let moved: Vec<_> =
            both.filter(|((old, new), _)| old != new).map(|((old, _), number)| (number, *old)).collect();
        let change = StageChange {
            action,
            removed: removed.len() as u32,
            changed: changed.len() as u32,
            moved: moved.len() as u32,
            added: nodes.len().saturating_sub(former_nodes.len()) as u32,
        };
        Self { change, nodes, triangles, changed, removed, moved }
    }
}

/// Returns the nodes and triangles of a mesh with a patch.
fn patched(mesh: &Mesh, patch: &MeshPatch) -> (Vec<LatticePoint>, Vec<StepTriangle>) {
    let mut nodes: Vec<_> = mesh.raw_nodes().iter().chain(&patch.added).copied().collect();
    patch.moved.iter().for_each(|&(id, point)| nodes[id.index()] = point);
    let mut changed = patch.changed.iter().peekable();
    let mut triangles = Vec::with_capacity(mesh.raw_triangle_count());
    let numbers = |corners: [NodeId; 3]| corners.map(|node| node.index() as u32 + 1);
    for (index, triangle) in mesh.raw_triangles().iter().enumerate() {
        let number = index as u32 + 1;
        let of_nodes = |nodes| StepTriangle { number, nodes: numbers(nodes), level: triangle.level() as u8 };
        match changed.next_if(|(id, _)| id.index() == index) {
            Some((_, pieces)) => {
                triangles.extend(patch.pieces[pieces.clone()].iter().map(|piece| of_nodes(piece.corners)));
            }
            None => triangles.extend((!triangle.is_outside()).then(|| of_nodes(triangle.vertices))),
        }
    }
    (nodes, triangles)
}

impl StageChange {
    /// Returns the algorithm that the stage belongs to, and which of its lines it runs.
    pub(super) fn lines(self) -> (Algorithm, Range<usize>) {
        use Algorithm::{FitToOutline, KeepByCentroid};
        match self.action {
            DerivationAction::RemoveByCentroid => (KeepByCentroid, 1..3),
            DerivationAction::RemoveByCorners => (FitToOutline, 1..3),
            DerivationAction::MoveToOutline => (FitToOutline, 3..5),
            DerivationAction::CutEdges => (FitToOutline, 5..7),
            DerivationAction::MoveToCorners => (FitToOutline, 7..8),
            DerivationAction::Retreat => (FitToOutline, 8..10),
            DerivationAction::HalveEdges => (FitToOutline, 10..11),
            DerivationAction::FlipEdges => (FitToOutline, 12..13),
            DerivationAction::ShiftNodes => (FitToOutline, 13..14),
            DerivationAction::PullToOutline => (FitToOutline, 14..15),
            DerivationAction::Clean => (Algorithm::Clean, 1..4),
        }
    }

    /// Says what the stage does, to how much, and why.
    pub(super) fn sentence(self) -> String {
        let removed = counted(self.removed, "triangle");
        let moved = counted(self.moved, "node");
        match self.action {
            DerivationAction::RemoveByCentroid => {
                format!(
                    "A triangle belongs to the mesh if its centroid lies in the domain: {removed} removed."
                )
            }
            DerivationAction::RemoveByCorners => {
                format!("{removed} removed: no corner of theirs lies in the domain.")
            }
            DerivationAction::MoveToOutline => format!(
                "{moved} moved onto the outline, which crosses an edge nearer to this end than to the other one."
            ),
            DerivationAction::CutEdges => format!(
                "Edges that the outline still crosses are cut, at {} more, and what lies outside is removed: {removed} as a whole.",
                counted(self.added, "node")
            ),
            DerivationAction::MoveToCorners => {
                format!("{moved} moved to sharp corners of the outline, so that the mesh has these corners.")
            }
            DerivationAction::Retreat => {
                format!(
                    "{moved} moved back towards the former place, where an angle was too small or an edge too long."
                )
            }
            DerivationAction::HalveEdges => format!(
                "Edges that moves made longer than their target are halved, at {} more.",
                counted(self.added, "node")
            ),
            DerivationAction::FlipEdges => format!(
                "Edges between {} flipped: the smallest angle of each pair becomes larger.",
                counted(self.changed, "triangle")
            ),
            DerivationAction::ShiftNodes => format!(
                "{moved} shifted, on the boundary along the outline: the smallest angle around each becomes larger."
            ),
            DerivationAction::PullToOutline => {
                format!("{moved} of the boundary moved onto the outline, as far as the angles allow it.")
            }
            DerivationAction::Clean => format!(
                "{removed} removed: parts that the document does not keep, and where the domain touches itself in a node."
            ),
        }
    }
}

/// Returns a number of things.
fn counted(count: u32, thing: &str) -> String {
    format!("{} {thing}{}", Grouped(count as usize), if count == 1 { "" } else { "s" })
}
