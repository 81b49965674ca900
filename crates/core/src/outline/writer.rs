//! Writes what is derived into what is kept of it.

use super::changes::{FittedBand, PiecesByTriangle};
use super::follower::{KeptNode, KeptPiece, KeptTriangle, OutlineFollower, Seat};
use super::line::OutlineOnLattice;
use super::places::{node_place, triangle_place};
use super::triangulation::NONE;
use crate::mesh::Mesh;

/// Writes triangles of a band, with their nodes.
pub(super) struct Writer<'a> {
    mesh: &'a Mesh,
    fitted: &'a FittedBand,
    outline: &'a OutlineOnLattice<'a>,
    written: Written,
}

/// What a writer knows of a band, and which of its nodes are written.
pub(super) struct Written {
    pieces: PiecesByTriangle,
    acted: Vec<bool>,
    is_node_written: Vec<bool>,
    star: Vec<(u32, usize)>,
}

impl Written {
    /// None of them.
    pub(super) fn new(fitted: &FittedBand) -> Self {
        Self {
            pieces: PiecesByTriangle::new(&fitted.band, &fitted.patchwork),
            acted: fitted.acted(),
            is_node_written: vec![false; fitted.patchwork.points.len()],
            star: Vec::new(),
        }
    }
}

impl<'a> Writer<'a> {
    pub(super) fn new(mesh: &'a Mesh, fitted: &'a FittedBand, outline: &'a OutlineOnLattice<'a>) -> Self {
        Self::going_on(mesh, fitted, outline, Written::new(fitted))
    }

    /// Returns a writer that continues where another one for the same band ended.
    pub(super) fn going_on(
        mesh: &'a Mesh,
        fitted: &'a FittedBand,
        outline: &'a OutlineOnLattice<'a>,
        written: Written,
    ) -> Self {
        Self { mesh, fitted, outline, written }
    }

    /// Returns what another writer needs to go on.
    pub(super) fn into_written(self) -> Written {
        self.written
    }

    /// Writes a triangle of the band, and its nodes.
    pub(super) fn write(&mut self, follower: &mut OutlineFollower, triangle: u32) {
        let FittedBand { band, patchwork, placement, .. } = self.fitted;
        let home = |v: u32| node_place(self.fitted.home(v));
        let pieces =
            self.written.pieces.replacement(self.mesh, band, patchwork, &self.outline.angles, triangle);
        let of_pieces: Vec<u32> = pieces.iter().flatten().flat_map(|(_, corners)| *corners).collect();
        let kept_piece = |(piece, corners): (u32, [u32; 3])| KeptPiece {
            corners: corners.map(home),
            on_boundary: self.on_boundary(piece, corners),
        };
        let pieces = pieces.map(|pieces| pieces.into_iter().map(kept_piece).collect());
        let id = band.ids[triangle as usize];
        let corners = band.triangles.corners[triangle as usize];
        let seat = Seat {
            place: triangle_place(self.mesh.corners(id)),
            is_touched: band.is_touched[triangle as usize],
            is_beside: false,
        };
        follower.keep(id, KeptTriangle { id: Some(id), corners: corners.map(home), pieces, seat });
        let cuts = placement.cuts[triangle as usize];
        for v in corners.into_iter().chain(cuts).chain(of_pieces).filter(|&v| v != NONE) {
            self.write_node(follower, v);
        }
    }

    /// Returns whether the edges of a piece from each of these corners to the next are on the boundary.
    fn on_boundary(&self, piece: u32, corners: [u32; 3]) -> [bool; 3] {
        let FittedBand { band, patchwork, .. } = self.fitted;
        [0, 1, 2].map(|i| {
            let opposite = patchwork.triangles.place(piece, corners[(i + 2) % 3]);
            let across = patchwork.triangles.across[piece as usize][opposite];
            if across != NONE {
                return !patchwork.inside[across as usize];
            }
            // The frame is there, or the band ends: beside it, triangles lie on the side of their nodes.
            let ends = [corners[i], corners[(i + 1) % 3]].map(|v| band.node_ids.get(v as usize));
            let [Some(&from), Some(&to)] = ends else { return true };
            let is_across = |id| self.mesh.triangle(id).edge_nodes().contains(&(to, from));
            !self.mesh.all_triangles_around(from).any(is_across)
        })
    }

    fn write_node(&mut self, follower: &mut OutlineFollower, node: u32) {
        let v = node as usize;
        if std::mem::replace(&mut self.written.is_node_written[v], true) {
            return;
        }
        let FittedBand { patchwork, pins, .. } = self.fitted;
        let pin = pins.binary_search_by_key(&node, |pin| pin.node);
        let kept = KeptNode {
            home: self.fitted.home(node),
            at: patchwork.points[v],
            acts: self.written.acted.get(v).is_some_and(|&acts| acts),
            fit: self.fitted.fit_of(self.outline, node, &mut self.written.star),
            corner_limit: pin.map_or(0.0, |n| pins[n].limit),
        };
        follower.nodes.insert(node_place(kept.home), kept);
    }
}
