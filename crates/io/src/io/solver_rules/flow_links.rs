//! Rules on flow links, from the centre of one cell of the file to that of the next.

use glam::DVec2;

use super::{BrokenPlace, WrittenMesh};
use meshbrush_core::cells::{CellLink, LARGEST_COSINE, LEAST_SHARE};
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

/// The least length of a connection for MODFLOW, as a share of the size of its cells: one this short has a
/// thousand times the conductance of its neighbours.
const LEAST_LENGTH: f64 = 1e-3;
/// The cosine between connection and edge above which a person should know: the share of the gradient along
/// the edge that MODFLOW takes for one across it.
const LARGEST_SHARE_ALONG: f64 = 0.1;

/// Finds connections whose length across the edge is 0 or nearly so.
pub(super) fn without_length(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    find(mesh, has_no_length, |link| {
        let (length, size) = (digits(across(link), 3), digits(link.size, 3));
        format!(
            "The centres of two cells are {length} apart across their edge, and the cells are {size} wide."
        )
    })
}

/// Finds other connections that do not cross their edge at a right angle.
pub(super) fn oblique(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let is_oblique = |link: &CellLink| link.cosine > LARGEST_SHARE_ALONG && !has_no_length(link);
    find(mesh, is_oblique, |link| {
        let cosine = fixed(link.cosine, 2);
        format!("A connection crosses its edge with the cosine {cosine}.")
    })
}

fn has_no_length(link: &CellLink) -> bool {
    across(link) < LEAST_LENGTH * link.size
}

/// Returns the length of a link across its edge.
fn across(link: &CellLink) -> f64 {
    link.length * (1.0 - link.cosine * link.cosine).max(0.0).sqrt()
}

/// Finds links, at the middles of the edges that they cross.
fn find(
    mesh: &WrittenMesh,
    is_broken: fn(&CellLink) -> bool,
    sentence: impl Fn(&CellLink) -> String,
) -> Vec<BrokenPlace> {
    let found = |link: &CellLink| {
        BrokenPlace::new(link.ends.map(|node| mesh.nodes[node]).iter().sum::<DVec2>() / 2.0, sentence(link))
    };
    mesh.links().iter().filter(|link| is_broken(link)).map(found).collect()
}
