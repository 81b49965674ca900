use glam::DVec2;

use super::Extract;
use crate::mesh::kernel::{NodeId, Triangle};

/// The figures of a mesh by which people judge it. Lengths and areas are in world units, angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct MeshStatistics {
    /// Length of the shortest edge.
    pub shortest_edge: f64,
    /// Middle of the shortest edge.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub shortest_edge_at: DVec2,
    /// Length of the longest edge.
    pub longest_edge: f64,
    /// Middle of the longest edge.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub longest_edge_at: DVec2,
    /// Area of the smallest triangle.
    pub smallest_area: f64,
    /// Area of the largest triangle.
    pub largest_area: f64,
    /// The smallest angle.
    pub smallest_angle: f64,
    /// Its corner.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub smallest_angle_at: DVec2,
    /// The largest angle.
    pub largest_angle: f64,
    /// Its corner.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub largest_angle_at: DVec2,
    /// Gradation: the largest ratio of the diameters of two triangles that share an edge, at least 1.
    pub size_ratio: f64,
    /// Middle of the edge between these two triangles.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub size_ratio_at: DVec2,
}

impl Extract<'_> {
    /// Returns the figures of all triangles; `None` without triangles.
    pub fn statistics(&self) -> Option<MeshStatistics> {
        let area = |[a, b, c]: [DVec2; 3]| 0.5 * (b - a).perp_dot(c - a).abs();
        self.statistics_by(|[from, to]| from.distance(to), area)
    }

    /// Returns the figures with other measures: of the length between two points, and of the area of a
    /// triangle.
    pub fn statistics_by(
        &self,
        length: impl Fn([DVec2; 2]) -> f64,
        area: impl Fn([DVec2; 3]) -> f64,
    ) -> Option<MeshStatistics> {
        let diameter =
            |triangle: &Triangle| self.edge_ends(triangle).map(&length).into_iter().fold(0.0, f64::max);
        let mut extremes = Extremes::default();
        for triangle in self.triangles() {
            let ends = self.edge_ends(triangle);
            extremes.note_edges(ends.map(|[from, to]| (length([from, to]), 0.5 * (from + to))));
            extremes.note_area(area(ends.map(|[from, _]| from)));
            extremes.note_ratios(self, triangle, diameter);
        }
        let (shortest, longest) = (extremes.shortest?, extremes.longest?);
        let [smallest, largest] = self.extreme_angles();
        let [smallest_area, largest_area] = extremes.areas?;
        let (size_ratio, size_ratio_at) = extremes.ratio.unwrap_or((1.0, longest.1));
        Some(MeshStatistics {
            shortest_edge: shortest.0,
            shortest_edge_at: shortest.1,
            longest_edge: longest.0,
            longest_edge_at: longest.1,
            smallest_area,
            largest_area,
            smallest_angle: smallest.0,
            smallest_angle_at: smallest.1,
            largest_angle: largest.0,
            largest_angle_at: largest.1,
            size_ratio,
            size_ratio_at,
        })
    }

    /// Returns the world coordinates of the ends of each edge of a triangle.
    fn edge_ends(&self, triangle: &Triangle) -> [[DVec2; 2]; 3] {
        triangle.edge_nodes().map(|(from, to)| [self.world(from), self.world(to)])
    }
}

/// A length or a ratio, and where it was found.
type Placed = (f64, DVec2);

#[derive(Default)]
struct Extremes {
    shortest: Option<Placed>,
    longest: Option<Placed>,
    ratio: Option<Placed>,
    areas: Option<[f64; 2]>,
}

impl Extremes {
    fn note_edges(&mut self, edges: [Placed; 3]) {
        for edge in edges {
            if self.shortest.is_none_or(|shortest| edge.0 < shortest.0) {
                self.shortest = Some(edge);
            }
            if self.longest.is_none_or(|longest| edge.0 > longest.0) {
                self.longest = Some(edge);
            }
        }
    }

    fn note_area(&mut self, area: f64) {
        let [low, high] = self.areas.unwrap_or([area; 2]);
        self.areas = Some([low.min(area), high.max(area)]);
    }

