//! The depths that files get: those of layers or of a quantity, no less than a least depth, and the largest
//! time step that they allow.

use serde::Serialize;

use super::args::DepthArguments;
use super::build::FinishedMesh;
use meshbrush_core::layers::{CourantFit, DepthFit, DepthSlope, EdgeTimes, LargestTimeStep, NodeDepths};
use meshbrush_io::io::Provenance;
use meshbrush_mesh::mesh::{Extract, TriangleId};
use meshbrush_mesh::text::digits;

/// A least depth, and what it changed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeastDepth {
    /// The least depth in files, in metres.
    pub depth: f64,
    /// The nodes that had less.
    pub raised: usize,
}

impl LeastDepth {
    /// Raises depths to the least one, and counts the nodes that had less.
    pub fn raise(depth: f64, depths: &mut [f64]) -> Self {
        let lower = depths.iter_mut().filter(|of_node| **of_node < depth);
        let raised = lower.map(|of_node| *of_node = depth).count();
        Self { depth, raised }
    }
}

/// How depths are changed for files.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthChanges {
    /// The least depth, in metres.
    pub least: Option<f64>,
    /// The largest r-factor of an edge.
    pub slope: Option<f64>,
}

/// What was changed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChangedDepths {
    /// By the least depth, if there is one.
    pub least: Option<LeastDepth>,
    /// By the largest r-factor, if there is one.
    pub slope: Option<DepthSlope>,
}

impl From<DepthArguments> for DepthChanges {
    fn from(typed: DepthArguments) -> Self {
        let DepthArguments { least_depth, depth_slope } = typed;
        Self { least: least_depth, slope: depth_slope }
    }
}

impl DepthChanges {
    /// Returns whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns these changes; where they ask for nothing, those of another.
    pub fn or(self, other: Self) -> Self {
        Self { least: self.least.or(other.least), slope: self.slope.or(other.slope) }
    }

    /// Changes depths: first those below the least one are raised, and then all are smoothed, which leaves
    /// none below it.
    pub fn apply(&self, mesh: &Extract, depths: &mut [f64]) -> ChangedDepths {
        let least = self.least.map(|least| LeastDepth::raise(least, depths));
        let slope = self.slope.map(|slope| DepthSlope::smooth(mesh.view(), depths, slope));
        ChangedDepths { least, slope }
    }
}

impl ChangedDepths {
    /// Returns whether a least depth and whether a largest r-factor was kept.
    pub fn kinds(&self) -> (bool, bool) {
        (self.least.is_some(), self.slope.is_some())
    }

    /// Returns the origin of a mesh with a line for each change.
    pub fn said_in(&self, provenance: Provenance) -> Provenance {
        let provenance = match self.least {
            Some(LeastDepth { depth, .. }) => provenance.with_line("least depth", &format!("{depth} m")),
            None => provenance,
        };
        match self.slope {
            Some(DepthSlope { limit, changed, largest, .. }) => provenance.with_line(
                "depth slope",
                &format!(
                    "r-factor of edges at most {limit}; {changed} nodes changed, by at most {} m",
                    digits(largest.abs(), 3)
                ),
            ),
            None => provenance,
        }
    }
}

/// The smoothing of depths to a slope, in JSON.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DepthSlopeSummary {
    /// The largest r-factor that was asked for.
    pub limit: f64,
    /// The largest r-factor of an edge before.
    pub before: f64,
    /// The largest one afterwards.
    pub after: f64,
    /// The nodes whose depth changed.
    pub changed: usize,
    /// The largest change, in metres: positive where the node is deeper now.
    pub largest_change: f64,
    /// The node of the largest change.
    pub at: [f64; 2],
    /// The water that there is more of, as a share of all of it.
    pub more_water: f64,
    /// Nodes that are dry, whose edges do not count.
    pub dry: usize,
}

impl From<DepthSlope> for DepthSlopeSummary {
    fn from(slope: DepthSlope) -> Self {
        let DepthSlope { limit, before, after, changed, largest, at, more_water, dry } = slope;
        Self { limit, before, after, changed, largest_change: largest, at: at.into(), more_water, dry }
    }
}

/// The largest time step of a wave of 1 m with the Courant number 1 along every edge, and across every
/// triangle.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TimeStepSummary {
    /// The time step by edges, in seconds.
    pub seconds: f64,
    /// The middle of the edge that decides it.
    pub at: [f64; 2],
    /// The time step by the smallest heights of triangles.
    pub by_height: Option<HeightTimeStep>,
}

