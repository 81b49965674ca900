//! The numbers by which triangles are judged.

use glam::DVec2;
use rayon::prelude::*;

use super::links::MeasuredLinks;
use crate::earth::Ground;
use crate::layers::{EdgeTimes, LevelCache, PaintLayers, SizeField};
use crate::mesh::{MeshView, NodeId, TriangleId};
use crate::text::LengthUnit;

/// What is measured of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QualityMeasure {
    /// The smallest angle of a triangle, in degrees: at most 60.
    SmallestAngle,
    /// The largest angle of a triangle, in degrees: at least 60.
    LargestAngle,
    /// The ratio of the longest to the shortest edge of a triangle: at least 1.
    EdgeRatio,
    /// The ratio of the longest edge of a triangle to h̄ at its middle, or to the diameter of the largest
    /// triangle where h̄ is larger. h̄ is found as for a pointer: with gradation it can be too large by 10⁻³.
    TargetRatio,
    /// The shortest time that a wave of 1 m takes along an edge of a triangle, in seconds: the largest time
    /// step with the Courant number 1.
    TimeStep,
    /// The triangles at a node.
    Valence,
    /// The length of a link between the centres of two cells, as Delft3D-FM has them, by the size of the
    /// cells. It removes those below 0.09.
    LinkLength,
    /// The cosine of the angle between a link and the edge that it crosses: 0 where they are orthogonal.
    LinkCosine,
}

impl QualityMeasure {
    /// All of them, in the order of lists.
    pub const ALL: [Self; 8] = [
        Self::SmallestAngle,
        Self::LargestAngle,
        Self::EdgeRatio,
        Self::TargetRatio,
        Self::TimeStep,
        Self::Valence,
        Self::LinkLength,
        Self::LinkCosine,
    ];

    /// Those of triangles, as [`TriangleMeasures::of_triangle`] returns them.
    pub const OF_TRIANGLES: [Self; 5] =
        [Self::SmallestAngle, Self::LargestAngle, Self::EdgeRatio, Self::TargetRatio, Self::TimeStep];

    /// Returns its name in JSON.
    pub fn key(self) -> &'static str {
        match self {
            Self::SmallestAngle => "smallest_angle",
            Self::LargestAngle => "largest_angle",
            Self::EdgeRatio => "edge_ratio",
            Self::TargetRatio => "target_ratio",
            Self::TimeStep => "time_step",
            Self::Valence => "triangles_at_node",
            Self::LinkLength => "link_length",
            Self::LinkCosine => "link_cosine",
        }
    }

    /// Returns whether it is of the links between cells.
    pub fn is_of_links(self) -> bool {
        matches!(self, Self::LinkLength | Self::LinkCosine)
    }

    /// Returns whether a smaller number is the worse one.
    pub fn is_worse_when_smaller(self) -> bool {
        matches!(self, Self::SmallestAngle | Self::TimeStep | Self::LinkLength)
    }
}

/// Measures triangles of an extract, one by one.
#[derive(Clone, Copy)]
pub struct TriangleMeasures<'a> {
    mesh: MeshView<'a>,
    ground: &'a Ground,
    target: Option<(&'a SizeField, &'a PaintLayers)>,
    times: Option<EdgeTimes<'a>>,
    /// The unit of coordinates, where links between cells are measured.
    links: Option<LengthUnit>,
}

impl<'a> TriangleMeasures<'a> {
    /// Measures angles and edge ratios.
    pub fn new(mesh: MeshView<'a>, ground: &'a Ground) -> Self {
        Self { mesh, ground, target: None, times: None, links: None }
    }

    /// Compares edges with the targets of a field as well.
    pub fn with_target(self, field: &'a SizeField, paint: &'a PaintLayers) -> Self {
        Self { target: Some((field, paint)), ..self }
    }

    /// Finds time steps as well, from the depths at the nodes in metres. In degrees there are none.
    pub fn with_depths(self, depths: &'a [f64], unit: LengthUnit) -> Self {
        Self { times: EdgeTimes::new(depths, unit), ..self }
    }

    /// Measures the links between cells as well: squares, and the triangles that are left
    /// ([`MeshCells::joined`](crate::cells::MeshCells::joined)). With degrees lengths are those on the Earth.
    pub fn with_links(self, unit: LengthUnit) -> Self {
        Self { links: Some(unit), ..self }
    }