    /// Compares a triangle with its neighbours that are not larger.
    fn note_ratios(
        &mut self,
        extract: &Extract,
        triangle: &Triangle,
        diameter_of: impl Fn(&Triangle) -> f64,
    ) {
        let diameter = diameter_of(triangle);
        for ((from, to), across) in triangle.edge_nodes().into_iter().zip(triangle.raw_neighbours) {
            let Some(neighbour) = across.triangle() else { continue };
            let ratio = diameter / diameter_of(&extract.triangles()[neighbour.index()]);
            if ratio >= 1.0 && self.ratio.is_none_or(|largest| ratio > largest.0) {
                self.ratio = Some((ratio, middle(extract, from, to)));
            }
        }
    }
}

fn middle(extract: &Extract, from: NodeId, to: NodeId) -> DVec2 {
    0.5 * (extract.world(from) + extract.world(to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Mesh};

    fn unit_square() -> Mesh {
        let lattice = Lattice::covering(Rect::UNIT, 0.5, 1_000_000).unwrap();
        Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap()
    }

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn a_coarse_grid_has_one_size() {
        let mesh = unit_square();
        let statistics = mesh.extract().statistics().unwrap();
        assert!(near(statistics.shortest_edge, 0.5) && near(statistics.longest_edge, 0.5_f64.sqrt()));
        assert!(near(statistics.smallest_area, 0.125) && near(statistics.largest_area, 0.125));
        assert!(near(statistics.size_ratio, 1.0));
        assert!((statistics.smallest_angle - 45.0).abs() < 1e-6);
        assert!((statistics.largest_angle - 90.0).abs() < 1e-6);
        let extract = mesh.extract();
        let has_angle = |at: DVec2, angle: f64| {
            extract.cells().any(|cell| {
                let corners = cell.corners.map(|node| extract.world(NodeId::from_index(node)));
                (0..3).filter(|&k| corners[k] == at).any(|k| {
                    let [p, q] = [1, 2].map(|step| corners[(k + step) % 3] - corners[k]);
                    (p.angle_to(q).abs().to_degrees() - angle).abs() < 1e-6
                })
            })
        };
        assert!(
            has_angle(statistics.smallest_angle_at, 45.0) && has_angle(statistics.largest_angle_at, 90.0)
        );
    }

    #[test]
    fn a_refined_corner_shows_in_the_extremes_and_their_places() {
        let mut mesh = unit_square();
        let corner = DVec2::ONE;
        let contains = |corners: [DVec2; 3]| corners.contains(&corner);
        let rule = |element: &crate::mesh::Element| {
            element.triangle.level() < 8 && contains(element.world_corners())
        };
        mesh.refine(&Limits::default(), rule).unwrap();
        let statistics = mesh.extract().statistics().unwrap();
        assert!(near(statistics.shortest_edge, 0.5 / 16.0), "{}", statistics.shortest_edge);
        assert!(statistics.shortest_edge_at.distance(corner) < 0.1);
        assert!(
            near(statistics.longest_edge, 0.5_f64.sqrt())
                && statistics.longest_edge_at.distance(corner) > 0.3
        );
        let extract = mesh.extract();
        let edges = extract.triangles().iter().flat_map(|triangle| triangle.edge_nodes());
        let ends: Vec<_> = edges.map(|(a, b)| [extract.world(a), extract.world(b)]).collect();
        let is_middle = |at: DVec2, length: f64| {
            ends.iter().any(|[a, b]| a.midpoint(*b) == at && near(a.distance(*b), length))
        };
        assert!(is_middle(statistics.shortest_edge_at, statistics.shortest_edge));
        assert!(is_middle(statistics.longest_edge_at, statistics.longest_edge));
        assert!(ends.iter().any(|[a, b]| a.midpoint(*b) == statistics.size_ratio_at));
        assert!(Rect::UNIT.contains(statistics.size_ratio_at));
        assert!(near(statistics.size_ratio, 2.0_f64.sqrt()), "neighbours differ by one level at most");
        assert!(near(statistics.largest_area / statistics.smallest_area, 256.0));
    }
}
