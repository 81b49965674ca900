//! The region index: a region in lattice coordinates, in a quadtree that finds its edges and answers exactly.

use super::outline_edge::{OutlineEdge, TriangleExtents};
use crate::geometry::{Lattice, LatticePoint, LatticeRect};

/// A region with its corners moved to the nearest points of a mesh's lattice, and a quadtree to find its
/// edges.
///
/// The squares of the tree are aligned with the coarse cells and with the bisection tree: two levels of
/// bisection halve a square once. So every triangle of the mesh lies in one square of about its own size.
///
/// ```text
/// root: one square        level 1               level 2, the smallest       a smallest crossed square
/// for each coarse cell                          squares
/// +---------------+       +-------+-------+     +---+---+---+---+           +-------------+
/// |               |       |       |       |     | O | O | O | O |           |     \       |
/// |               |       |   O   |   X   |     +---+---+---+---+           |      \      |
/// |               |       |       |       |     | O | O | X | X |           s-------*--+  |
/// |       X       |       +-------+-------+     +---+---+---+---+           |        \ |  |
/// |               |       |       |       |     | O | X | I | I |           |         \p  |
/// |               |       |   X   |   I   |     +---+---+---+---+           |          \  |
/// |               |       |       |       |     | X | X | I | I |           +-------------+
/// +---------------+       +-------+-------+     +---+---+---+---+
///
/// O outside, I inside, X crossed by an edge     s: stored state; the path to p crosses one edge (*)
/// ```
///
/// A square is outside, inside, or *crossed*: an edge touches it, its sides included. The smallest crossed
/// squares list their edges. Whether a point in one of them lies inside follows from the state at the middle
/// of the square's left side and the number of edges crossed on the way from there to the point.
///
/// All answers are exact for the region with its corners on the lattice. Edges along the sides of the grid do
/// not count as *outline*: the mesh ends there anyway.
#[derive(Clone, Debug)]
pub struct RegionOnLattice {
    /// Squares along x and y at the root, one for each coarse cell or for several cells together.
    pub(super) cells: [u32; 2],
    /// Binary logarithm of the side of a root square, in lattice steps.
    pub(super) root_bits: u32,
    /// The levels of the tree, root first. The side of a square halves from one level to the next.
    pub(super) levels: Vec<TreeLevel>,
    pub(super) edges: Vec<OutlineEdge>,
    /// For each smallest square, whether the middle of its left side lies inside.
    pub(super) inside_at_left: Vec<bool>,
    /// For each smallest square, the end of its range in `edges_of_square`; the range begins at the end of
    /// the previous square's range.
    pub(super) ends: Vec<u32>,
    /// Indices into `edges`, square by square.
    pub(super) edges_of_square: Vec<u32>,
}

/// The squares of one size, row by row from the lowest.
#[derive(Clone, Debug)]
pub(super) struct TreeLevel {
    pub(super) columns: u32,
    pub(super) states: Vec<SquareState>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SquareState {
    Outside,
    Inside,
    /// An edge touches it.
    Crossed,
}

impl RegionOnLattice {
    /// Returns the index before any edge is added.
    pub(super) fn without_edges(lattice: &Lattice) -> Self {
        Self {
            cells: lattice.cells(),
            root_bits: lattice.halvings(),
            levels: Vec::new(),
            edges: Vec::new(),
            inside_at_left: Vec::new(),
            ends: Vec::new(),
            edges_of_square: Vec::new(),
        }
    }

    /// Returns whether a lattice point lies in the closed region.
    pub fn contains(&self, p: LatticePoint) -> bool {
        self.holds([p.x, p.y].map(|c| 3 * i64::from(c)))
    }

    /// Returns whether a triangle of the mesh, given by its corners and level, does not touch the region.
    pub fn lies_outside(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        self.side_of(corners, level) == Some(false)
    }

    /// Returns whether a triangle of the mesh, given by its corners and level, lies in the region; `None`
    /// where the outline touches it.
    pub fn side_of(&self, corners: [LatticePoint; 3], level: u32) -> Option<bool> {
        match self.relation_to(corners, level, &|_| true) {
            Relation::Crossed => None,
            Relation::Uncrossed(inside) => Some(inside),
        }
    }

    /// Returns whether the outline touches a triangle of the mesh, given by its corners and level.
    pub fn outline_crosses(&self, corners: [LatticePoint; 3], level: u32) -> bool {
        self.relation_to(corners, level, &|edge| !edge.on_frame) == Relation::Crossed
    }

    /// Returns whether the centroid of a triangle lies in the closed region. (Closed, so that a mirrored
    /// region has the mirrored triangles.)
    pub fn has_centroid_of(&self, corners: [LatticePoint; 3]) -> bool {
        self.holds(thrice_centroid(corners))
    }

