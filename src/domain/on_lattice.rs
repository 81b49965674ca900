//! A region as the mesh asks about it: exactly, in lattice coordinates.

use super::edge::{Corners, Edge};
use crate::geometry::{Lattice, LatticePoint, LatticeRect};

/// A region with its corners moved to the nearest points of a mesh's lattice, and a tree of squares to find its edges by.
///
/// A square of the tree is outside, inside, or *cut*: an edge has a point in common with it, rim included. The smallest squares
/// that are cut know their edges. All answers are exact for the region as it lies on the lattice.
///
/// Edges along the sides of the grid are no *boundary*: the mesh ends there anyway.
#[derive(Clone, Debug)]
pub struct RegionOnLattice {
    /// Squares along x and y at the root, one for each coarse cell or for several.
    pub(super) cells: [u32; 2],
    /// Binary logarithm of the side of a root square, in lattice steps.
    pub(super) root_bits: u32,
    /// The tree, root first: side lengths halve from one entry to the next.
    pub(super) layers: Vec<Layer>,
    pub(super) edges: Vec<Edge>,
    /// For each smallest square whether its left rim lies inside, half way up.
    pub(super) inside_at_left: Vec<bool>,
    /// For each smallest square the end of its part of `edges_of_square`.
    pub(super) ends: Vec<u32>,
    pub(super) edges_of_square: Vec<u32>,
}

/// Squares of one size, row by row from below.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub(super) columns: u32,
    pub(super) states: Vec<State>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    Outside,
    Inside,
    Cut,
}

impl RegionOnLattice {
    /// The grid, before any edge is laid on it.
    pub(super) fn without_edges(lattice: &Lattice) -> Self {
        Self {
            cells: lattice.cells(),
            root_bits: lattice.halvings(),
            layers: Vec::new(),
            edges: Vec::new(),
            inside_at_left: Vec::new(),
            ends: Vec::new(),
            edges_of_square: Vec::new(),
        }
    }

    /// Whether a point of the closed region lies at a lattice point.
    pub fn contains(&self, p: LatticePoint) -> bool {
        let p = [i64::from(p.x), i64::from(p.y)];
        let square = self.square_of(p);
        match self.smallest().states[square] {
            State::Outside => false,
            State::Inside => true,
            State::Cut => {
                self.edges_in(square).any(|edge| edge.holds(p)) || self.is_inside([p[0], p[1]].map(|c| c * 3))
            }
        }
    }

    /// Whether a triangle of the mesh, given by corners and level, has no point in common with the region.
    pub fn misses(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        match self.meets(corners, level, &|_| true) {
            Meeting::Cut => false,
            Meeting::Uncut(inside) => !inside,
        }
    }

    /// Whether the boundary has a point in common with a triangle of the mesh.
    pub fn cuts(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        self.meets(corners, level, &|edge| !edge.on_frame) == Meeting::Cut
    }

    /// Whether the centroid of a triangle lies in the region. On an edge, the side does not matter but is always the same.
    pub fn has_centroid_of(&self, corners: [LatticePoint; 3]) -> bool {
        self.is_inside(thrice_centroid(corners))
    }

    /// Goes down the tree from the smallest square that holds the triangle.
    fn meets(&self, corners: [LatticePoint; 3], level: u32, counts: &impl Fn(&Edge) -> bool) -> Meeting {
        let depth = (level as usize / 2).min(self.layers.len() - 1);
        let centroid = thrice_centroid(corners);
        let side = 3 << (self.root_bits as usize - depth);
        let square = [(centroid[0] / side) as u32, (centroid[1] / side) as u32];
        match self.state(depth, square) {
            State::Outside => return Meeting::Uncut(false),
            State::Inside => return Meeting::Uncut(true),
            State::Cut => {}
        }
        let triangle = Corners::of(corners);
        if self.cut_within(depth, square, corners, &triangle, counts) {
            Meeting::Cut
        } else {
            Meeting::Uncut(self.is_inside(centroid))
        }
    }

