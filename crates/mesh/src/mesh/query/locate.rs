//! Point location by walking: Algorithms 14 and 15, with exact orientation tests and a typed answer.

use std::cmp::Ordering;

use glam::DVec2;

use crate::geometry::{Side, exact_sum_sign};
use crate::mesh::kernel::{Mesh, NodeId, TriangleId, WalkEnd};

/// The location of a point in a mesh.
///
/// A point on an edge or a vertex belongs to several triangles; the location has the one with the lowest
/// index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// Strictly inside a triangle.
    Inside {
        /// That triangle.
        triangle: TriangleId,
    },
    /// The point is on an edge, but not at its ends.
    OnEdge {
        /// The triangle with the lowest index among the one or two that share the edge.
        triangle: TriangleId,
        /// Which edge of it: 0 is the bisection edge, then anticlockwise.
        edge: usize,
    },
    /// The point is a node.
    OnVertex {
        /// The triangle with the lowest index among those around the node.
        triangle: TriangleId,
        /// The node.
        node: NodeId,
    },
    /// Beyond the rectangle that the coarse grid covers.
    OutsideBounds,
    /// Within that rectangle, but where no triangle was kept, or only one outside the domain.
    OutsideDomain,
    /// A coordinate is NaN.
    Invalid,
}

impl Location {
    /// Returns the triangle found, if any.
    pub fn triangle(&self) -> Option<TriangleId> {
        match *self {
            Self::Inside { triangle } | Self::OnEdge { triangle, .. } | Self::OnVertex { triangle, .. } => {
                Some(triangle)
            }
            Self::OutsideBounds | Self::OutsideDomain | Self::Invalid => None,
        }
    }
}

impl Mesh {
    /// Finds the triangle that contains a point in world coordinates (Algorithm 15).
    ///
    /// The answer is exact for the point's lattice coordinates
    /// ([`Lattice::lattice_from_world`](crate::geometry::Lattice::lattice_from_world)). The walk starts in a
    /// descendant of the coarse triangle around the point (Algorithm 14) and never leaves that coarse
    /// triangle, as no edge on its rim has the point strictly beyond: holes cannot trap it.
    pub fn locate(&self, point: DVec2) -> Location {
        let p = match self.point_on_lattice(point) {
            Ok(p) => p,
            Err(nowhere) => return nowhere,
        };
        self.coarse_numbers_round(p)
            .filter_map(|number| self.coarse.get(number))
            .map(|start| self.found_from(start, p, |_| {}).1)
            .filter(|found| *found != Location::OutsideDomain)
            .min_by_key(Location::triangle)
            .unwrap_or(Location::OutsideDomain)
    }

    /// Returns the lattice coordinates of a point in world coordinates, or why no triangle can contain it.
    fn point_on_lattice(&self, point: DVec2) -> Result<DVec2, Location> {
        let p = self.lattice.lattice_from_world(point);
        if p.is_nan() {
            return Err(Location::Invalid);
        }
        let extent = self.lattice.extent().as_dvec2();
        let is_within = p.cmpge(DVec2::ZERO).all() && p.cmple(extent).all();
        if is_within { Ok(p) } else { Err(Location::OutsideBounds) }
    }

    /// Walks from `start` to `p`, both in the same coarse triangle, through the triangles visited. Returns
    /// the triangle in which the walk ends, and where it finds the point.
    #[inline]
    fn found_from(
        &self,
        start: TriangleId,
        p: DVec2,
        visit: impl FnMut(TriangleId),
    ) -> (TriangleId, Location) {
        match self.walk_through(start, p, visit) {
            WalkEnd::Found(id, sides) => (id, self.lowest_round(id, sides)),
            WalkEnd::Blocked => unreachable!("the walk stays in the coarse triangle that it starts in"),
        }
    }

    /// Returns the triangles through which [`Self::locate`] finds a point in world coordinates, from the
    /// triangle of the bucket to the answer (Algorithm 15). Consecutive triangles are neighbours. Empty where
    /// no triangle of the domain contains the point.
    ///
    /// If the point is on an edge or a vertex, the walk ends in any triangle around it; the last triangles
    /// then lead to the one in the answer.
    pub fn walk_path(&self, point: DVec2) -> Vec<TriangleId> {
        let Ok(p) = self.point_on_lattice(point) else { return Vec::new() };
        let starts = self.coarse_numbers_round(p).filter_map(|number| self.coarse.get(number));
        let found = starts.filter_map(|start| {
            let (end, location) = self.found_from(start, p, |_| {});
            Some((location.triangle()?, start, end, location))
        });
        let Some((answer, start, end, location)) = found.min_by_key(|(answer, ..)| *answer) else {
            return Vec::new();
        };
        let mut path = Vec::new();
        self.walk_through(start, p, |id| path.push(id));
        match location {
            Location::OnVertex { node, .. } => path.extend(self.turns_between(node, end, answer)),
            _ if end != answer => path.push(answer),
            _ => {}
        }
        path
    }