    /// Finds how the edges for which `counts` is true lie to a triangle.
    fn relation_to(
        &self,
        corners: [LatticePoint; 3],
        level: u32,
        counts: &impl Fn(&OutlineEdge) -> bool,
    ) -> Relation {
        // The smallest square that contains the triangle is on this level of the tree.
        let depth = (level as usize / 2).min(self.levels.len() - 1);
        let centroid = thrice_centroid(corners);
        let side = 3 << (self.root_bits as usize - depth);
        let square = [(centroid[0] / side) as u32, (centroid[1] / side) as u32];
        match self.state(depth, square) {
            SquareState::Outside => return Relation::Uncrossed(false),
            SquareState::Inside => return Relation::Uncrossed(true),
            SquareState::Crossed => {}
        }
        // In a crossed square the edges decide, and without an edge at the triangle any of its points.
        let triangle = TriangleExtents::new(corners);
        if self.crossed_within(depth, square, corners, &triangle, counts) {
            Relation::Crossed
        } else {
            Relation::Uncrossed(self.is_inside(centroid))
        }
    }

    /// Returns whether an edge that counts touches the triangle within a square of the tree. The recursion is
    /// as deep as the tree.
    fn crossed_within(
        &self,
        depth: usize,
        [column, row]: [u32; 2],
        corners: [LatticePoint; 3],
        triangle: &TriangleExtents,
        counts: &impl Fn(&OutlineEdge) -> bool,
    ) -> bool {
        let square = [column, row];
        if self.state(depth, square) != SquareState::Crossed || !self.rect(depth, square).touches(corners) {
            return false;
        }
        if depth + 1 == self.levels.len() {
            let square = row as usize * self.smallest().columns as usize + column as usize;
            return self.edges_in(square).any(|edge| counts(edge) && edge.touches(triangle));
        }
        let quarters = [[0, 0], [1, 0], [0, 1], [1, 1]];
        quarters.iter().any(|[x, y]| {
            self.crossed_within(depth + 1, [2 * column + x, 2 * row + y], corners, triangle, counts)
        })
    }

    /// Returns whether a point, given by three times its coordinates, lies in the closed region.
    fn holds(&self, thrice: [i64; 2]) -> bool {
        let on_edge = || {
            let square = self.square_of(thrice.map(|c| c.div_euclid(3)));
            self.edges_in(square).any(|edge| edge.holds(thrice))
        };
        self.is_inside(thrice) || on_edge()
    }

    /// Returns whether a point, given by three times its coordinates, lies inside: by the edges that a path
    /// crosses from the middle of its square's left side to the point, first horizontally and then
    /// vertically.
    fn is_inside(&self, thrice: [i64; 2]) -> bool {
        let square = self.square_of(thrice.map(|c| c.div_euclid(3)));
        match self.smallest().states[square] {
            SquareState::Outside => return false,
            SquareState::Inside => return true,
            SquareState::Crossed => {}
        }
        let [left, height] = self.middle_of_left_side(square);
        let between = self.edges_in(square).filter(|edge| {
            edge.crosses_between(left, i64::MAX, [thrice[0], height])
                != edge.crosses_beside(thrice[0], height, thrice[1])
        });
        self.inside_at_left[square] ^ (between.count() % 2 == 1)
    }

    /// Returns the middle of a smallest square's left side, in thirds of a lattice step.
    fn middle_of_left_side(&self, square: usize) -> [i64; 2] {
        let (bits, columns) = (self.smallest_bits(), self.smallest().columns as usize);
        let (column, row) = ((square % columns) as i64, (square / columns) as i64);
        // Left of the grid there are no edges.
        let left = if column == 0 { i64::MIN } else { 3 * (column << bits) };
        [left, middle_of_row(row, bits)]
    }

    fn smallest(&self) -> &TreeLevel {
        self.levels.last().expect("there is a root")
    }

    fn smallest_bits(&self) -> u32 {
        self.root_bits - (self.levels.len() as u32 - 1)
    }

    pub(super) fn edges_in(&self, square: usize) -> impl Iterator<Item = &OutlineEdge> {
        let start = if square == 0 { 0 } else { self.ends[square - 1] as usize };
        self.edges_of_square[start..self.ends[square] as usize].iter().map(|&n| &self.edges[n as usize])
    }

    pub(super) fn state(&self, depth: usize, [column, row]: [u32; 2]) -> SquareState {
        let tree_level = &self.levels[depth];
        tree_level.states[row as usize * tree_level.columns as usize + column as usize]
    }

    fn rect(&self, depth: usize, square: [u32; 2]) -> LatticeRect {
        let bits = self.root_bits - depth as u32;
        let corner = |[x, y]: [u32; 2]| LatticePoint::new(x << bits, y << bits);
        LatticeRect { min: corner(square), max: corner(square.map(|n| n + 1)) }
    }