    /// Whether an edge that counts touches the triangle, somewhere in a square of the tree.
    fn cut_within(
        &self,
        depth: usize,
        [column, row]: [u32; 2],
        corners: [LatticePoint; 3],
        triangle: &Corners,
        counts: &impl Fn(&Edge) -> bool,
    ) -> bool {
        let square = [column, row];
        if self.state(depth, square) != State::Cut || !self.rect(depth, square).touches(corners) {
            return false;
        }
        if depth + 1 == self.layers.len() {
            let square = row as usize * self.smallest().columns as usize + column as usize;
            return self.edges_in(square).any(|edge| counts(edge) && edge.touches(triangle));
        }
        let quarters = [[0, 0], [1, 0], [0, 1], [1, 1]];
        quarters.iter().any(|[x, y]| {
            self.cut_within(depth + 1, [2 * column + x, 2 * row + y], corners, triangle, counts)
        })
    }

    /// Whether a point lies inside, given by three times its coordinates: by the edges between it and the middle of the left rim
    /// of its square, first across and then up or down.
    fn is_inside(&self, thrice: [i64; 2]) -> bool {
        let square = self.square_of(thrice.map(|c| c.div_euclid(3)));
        match self.smallest().states[square] {
            State::Outside => return false,
            State::Inside => return true,
            State::Cut => {}
        }
        let [left, height] = self.middle_of_left_rim(square);
        let between = self.edges_in(square).filter(|edge| {
            edge.crosses_between(left, i64::MAX, [thrice[0], height])
                != edge.crosses_beside(thrice[0], height, thrice[1])
        });
        self.inside_at_left[square] ^ (between.count() % 2 == 1)
    }

    /// Where the state of a smallest square is known from, in thirds of a step.
    fn middle_of_left_rim(&self, square: usize) -> [i64; 2] {
        let (bits, columns) = (self.smallest_bits(), self.smallest().columns as usize);
        let (column, row) = ((square % columns) as i64, (square / columns) as i64);
        // Left of the grid there are no edges.
        let left = if column == 0 { i64::MIN } else { 3 * (column << bits) };
        [left, middle_of_row(row, bits)]
    }

    fn smallest(&self) -> &Layer {
        self.layers.last().expect("there is a root")
    }

    fn smallest_bits(&self) -> u32 {
        self.root_bits - (self.layers.len() as u32 - 1)
    }

    pub(super) fn edges_in(&self, square: usize) -> impl Iterator<Item = &Edge> {
        let start = if square == 0 { 0 } else { self.ends[square - 1] as usize };
        self.edges_of_square[start..self.ends[square] as usize].iter().map(|&n| &self.edges[n as usize])
    }

    fn state(&self, depth: usize, [column, row]: [u32; 2]) -> State {
        let layer = &self.layers[depth];
        layer.states[row as usize * layer.columns as usize + column as usize]
    }

    fn rect(&self, depth: usize, square: [u32; 2]) -> LatticeRect {
        let bits = self.root_bits - depth as u32;
        let corner = |[x, y]: [u32; 2]| LatticePoint::new(x << bits, y << bits);
        LatticeRect { min: corner(square), max: corner(square.map(|n| n + 1)) }
    }

    /// The smallest square that holds a point of the grid; on a rim the upper and the right one, as far as there is one.
    fn square_of(&self, point: [i64; 2]) -> usize {
        let (layer, bits) = (self.smallest(), self.smallest_bits());
        let rows = layer.states.len() / layer.columns as usize;
        let at = |c: i64, count: usize| ((c >> bits).max(0) as usize).min(count - 1);
        at(point[1], rows) * layer.columns as usize + at(point[0], layer.columns as usize)
    }
}

/// How a triangle meets the edges that count.
#[derive(PartialEq)]
enum Meeting {
    /// One of them touches it.
    Cut,
    /// None does; whether the triangle lies inside.
    Uncut(bool),
}

