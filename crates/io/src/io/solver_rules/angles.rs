//! Rules on the angles of triangles.

use super::{BrokenPlace, WrittenMesh};
use meshbrush_mesh::text::fixed;

/// The least cosine of an angle for SWAN: 143.13°.
const LEAST_COSINE: f64 = -0.8;

/// Finds triangles with an angle of more than 143.13° in the coordinates of the file.
pub(super) fn obtuse(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let found = |triangle: usize| {
        let corners = mesh.corners(triangle);
        let cosines = [0, 1, 2].map(|k| {
            let (p, q) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
            p.dot(q) / (p.length() * q.length())
        });
        let cosine = cosines.into_iter().fold(1.0, f64::min);
        let angle = fixed(libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees(), 1);
        let largest = fixed(libm::acos(LEAST_COSINE).to_degrees(), 2);
        (cosine < LEAST_COSINE).then(|| {
            BrokenPlace::new(
                mesh.middle(triangle),
                format!("Triangle {} has an angle of {angle}°, and {largest}° are the most.", triangle + 1),
            )
        })
    };
    (0..mesh.triangles.len()).filter_map(found).collect()
}
