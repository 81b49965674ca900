//! Finds crossings of the outline of a region with edges of the mesh, its points nearest to others, and its
//! rings.

use glam::DVec2;

use super::RegionOnLattice;
use super::lines::crossing;
use super::on_lattice::SquareState;
use super::outline_edge::OutlineEdge;
use crate::geometry::LatticePoint;

impl RegionOnLattice {
    /// Returns where the outline crosses the segment from a lattice point inside the region to one outside,
    /// as a share of its length from `inside`. Of several crossings, the middle one.
    ///
    /// Which edges of the outline cross is decided exactly. Edges along the sides of the grid do not count: a
    /// segment meets the outline beside them where it leaves them.
    pub fn middle_crossing(&self, inside: LatticePoint, outside: LatticePoint) -> f64 {
        let [p, q] = [inside, outside].map(|p| [i64::from(p.x), i64::from(p.y)]);
        let (low, high) = ([0, 1].map(|i| p[i].min(q[i])), [0, 1].map(|i| p[i].max(q[i])));
        let mut crossings = Vec::new();
        for edge in self.edges_near(low, high) {
            edge.push_crossings(p, q, &mut crossings);
        }
        crossings.sort_by(f64::total_cmp);
        crossings.get(crossings.len().saturating_sub(1) / 2).copied().unwrap_or(0.5)
    }

    /// Returns the lattice points nearest to the crossings of the outline with a segment, in the order of the
    /// region. Edges along the sides of the grid do not count, nor do those that only touch it.
    pub(crate) fn crossings_with(&self, ends: [LatticePoint; 2]) -> Vec<LatticePoint> {
        let [a, b] = ends.map(|p| [i64::from(p.x), i64::from(p.y)]);
        let (low, high) = ([0, 1].map(|i| a[i].min(b[i])), [0, 1].map(|i| a[i].max(b[i])));
        let point = |[x, y]: [i64; 2]| LatticePoint::new(x as u32, y as u32);
        self.edges_near(low, high).filter_map(|edge| crossing(ends, edge.ends.map(point))).collect()
    }

    /// Returns the point of the outline nearest to `p`, if its distance is at most `reach`. Points are in
    /// lattice coordinates, distances in world units, and `step` is the world length of a lattice step along
    /// x and y. Edges along the sides of the grid do not count.
    pub fn nearest_on_outline(&self, p: DVec2, reach: f64, step: DVec2) -> Option<DVec2> {
        let mut near = OutlineNearby::default();
        near.collect(self, p, reach, step);
        near.nearest(p, reach)
    }

    /// Returns the corners of each ring of the outline in order, those on the sides of the grid included.
    pub fn outline_rings(&self) -> Vec<Vec<LatticePoint>> {
        let point = |[x, y]: [i64; 2]| LatticePoint::new(x as u32, y as u32);
        // The edges of a ring follow one another.
        let follows = |a: &OutlineEdge, b: &OutlineEdge| a.ends[1] == b.ends[0];
        let rings = self.edges.chunk_by(follows);
        rings.map(|edges| edges.iter().map(|edge| point(edge.ends[0])).collect()).collect()
    }

    /// Returns the edges of the outline in the smallest squares that touch a rectangle, each once, in the
    /// order of the region; those along the sides of the grid are left out.
    fn edges_near(&self, low: [i64; 2], high: [i64; 2]) -> impl Iterator<Item = &OutlineEdge> {
        let mut found = Vec::new();
        self.collect_edges_near([low, high], &mut found);
        found.into_iter().map(|n| &self.edges[n as usize]).filter(|edge| !edge.on_frame)
    }

    /// Writes the numbers of the edges in the smallest squares that touch a rectangle into `found`, in
    /// ascending order, each once.
    fn collect_edges_near(&self, rect: [[i64; 2]; 2], found: &mut Vec<u32>) {
        let [low, high] = rect;
        let size = (high[0] - low[0]).max(high[1] - low[1]).max(1) as u64;
        let bits = size.next_power_of_two().trailing_zeros();
        let depth = (self.root_bits.saturating_sub(bits) as usize).min(self.levels.len() - 1);
        found.clear();
        let [first, last] = rect.map(|corner| self.square_at(depth, corner));
        for row in first[1]..=last[1] {
            for column in first[0]..=last[0] {
                self.collect_edges(depth, [column, row], rect, found);
            }
        }
        found.sort_unstable();
        found.dedup();
    }

    /// Returns the square of a level of the tree that contains a point, or the nearest one.
    fn square_at(&self, depth: usize, point: [i64; 2]) -> [u32; 2] {
        let tree_level = &self.levels[depth];
        let rows = tree_level.states.len() as u32 / tree_level.columns;
        let bits = self.root_bits - depth as u32;
        let at = |c: i64, count: u32| (c >> bits).clamp(0, i64::from(count) - 1) as u32;
        [at(point[0], tree_level.columns), at(point[1], rows)]
    }

