//! Decides which nodes move onto the outline, and to which points.

use rayon::prelude::*;

use super::angles::Angles;
use super::band::{Band, GRAIN};
use crate::domain::RegionOnLattice;
use crate::geometry::{Lattice, LatticePoint};

/// The side of the outline on which a node lies, after the nodes nearest to it have moved onto it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OutlineSide {
    Inside,
    Outside,
    /// On the outline, or moving onto it.
    On,
}

impl OutlineSide {
    pub(super) fn from_inside(inside: bool) -> Self {
        if inside { Self::Inside } else { Self::Outside }
    }
}

/// The points where the outline crosses the edges of the band, one for each edge between a node inside and
/// one outside.
pub(super) struct Crossings {
    /// For each triangle and corner, the crossing of the opposite edge, as a share of its length from its
    /// first end, anticlockwise; NaN if the ends lie on the same side.
    shares: Vec<[f64; 3]>,
    extent: LatticePoint,
}

impl Crossings {
    pub(super) fn new(band: &Band, region: &RegionOnLattice, lattice: &Lattice) -> Self {
        let triangles = (0..band.triangles.len() as u32).into_par_iter().with_min_len(GRAIN);
        let found = triangles.map(|t| [0, 1, 2].map(|i| Self::of_first_owner(band, region, t, i)));
        let mut shares: Vec<[f64; 3]> = found.collect();
        for t in 0..shares.len() {
            for i in 0..3 {
                let across = band.triangles.across[t][i];
                if across < t as u32 {
                    let j = band.triangles.across[across as usize].iter().position(|&n| n == t as u32);
                    shares[t][i] = 1.0 - shares[across as usize][j.expect("neighbours know each other")];
                }
            }
        }
        Self { shares, extent: lattice.extent() }
    }

    /// Returns the crossing of the edge opposite the i-th corner of a triangle, if it has nodes on both sides
    /// and is not the edge of a triangle with a lower number; otherwise NaN.
    fn of_first_owner(band: &Band, region: &RegionOnLattice, triangle: u32, i: usize) -> f64 {
        let [_, from, to] = band.triangles.starting_at(triangle, i).map(|v| v as usize);
        if band.inside[from] == band.inside[to] || band.triangles.across[triangle as usize][i] < triangle {
            return f64::NAN;
        }
        let [p, q] = [from, to].map(|v| band.points[v]);
        match band.inside[from] {
            true => region.middle_crossing(p, q),
            false => 1.0 - region.middle_crossing(q, p),
        }
    }

    /// Returns the crossing of the edge opposite the i-th corner of a triangle, as a share of its length from
    /// the end `node`; NaN if there is none.
    fn share_from(&self, band: &Band, node: u32, (triangle, i): (u32, usize)) -> f64 {
        let [_, from, _] = band.triangles.starting_at(triangle, i);
        let share = self.shares[triangle as usize][i];
        if from == node { share } else { 1.0 - share }
    }

    /// Returns the crossing of the edge opposite the i-th corner of a triangle as a lattice point.
    pub(super) fn point(&self, band: &Band, triangle: u32, i: usize) -> LatticePoint {
        let [_, from, to] = band.starting_at(triangle, i, &band.points).map(LatticePoint::as_dvec2);
        rounded(from + self.shares[triangle as usize][i] * (to - from), self.extent)
    }
}

/// Returns the lattice point nearest to real lattice coordinates.
pub(super) fn rounded(p: glam::DVec2, extent: LatticePoint) -> LatticePoint {
    let p = (p + 0.5).floor().clamp(glam::DVec2::ZERO, extent.as_dvec2());
    LatticePoint::new(p.x as u32, p.y as u32)
}

/// The link of a node: the edges at it, anticlockwise.
struct Link {
    /// The nodes at the other ends.
    nodes: Vec<u32>,
    /// Triangle and corner opposite each edge.
    edges: Vec<(u32, usize)>,
    closed: bool,
}

