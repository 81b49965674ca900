//! Histograms and extremes of all triangles and nodes.

use glam::DVec2;
use rayon::prelude::*;

use super::bins::Classes;
use super::links::{MeasuredLinks, number_of};
use super::{QualityBin, QualityMeasure, TriangleMeasures};
use crate::layers::LevelCache;
use crate::mesh::NodeId;

/// Triangles that a thread takes at a time, with a cache of its own: the numbers do not depend on threads.
const GRAIN: usize = 4096;
/// Triangles of a step.
const STEP: usize = 64 * GRAIN;

/// A number, and where it was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPlace {
    /// The number.
    pub value: f64,
    /// The middle of the triangle, or the node, in world units.
    pub at: DVec2,
    /// The middle of the triangle, or of one at the node, in world units.
    pub inside: DVec2,
    /// The diameter of that triangle in the plane, in world units.
    pub size: f64,
}

/// The histogram of a measure, and its extremes.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureSummary {
    /// What was measured.
    pub measure: QualityMeasure,
    /// The classes in ascending order.
    pub bins: Vec<QualityBin>,
    /// The least number; of equal ones the first.
    pub least: MeasuredPlace,
    /// The greatest number; of equal ones the first.
    pub greatest: MeasuredPlace,
}

impl MeasureSummary {
    /// Returns the worst number.
    pub fn worst(&self) -> &MeasuredPlace {
        if self.measure.is_worse_when_smaller() { &self.least } else { &self.greatest }
    }

    /// Returns the classes from the first to the last one that has any triangle or node.
    pub fn bins_in_use(&self) -> &[QualityBin] {
        let is_used = |bin: &QualityBin| bin.count > 0;
        let first = self.bins.iter().position(is_used).unwrap_or(0);
        let last = self.bins.iter().rposition(is_used).unwrap_or(0);
        &self.bins[first..=last]
    }
}

/// The summaries of all measures that a mesh has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshQuality(Vec<MeasureSummary>);

impl MeshQuality {
    /// Measures a mesh. The work is done on all threads.
    pub fn of(measures: &TriangleMeasures<'_>) -> Self {
        let mut count = QualityCount::default();
        loop {
            if let Some(quality) = count.advance(measures) {
                return quality;
            }
        }
    }

    /// Returns the summary of a measure; `None` where nothing has such a number.
    pub fn get(&self, measure: QualityMeasure) -> Option<&MeasureSummary> {
        self.0.iter().find(|summary| summary.measure == measure)
    }

    /// Returns all summaries, in the order of [`QualityMeasure::ALL`].
    pub fn summaries(&self) -> impl Iterator<Item = &MeasureSummary> {
        self.0.iter()
    }
}

/// The work of [`MeshQuality::of`], in steps. Mesh, field and depths are the same in all of them.
#[derive(Debug, Default)]
pub struct QualityCount {
    /// What is counted next.
    step: CountStep,
    /// The triangle to begin at.
    next: usize,
    /// The counts of [`QualityMeasure::OF_TRIANGLES`], once there is one.
    of_triangles: Option<[Tally; 5]>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum CountStep {
    /// Everything but the classes of time steps, which begin at the least one.
    #[default]
    Triangles,
    TimeSteps,
    Nodes,
}

impl QualityCount {
    /// Takes the next step. Returns the quality after the last one.
    pub fn advance(&mut self, measures: &TriangleMeasures<'_>) -> Option<MeshQuality> {
        let end = measures.mesh().triangles().len().min(self.next + STEP);
        match self.step {
            CountStep::Triangles => self.count_triangles(measures, end),
            CountStep::TimeSteps => self.count_time_steps(measures, end),
            CountStep::Nodes => return Some(self.finish(measures)),
        }
        self.next = end;
        if end == measures.mesh().triangles().len() {
            self.next = 0;
            self.step = match self.step {
                CountStep::Triangles => self.begin_time_steps(),
                CountStep::TimeSteps | CountStep::Nodes => CountStep::Nodes,
            };
        }
        None
    }

