//! How well a mesh renders the outline of its region.

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;

use super::segments::SegmentGrid;
use super::{Region, Ring, region, signed_area};
use crate::mesh::{Extract, Mesh, NodeId, TriangleId};

/// A mesh compared with the region that it should cover. Lengths and areas are in world units.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FitQuality {
    /// The area of the mesh without that of the region.
    pub net_area: f64,
    /// The area that only one of the two covers.
    pub misclassified_area: f64,
    /// Length of the boundary of the mesh.
    pub boundary_length: f64,
    /// Length of the outline of the region.
    pub outline_length: f64,
    /// The largest distance from the boundary of the mesh to the outline, and where: at nodes and middles of
    /// edges.
    pub farthest_from_outline: Option<(f64, DVec2)>,
    /// The largest distance from the outline to the boundary of the mesh, and where: at corners, and between
    /// them at steps of half an edge of the mesh.
    pub farthest_from_mesh: Option<(f64, DVec2)>,
    /// Holes of the region.
    pub islands: usize,
    /// A corner of each hole of the region that the mesh covers.
    pub lost_islands: Vec<DVec2>,
    /// The smallest angle of a triangle, in degrees.
    pub smallest_angle: f64,
    /// The largest angle of a triangle, in degrees.
    pub largest_angle: f64,
}

impl FitQuality {
    /// Compares a mesh, and the extract of it, with the region of its domain. Takes time in proportion to
    /// the triangles and to n log n of the corners.
    pub fn of(mesh: &Mesh, extract: &Extract, region: &Region) -> Self {
        let boundary: Vec<[DVec2; 2]> = extract
            .boundary_edges()
            .map(|edge| edge.ends.map(|node| extract.world(NodeId::from_index(node))))
            .collect();
        let outline: Vec<[DVec2; 2]> = region.edges().collect();
        let [boundary_length, outline_length] =
            [&boundary, &outline].map(|edges| edges.iter().map(length).sum());
        let step = 0.5 * boundary_length / boundary.len().max(1) as f64;
        let ring =
            |nodes: &Vec<usize>| nodes.iter().map(|&node| extract.world(NodeId::from_index(node))).collect();
        let loops: Vec<Ring> = extract.boundary_loops().iter().map(ring).collect();
        let [smallest_angle, largest_angle] = extract.angle_range();
        Self {
            net_area: loops.iter().map(|ring| signed_area(ring)).sum::<f64>() - region.area(),
            misclassified_area: region.area_of(&loops, OverlayRule::Xor, FillRule::EvenOdd),
            farthest_from_outline: farthest(&boundary, f64::INFINITY, &outline),
            farthest_from_mesh: farthest(&outline, step, &boundary),
            islands: region.hole_count(),
            lost_islands: lost_islands(mesh, region),
            boundary_length,
            outline_length,
            smallest_angle,
            largest_angle,
        }
    }
}

fn length([a, b]: &[DVec2; 2]) -> f64 {
    a.distance(*b)
}

/// The largest distance of `edges` from `others`: at their starts and middles, and at least every `step`.
fn farthest(edges: &[[DVec2; 2]], step: f64, others: &[[DVec2; 2]]) -> Option<(f64, DVec2)> {
    let grid = SegmentGrid::new(others)?;
    let samples = edges.iter().flat_map(|edge| {
        let [a, b] = *edge;
        let count = (length(edge) / step).ceil().clamp(2.0, 1e4) as usize;
        (0..count).map(move |k| a.lerp(b, k as f64 / count as f64))
    });
    samples.map(|p| (grid.distance(p), p)).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// A corner of each hole in which no triangle outside the mesh has its centroid.
fn lost_islands(mesh: &Mesh, region: &Region) -> Vec<DVec2> {
    let mut lost: Vec<&Ring> = region.polygons().iter().flat_map(|rings| rings.iter().skip(1)).collect();
    for (id, triangle) in mesh.raw_triangles().iter().enumerate() {
        if lost.is_empty() {
            break;
        }
        if triangle.is_outside() {
            let corners = mesh.world_corners(TriangleId::from_index(id));
            let centroid = corners.iter().sum::<DVec2>() / 3.0;
            lost.retain(|ring| !region::encloses(ring, centroid));
        }
    }
    lost.iter().map(|ring| ring[0]).collect()
}