    /// Returns the smallest square that contains a point of the grid; on a side between two squares the upper
    /// or right one.
    fn square_of(&self, point: [i64; 2]) -> usize {
        let (tree_level, bits) = (self.smallest(), self.smallest_bits());
        let rows = tree_level.states.len() / tree_level.columns as usize;
        let at = |c: i64, count: usize| ((c >> bits).max(0) as usize).min(count - 1);
        at(point[1], rows) * tree_level.columns as usize + at(point[0], tree_level.columns as usize)
    }
}

/// How edges lie to a triangle.
#[derive(PartialEq)]
enum Relation {
    /// An edge touches it.
    Crossed,
    /// No edge touches it; the value says whether the triangle is inside.
    Uncrossed(bool),
}

impl TreeLevel {
    /// Returns the state of four squares of this level as one square of the level above.
    pub(super) fn joined(&self, [column, row]: [u32; 2]) -> SquareState {
        let first = (2 * row * self.columns + 2 * column) as usize;
        let above = first + self.columns as usize;
        let [a, b, c, d] = [first, first + 1, above, above + 1].map(|n| self.states[n]);
        if a == b && b == c && c == d { a } else { SquareState::Crossed }
    }
}

/// Returns the height of the middle of a row of squares, in thirds of a step. If a side is one step, no
/// corner has this height.
pub(super) fn middle_of_row(row: i64, bits: u32) -> i64 {
    ((3 * (2 * row + 1)) << bits) / 2
}

/// Returns three times the centroid, which is a whole number.
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

    /// Returns a star with a hole, with some corners on coarse lattice points, and a strip along the left
    /// side of the frame.
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

    /// Inside, and on an edge: tested with all edges in i128. Shares only the corners with the index.
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
    fn every_answer_equals_that_of_brute_force() {
        let mut random = fastrand::Rng::with_seed(11);
        let (mut cut, mut inside, mut outside, mut on_edge) = (0, 0, 0, 0);
        let mut centroids_on_edge = 0;
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
            // Sometimes with so few entries that squares are larger than coarse cells.
            let most = 1 << random.u32(0..12);
            let mut builder = RegionOnLatticeBuilder::within(&region, &lattice, most);
            while builder.advance(random.usize(1..300)) == Progress::More {}
            let index = builder.finish();
            for element in mesh.raw_elements() {
                let touched = cut_by_brute_force(&region, &lattice, element.corners);
                let sum =
                    |c: fn(&LatticePoint) -> u32| element.corners.iter().map(|p| i128::from(c(p))).sum();
                let (centroid_in, centroid_on) =
                    brute_force(&region, &lattice, [sum(|p| p.x), sum(|p| p.y)], 3);
                assert_eq!(
                    index.lies_outside(element.corners, element.triangle.level()),
                    !touched && !centroid_in
                );
                assert_eq!(index.has_centroid_of(element.corners), centroid_in || centroid_on);
                centroids_on_edge += usize::from(centroid_on);
                assert!(!index.outline_crosses(element.corners, element.triangle.level()) || touched);
                cut += usize::from(index.outline_crosses(element.corners, element.triangle.level()));
                inside += usize::from(!touched && centroid_in);
                outside += usize::from(index.lies_outside(element.corners, element.triangle.level()));
            }
            for node in mesh.raw_nodes() {
                let (inside, on) =
                    brute_force(&region, &lattice, [i128::from(node.x), i128::from(node.y)], 1);
                assert_eq!(index.contains(*node), inside || on, "{node:?}");
                on_edge += usize::from(on);
            }
        }
        assert!(
            cut > 1000 && inside > 1000 && outside > 1000 && on_edge > 30 && centroids_on_edge > 0,
            "{cut} {inside} {outside} {on_edge} {centroids_on_edge}"
        );
    }

    #[test]
    fn sides_of_the_frame_do_not_count_as_outline() {
        let whole = Arc::new(Region::new(&[vec![crate::domain::corners(&Rect::UNIT)]], Rect::UNIT));
        let mut mesh = Mesh::coarse_grid(
            &Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap(),
            |_| true,
            &Limits::default(),
        )
        .unwrap();
        let index = RegionOnLatticeBuilder::new(&whole, mesh.lattice()).finish();
        mesh.classify(0..32, |element| {
            assert!(
                !index.outline_crosses(element.corners, element.triangle.level())
                    && !index.lies_outside(element.corners, element.triangle.level())
                    && index.has_centroid_of(element.corners)
            );
            false
        });
        assert!(mesh.raw_nodes().iter().all(|&node| index.contains(node)));
    }
}