    /// Returns the triangles around `node` from `from` to `to`, without the first.
    fn turns_between(&self, node: NodeId, from: TriangleId, to: TriangleId) -> Vec<TriangleId> {
        let (mut turns, mut last) = (Vec::new(), from);
        for id in self.raw_triangles_around(node, from).skip(1) {
            if last == to {
                break;
            }
            // At the boundary of the grid, the triangles on the other side of the first one follow.
            if !self.triangle(last).raw_neighbours.iter().any(|across| across.triangle() == Some(id)) {
                turns.clear();
            }
            turns.push(id);
            last = id;
        }
        turns
    }

    /// Returns the mean number of steps from triangle to triangle in which [`Self::locate`] finds a point of
    /// the domain, over about `count` points that are spread evenly. Zero where none is in the domain.
    pub fn mean_walk_steps(&self, count: usize) -> f64 {
        let bounds = self.lattice.bounds();
        let mut shares = DVec2::ZERO;
        let (mut steps, mut found) = (0, 0);
        for _ in 0..count {
            // The R2 sequence: powers of the root of x³ = x + 1.
            shares = (shares + DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_3)).fract();
            let path = self.walk_path(bounds.min + shares * bounds.size());
            steps += path.len().saturating_sub(1);
            found += usize::from(!path.is_empty());
        }
        if found > 0 { steps as f64 / found as f64 } else { 0.0 }
    }

    /// Returns the most steps that Algorithm 15 takes: 2 to the power of the deepest level.
    pub fn walk_bound(&self) -> f64 {
        let deepest = self.level_counts().len().saturating_sub(1);
        (0..deepest).fold(1.0, |bound, _| 2.0 * bound)
    }

    /// Returns the coarse triangles that contain a point in lattice coordinates (Algorithm 14): one, or up to
    /// six around a coarse node.
    fn coarse_numbers_round(&self, p: DVec2) -> impl Iterator<Item = usize> {
        let [columns, rows] = self.lattice.cells();
        let steps = f64::from(self.lattice.cell_steps());
        let (cell_x, cell_y) = (p.x / steps, p.y / steps); // a power of two: exact
        let across = closed_cells(cell_x, columns);
        closed_cells(cell_y, rows).flat_map(move |row| {
            across.clone().flat_map(move |column| {
                let below = 2 * (row as usize * columns as usize + column as usize);
                match exact_sum_sign(cell_x, cell_y, f64::from(column + row + 1)) {
                    Ordering::Less => below..=below,
                    Ordering::Equal => below..=below + 1,
                    Ordering::Greater => below + 1..=below + 1,
                }
            })
        })
    }

    /// Returns the location of a point that was found in triangle `id`, on the given sides of its edges. On
    /// an edge or vertex it has the triangle around it with the lowest index in the domain.
    pub(super) fn lowest_round(&self, id: TriangleId, sides: [Side; 3]) -> Location {
        let triangle = self.triangle(id);
        let on = sides.map(|side| side == Side::On);
        match on.iter().filter(|&&on| on).count() {
            0 if triangle.is_outside() => Location::OutsideDomain,
            0 => Location::Inside { triangle: id },
            1 => {
                let edge = on.iter().position(|&on| on).unwrap_or(0);
                let both = [Some(id), triangle.raw_neighbours[edge].triangle()];
                match both.into_iter().flatten().filter(|&id| self.is_in_domain(id)).min() {
                    None => Location::OutsideDomain,
                    Some(lowest) if lowest == id => Location::OnEdge { triangle: id, edge },
                    Some(across) => {
                        Location::OnEdge { triangle: across, edge: self.edge_towards(across, id) }
                    }
                }
            }
            _ => {
                // Two of three edges anticlockwise: the first of them ends in the vertex that they share.
                let first = (0..3).find(|&j| on[j] && on[(j + 1) % 3]).unwrap_or(0);
                let node = triangle.edge_nodes()[first].1;
                let lowest = self.raw_triangles_around(node, id).filter(|&id| self.is_in_domain(id)).min();
                lowest.map_or(Location::OutsideDomain, |triangle| Location::OnVertex { triangle, node })
            }
        }
    }

    /// Returns the place of the edge of `id` that it shares with `across`.
    pub(super) fn edge_towards(&self, id: TriangleId, across: TriangleId) -> usize {
        let found = self.triangle(id).raw_neighbours.iter().position(|n| n.triangle() == Some(across));
        found.expect("neighbours are symmetric (invariant 3)")
    }
}

/// Returns cells of a row of `count` whose closure contains `x`, measured in cells: one, or two where `x` is
/// a whole number.
fn closed_cells(x: f64, count: u32) -> std::ops::RangeInclusive<u32> {
    let cell = x.floor();
    let last = (cell as u32).min(count - 1);
    let first = if cell == x && cell > 0.0 { cell as u32 - 1 } else { last };
    first..=last
}
