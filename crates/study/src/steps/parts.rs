//! The roles of the triangles of a mesh in a step.

use super::player::StepPlayer;
use super::recording::StepAction;

/// The role of a triangle in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepPart {
    /// The triangle waits on the stack.
    Waiting,
    /// The triangle's row was changed, because its neighbour was bisected.
    Relinked,
    /// The triangle is the bisection neighbour, or a half of it.
    Across,
    /// The triangle is the one of the step, or a half of it.
    Current,
}

impl StepPlayer {
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