impl Link {
    fn new(band: &Band, node: u32, star: &mut Vec<(u32, usize)>) -> Self {
        band.triangles.star(node, star);
        let mut link = Self { nodes: Vec::new(), edges: Vec::new(), closed: false };
        for &(t, i) in star.iter() {
            let [_, right, _] = band.triangles.starting_at(t, i);
            link.nodes.push(right);
            link.edges.push((t, (i + 2) % 3));
        }
        let (last, i) = *star.last().expect("the node is in the band");
        let [_, _, left] = band.triangles.starting_at(last, i);
        link.closed = left == link.nodes[0];
        if !link.closed {
            link.nodes.push(left);
            link.edges.push((last, (i + 1) % 3));
        }
        link
    }

    /// Returns whether the nodes inside follow one another, and so do the nodes outside. The area beyond the
    /// frame is outside.
    fn is_divided_once(&self, band: &Band) -> bool {
        let beyond = (!self.closed).then_some(false);
        let signs: Vec<bool> = self.nodes.iter().map(|&v| band.inside[v as usize]).chain(beyond).collect();
        let changes = (0..signs.len()).filter(|&k| signs[k] != signs[(k + 1) % signs.len()]);
        changes.count() == 2
    }

    /// Returns whether the node may move along its k-th edge. A node on the frame moves along the frame,
    /// except where the domain does not reach the frame on either side of it.
    fn admits(&self, band: &Band, crossings: &Crossings, node: u32, k: usize) -> bool {
        let last = self.nodes.len() - 1;
        // The outline may touch the frame in the neighbour only.
        let touches = |k: usize| crossings.share_from(band, node, self.edges[k]) == 1.0;
        let reaches = |k: usize| band.inside[self.nodes[k] as usize] && !touches(k);
        self.closed || k == 0 || k == last || !(reaches(0) || reaches(last))
    }
}

/// Returns the side and the goal of each node of the band. A node moves if the outline crosses an edge of it
/// nearer to it than to the other end: to the nearest such crossing, all nodes at once. It moves only if the
/// outline passes between the nodes around it once.
pub(super) fn snapped(
    band: &Band,
    crossings: &Crossings,
    angles: &Angles,
) -> (Vec<OutlineSide>, Vec<LatticePoint>) {
    let nodes = (0..band.points.len() as u32).into_par_iter().with_min_len(GRAIN);
    let placed = nodes.map_init(Vec::new, |star, v| {
        let (side, home) = (OutlineSide::from_inside(band.inside[v as usize]), band.points[v as usize]);
        if !band.active[v as usize] {
            return (side, home);
        }
        let link = Link::new(band, v, star);
        let goal = if link.is_divided_once(band) {
            nearest_crossing(band, crossings, angles, v, &link)
        } else {
            None
        };
        goal.map_or((side, home), |goal| (OutlineSide::On, goal))
    });
    placed.unzip()
}

fn nearest_crossing(
    band: &Band,
    crossings: &Crossings,
    angles: &Angles,
    node: u32,
    link: &Link,
) -> Option<LatticePoint> {
    let home = band.points[node as usize];
    let mut nearest: Option<(f64, LatticePoint)> = None;
    for (k, &(t, i)) in link.edges.iter().enumerate() {
        let share = crossings.share_from(band, node, (t, i));
        // Comparisons with NaN are false.
        let is_near = share < 0.5;
        if !is_near || !(share == 0.0 || link.admits(band, crossings, node, k)) {
            continue;
        }
        let point = crossings.point(band, t, i);
        let distance = angles.vector(home, point).length();
        if nearest.is_none_or(|(d, other)| (distance, point) < (d, other)) {
            nearest = Some((distance, point));
        }
    }
    let goal = nearest?.1;
    // The corners of the frame stay, where the domain has a side of the frame beside them.
    let is_corner = !link.closed && {
        let (a, b) = (band.points[link.nodes[0] as usize], band.points[*link.nodes.last()? as usize]);
        a.x != b.x && a.y != b.y
    };
    let stays = is_corner && band.inside[node as usize];
    (!stays || goal == home).then_some(goal)
}