impl Layer {
    /// The state of four squares together.
    pub(super) fn joined(&self, [column, row]: [u32; 2]) -> State {
        let first = (2 * row * self.columns + 2 * column) as usize;
        let above = first + self.columns as usize;
        let [a, b, c, d] = [first, first + 1, above, above + 1].map(|n| self.states[n]);
        if a == b && b == c && c == d { a } else { State::Cut }
    }
}

/// Half a side up in a row of squares, in thirds of a step: no corner lies at that height where the side is one step.
pub(super) fn middle_of_row(row: i64, bits: u32) -> i64 {
    ((3 * (2 * row + 1)) << bits) / 2
}

fn thrice_centroid(corners: [LatticePoint; 3]) -> [i64; 2] {
    let sum = |c: fn(&LatticePoint) -> u32| corners.iter().map(|p| i64::from(c(p))).sum();
    [sum(|p| p.x), sum(|p| p.y)]
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DVec2, dvec2};

    use super::*;
    use crate::domain::region_builder::RegionOnLatticeBuilder;
    use crate::domain::{Polygon, Region, Ring};
    use crate::geometry::Rect;
    use crate::mesh::{Limits, Mesh, Progress, TriangleId};

    /// A star with a hole, with corners on and off the lattice, and a strip along the left side of the frame.
    fn region(random: &mut fastrand::Rng) -> Region {
        let ring = |centre: DVec2, radius: f64, points: usize, random: &mut fastrand::Rng| -> Ring {
            let at = |k: usize, random: &mut fastrand::Rng| {
                let angle = k as f64 / points as f64 * std::f64::consts::TAU;
                let p =
                    centre + radius * (0.3 + 0.7 * random.f64()) * dvec2(libm::cos(angle), libm::sin(angle));
                if random.bool() { (p * 16.0).round() / 16.0 } else { p }
            };
            (0..points).map(|k| at(k, random)).collect()
        };
        let star: Polygon = vec![
            ring(DVec2::splat(0.5), 0.6, 3 + random.usize(..30), random),
            ring(DVec2::splat(0.5), 0.2, 3 + random.usize(..8), random),
        ];
        let strip = vec![crate::domain::corners(&Rect::new(DVec2::ZERO, dvec2(random.f64() * 0.2, 1.0)))];
        Region::new(&[star, strip], Rect::UNIT)
    }

    /// By all edges, one after the other, in i128: shares nothing but the corners.
    fn brute_force(region: &Region, lattice: &Lattice, p: [i128; 2], scale: i128) -> (bool, bool) {
        let place = |p: DVec2| {
            let p = lattice.nearest(p);
            [i128::from(p.x) * scale, i128::from(p.y) * scale]
        };
        let (mut inside, mut on) = (false, false);
        for [a, b] in region.edges().map(|edge| edge.map(place)) {
            let turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            let within = |i: usize| a[i].min(b[i]) <= p[i] && p[i] <= a[i].max(b[i]);
            on |= turn == 0 && within(0) && within(1);
            inside ^= (a[1] > p[1]) != (b[1] > p[1]) && (turn > 0) == (b[1] > a[1]);
        }
        (inside, on)
    }

    fn cut_by_brute_force(region: &Region, lattice: &Lattice, corners: [LatticePoint; 3]) -> bool {
        let corners = corners.map(|p| [i128::from(p.x), i128::from(p.y)]);
        let place = |p: DVec2| {
            let p = lattice.nearest(p);
            [i128::from(p.x), i128::from(p.y)]
        };
        let turn = |a: [i128; 2], b: [i128; 2], p: [i128; 2]| {
            ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).signum()
        };
        let holds = |p| {
            let turns = [0, 1, 2].map(|i| turn(corners[i], corners[(i + 1) % 3], p));
            turns.iter().all(|&t| t >= 0) || turns.iter().all(|&t| t <= 0)
        };
        let on = |a: [i128; 2], b: [i128; 2], p: [i128; 2]| {
            turn(a, b, p) == 0 && (0..2).all(|i| a[i].min(b[i]) <= p[i] && p[i] <= a[i].max(b[i]))
        };
        region.edges().map(|edge| edge.map(place)).any(|[a, b]| {
            holds(a)
                || holds(b)
                || (0..3).any(|i| {
                    let (c, d) = (corners[i], corners[(i + 1) % 3]);
                    (turn(a, b, c) != turn(a, b, d) && turn(c, d, a) != turn(c, d, b))
                        || on(a, b, c)
                        || on(a, b, d)
                })
        })
    }

    #[test]
    fn every_answer_is_that_of_brute_force() {
        let mut random = fastrand::Rng::with_seed(11);
        let (mut cut, mut inside, mut outside, mut on_edge) = (0, 0, 0, 0);
        for _ in 0..60 {
            let region = Arc::new(region(&mut random));
            let mut mesh = Mesh::coarse_grid(
                &Lattice::covering(Rect::UNIT, 0.34, 1_000_000).unwrap(),
                |_| true,
                &Limits::default(),
            )
            .unwrap();
            for _ in 0..150 {
                mesh.refine_triangle(TriangleId::from_index(random.usize(..mesh.raw_triangle_count())));
            }
            let lattice = *mesh.lattice();
            // At times so little room that squares are larger than coarse cells.
            let most = 1 << random.u32(0..12);
            let mut builder = RegionOnLatticeBuilder::within(&region, &lattice, most);
            while builder.advance(random.usize(1..300)) == Progress::More {}
            let sorted = builder.finish();
            let all = 0..mesh.raw_triangle_count();
            mesh.classify(all, |element| {
                let touched = cut_by_brute_force(&region, &lattice, element.corners);
                let sum =
                    |c: fn(&LatticePoint) -> u32| element.corners.iter().map(|p| i128::from(c(p))).sum();
                let (centroid_in, centroid_on) =
                    brute_force(&region, &lattice, [sum(|p| p.x), sum(|p| p.y)], 3);
                assert_eq!(
                    sorted.misses(element.corners, element.triangle.level()),
                    !touched && !centroid_in
                );
                assert!(centroid_on || sorted.has_centroid_of(element.corners) == centroid_in);
                assert!(!sorted.cuts(element.corners, element.triangle.level()) || touched);
                cut += usize::from(sorted.cuts(element.corners, element.triangle.level()));
                inside += usize::from(!touched && centroid_in);
                outside += usize::from(sorted.misses(element.corners, element.triangle.level()));
                !centroid_in
            });
            for node in mesh.raw_nodes() {
                let (inside, on) =
                    brute_force(&region, &lattice, [i128::from(node.x), i128::from(node.y)], 1);
                assert_eq!(sorted.contains(*node), inside || on, "{node:?}");
                on_edge += usize::from(on);
            }
        }
        assert!(
            cut > 1000 && inside > 1000 && outside > 1000 && on_edge > 30,
            "{cut} {inside} {outside} {on_edge}"
        );
    }

    #[test]
    fn sides_of_the_frame_are_no_boundary() {
        let whole = Arc::new(Region::new(&[vec![crate::domain::corners(&Rect::UNIT)]], Rect::UNIT));
        let mut mesh = Mesh::coarse_grid(
            &Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap(),
            |_| true,
            &Limits::default(),
        )
        .unwrap();
        let sorted = RegionOnLatticeBuilder::new(&whole, mesh.lattice()).finish();
        mesh.classify(0..32, |element| {
            assert!(
                !sorted.cuts(element.corners, element.triangle.level())
                    && !sorted.misses(element.corners, element.triangle.level())
                    && sorted.has_centroid_of(element.corners)
            );
            false
        });
        assert!(mesh.raw_nodes().iter().all(|&node| sorted.contains(node)));
    }
}
