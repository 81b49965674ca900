//! Rules on the boundary and its strings.

use glam::DVec2;

use super::{BrokenPlace, WrittenMesh, WrittenString};
use meshbrush_core::domain::signed_area;

/// The largest sum of FVCOM's numbers of the nodes of a triangle: 0 inside, 1 at a solid boundary, 2 at an
/// open one.
const LARGEST_SUM: usize = 4;
/// The most edges of a hole that MeshKernel and D-Flow FM take for a cell.
const MOST_EDGES_OF_CELL: usize = 6;

/// Finds nodes in which the boundary touches itself.
pub(super) fn touching(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let mut leaving = vec![0_u32; mesh.nodes.len()];
    mesh.boundary().iter().for_each(|edge| leaving[edge[0]] += 1);
    let found = |node: usize| {
        let sentence = format!("The boundary touches itself in node {}.", node + 1);
        BrokenPlace::new(mesh.nodes[node], sentence)
    };
    (0..leaving.len()).filter(|&node| leaving[node] > 1).map(found).collect()
}

/// Finds nodes that are in the list of open nodes more than once.
pub(super) fn open_nodes_twice(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let mut times = vec![0_usize; mesh.nodes.len()];
    mesh.strings.iter().filter(|string| string.is_open).flat_map(|string| &string.nodes).for_each(|&node| {
        times[node] += 1;
    });
    let found = |node: usize| {
        let sentence = format!("Node {} is {} times in the list of open nodes.", node + 1, times[node]);
        BrokenPlace::new(mesh.nodes[node], sentence)
    };
    (0..times.len()).filter(|&node| times[node] > 1).map(found).collect()
}

/// Finds open strings without an edge.
pub(super) fn short_open_strings(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    strings(mesh, |string| string.is_open && string.nodes.len() < 2)
}

/// Finds strings of one edge.
pub(super) fn strings_of_two_nodes(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    strings(mesh, |string| string.nodes.len() == 2)
}

/// Finds strings, with their number of nodes. Smaller triangles along one give it more.
fn strings(mesh: &WrittenMesh, is_broken: impl Fn(&WrittenString) -> bool) -> Vec<BrokenPlace> {
    let found = |string: &WrittenString| {
        let (kind, count) = (if string.is_open { "open boundary" } else { "boundary" }, string.nodes.len());
        let nodes = if count == 1 { "node" } else { "nodes" };
        let sentence = format!("The {kind} “{}” has {count} {nodes}.", string.name);
        let place = mesh.nodes[*string.nodes.first()?];
        Some(BrokenPlace::new(place, sentence).mended_in(mesh.triangles_along(&string.nodes)))
    };
    mesh.strings.iter().filter(|string| is_broken(string)).filter_map(found).collect()
}

/// Finds open pieces that vanish where nodes are marked instead of edges.
pub(super) fn lost_open_pieces(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let found = |(node, name): &(usize, String)| {
        let sentence = format!(
            "No edge would be left of the open boundary “{name}”, which lies beside land of one edge."
        );
        BrokenPlace::new(mesh.nodes[*node], sentence).mended_in(mesh.triangles_along(&[*node]))
    };
    mesh.lost_open.iter().map(found).collect()
}

/// Finds triangles with two open nodes and a third node on the boundary.
pub(super) fn two_open_nodes_and_shore(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let number = |node: usize| usize::from(mesh.is_on_boundary(node)) + usize::from(mesh.is_open[node]);
    let sum = |triangle: usize| mesh.triangles[triangle].map(number).iter().sum::<usize>();
    let found = |triangle| {
        let sentence = format!(
            "Triangle {} has two open nodes, and its third node is on the boundary, too: the sum over its nodes is {}, and \
             may be {LARGEST_SUM}.",
            triangle + 1,
            sum(triangle)
        );
        BrokenPlace::new(mesh.middle(triangle), sentence).mended_in(vec![triangle])
    };
    (0..mesh.triangles.len()).filter(|&triangle| sum(triangle) > LARGEST_SUM).map(found).collect()
}

/// Finds triangles all nodes of which are on the boundary.
pub(super) fn overconstrained(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let mut edges_of: Vec<[usize; 2]> = mesh.boundary().to_vec();
    edges_of.sort_unstable();
    let on_boundary = |&[a, b, c]: &[usize; 3]| {
        let is_edge = |ends: &[usize; 2]| edges_of.binary_search(ends).is_ok();
        [[a, b], [b, c], [c, a]].iter().filter(|ends| is_edge(ends)).count()
    };
    let is_broken = |corners: &[usize; 3]| corners.iter().all(|&node| mesh.is_on_boundary(node));
    let found = |(triangle, corners): (usize, &[usize; 3])| {
        let which = match on_boundary(corners) {
            0 | 1 => "it reaches from one boundary to another",
            _ => "two of its edges are on the boundary, and TELEMAC names it",
        };
        let sentence = format!("All nodes of triangle {} are on the boundary: {which}.", triangle + 1);
        BrokenPlace::new(mesh.middle(triangle), sentence).mended_in(vec![triangle])
    };
    mesh.triangles.iter().enumerate().filter(|(_, corners)| is_broken(corners)).map(found).collect()
}

/// Finds islands with so few edges that they are taken for cells.
pub(super) fn islands_like_cells(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let is_island = |nodes: &Vec<usize>| {
        let corners: Vec<DVec2> = nodes.iter().map(|&node| mesh.nodes[node]).collect();
        nodes.len() <= MOST_EDGES_OF_CELL && signed_area(&corners) < 0.0
    };
    let found = |nodes: &Vec<usize>| {
        let sentence = format!("An island has {} edges, and its solver takes it for a cell.", nodes.len());
        BrokenPlace::new(mesh.nodes[nodes[0]], sentence).mended_in(mesh.triangles_along(nodes))
    };
    mesh.boundary_loops().iter().filter(|nodes| is_island(nodes)).map(found).collect()
}
