//! The arrays at any step of a recording.

use std::sync::Arc;

use super::names::NamedPlace;
use super::recording::{RecordedStep, Recording, ReportRow, RowChange, StepAction};
use super::stages::{StepStage, StepTriangle};
use crate::geometry::LatticePoint;

/// 𝒯, 𝒩 and S_b at a step of a recording. Going back restores exactly the same arrays.
#[derive(Clone, Debug)]
pub struct StepPlayer {
    recording: Arc<Recording>,
    /// How many steps are done.
    position: usize,
    rows: Vec<ReportRow>,
    node_count: usize,
    stack: Vec<u32>,
}

impl StepPlayer {
    /// Returns the coarse grid, before the first step.
    pub fn new(recording: Arc<Recording>) -> Self {
        let (rows, node_count) = (recording.coarse_rows.clone(), recording.coarse_nodes);
        Self { recording, position: 0, rows, node_count, stack: Vec::new() }
    }

    /// Returns the recording that is played.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Returns how many steps are done.
    pub fn position(&self) -> usize {
        self.position
    }

    /// Returns how many steps there are.
    pub fn len(&self) -> usize {
        self.recording.steps.len()
    }

    /// Returns whether there is no step.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the step that was done last.
    pub fn step(&self) -> Option<&RecordedStep> {
        self.position.checked_sub(1).map(|last| &self.recording.steps[last])
    }

    /// Returns the rows that it changed.
    pub fn changes(&self) -> &[RowChange] {
        self.position.checked_sub(1).map_or(&[], |last| self.recording.changes(last))
    }

    /// 𝒯; the first row has number 1.
    pub fn rows(&self) -> &[ReportRow] {
        &self.rows
    }

    /// The nodes in lattice coordinates; the first one has number 1. Those of 𝒩, until stages follow.
    pub fn nodes(&self) -> &[LatticePoint] {
        self.stage().map_or(&self.recording.nodes[..self.node_count], |stage| &stage.nodes)
    }

    /// Returns the stage that was done last; `None` during the refinement.
    pub fn stage(&self) -> Option<&StepStage> {
        let stages = &self.recording.stages;
        let done = (self.position + stages.len()).checked_sub(self.len())?;
        done.checked_sub(1).map(|last| &stages[last])
    }

    /// Returns the triangles as they are drawn: those of 𝒯, until stages follow.
    pub fn triangles(&self) -> impl Iterator<Item = StepTriangle> + '_ {
        let (rows, derived) = match self.stage() {
            None => (self.rows(), &[][..]),
            Some(stage) => (&[][..], &stage.triangles[..]),
        };
        let of_rows = rows.iter().zip(1..).map(|(row, number)| StepTriangle::of_row(number, row));
        of_rows.chain(derived.iter().copied())
    }

    /// Returns how many triangles of each level there are.
    pub fn level_counts(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for triangle in self.triangles() {
            let level = usize::from(triangle.level);
            if counts.len() <= level {
                counts.resize(level + 1, 0);
            }
            counts[level] += 1;
        }
        counts
    }

    /// S_b, the top last.
    pub fn stack(&self) -> &[u32] {
        &self.stack
    }

    /// S_b as text: its triangles, the top last.
    pub fn stack_in_words(&self) -> String {
        let triangles: Vec<String> = self.stack.iter().map(u32::to_string).collect();
        if triangles.is_empty() { "empty".into() } else { triangles.join(", ") }
    }

    /// Returns the vertices of a triangle by its number, in its order.
    ///
    /// # Panics
    /// Panics when there is no such triangle at this step.
    pub fn corners(&self, number: u32) -> [LatticePoint; 3] {
        let [a, b, c, ..] = self.rows[number as usize - 1];
        [a, b, c].map(|node| self.recording.nodes[node as usize - 1])
    }

    /// Returns the corners of what has a name: three of a triangle, one of a node, two of an edge.
    pub fn points_of(&self, place: NamedPlace) -> Vec<LatticePoint> {
        let node = |node: u32| self.nodes()[node as usize - 1];
        match place {
            NamedPlace::Triangle(number) => self.corners(number).to_vec(),
            NamedPlace::Node(number) => vec![node(number)],
            NamedPlace::Boundary(ends) => ends.map(node).to_vec(),
        }
    }

    /// Goes to where `position` steps are done, at most to the end.
    pub fn go_to(&mut self, position: usize) {
        let position = position.min(self.len());
        while self.position < position {
            self.forward();
        }
        while self.position > position {
            self.back();
        }
    }

    fn forward(&mut self) {
        let step = self.recording.steps[self.position];
        match step.action {
            StepAction::Push => self.stack.push(step.triangle),
            StepAction::Pop => _ = self.stack.pop(),
            _ => {}
        }
        self.node_count += usize::from(step.new_node.is_some());
        for change in self.recording.changes(self.position) {
            match change.before {
                Some(_) => self.rows[change.number as usize - 1] = change.after,
                None => self.rows.push(change.after),
            }
        }
        self.position += 1;
    }

    fn back(&mut self) {
        self.position -= 1;
        let step = self.recording.steps[self.position];
        for change in self.recording.changes(self.position).iter().rev() {
            match change.before {
                Some(before) => self.rows[change.number as usize - 1] = before,
                None => _ = self.rows.pop(),
            }
        }
        self.node_count -= usize::from(step.new_node.is_some());
        match step.action {
            StepAction::Push => _ = self.stack.pop(),
            StepAction::Pop => self.stack.push(step.triangle),
            _ => {}
        }
    }
}
