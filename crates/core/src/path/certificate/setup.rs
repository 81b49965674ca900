//! The mesh that the certificate starts with, and the triangles that count.

use glam::DVec2;

use super::task::{CertificateTask, Placement};
use super::triangle::FlatTriangle;
use crate::mesh::{Limits, Mesh, TriangleId};
use crate::path::disjoint_sets::DisjointSets;
use crate::path::{PathError, Waypoint};

/// The largest triangles on the path, as a part of the domain's longer side.
const LARGEST: f64 = 1.0 / 32.0;
/// The diameter of other triangles, as a part of their distance from the path.
const GRADING: f64 = 0.7;

/// A point this far outside a triangle, as a part of its height, counts as on its edge.
const TOUCHES: f64 = 1e-9;

/// Returns a mesh that is finer near the path.
pub(super) fn graded_mesh(task: &CertificateTask) -> Result<Mesh, PathError> {
    let limits = Limits { max_triangles: 8 * task.most_nodes, ..Limits::default() };
    let too_fine = |_| PathError::TooLarge { limit: task.most_nodes };
    let mut mesh = Mesh::coarse_grid(&task.lattice, |_| true, &limits).map_err(too_fine)?;
    let largest = LARGEST * task.lattice.bounds().size().max_element();
    let graded = mesh.refine(&limits, |element| {
        let diameter = element.diameter();
        if diameter <= largest {
            return false;
        }
        let centroid = FlatTriangle::new(element.world_corners()).centroid();
        diameter > GRADING * distance_from(&task.path, centroid)
    });
    graded.map_err(|_| PathError::TooLarge { limit: task.most_nodes })?;
    Ok(mesh)
}

/// Returns the distance of a point from a polyline of at least one point.
pub(super) fn distance_from(path: &[DVec2], point: DVec2) -> f64 {
    let from_segment = |pair: &[DVec2]| {
        let along = pair[1] - pair[0];
        let length_squared = along.length_squared().max(f64::MIN_POSITIVE);
        let share = ((point - pair[0]).dot(along) / length_squared).clamp(0.0, 1.0);
        point.distance(pair[0] + share * along)
    };
    path.windows(2).map(from_segment).fold(f64::INFINITY, f64::min)
}

/// The triangles that a path from the start can reach, over edges or nodes.
pub(super) struct ReachableTriangles {
    pub triangles: Vec<TriangleId>,
    /// For each of them whether the boundary may pass through it.
    pub cut: Vec<bool>,
    /// The place of the start's triangle among them.
    pub start: usize,
    /// The place of the goal's triangle among them.
    pub goal: usize,
}

/// Finds the triangles that are not wholly outside and belong together with the start's.
pub(super) fn reachable(mesh: &Mesh, task: &CertificateTask) -> Result<ReachableTriangles, PathError> {
    let placements: Vec<Placement> = mesh.raw_elements().map(|element| (task.placement)(&element)).collect();
    let mut parts = DisjointSets::new(mesh.raw_nodes().len());
    for (triangle, placement) in mesh.raw_triangles().iter().zip(&placements) {
        if *placement != Placement::Outside {
            let [a, b, c] = triangle.vertices.map(|node| node.index());
            parts.join(a, b);
            parts.join(b, c);
        }
    }
    let is_kept = |id: TriangleId| placements[id.index()] != Placement::Outside;
    let find = |which, at| {
        // On a boundary, another triangle than the one found may belong to the domain.
        let touches = |&id: &TriangleId| {
            is_kept(id)
                && FlatTriangle::new(mesh.world_corners(id)).barycentric(at).iter().all(|&s| s >= -TOUCHES)
        };
        let found = mesh.locate(at).triangle().filter(|&id| is_kept(id));
        let found = found.or_else(|| (0..placements.len()).map(TriangleId::from_index).find(touches));
        found.ok_or(PathError::BeyondOutline { which, at })
    };
    let start = find(Waypoint::Start, task.start())?;
    let goal = find(Waypoint::Goal, task.goal())?;
    let mut part_of = |id: TriangleId| parts.root(mesh.triangle(id).vertices[0].index());
    let home = part_of(start);
    let triangles: Vec<TriangleId> = (0..placements.len())
        .filter(|&index| placements[index] != Placement::Outside)
        .map(TriangleId::from_index)
        .filter(|&id| part_of(id) == home)
        .collect();
    let place = |id: TriangleId| triangles.binary_search(&id).ok();
    let (Some(start), Some(goal)) = (place(start), place(goal)) else {
        return Err(PathError::Apart { from: Waypoint::Start, to: Waypoint::Goal });
    };
    let cut = triangles.iter().map(|id| placements[id.index()] == Placement::Cut).collect();
    Ok(ReachableTriangles { triangles, cut, start, goal })
}
