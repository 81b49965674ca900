//! The lines around a corridor.

use std::collections::BTreeMap;

use glam::DVec2;

use super::path_mesh::{NONE, PathMesh};
use super::{Corridor, Passage};

/// A point of the outline: a node (twice), or the crossing on the edge from an inner node to an outer one.
type OutlinePoint = [u32; 2];

/// A piece of the outline, with the corridor to its left.
type OutlinePiece = [(OutlinePoint, DVec2); 2];

impl Corridor {
    /// Returns the closed lines around the corridor of `share`, in world units. The last point of each equals
    /// the first, and the corridor is to the left.
    ///
    /// They are the contours of the excess, which is linear on each triangle, and parts of the boundary of
    /// the open triangles.
    pub fn outlines(&self, mesh: &PathMesh, share: f64) -> Vec<Vec<DVec2>> {
        let mut pieces: Vec<OutlinePiece> = Vec::new();
        for t in (0..mesh.triangle_count() as u32).filter(|&t| mesh.passage(t) == Passage::Open) {
            self.add_pieces(mesh, t, share, &mut pieces);
        }
        chained(&pieces)
    }

    /// Adds the pieces of the outline in a triangle.
    fn add_pieces(&self, mesh: &PathMesh, t: u32, share: f64, pieces: &mut Vec<OutlinePiece>) {
        let corners = mesh.triangles[t as usize].corners;
        let is_inside = corners.map(|node| self.excess()[node as usize] <= share);
        if is_inside == [false; 3] {
            return;
        }
        let node = |k: usize| ([corners[k]; 2], mesh.nodes[corners[k] as usize]);
        let (mut exit, mut entry) = (None, None);
        for k in 0..3 {
            let next = (k + 1) % 3;
            let across = mesh.across[t as usize][k];
            let is_rim = across == NONE || mesh.passage(across) != Passage::Open;
            let along = match (is_inside[k], is_inside[next]) {
                (true, true) => [node(k), node(next)],
                (true, false) => {
                    let out = self.crossing(mesh, corners[k], corners[next], share);
                    exit = Some(out);
                    [node(k), out]
                }
                (false, true) => {
                    let back = self.crossing(mesh, corners[next], corners[k], share);
                    entry = Some(back);
                    [back, node(next)]
                }
                (false, false) => continue,
            };
            if is_rim {
                pieces.push(along);
            }
        }
        if let (Some(exit), Some(entry)) = (exit, entry) {
            pieces.push([exit, entry]);
        }
    }

    /// Returns where the excess is `share` on the edge from an inner node to an outer one.
    fn crossing(&self, mesh: &PathMesh, inner: u32, outer: u32, share: f64) -> (OutlinePoint, DVec2) {
        let [low, high] = [inner, outer].map(|node| self.excess()[node as usize]);
        let [from, to] = [inner, outer].map(|node| mesh.nodes[node as usize]);
        ([inner, outer], from.lerp(to, (share - low) / (high - low)))
    }
}

/// Joins pieces to closed lines.
fn chained(pieces: &[OutlinePiece]) -> Vec<Vec<DVec2>> {
    let mut from: BTreeMap<OutlinePoint, Vec<usize>> = BTreeMap::new();
    for (number, [(start, _), _]) in pieces.iter().enumerate() {
        from.entry(*start).or_default().push(number);
    }
    let mut lines = Vec::new();
    while let Some((&start, _)) = from.first_key_value() {
        let mut line = Vec::new();
        let mut at = start;
        while let Some(number) = from.get_mut(&at).and_then(Vec::pop) {
            if from.get(&at).is_some_and(Vec::is_empty) {
                from.remove(&at);
            }
            let [(_, point), (end, last)] = pieces[number];
            if line.is_empty() {
                line.push(point);
            }
            line.push(last);
            at = end;
        }
        lines.push(line);
    }
    lines
}