    fn collect_edges(
        &self,
        depth: usize,
        [column, row]: [u32; 2],
        rect: [[i64; 2]; 2],
        found: &mut Vec<u32>,
    ) {
        let bits = self.root_bits - depth as u32;
        let apart =
            |n: u32, i: usize| (i64::from(n) << bits) > rect[1][i] || (i64::from(n) + 1) << bits < rect[0][i];
        if self.state(depth, [column, row]) != SquareState::Crossed || apart(column, 0) || apart(row, 1) {
            return;
        }
        if depth + 1 < self.levels.len() {
            for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                self.collect_edges(depth + 1, [2 * column + x, 2 * row + y], rect, found);
            }
            return;
        }
        let square = row as usize * self.levels[depth].columns as usize + column as usize;
        let start = if square == 0 { 0 } else { self.ends[square - 1] as usize };
        found.extend_from_slice(&self.edges_of_square[start..self.ends[square] as usize]);
    }
}

/// The edges of an outline near a point, for several searches of nearest points there.
#[derive(Debug, Default)]
pub(crate) struct OutlineNearby {
    edges: Vec<[DVec2; 2]>,
    /// World length of a lattice step along x and y.
    step: DVec2,
    /// The numbers of the edges in the squares nearby.
    numbers: Vec<u32>,
}

impl OutlineNearby {
    /// Takes the edges within `reach` of `p`, and perhaps others. Edges along the sides of the grid do not
    /// count.
    pub(crate) fn collect(&mut self, region: &RegionOnLattice, p: DVec2, reach: f64, step: DVec2) {
        let margin = DVec2::splat(reach) / step + DVec2::ONE;
        let (low, high) = (p - margin, p + margin);
        let rect = [low, high].map(|p| [p.x.floor() as i64, p.y.floor() as i64]);
        region.collect_edges_near(rect, &mut self.numbers);
        let edges = self.numbers.iter().map(|&n| &region.edges[n as usize]).filter(|edge| !edge.on_frame);
        let ends = edges.map(|edge| edge.ends.map(|[x, y]| DVec2::new(x as f64, y as f64)));
        let is_near = |[a, b]: &[DVec2; 2]| a.min(*b).cmple(high).all() && a.max(*b).cmpge(low).all();
        self.edges.clear();
        self.edges.extend(ends.filter(is_near));
        self.step = step;
    }

    /// Returns the point of the edges nearest to `p`, if its distance is at most `reach`; of several, the one
    /// with the lowest x, then y.
    pub(crate) fn nearest(&self, p: DVec2, reach: f64) -> Option<DVec2> {
        let mut nearest: Option<(f64, DVec2)> = None;
        // With a margin for rounding: an edge at the same distance may come first by its place.
        let mut farthest = reach * reach * (1.0 + 1e-9);
        for &[a, b] in &self.edges {
            let to_box = (p.clamp(a.min(b), a.max(b)) - p) * self.step;
            if to_box.length_squared() > farthest {
                continue;
            }
            let (along, to) = ((b - a) * self.step, (p - a) * self.step);
            let point = a + (b - a) * (along.dot(to) / along.length_squared()).clamp(0.0, 1.0);
            let distance = ((p - point) * self.step).length();
            let key = |distance: f64, point: DVec2| (distance, point.x, point.y);
            let nearer = nearest.is_none_or(|(d, other)| key(distance, point) < key(d, other));
            if distance <= reach && nearer {
                nearest = Some((distance, point));
                farthest = distance * distance * (1.0 + 1e-9);
            }
        }
        nearest.map(|(_, point)| point)
    }
}

impl OutlineEdge {
    /// Appends where the edge meets the segment from `p` to `q`, as shares of its length from `p`: one place,
    /// or two ends of a common part.
    fn push_crossings(&self, p: [i64; 2], q: [i64; 2], crossings: &mut Vec<f64>) {
        // Lattice coordinates stay below 2^31, so the products fit.
        let turn = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let apart = |s: i64, t: i64| (s > 0 && t > 0) || (s < 0 && t < 0);
        let [a, b] = self.ends;
        let (a_side, b_side) = (turn(p, q, a), turn(p, q, b));
        let (p_side, q_side) = (turn(a, b, p), turn(a, b, q));
        if apart(a_side, b_side) || apart(p_side, q_side) {
            return;
        }
        if a_side != 0 || b_side != 0 {
            let (p_side, q_side) = (p_side as f64, q_side as f64);
            return crossings.push(p_side / (p_side - q_side));
        }
        let axis = usize::from((q[0] - p[0]).abs() < (q[1] - p[1]).abs());
        let share = |c: [i64; 2]| (c[axis] - p[axis]) as f64 / (q[axis] - p[axis]) as f64;
        let (s, t) = (share(a), share(b));
        if s.max(t) >= 0.0 && s.min(t) <= 1.0 {
            crossings.extend([s, t].map(|share| share.clamp(0.0, 1.0)));
        }
    }
}
