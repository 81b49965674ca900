//! How well a mesh renders the outline of its region.

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;

use super::farthest::farthest;
use super::holes::{HoleComparison, HoleFigures, compare_holes};
use super::segments::Segments;
use super::{Region, Ring};
use crate::earth::Ground;
use crate::mesh::{Extract, NodeId};

/// A mesh as files have it, compared with the region that it should cover. Lengths and areas are in world
/// units, with a projection in metres on the ellipsoid.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FitQuality {
    /// The area of the region.
    pub region_area: f64,
    /// The area of the mesh minus the area of the region.
    pub net_area: f64,
    /// The area that only one of the two covers.
    pub misclassified_area: f64,
    /// Length of the boundary of the mesh.
    pub boundary_length: f64,
    /// Length of the outline of the region.
    pub outline_length: f64,
    /// The largest distance from the boundary of the mesh to the outline, and where. It is never too small,
    /// and too large by a share of 1e-9 at most, apart from rounding errors.
    pub farthest_from_outline: Option<(f64, DVec2)>,
    /// The largest distance from the outline to the boundary of the mesh, and where; as exact.
    pub farthest_from_mesh: Option<(f64, DVec2)>,
    /// Holes of the region.
    pub islands: usize,
    /// The holes of the region that lie wholly under triangles.
    pub lost_islands: Vec<HoleFigures>,
    /// The holes of the mesh that contain no part of a hole of the region: mostly inlets whose mouth the mesh
    /// closes.
    pub new_holes: Vec<HoleFigures>,
    /// The smallest angle of a triangle, in degrees.
    pub smallest_angle: f64,
    /// The largest angle of a triangle, in degrees.
    pub largest_angle: f64,
}

impl FitQuality {
    /// Compares the extract that files get with the region of its domain. Takes time proportional to the
    /// triangles, and to n log n for the n edges of boundary and outline.
    pub fn of(extract: &Extract, region: &Region, ground: &Ground) -> Self {
        let mut comparison = FitComparison::new(extract, region, ground);
        loop {
            if let Some(quality) = comparison.advance(region, ground) {
                return quality;
            }
        }
    }
}

/// The work of [`FitQuality::of`], in steps. Region and ground are the same in all of them.
pub struct FitComparison {
    step: FitComparisonStep,
    /// The boundary of the mesh.
    loops: Vec<Ring>,
    /// Its edges, and those of the outline.
    edges: [Vec<[DVec2; 2]>; 2],
    quality: FitQuality,
}

/// What is done next.
#[derive(Clone, Copy)]
enum FitComparisonStep {
    Holes,
    Areas,
    FromOutline,
    FromMesh,
    Done,
}

impl FitComparison {
    /// Begins to compare the extract that files get with the region of its domain.
    pub fn new(extract: &Extract, region: &Region, ground: &Ground) -> Self {
        let ring =
            |nodes: &Vec<usize>| nodes.iter().map(|&node| extract.world(NodeId::from_index(node))).collect();
        let loops: Vec<Ring> = extract.boundary_loops().iter().map(ring).collect();
        let edges = [edges(loops.iter()), edges(region.rings())];
        let [boundary_length, outline_length] =
            [0, 1].map(|which: usize| edges[which].iter().map(|&edge| ground.length(edge)).sum());
        let area = |ring: &Ring| ground.signed_area(ring);
        let region_area = region.rings().map(area).sum::<f64>();
        let [smallest_angle, largest_angle] = extract.angle_range();
        let quality = FitQuality {
            region_area,
            net_area: loops.iter().map(area).sum::<f64>() - region_area,
            misclassified_area: 0.0,
            boundary_length,
            outline_length,
            farthest_from_outline: None,
            farthest_from_mesh: None,
            islands: region.hole_count(),
            lost_islands: Vec::new(),
            new_holes: Vec::new(),
            smallest_angle,
            largest_angle,
        };
        Self { step: FitComparisonStep::Holes, loops, edges, quality }
    }

    /// Takes the next step. Returns the comparison after the last one.
    pub fn advance(&mut self, region: &Region, ground: &Ground) -> Option<FitQuality> {
        let Self { step, loops, edges: [boundary, outline], quality } = self;
        *step = match *step {
            FitComparisonStep::Holes => {
                let HoleComparison { lost, new } = compare_holes(region, loops);
                let on_ground =
                    |holes: Vec<HoleFigures>| holes.into_iter().map(|hole| hole.on_ground(ground)).collect();
                (quality.lost_islands, quality.new_holes) = (on_ground(lost), on_ground(new));
                FitComparisonStep::Areas
            }
            FitComparisonStep::Areas => {
                let only_one = region.overlaid(loops, OverlayRule::Xor, FillRule::EvenOdd);
                let area = only_one.rings().map(|ring| ground.signed_area(ring)).sum::<f64>();
                // The empty sum is -0.
                quality.misclassified_area = area.max(0.0);
                FitComparisonStep::FromOutline
            }
            FitComparisonStep::FromOutline => {
                quality.farthest_from_outline = farthest_from(boundary, outline, ground);
                FitComparisonStep::FromMesh
            }
            FitComparisonStep::FromMesh => {
                quality.farthest_from_mesh = farthest_from(outline, boundary, ground);
                FitComparisonStep::Done
            }
            FitComparisonStep::Done => return Some(quality.clone()),
        };
        None
    }
}

fn edges<'a>(rings: impl Iterator<Item = &'a Ring>) -> Vec<[DVec2; 2]> {
    rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])).collect()
}

fn farthest_from(edges: &[[DVec2; 2]], others: &[[DVec2; 2]], ground: &Ground) -> Option<(f64, DVec2)> {
    let (distance, at) = farthest(edges, &Segments::new(others.to_vec())?)?;
    Some((ground.longest(distance, at), at))
}