    fn count_triangles(&mut self, measures: &TriangleMeasures<'_>, end: usize) {
        let blank = QualityMeasure::OF_TRIANGLES.map(|measure| Tally::new(measure, f64::NAN));
        let found = in_parts(self.next..end, |triangles| {
            let (mut tallies, mut squares) = (blank.clone(), LevelCache::default());
            for triangle in triangles {
                let numbers = measures.of_triangle(triangle, &mut squares);
                for (tally, number) in tallies.iter_mut().zip(numbers) {
                    tally.note(number, triangle);
                }
            }
            tallies
        });
        let tallies = self.of_triangles.get_or_insert(blank);
        for part in &found {
            tallies.iter_mut().zip(part).for_each(|(tally, part)| tally.join(part));
        }
    }

    /// Goes on with the classes of time steps, where there are any.
    fn begin_time_steps(&mut self) -> CountStep {
        let steps = self.of_triangles.as_mut().map(|[.., steps]| steps);
        let least = steps.as_ref().and_then(|steps| steps.least);
        match (steps, least) {
            (Some(steps), Some((least, _))) => {
                *steps = Tally::new(QualityMeasure::TimeStep, least);
                CountStep::TimeSteps
            }
            _ => CountStep::Nodes,
        }
    }

    fn count_time_steps(&mut self, measures: &TriangleMeasures<'_>, end: usize) {
        let Some([.., steps]) = &mut self.of_triangles else { return };
        let blank = steps.blank();
        let found = in_parts(self.next..end, |triangles| {
            let (mut tally, mut squares) = (blank.clone(), LevelCache::default());
            for triangle in triangles {
                tally.note(measures.of(QualityMeasure::TimeStep, triangle, &mut squares), triangle);
            }
            tally
        });
        found.iter().for_each(|part| steps.join(part));
    }

    fn finish(&mut self, measures: &TriangleMeasures<'_>) -> MeshQuality {
        let of_triangle = |value: f64, triangle: usize| {
            let (inside, size) = middle_and_size(measures, triangle);
            MeasuredPlace { value, at: inside, inside, size }
        };
        let mut summaries: Vec<MeasureSummary> = Vec::new();
        for tally in self.of_triangles.iter().flatten() {
            summaries.extend(tally.summary(of_triangle));
        }
        summaries.extend(valences(measures));
        summaries.extend(links(measures));
        MeshQuality(summaries)
    }
}

/// Counts the triangles at each node.
fn valences(measures: &TriangleMeasures<'_>) -> Option<MeasureSummary> {
    let mesh = measures.mesh();
    // With the first triangle at each node.
    let mut nodes = vec![(0_u32, 0_usize); mesh.nodes().len()];
    for (number, triangle) in mesh.triangles().iter().enumerate() {
        for node in triangle.vertices {
            let (count, first) = &mut nodes[node.index()];
            if *count == 0 {
                *first = number;
            }
            *count += 1;
        }
    }
    let mut tally = Tally::new(QualityMeasure::Valence, f64::NAN);
    for (node, &(count, _)) in nodes.iter().enumerate() {
        tally.note((count > 0).then_some(f64::from(count)), node);
    }
    tally.summary(|value, node| {
        let (inside, size) = middle_and_size(measures, nodes[node].1);
        MeasuredPlace { value, at: mesh.world(NodeId::from_index(node)), inside, size }
    })
}

/// Counts the links between cells by their lengths, and those that solvers keep by their cosines.
fn links(measures: &TriangleMeasures<'_>) -> Vec<MeasureSummary> {
    let Some(MeasuredLinks { links, triangles }) = measures.links() else { return Vec::new() };
    let place = |value: f64, link: usize| {
        let [a, b] = links[link].ends.map(|node| measures.mesh().world(NodeId::from_index(node)));
        let (inside, size) = middle_and_size(measures, triangles[link][0]);
        MeasuredPlace { value, at: a.midpoint(b), inside, size }
    };
    let summary = |measure| {
        let mut tally = Tally::new(measure, f64::NAN);
        links.iter().enumerate().for_each(|(number, link)| tally.note(number_of(link, measure), number));
        tally.summary(place)
    };
    QualityMeasure::ALL.into_iter().filter(|measure| measure.is_of_links()).filter_map(summary).collect()
}

/// Returns the middle of a triangle and its diameter in the plane.
fn middle_and_size(measures: &TriangleMeasures<'_>, triangle: usize) -> (DVec2, f64) {
    let [a, b, c] = measures.corners(triangle);
    ((a + b + c) / 3.0, a.distance(b).max(b.distance(c)).max(c.distance(a)))
}

/// Returns what is found in each part of a range of triangles, in their order.
fn in_parts<T: Send>(
    triangles: std::ops::Range<usize>,
    find: impl Fn(std::ops::Range<usize>) -> T + Sync,
) -> Vec<T> {
    let part = |from: usize| find(from..triangles.end.min(from + GRAIN));
    triangles.clone().into_par_iter().step_by(GRAIN).map(part).collect()
}

/// A number, and the triangle or node that has it.
type Numbered = (f64, usize);

/// The counts of a measure.
#[derive(Clone, Debug)]
struct Tally {
    measure: QualityMeasure,
    classes: Classes,
    counts: Vec<(usize, Option<Numbered>)>,
    least: Option<Numbered>,
    greatest: Option<Numbered>,
}

impl Tally {
    fn new(measure: QualityMeasure, least: f64) -> Self {
        let classes = Classes::of(measure, least);
        let counts = vec![(0, None); classes.count()];
        Self { measure, classes, counts, least: None, greatest: None }
    }

