//! Open boundaries along which a coast runs so close that no more than two triangles are between them, and
//! the triangles to cut off there.
//!
//! ```text
//!   land ──────────────────     A strip: nodes of the open boundary that are two edges from land or closer,
//!    /\  /\  /\  /\  /\  /\     at least LEAST_STRIP in a row. Those within END edges of the string's ends
//!   open ──────────────────     are left out: every open boundary meets the land there.
//! ```

use std::ops::Range;

use glam::DVec2;
use meshbrush_mesh::text::{Grouped, Number};

use super::{BrokenPlace, WrittenMesh, WrittenString};

/// Nodes of an open boundary at each end of it that do not count as a strip.
const END: usize = 4;
/// The fewest nodes in a row of a strip along land.
const LEAST_STRIP: usize = 4;
/// The fewest nodes of an open boundary that stay between two cuts, or between a cut and its end.
const LEAST_REST: usize = 2 * END;

/// Finds strips between an open boundary and a coast.
pub(super) fn strips_along_frame(mesh: &WrittenMesh) -> Vec<BrokenPlace> {
    let is_near = near_land(mesh);
    let in_string = |string: &WrittenString| {
        let found = |nodes: Range<usize>| {
            let sentence = format!(
                "The open boundary “{}” runs along land over {} edges, with at most two triangles between them.",
                string.name,
                nodes.len() - 1
            );
            BrokenPlace::new(mesh.nodes[string.nodes[nodes.start + nodes.len() / 2]], sentence)
        };
        runs(string, &is_near).into_iter().map(found).collect::<Vec<_>>()
    };
    open_strings(mesh).flat_map(in_string).collect()
}

/// Triangles that are to be cut off, or why they cannot be.
pub(super) struct StripCut {
    /// A place in the strip.
    pub(super) place: DVec2,
    /// The triangles.
    pub(super) triangles: Result<Vec<usize>, String>,
}

/// Returns what is to be cut off so that no strip is left: the triangles between its nodes and the land, and
/// small parts that nothing else joins to the sea.
pub(super) fn strip_cuts(mesh: &WrittenMesh) -> Vec<StripCut> {
    let is_near = near_land(mesh);
    let neighbours = neighbours(mesh);
    let in_string = |string: &WrittenString| {
        let cut = |nodes: Range<usize>| {
            let nodes = &string.nodes[nodes];
            let triangles = with_small_parts(&neighbours, between(mesh, nodes), |it| mesh.middle(it));
            StripCut { place: mesh.nodes[nodes[nodes.len() / 2]], triangles }
        };
        joined(runs(string, &is_near), string.nodes.len()).into_iter().map(cut).collect::<Vec<_>>()
    };
    open_strings(mesh).flat_map(in_string).collect()
}

fn open_strings(mesh: &WrittenMesh) -> impl Iterator<Item = &WrittenString> {
    mesh.strings.iter().filter(|string| string.is_open)
}

/// Returns which nodes are on land.
fn on_land(mesh: &WrittenMesh) -> Vec<bool> {
    (0..mesh.nodes.len()).map(|node| mesh.is_on_boundary(node) && !mesh.is_open[node]).collect()
}

/// Returns which nodes are two edges from land or closer.
fn near_land(mesh: &WrittenMesh) -> Vec<bool> {
    mesh.beside(&mesh.beside(&on_land(mesh)))
}

/// Returns the strips of a string, as places in its list of nodes.
fn runs(string: &WrittenString, is_near: &[bool]) -> Vec<Range<usize>> {
    let end = string.nodes.len().saturating_sub(END).max(END.min(string.nodes.len()));
    let inner = string.nodes.get(END..end).unwrap_or_default();
    let mut start = END;
    let mut runs = Vec::new();
    for run in inner.chunk_by(|&a, &b| is_near[a] == is_near[b]) {
        if is_near[run[0]] && run.len() >= LEAST_STRIP {
            runs.push(start..start + run.len());
        }
        start += run.len();
    }
    runs
}