/// The largest time step with which no wave crosses a triangle along its smallest height.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct HeightTimeStep {
    /// The time step, in seconds.
    pub seconds: f64,
    /// The middle of the triangle that decides it.
    pub at: [f64; 2],
}

impl TimeStepSummary {
    /// Returns the time steps of a mesh as files get it; `None` where no edge has water at an end, and in
    /// degrees.
    pub fn of(finished: &FinishedMesh, extract: &Extract, depths: &[f64]) -> Option<Self> {
        let (ground, unit) = (finished.ground(), finished.unit());
        let by_edge = LargestTimeStep::of(extract.view(), depths, unit, |ends| ground.length(ends))?;
        let by_height = HeightTimeStep::of(finished, extract, depths);
        Some(Self { seconds: by_edge.seconds, at: by_edge.at.into(), by_height })
    }
}

impl HeightTimeStep {
    fn of(finished: &FinishedMesh, extract: &Extract, depths: &[f64]) -> Option<Self> {
        let times = EdgeTimes::new(depths, finished.unit())?;
        let view = extract.view();
        let step = |id: TriangleId| {
            let corners = view.world_corners(id);
            let [a, b, c] = view.triangle(id).vertices.map(|node| node.index());
            let [p, q, r] = corners;
            let sides = [[p, q], [q, r], [r, p]].map(|ends| finished.ground().length(ends));
            let height = smallest_height(sides);
            let across = [[a, b], [b, c], [c, a]].into_iter().filter_map(|ends| times.seconds(ends, height));
            let seconds = across.min_by(f64::total_cmp)?;
            Some(Self { seconds, at: ((p + q + r) / 3.0).into() })
        };
        let steps = (0..view.triangles().len()).map(TriangleId::from_index).filter_map(step);
        // Of equal ones the first.
        steps.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }
}

/// How far depths that are linear over triangles are from the pixels of the layers of depths.
#[derive(Clone, Debug, Serialize)]
pub struct DepthSummary {
    /// Pixels that were compared.
    pub pixels: usize,
    /// The largest difference of either sign, in metres.
    pub largest_error: f64,
    /// Where that is.
    pub at: [f64; 2],
    /// The square root of the mean of the squares, in metres.
    pub rms_error: f64,
    /// The mean, in metres: positive where the mesh holds more water.
    pub mean_error: f64,
    /// Nodes outside the layers of depths, which have the depth of the nearest pixel.
    pub filled_nodes: usize,
    /// The distance of the farthest of these pixels.
    pub farthest_filled: f64,
}

impl From<&NodeDepths> for DepthSummary {
    fn from(depths: &NodeDepths) -> Self {
        let NodeDepths { depths: _, filled, farthest, fit } = depths;
        let DepthFit { pixels, largest, at, rms, mean } = *fit;
        Self {
            pixels,
            largest_error: largest,
            at: at.into(),
            rms_error: rms,
            mean_error: mean,
            filled_nodes: *filled,
            farthest_filled: *farthest,
        }
    }
}

/// The Courant numbers of edges, u Δt / L, for a layer that keeps them below a number.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CourantSummary {
    /// The number that was given.
    pub limit: f64,
    /// The time step, in seconds.
    pub time_step: f64,
    /// The edges with water at an end.
    pub edges: usize,
    /// The number of these edges that exceed the limit.
    pub above: usize,
    /// The largest Courant number.
    pub largest: f64,
    /// The middle of the edge that has it.
    pub at: [f64; 2],
}

impl From<CourantFit> for CourantSummary {
    fn from(fit: CourantFit) -> Self {
        let CourantFit { limit, time_step, edges, above, largest, at } = fit;
        Self { limit, time_step, edges, above, largest, at: at.into() }
    }
}

/// Returns the smallest height of a triangle with these sides.
fn smallest_height([a, b, c]: [f64; 3]) -> f64 {
    let half = 0.5 * (a + b + c);
    // By the formula of Heron; rounding can make a flat triangle negative.
    let area = (half * (half - a) * (half - b) * (half - c)).max(0.0).sqrt();
    2.0 * area / a.max(b).max(c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_height_stands_on_the_longest_side() {
        assert_eq!(smallest_height([3.0, 4.0, 5.0]), 2.4);
        assert_eq!(smallest_height([1.0, 1.0, 2.0]), 0.0);
    }

    #[test]
    fn depths_are_raised_and_counted() {
        let mut depths = [0.0, 3.0, 2.9, 50.0, -4.0];
        assert_eq!(LeastDepth::raise(3.0, &mut depths), LeastDepth { depth: 3.0, raised: 3 });
        assert_eq!(depths, [3.0, 3.0, 3.0, 50.0, 3.0]);
    }
}