    /// Returns the mesh.
    pub fn mesh(&self) -> MeshView<'a> {
        self.mesh
    }

    /// Returns a number of a triangle; `None` where it has none, as one without water has no time step.
    /// `squares` must have been used for this field only.
    ///
    /// # Panics
    /// Panics when there is no such triangle.
    pub fn of(&self, measure: QualityMeasure, triangle: usize, squares: &mut LevelCache) -> Option<f64> {
        match measure {
            QualityMeasure::SmallestAngle => Some(self.angles(triangle)[0]),
            QualityMeasure::LargestAngle => Some(self.angles(triangle)[1]),
            QualityMeasure::EdgeRatio => Some(ratio(self.edges(triangle))),
            QualityMeasure::TargetRatio => self.target_ratio(triangle, self.edges(triangle), squares),
            QualityMeasure::TimeStep => self.time_step(triangle, self.edges(triangle)),
            QualityMeasure::Valence | QualityMeasure::LinkLength | QualityMeasure::LinkCosine => None,
        }
    }

    /// Returns the greatest number of triangles at a corner of each triangle.
    pub fn most_at_corners(&self) -> Vec<u32> {
        let mut at_node = vec![0_u32; self.mesh.nodes().len()];
        self.mesh.triangles().iter().flat_map(|triangle| triangle.vertices).for_each(|node| {
            at_node[node.index()] += 1;
        });
        let most = |corners: [NodeId; 3]| corners.map(|node| at_node[node.index()]).into_iter().max();
        self.mesh.triangles().iter().map(|triangle| most(triangle.vertices).unwrap_or(0)).collect()
    }

    /// Returns a number of each triangle that is not found by looking at it alone: the greatest number of
    /// triangles at its corners, or the worst link of its cell; NaN without a link. `None` for other
    /// measures.
    pub fn of_all(&self, measure: QualityMeasure) -> Option<Vec<f64>> {
        match measure {
            QualityMeasure::Valence => Some(self.most_at_corners().into_iter().map(f64::from).collect()),
            _ if measure.is_of_links() => Some(self.links()?.worst(measure, self.mesh.triangles().len())),
            _ => None,
        }
    }

    /// Returns the links between cells, if they are measured.
    pub(super) fn links(&self) -> Option<MeasuredLinks> {
        Some(MeasuredLinks::of(self.mesh, self.links?))
    }

    /// Returns the least time step of all triangles, in seconds; `None` where none has one.
    pub fn least_time_step(&self) -> Option<f64> {
        let all = (0..self.mesh.triangles().len()).into_par_iter();
        let steps = all.filter_map(|triangle| self.time_step(triangle, self.edges(triangle)));
        steps.min_by(f64::total_cmp)
    }

    /// Returns the numbers of a triangle, in the order of [`QualityMeasure::OF_TRIANGLES`].
    pub(super) fn of_triangle(&self, triangle: usize, squares: &mut LevelCache) -> [Option<f64>; 5] {
        let ([smallest, largest], edges) = (self.angles(triangle), self.edges(triangle));
        [
            Some(smallest),
            Some(largest),
            Some(ratio(edges)),
            self.target_ratio(triangle, edges, squares),
            self.time_step(triangle, edges),
        ]
    }

    /// Returns the corners of a triangle in world units.
    pub(super) fn corners(&self, triangle: usize) -> [DVec2; 3] {
        self.mesh.world_corners(TriangleId::from_index(triangle))
    }

    /// Returns the smallest and the largest angle, in degrees.
    fn angles(&self, triangle: usize) -> [f64; 2] {
        let corners = self.corners(triangle);
        let cosines = [0, 1, 2].map(|k| {
            let (p, q) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
            p.dot(q) / (p.length() * q.length())
        });
        // A smaller angle has a larger cosine.
        let [least, greatest] = range(cosines);
        [greatest, least].map(|cosine| libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees())
    }

    /// Returns the lengths of the edges on the ground, from each vertex to the next.
    fn edges(&self, triangle: usize) -> [f64; 3] {
        let [a, b, c] = self.corners(triangle);
        [[a, b], [b, c], [c, a]].map(|ends| self.ground.length(ends))
    }

    fn target_ratio(&self, triangle: usize, edges: [f64; 3], squares: &mut LevelCache) -> Option<f64> {
        let (field, paint) = self.target?;
        // In an order that does not depend on how the triangle was made: sums are rounded.
        let mut corners = self.corners(triangle);
        corners.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let middle = corners.iter().sum::<DVec2>() / 3.0;
        let target = field.compared_target_at(squares, paint, middle);
        (target > 0.0).then(|| range(edges)[1] / target)
    }

    fn time_step(&self, triangle: usize, edges: [f64; 3]) -> Option<f64> {
        let times = self.times?;
        let [a, b, c] =
            self.mesh.triangle(TriangleId::from_index(triangle)).vertices.map(|node| node.index());
        let ends = [[a, b], [b, c], [c, a]];
        let along = ends.into_iter().zip(edges).filter_map(|(ends, length)| times.seconds(ends, length));
        along.min_by(f64::total_cmp)
    }
}

/// Returns the ratio of the longest to the shortest edge.
fn ratio(edges: [f64; 3]) -> f64 {
    let [shortest, longest] = range(edges);
    longest / shortest
}

/// Returns the least and the greatest of three numbers.
fn range([a, b, c]: [f64; 3]) -> [f64; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}