    fn blank(&self) -> Self {
        let counts = vec![(0, None); self.counts.len()];
        Self { counts, least: None, greatest: None, ..*self }
    }

    fn note(&mut self, number: Option<f64>, owner: usize) {
        let Some(number) = number.filter(|number| !number.is_nan()) else { return };
        let found = (number, owner);
        let (count, worst) = &mut self.counts[self.classes.of_number(number)];
        *count += 1;
        keep(worst, found, self.measure.is_worse_when_smaller());
        keep(&mut self.least, found, true);
        keep(&mut self.greatest, found, false);
    }

    /// Adds the counts of later triangles.
    fn join(&mut self, later: &Self) {
        for ((count, worst), (more, other)) in self.counts.iter_mut().zip(&later.counts) {
            *count += more;
            if let Some(other) = *other {
                keep(worst, other, self.measure.is_worse_when_smaller());
            }
        }
        for (kept, other, smaller) in
            [(&mut self.least, later.least, true), (&mut self.greatest, later.greatest, false)]
        {
            if let Some(other) = other {
                keep(kept, other, smaller);
            }
        }
    }

    /// Returns the summary, with the places of numbers; `None` without any number.
    fn summary(&self, place: impl Fn(f64, usize) -> MeasuredPlace) -> Option<MeasureSummary> {
        let place = |(value, owner): Numbered| place(value, owner);
        let (least, greatest) = (place(self.least?), place(self.greatest?));
        let bins = self.counts.iter().enumerate().map(|(class, &(count, worst))| {
            let [from, to] = self.classes.bounds(class);
            QualityBin { from, to, count, worst: worst.map(place) }
        });
        Some(MeasureSummary { measure: self.measure, bins: bins.collect(), least, greatest })
    }
}

/// Keeps the smaller or the larger number, and of equal ones the first.
fn keep(kept: &mut Option<Numbered>, found: Numbered, smaller: bool) {
    let is_beyond = |kept: &Numbered| if smaller { found.0 < kept.0 } else { found.0 > kept.0 };
    if kept.as_ref().is_none_or(is_beyond) {
        *kept = Some(found);
    }
}
