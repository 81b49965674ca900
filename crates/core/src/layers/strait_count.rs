//! Triangles across straits, counted on a finished mesh.

use std::ops::ControlFlow;

use glam::DVec2;
use rayon::prelude::*;

use super::{MedialBall, Straits};
use crate::geometry::{BoxTree, Rect};
use crate::mesh::MeshView;

/// A triangle counts where this share of a crossing is in it.
const LEAST_SHARE: f64 = 1e-9;

/// The triangles across a strait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraitCount {
    /// The strait.
    pub disc: MedialBall,
    /// The number of triangles that the segment between its shores crosses.
    pub triangles: usize,
}

impl StraitCount {
    /// Counts the triangles of a mesh across a passage, if one is given, and then across each strait.
    pub fn of(straits: &Straits, passage: Option<&MedialBall>, mesh: MeshView) -> Vec<Self> {
        let lattice = mesh.lattice();
        let nodes: Vec<DVec2> =
            mesh.nodes().par_iter().map(|&node| lattice.world_from_lattice(node)).collect();
        let corners = |n: usize| mesh.triangles()[n].vertices.map(|node| nodes[node.index()]);
        let bounds = |n: usize| {
            let [a, b, c] = corners(n);
            Rect::new(a.min(b).min(c), a.max(b).max(c))
        };
        let boxes: Vec<Rect> = (0..mesh.triangles().len()).into_par_iter().map(bounds).collect();
        let tree = BoxTree::new(&boxes);
        let count = |disc: &MedialBall| {
            let [from, to] = disc.shores;
            let mut triangles = 0;
            let _ = tree.visit_meeting(&Rect::spanning(from, to), |n| {
                triangles += usize::from(share_within(corners(n as usize), from, to) > LEAST_SHARE);
                ControlFlow::Continue(())
            });
            Self { disc: *disc, triangles }
        };
        let first = passage.map(count);
        first.into_iter().chain(straits.found.discs().par_iter().map(count).collect::<Vec<_>>()).collect()
    }
}

/// Returns the share of a segment that is in a triangle.
fn share_within([a, b, c]: [DVec2; 3], from: DVec2, to: DVec2) -> f64 {
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    let side = (b - a).perp_dot(c - a).signum();
    for (start, end) in [(a, b), (b, c), (c, a)] {
        let inside = |at: DVec2| side * (end - start).perp_dot(at - start);
        let (first, last) = (inside(from), inside(to));
        let crossing = first / (first - last);
        match (first > 0.0, last > 0.0) {
            (true, true) => {}
            (false, false) => return 0.0,
            (false, true) => enters = enters.max(crossing),
            (true, false) => leaves = leaves.min(crossing),
        }
    }
    leaves - enters
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    #[test]
    fn the_share_of_a_segment_in_a_triangle_is_that_of_points_along_it() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut point = || dvec2(random.f64(), random.f64());
        for _ in 0..2000 {
            let (corners, from, to) = ([point(), point(), point()], point(), point());
            let is_in = |at: DVec2| {
                let turns = [0, 1, 2].map(|n| {
                    let (a, b) = (corners[n], corners[(n + 1) % 3]);
                    (b - a).perp_dot(at - a) > 0.0
                });
                turns == [turns[0]; 3]
            };
            let steps = 4000;
            let inside =
                (0..steps).filter(|&n| is_in(from.lerp(to, (f64::from(n) + 0.5) / f64::from(steps))));
            let expected = inside.count() as f64 / f64::from(steps);
            let found = share_within(corners, from, to).max(0.0);
            assert!((found - expected).abs() < 1e-3, "{found} {expected}");
        }
    }
}
