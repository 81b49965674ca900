//! The letters by which the lines of an algorithm and the panel name triangles and nodes, at a step.

use super::player::StepPlayer;
use super::recording::{BOUNDARY, RecordedStep, ReportRow, StepAction};
use crate::text::fixed;

/// What has a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedPlace {
    /// A triangle by its number.
    Triangle(u32),
    /// A node by its number.
    Node(u32),
    /// The boundary beside the edge between two nodes, or halves of it.
    Boundary([u32; 2]),
}

/// Names of triangles and nodes, in the order in which they were given.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names(Vec<(NamedPlace, Vec<String>)>);

impl Names {
    /// Gives a triangle or node one more name.
    pub fn add(&mut self, place: NamedPlace, name: impl Into<String>) {
        match self.0.iter_mut().find(|(known, _)| *known == place) {
            Some((_, names)) => names.push(name.into()),
            None => self.0.push((place, vec![name.into()])),
        }
    }

    /// Returns what has names, each with all of them before its number: `i_b = n[2] = 57`.
    pub fn labels(&self) -> impl Iterator<Item = (NamedPlace, String)> + '_ {
        self.0.iter().map(|(place, names)| {
            let number = match *place {
                NamedPlace::Triangle(number) | NamedPlace::Node(number) => f64::from(number),
                NamedPlace::Boundary(_) => f64::from(BOUNDARY),
            };
            (*place, format!("{} = {}", names.join(" = "), fixed(number, 0)))
        })
    }

    fn add_nodes(&mut self, row: &ReportRow, names: [&str; 3]) {
        for (node, name) in row.iter().zip(names) {
            self.add(NamedPlace::Node(*node as u32), name);
        }
    }

    /// Names a triangle that is a neighbour, unless that is the boundary.
    fn add_neighbour(&mut self, number: i32, name: &str) {
        if let Ok(number) = u32::try_from(number) {
            self.add(NamedPlace::Triangle(number), name);
        }
    }
}

impl StepPlayer {
    /// Returns the names that the lines and the data of the last step use.
    pub fn names(&self) -> Names {
        let mut names = Names::default();
        let Some(step) = self.step().filter(|step| step.triangle > 0) else { return names };
        let i = if step.action == StepAction::Pop { "i = j" } else { "i" };
        names.add(NamedPlace::Triangle(step.triangle), i);
        if let Some(across) = step.across {
            names.add(NamedPlace::Triangle(across), "i_b");
        }
        match step.action {
            StepAction::Bisect => self.name_halves(step, &mut names, |names, row, is_across| {
                names.add_nodes(
                    row,
                    if is_across { ["v_b[1]", "v_b[2]", "v_b[3]"] } else { ["v[1]", "v[2]", "v[3]"] },
                );
            }),
            StepAction::UpdateNeighbours(_) => self.name_halves(step, &mut names, |names, row, is_across| {
                let [first, second] = if is_across { ["n_b[1]", "n_b[2]"] } else { ["n[1]", "n[2]"] };
                names.add_neighbour(row[4], first);
                names.add_neighbour(row[5], second);
            }),
            _ => {
                let row = self.rows()[step.triangle as usize - 1];
                names.add_nodes(&row, ["v₁", "v₂", "v₃"]);
                if step.across.is_none() {
                    let end = row[usize::from(step.k)];
                    names.add(NamedPlace::Boundary([row[0], end].map(|node| node as u32)), "i_b");
                }
            }
        }
        if let Some(node) = step.new_node {
            names.add(NamedPlace::Node(node), "N_x");
        }
        names
    }

    /// Names the new halves, and what `of_row` names in the rows of t_i and t_b before the step.
    fn name_halves(
        &self,
        step: &RecordedStep,
        names: &mut Names,
        of_row: impl Fn(&mut Names, &ReportRow, bool),
    ) {
        let last = self.rows().len() as u32;
        match step.across {
            Some(_) => {
                names.add(NamedPlace::Triangle(last - 1), "ī");
                names.add(NamedPlace::Triangle(last), "ī_b");
            }
            None => {
                names.add(NamedPlace::Triangle(last), "ī");
                let ends = [
                    self.rows()[step.triangle as usize - 1][0],
                    self.rows()[last as usize - 1][usize::from(step.k) - 1],
                ];
                names.add(NamedPlace::Boundary(ends.map(|node| node as u32)), "β");
            }
        }
        for (number, is_across) in [(Some(step.triangle), false), (step.across, true)] {
            let change = self.changes().iter().find(|change| Some(change.number) == number);
            if let Some(before) = change.and_then(|change| change.before) {
                of_row(names, &before, is_across);
            }
        }
    }
}
