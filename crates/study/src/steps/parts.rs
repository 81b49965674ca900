//! The roles of the triangles of a mesh in a step.

use super::player::StepPlayer;
use super::recording::StepAction;
use super::stages::StepTriangle;
use crate::geometry::LatticePoint;

/// The role of a triangle in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepPart {
    /// Nothing is left of the triangle.
    Removed,
    /// The triangle waits on the stack.
    Waiting,
    /// The triangle's row was changed, because its neighbour was bisected.
    Relinked,
    /// The triangle is the bisection neighbour, or a half of it.
    Across,
    /// The triangle is the one of the step, or a half of it.
    Current,
}

/// A triangle with its role in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marked {
    /// Its number.
    pub number: u32,
    /// Where its nodes are, or were before it was removed.
    pub corners: [LatticePoint; 3],
    /// Its role.
    pub part: StepPart,
}

impl StepPlayer {
    /// Returns the triangles that the last step was about, with their corners. What matters most comes last.
    pub fn marked(&self) -> Vec<Marked> {
        let Some(stage) = self.stage() else {
            let of_part = |(number, part)| Marked { number, corners: self.corners(number), part };
            return self.parts().into_iter().map(of_part).collect();
        };
        let removed = stage.removed.iter().map(|&(number, corners)| (number, corners, StepPart::Removed));
        let of_changed = |one: &StepTriangle| (one.number, one.corners(&stage.nodes), StepPart::Current);
        let all = removed.chain(stage.changed.iter().map(of_changed));
        all.map(|(number, corners, part)| Marked { number, corners, part }).collect()
    }

    /// Returns where the nodes that the last step moved were and are, as lattice points.
    pub fn moves(&self) -> impl Iterator<Item = [LatticePoint; 2]> + '_ {
        let stage = self.stage();
        let moved = stage.into_iter().flat_map(|stage| stage.moved.iter().map(move |one| (stage, one)));
        moved.map(|(stage, &(number, from))| [from, stage.nodes[number as usize - 1]])
    }

    /// Returns the triangles that the last step was about, by number. What matters most comes last.
    pub fn parts(&self) -> Vec<(u32, StepPart)> {
        let mut parts: Vec<_> = self.stack().iter().map(|&number| (number, StepPart::Waiting)).collect();
        let Some(step) = self.step().filter(|step| step.triangle > 0) else { return parts };
        if let StepAction::UpdateNeighbours(_) = step.action {
            parts.extend(self.changes().iter().map(|change| (change.number, StepPart::Relinked)));
        }
        if let StepAction::Bisect | StepAction::UpdateNeighbours(_) = step.action {
            let last = self.rows().len() as u32;
            match step.across {
                Some(_) => parts.extend([(last, StepPart::Across), (last - 1, StepPart::Current)]),
                None => parts.push((last, StepPart::Current)),
            }
        }
        parts.extend(step.across.map(|across| (across, StepPart::Across)));
        parts.push((step.triangle, StepPart::Current));
        let numbers: Vec<u32> = parts.iter().map(|(number, _)| *number).collect();
        let mut place = 0;
        parts.retain(|(number, _)| {
            place += 1;
            !numbers[place..].contains(number)
        });
        parts
    }
}
