//! Nodes at which lines, or a line and the boundary, meet at a small angle.

use crate::geometry::NumberMap;
use crate::outline::angles::Angles;
use crate::outline::local::LocalMesh;
use crate::outline::triangulation::NONE;

/// Of the angle between two lines, the share that an angle of a triangle at their node has at least.
const SHARE: f64 = 0.8;

/// For each node at which lines meet at a small angle, the cotangent of the smallest angle that a triangle
/// there may have.
pub(super) struct SharpNodes {
    limits: NumberMap<u32, f64>,
}

impl SharpNodes {
    pub(super) fn new(local: &LocalMesh, angles: &Angles) -> Self {
        let mut nodes: Vec<u32> = local.fixed.keys().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let (mut limits, mut star) = (NumberMap::default(), Vec::new());
        for v in nodes {
            local.triangles.star(v, &mut star);
            let limit = smallest(local, angles, v, &star);
            if limit > angles.limit() {
                limits.insert(v, limit);
            }
        }
        Self { limits }
    }

    /// Returns the largest limit; 0 without any.
    pub(super) fn largest(&self) -> f64 {
        self.limits.values().copied().fold(0.0, f64::max)
    }

    /// Returns the limit at a node; 0 where lines do not meet at a small angle.
    pub(super) fn limit(&self, node: u32) -> f64 {
        self.limits.get(&node).copied().unwrap_or(0.0)
    }
}

/// Returns the limit for the smallest angle between edges at a node that lie on lines or on the boundary.
fn smallest(local: &LocalMesh, angles: &Angles, v: u32, star: &[(u32, usize)]) -> f64 {
    let at = local.points[v as usize];
    let mut ends = Vec::new();
    for &(t, i) in star {
        let [_, right, left] = local.triangles.starting_at(t, i);
        let across = local.triangles.across[t as usize];
        if across[(i + 2) % 3] == NONE || local.is_fixed(v, right) {
            ends.push(right);
        }
        if across[(i + 1) % 3] == NONE {
            ends.push(left);
        }
    }
    let closes = local.closes(star);
    let pairs = (0..ends.len()).filter(|&n| closes || n + 1 < ends.len());
    let mut limit = 0.0f64;
    for n in pairs.filter(|_| ends.len() > 1) {
        let [right, left] = [ends[n], ends[(n + 1) % ends.len()]].map(|w| local.points[w as usize]);
        let (a, b) = (angles.vector(at, right), angles.vector(at, left));
        let (sine, cosine) = (a.perp_dot(b), a.dot(b));
        if sine > 0.0 && cosine > angles.limit() * sine {
            limit = limit.max(1.0 / libm::tan(SHARE * libm::atan2(sine, cosine)));
        }
    }
    limit
}
