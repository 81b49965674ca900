//! Rules on flow links, from the centre of one cell of the file to that of the next.

use glam::DVec2;

use super::{BrokenPlace, WrittenMesh};
use meshbrush_core::cells::{CellLink, CellNodes, LARGEST_COSINE, LEAST_SHARE};
use meshbrush_mesh::text::{digits, fixed};

/// Finds links that the solver removes, so that no water crosses them.
pub(super) fn short(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    find(mesh, CellLink::is_short, |link| {
        let (length, least) = (digits(link.length, 3), digits(LEAST_SHARE * link.size, 3));
        format!("The centres of two cells are {length} apart, and links of less than {least} are removed.")
    })
}

/// Finds links that do not cross their edge at a right angle, by far.
pub(super) fn skewed(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    find(mesh, CellLink::is_skewed, |link| {
        let cosine = fixed(link.cosine, 2);
        format!("A link crosses its edge with the cosine {cosine}, and {LARGEST_COSINE} is the largest.")
    })
}

/// Finds links, at the middles of the edges that they cross.
fn find(
    mesh: &WrittenMesh,
    is_broken: fn(&CellLink) -> bool,
    sentence: impl Fn(&CellLink) -> String,
) -> Vec<BrokenPlace> {
    let nodes = CellNodes { nodes: &mesh.nodes, triangles: &mesh.triangles, unit: mesh.unit };
    let found = |link: &CellLink| BrokenPlace {
        place: link.ends.map(|node| mesh.nodes[node]).iter().sum::<DVec2>() / 2.0,
        sentence: sentence(link),
    };
    mesh.cells().links(nodes).iter().filter(|link| is_broken(link)).map(found).collect()
}
