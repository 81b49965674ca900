//! Why a march did not reach a goal.

use super::disjoint_sets::DisjointSets;
use super::path_mesh::{PathMesh, PathTriangle};
use super::place::MeshPlace;
use super::{Passage, PathError, Waypoint};

/// Returns why no path of finite cost leads between two places on a mesh.
pub(super) fn obstacle(mesh: &PathMesh, places: [MeshPlace; 2], [from, to]: [Waypoint; 2]) -> PathError {
    let mut open = parts(mesh, |triangle| triangle.passage == Passage::Open);
    let node = |place: MeshPlace| place.corner_nodes(mesh)[0] as usize;
    let [home, aim] = places.map(|place| open.root(node(place)));
    if home == aim {
        return PathError::CostOutOfRange { at: places[0].point, value: f64::INFINITY };
    }
    let mut without_regions = parts(mesh, |triangle| triangle.is_passable() || triangle.is_kept_out);
    if without_regions.root(node(places[0])) != without_regions.root(node(places[1])) {
        return PathError::Apart { from, to };
    }
    let mut size = |part: usize| {
        let triangles = mesh.triangles.iter().filter(|triangle| triangle.passage == Passage::Open);
        triangles.filter(|triangle| open.root(triangle.corners[0] as usize) == part).count()
    };
    let which = if size(home) < size(aim) { from } else { to };
    PathError::Enclosed { which, from, to }
}

/// Returns the connected components of the nodes, joined by the triangles that count.
pub(super) fn parts(mesh: &PathMesh, counts: impl Fn(&PathTriangle) -> bool) -> DisjointSets {
    let mut parts = DisjointSets::new(mesh.nodes.len());
    for triangle in mesh.triangles.iter().filter(|triangle| counts(triangle)) {
        let [a, b, c] = triangle.corners.map(|node| node as usize);
        parts.join(a, b);
        parts.join(b, c);
    }
    parts
}
