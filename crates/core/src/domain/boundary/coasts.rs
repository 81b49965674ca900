//! The coasts of a domain: its boundary without the parts across which water flows.

use glam::DVec2;

use super::super::{Domain, DomainShape};
use super::pieces::unindexed_pieces;
use super::{BoundaryMarks, BoundaryPiece, BoundaryType};

/// An edge of a coast, with the water on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoastEdge {
    /// Its ends, in the order of the ring.
    pub ends: [DVec2; 2],
    /// The number of its ring.
    pub ring: u32,
    /// The length of the ring up to the first end, in world units.
    pub along: f64,
    /// The number of the next edge, if the coast goes on.
    pub next: Option<u32>,
}

/// The coasts of a domain: its boundary without the open parts and the mouths of rivers.
#[derive(Clone, Debug, Default)]
pub struct Coasts {
    /// The edges, ring by ring.
    pub edges: Vec<CoastEdge>,
    /// The length of each ring, with its open parts, in world units.
    pub lengths: Vec<f64>,
}

impl Coasts {
    /// Returns the coasts of a domain; none of a domain that is given by a formula, or of a whole rectangle,
    /// unless a mark makes a side of it land.
    pub fn new(domain: &Domain, marks: &BoundaryMarks) -> Self {
        let lengths = lengths_of_rings(domain);
        let mut edges: Vec<CoastEdge> = Vec::new();
        for piece in coast_pieces(domain, marks) {
            let (ring, length) = (piece.place.ring, lengths[piece.place.ring as usize]);
            let mut along = piece.place.along;
            for ends in piece.points.windows(2).map(|ends| [ends[0], ends[1]]) {
                if along >= length {
                    along -= length;
                }
                edges.push(CoastEdge { ends, ring, along, next: None });
                along += ends[0].distance(ends[1]);
            }
        }
        edges.sort_by(|a, b| a.ring.cmp(&b.ring).then(a.along.total_cmp(&b.along)));
        let mut coasts = Self { edges, lengths };
        coasts.join();
        coasts
    }

    /// Finds the next edge of each.
    fn join(&mut self) {
        let mut first = 0;
        while first < self.edges.len() {
            let ring = self.edges[first].ring;
            let count = self.edges[first..].iter().take_while(|edge| edge.ring == ring).count();
            let of_ring = &mut self.edges[first..first + count];
            for n in 0..count {
                let next = (n + 1) % count;
                let meet = next != n && of_ring[n].ends[1] == of_ring[next].ends[0];
                of_ring[n].next = meet.then_some((first + next) as u32);
            }
            first += count;
        }
    }
}

/// Returns the coasts of a domain as polylines. None for a domain that is given by a formula.
pub fn coasts(domain: &Domain, marks: &BoundaryMarks) -> Vec<Vec<DVec2>> {
    coast_pieces(domain, marks).map(|piece| piece.points).collect()
}

/// Returns the pieces of the boundary that are land.
fn coast_pieces(domain: &Domain, marks: &BoundaryMarks) -> impl Iterator<Item = BoundaryPiece> {
    let is_land = |piece: &BoundaryPiece| !piece.boundary_type().lets_water_through();
    unindexed_pieces(domain, marks).into_iter().flatten().filter(is_land)
}

fn lengths_of_rings(domain: &Domain) -> Vec<f64> {
    let perimeter = |ring: &[DVec2]| -> f64 {
        ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum()
    };
    match &domain.shape {
        DomainShape::Whole => vec![2.0 * domain.bounds.size().element_sum()],
        DomainShape::Region(region) => region.rings().map(|ring| perimeter(ring)).collect(),
        DomainShape::Formula(_) => Vec::new(),
    }
}

impl BoundaryMarks {
    /// Returns the marks that decide where the coasts are, without names that do not matter for that.
    pub fn of_coasts(&self) -> Self {
        let decides = |name: &str| BoundaryType::from_name(name).is_some();
        // The first name of a piece counts, so that another one before it matters.
        let names =
            if self.names.iter().any(|(_, name)| decides(name)) { self.names.clone() } else { Vec::new() };
        match self.types.is_empty() && names.is_empty() {
            true => Self::default(),
            false => Self { splits: self.splits.clone(), names, types: self.types.clone() },
        }
    }
}