/// Joins strips so that no open boundary of a few nodes stays between two of them, or at an end.
fn joined(runs: Vec<Range<usize>>, nodes: usize) -> Vec<Range<usize>> {
    let mut joined: Vec<Range<usize>> = Vec::new();
    for run in runs {
        match joined.last_mut() {
            Some(last) if run.start - last.end < LEAST_REST => last.end = run.end,
            _ => joined.push(run),
        }
    }
    if let Some(first) = joined.first_mut().filter(|first| first.start < LEAST_REST) {
        first.start = 0;
    }
    if let Some(last) = joined.last_mut().filter(|last| nodes - last.end < LEAST_REST) {
        last.end = nodes;
    }
    joined
}

/// Returns the triangles at nodes of an open boundary, and those from there to the land.
///
/// ```text
///   land ───o─────o─────o──     The triangles at the chosen nodes ● reach to the nodes ○ beside them. The
///          / \   / \   / \      other triangles between ○ and land are cut off, too.
///   ○─────○─────○─────○
///    \   / \   / \   / \
///   ──●─────●─────●─────●─
/// ```
fn between(mesh: &WrittenMesh, chosen: &[usize]) -> Vec<usize> {
    let mut is_chosen = vec![false; mesh.nodes.len()];
    chosen.iter().for_each(|&node| is_chosen[node] = true);
    let is_beside = mesh.beside(&is_chosen);
    let is_land = on_land(mesh);
    let is_between = |corners: &[usize; 3]| {
        let touches = corners.iter().any(|&node| is_chosen[node]);
        let reaches = corners.iter().any(|&node| is_beside[node] && !is_land[node]);
        touches || (reaches && corners.iter().all(|&node| is_beside[node] || is_land[node]))
    };
    (0..mesh.triangles.len()).filter(|&triangle| is_between(&mesh.triangles[triangle])).collect()
}

/// Returns the triangles across the edges of each triangle.
fn neighbours(mesh: &WrittenMesh) -> Vec<Vec<usize>> {
    let sides = mesh.triangles.iter().enumerate().flat_map(|(triangle, &[a, b, c])| {
        [[a, b], [b, c], [c, a]].map(|[from, to]| ([from.min(to), from.max(to)], triangle))
    });
    let mut sides: Vec<([usize; 2], usize)> = sides.collect();
    sides.sort_unstable();
    let mut neighbours = vec![Vec::new(); mesh.triangles.len()];
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        neighbours[pair[0].1].push(pair[1].1);
        neighbours[pair[1].1].push(pair[0].1);
    }
    neighbours
}

/// Returns triangles to cut off, with those that only these join to the rest, as far as they are fewer.
///
/// # Errors
/// Fails with a sentence where a larger part would be parted from the rest.
fn with_small_parts(
    neighbours: &[Vec<usize>],
    mut cut: Vec<usize>,
    middle: impl Fn(usize) -> DVec2,
) -> Result<Vec<usize>, String> {
    let mut is_taken = vec![false; neighbours.len()];
    cut.iter().for_each(|&triangle| is_taken[triangle] = true);
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for &first in cut.iter().flat_map(|&triangle| &neighbours[triangle]) {
        if std::mem::replace(&mut is_taken[first], true) {
            continue;
        }
        let mut part = vec![first];
        let mut done = 0;
        while let Some(&triangle) = part.get(done) {
            done += 1;
            let fresh =
                neighbours[triangle].iter().filter(|&&it| !std::mem::replace(&mut is_taken[it], true));
            part.extend(fresh);
        }
        parts.push(part);
    }
    parts.sort_by_key(|part| std::cmp::Reverse(part.len()));
    let most = cut.len();
    match parts.get(1) {
        _ if parts.is_empty() => Err("nothing of the sea would be left".to_owned()),
        Some(part) if part.len() > most => {
            let at = middle(part[0]);
            Err(format!(
                "{} triangles around x = {}, y = {} would be parted from the sea. If they may go, too, add a ring of your \
                 own to `cut_off`",
                Grouped(part.len()),
                Number(at.x),
                Number(at.y)
            ))
        }
        _ => {
            cut.extend(parts.drain(1..).flatten());
            Ok(cut)
        }
    }
}
