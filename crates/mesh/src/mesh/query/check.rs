//! The invariants of a mesh as executable checks. They are slow: for tests and debugging.

use std::collections::{BTreeMap, HashMap};
use std::error::Error;
use std::fmt;

use crate::geometry::LatticePoint;
use crate::mesh::kernel::{
    Answer, DEEPEST_LEVEL, Diameters, Element, LevelAndSide, Mesh, NodeId, Orientation, TriangleId,
};

/// A broken invariant of [`Mesh`], in the order of the list there.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Violation {
    /// A reference points beyond its array; nothing else of the triangle is checked.
    DanglingReference(TriangleId),
    /// Invariant 1.
    WrongShape(TriangleId),
    /// Invariant 2.
    WrongOrientation(TriangleId),
    /// Invariant 3: the triangle across the edge does not answer with the same edge.
    AsymmetricNeighbour {
        /// The triangle.
        triangle: TriangleId,
        /// Place of the edge, the bisection edge first.
        edge: usize,
    },
    /// Invariant 4: two triangles have the edge, but one has the boundary as its neighbour there; or more
    /// than two triangles have the edge.
    UnmatchedEdge(NodeId, NodeId),
    /// Invariant 4: a node in the middle of a boundary edge.
    HangingNode {
        /// The triangle with the edge.
        triangle: TriangleId,
        /// The node in its middle.
        node: NodeId,
    },
    /// Invariant 5.
    LevelJump(TriangleId, TriangleId),
    /// Invariant 6.
    AreaNotConserved {
        /// Twice the area covered, in lattice squares.
        covered: u128,
        /// Twice the area of the kept coarse triangles, in lattice squares.
        expected: u128,
    },
    /// Invariant 7: no triangle uses the node.
    OrphanNode(NodeId),
    /// Invariant 7: two nodes at the same place.
    CoincidentNodes(NodeId, NodeId),
    /// Invariant 8.
    LostBucket(TriangleId),
    /// Invariant 9: the triangle noted for the node does not have it.
    LostNode(NodeId),
    /// Invariant 9.
    Miscounted {
        /// The level.
        level: u32,
        /// Whether those outside the domain are meant, or those inside.
        outside: bool,
        /// The number that the mesh stores.
        noted: usize,
        /// The number that was counted.
        counted: usize,
    },
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DanglingReference(id) => {
                write!(f, "triangle {id:?} refers to a node or triangle that does not exist")
            }
            Self::WrongShape(id) => write!(
                f,
                "triangle {id:?} does not have the right-angled isosceles shape and size of its level (Eq. 1)"
            ),
            Self::WrongOrientation(id) => {
                write!(f, "the vertices of triangle {id:?} do not run the way that it says")
            }
            Self::AsymmetricNeighbour { triangle, edge } => {
                write!(f, "edge {edge} of triangle {triangle:?} is not shared with the neighbour it names")
            }
            Self::UnmatchedEdge(a, b) => {
                write!(f, "the edge from node {a:?} to {b:?} is shared, but not by neighbours")
            }
            Self::HangingNode { triangle, node } => {
                write!(f, "node {node:?} hangs in the middle of an edge of triangle {triangle:?}")
            }
            Self::LevelJump(a, b) => write!(f, "neighbours {a:?} and {b:?} differ by more than one level"),
            Self::AreaNotConserved { covered, expected } => write!(
                f,
                "the triangles cover {covered} half lattice squares, and the kept coarse triangles {expected}"
            ),
            Self::OrphanNode(node) => write!(f, "no triangle uses node {node:?}"),
            Self::CoincidentNodes(a, b) => write!(f, "nodes {a:?} and {b:?} are at the same place"),
            Self::LostBucket(id) => {
                write!(f, "entry {id:?} does not lie in the coarse triangle of the same index")
            }
            Self::LostNode(node) => {
                write!(f, "the triangle noted for node {node:?} does not have that node")
            }
            Self::Miscounted { level, outside, noted, counted } => write!(
                f,
                "{noted} triangles are noted for level {level} (outside: {outside}), and there are {counted}"
            ),
        }
    }
}

impl Error for Violation {}

impl Mesh {
    /// Returns every broken invariant; empty for every mesh that this library makes.
    pub fn violations(&self) -> Vec<Violation> {
        let mut found = Vec::new();
        let ids = || (0..self.triangles.len()).map(TriangleId::from_index);
        found.extend(ids().filter(|&id| self.dangles(id)).map(Violation::DanglingReference));
        if !found.is_empty() {
            return found;
        }
        for id in ids() {
            self.check_shape(id, &mut found);
            self.check_neighbours(id, &mut found);
        }
        self.check_edges(&mut found);
        self.check_area(&mut found);
        self.check_nodes(&mut found);
        self.check_buckets(&mut found);
        self.check_ledgers(&mut found);
        found
    }

    /// Returns the triangles whose diameter exceeds their target (the negation of Eq. 14).
    ///
    /// # Errors
    /// Fails when the rule fails.
    pub fn unsatisfied<A: Answer>(
        &self,
        mut exceeds: impl FnMut(&Element) -> A,
    ) -> Result<Vec<TriangleId>, A::Error> {
        let mut found = Vec::new();
        let diameters = Diameters::of(self);
        for id in (0..self.triangles.len()).map(TriangleId::from_index) {
            if exceeds(&self.element_with(id, &diameters)).into_result()? {
                found.push(id);
            }
        }
        Ok(found)
    }

    fn dangles(&self, id: TriangleId) -> bool {
        let triangle = self.triangle(id);
        triangle.vertices.iter().any(|v| v.index() >= self.nodes.len())
            || triangle
                .raw_neighbours
                .iter()
                .filter_map(|n| n.triangle())
                .any(|n| n.index() >= self.triangles.len())
    }

    fn check_shape(&self, id: TriangleId, found: &mut Vec<Violation>) {
        let triangle = self.triangle(id);
        let [from, to] = triangle.bisection_edge().map(|v| self.node(v));
        let apex = self.node(triangle.apex());
        let cell = u128::from(self.lattice.cell_steps());
        // The square of the bisection edge is 2 δ² at level 0 and halves with each level; each leg's is half
        // of it.
        let long = (2 * cell * cell) >> triangle.level();
        let legs_fit = [from, to].iter().all(|&end| 2 * squared_distance(apex, end) == long);
        if squared_distance(from, to) != long || !legs_fit {
            found.push(Violation::WrongShape(id));
        }
        let turn = twice_signed_area(self.corners(id));
        if (turn > 0) != (triangle.orientation() == Orientation::Anticlockwise) || turn == 0 {
            found.push(Violation::WrongOrientation(id));
        }
    }

    fn check_neighbours(&self, id: TriangleId, found: &mut Vec<Violation>) {
        let triangle = self.triangle(id);
        for (edge, (from, to)) in triangle.edge_nodes().into_iter().enumerate() {
            let Some(across) = triangle.raw_neighbours[edge].triangle() else { continue };
            let other = self.triangle(across);
            let answers = (0..3).any(|j| {
                // Both run anticlockwise, so they run along a shared edge in opposite directions.
                other.raw_neighbours[j].triangle() == Some(id) && other.edge_nodes()[j] == (to, from)
            });
            if !answers || across == id {
                found.push(Violation::AsymmetricNeighbour { triangle: id, edge });
            }
            if id < across && triangle.level().abs_diff(other.level()) > 1 {
                found.push(Violation::LevelJump(id, across));
            }
        }
    }

    fn check_edges(&self, found: &mut Vec<Violation>) {
        let mut owners: BTreeMap<(NodeId, NodeId), (u32, bool)> = BTreeMap::new();
        for triangle in &self.triangles {
            for (j, (from, to)) in triangle.edge_nodes().into_iter().enumerate() {
                let entry = owners.entry((from.min(to), from.max(to))).or_default();
                entry.0 += 1;
                entry.1 |= triangle.raw_neighbours[j].triangle().is_none();
            }
        }
        for (&(a, b), &(count, on_boundary)) in &owners {
            if count != if on_boundary { 1 } else { 2 } {
                found.push(Violation::UnmatchedEdge(a, b));
            }
        }
        let node_at: HashMap<LatticePoint, NodeId> =
            self.nodes.iter().enumerate().map(|(n, &p)| (p, NodeId::from_index(n))).collect();
        for (index, triangle) in self.triangles.iter().enumerate() {
            for (from, to) in triangle.edge_nodes() {
                let (a, b) = (self.node(from), self.node(to));
                let halves = (a.x ^ b.x) & 1 == 0 && (a.y ^ b.y) & 1 == 0;
                if halves && let Some(&node) = node_at.get(&a.midpoint(b)) {
                    found.push(Violation::HangingNode { triangle: TriangleId::from_index(index), node });
                }
            }
        }
    }

    fn check_area(&self, found: &mut Vec<Violation>) {
        let ids = (0..self.triangles.len()).map(TriangleId::from_index);
        let covered = ids.map(|id| twice_signed_area(self.corners(id)).unsigned_abs()).sum();
        let cell = u128::from(self.lattice.cell_steps());
        let expected = self.coarse.kept() as u128 * cell * cell;
        if covered != expected {
            found.push(Violation::AreaNotConserved { covered, expected });
        }
    }

    fn check_nodes(&self, found: &mut Vec<Violation>) {
        let mut used = vec![false; self.nodes.len()];
        for node in self.triangles.iter().flat_map(|t| t.vertices) {
            used[node.index()] = true;
        }
        let orphans = (0..self.nodes.len()).filter(|&n| !used[n]);
        found.extend(orphans.map(|n| Violation::OrphanNode(NodeId::from_index(n))));
        let mut first_at: HashMap<LatticePoint, NodeId> = HashMap::new();
        for (n, &place) in self.nodes.iter().enumerate() {
            let id = NodeId::from_index(n);
            let first = *first_at.entry(place).or_insert(id);
            if first != id {
                found.push(Violation::CoincidentNodes(first, id));
            }
        }
    }

    fn check_buckets(&self, found: &mut Vec<Violation>) {
        let [columns, rows] = self.lattice.cells().map(|n| n as usize);
        let cell = u64::from(self.lattice.cell_steps());
        for number in 0..2 * columns * rows {
            let Some(id) = self.coarse.get(number) else { continue };
            let left = (number / 2 % columns) as u64 * cell;
            let bottom = (number / 2 / columns) as u64 * cell;
            let inside = self.corners(id).iter().all(|c| {
                let (x, y) = (u64::from(c.x), u64::from(c.y));
                let in_cell = (left..=left + cell).contains(&x) && (bottom..=bottom + cell).contains(&y);
                let diagonal = left + bottom + cell;
                in_cell && if number.is_multiple_of(2) { x + y <= diagonal } else { x + y >= diagonal }
            });
            if !inside {
                found.push(Violation::LostBucket(id));
            }
        }
    }

    fn check_ledgers(&self, found: &mut Vec<Violation>) {
        let has_it = |n: &NodeId| {
            let noted = self.triangle_at.get(n.index()).and_then(|id| self.triangles.get(id.index()));
            noted.is_some_and(|triangle| triangle.vertices.contains(n))
        };
        let nodes = (0..self.nodes.len().max(self.triangle_at.len())).map(NodeId::from_index);
        found.extend(nodes.filter(|n| !has_it(n)).map(Violation::LostNode));
        let mut counted = [0; LevelAndSide::COUNT];
        for triangle in &self.triangles {
            counted[triangle.level_and_side().index()] += 1;
        }
        for outside in [false, true] {
            for level in 0..=DEEPEST_LEVEL as u32 {
                let kind = LevelAndSide::inside(level).with_outside(outside).index();
                let (noted, counted) = (self.counts.0[kind] as usize, counted[kind]);
                if counted != noted {
                    found.push(Violation::Miscounted { level, outside, noted, counted });
                }
            }
        }
    }
}

fn squared_distance(a: LatticePoint, b: LatticePoint) -> u128 {
    let (dx, dy) = (u128::from(a.x.abs_diff(b.x)), u128::from(a.y.abs_diff(b.y)));
    dx * dx + dy * dy
}

/// Positive when the corners run anticlockwise; in lattice squares.
fn twice_signed_area([a, b, c]: [LatticePoint; 3]) -> i128 {
    let difference = |p: LatticePoint, q: LatticePoint| {
        (i128::from(p.x) - i128::from(q.x), i128::from(p.y) - i128::from(q.y))
    };
    let (ab, ac) = (difference(b, a), difference(c, a));
    ab.0 * ac.1 - ab.1 * ac.0
}

/// A check that never fails proves nothing: each test breaks a mesh on purpose, and a violation must name the
/// break.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::{Limits, Neighbour, Triangle};

    /// Returns the unit square in 2 × 2 cells, refined around the first triangle.
    fn valid_mesh() -> Mesh {
        let mut mesh = Mesh::coarse_grid(
            &Lattice::covering(Rect::UNIT, 0.5, 1_000_000).unwrap(),
            |_| true,
            &Limits::default(),
        )
        .unwrap();
        for _ in 0..3 {
            mesh.refine_triangle(TriangleId(0));
        }
        assert_eq!(mesh.violations(), []);
        mesh
    }

    #[track_caller]
    fn assert_reported(mesh: &Mesh, expected: impl Fn(&Violation) -> bool) {
        let violations = mesh.violations();
        assert!(violations.iter().any(expected), "{violations:#?}");
    }

    /// Returns a triangle that has a neighbour across its bisection edge, and that neighbour.
    fn pair(mesh: &Mesh) -> (TriangleId, TriangleId) {
        let ids = (0..mesh.triangles.len()).map(TriangleId::from_index);
        let across = |id| mesh.triangle(id).raw_neighbours[0].triangle();
        let level = |id| mesh.triangle(id).level();
        ids.filter_map(|id| Some((id, across(id)?))).find(|&(a, b)| level(a) == level(b)).unwrap()
    }

    fn with_level(t: Triangle, level: u32) -> Triangle {
        Triangle::new(t.vertices, t.raw_neighbours, t.orientation(), LevelAndSide::inside(level))
    }

    #[test]
    fn a_dangling_reference_is_reported() {
        let mut mesh = valid_mesh();
        mesh.triangles[2].vertices[1] = NodeId(999);
        assert_eq!(mesh.violations(), [Violation::DanglingReference(TriangleId(2))]);
        let mut mesh = valid_mesh();
        mesh.triangles[3].raw_neighbours[2] = TriangleId(999).into();
        assert_eq!(mesh.violations(), [Violation::DanglingReference(TriangleId(3))]);
    }

    #[test]
    fn a_wrong_shape_is_reported() {
        let mut mesh = valid_mesh();
        mesh.triangles[1] = with_level(mesh.triangles[1], mesh.triangles[1].level() + 2);
        assert_reported(&mesh, |v| *v == Violation::WrongShape(TriangleId(1)));
    }

    #[test]
    fn a_wrong_orientation_is_reported() {
        let mut mesh = valid_mesh();
        let t = mesh.triangles[1];
        mesh.triangles[1] =
            Triangle::new(t.vertices, t.raw_neighbours, t.orientation().reversed(), t.level_and_side());
        assert_reported(&mesh, |v| *v == Violation::WrongOrientation(TriangleId(1)));
    }

    #[test]
    fn an_asymmetric_neighbour_is_reported() {
        let mut mesh = valid_mesh();
        let (a, b) = pair(&mesh);
        mesh.triangles[b.index()].raw_neighbours[0] = Neighbour::BOUNDARY;
        assert_reported(&mesh, |v| *v == Violation::AsymmetricNeighbour { triangle: a, edge: 0 });
        let mut mesh = valid_mesh();
        mesh.triangles[a.index()].raw_neighbours.rotate_left(1);
        assert_reported(
            &mesh,
            |v| matches!(v, Violation::AsymmetricNeighbour { triangle, .. } if *triangle == a),
        );
    }

    #[test]
    fn a_shared_edge_called_boundary_on_both_sides_is_reported() {
        let mut mesh = valid_mesh();
        let (a, b) = pair(&mesh);
        mesh.triangles[a.index()].raw_neighbours[0] = Neighbour::BOUNDARY;
        mesh.triangles[b.index()].raw_neighbours[0] = Neighbour::BOUNDARY;
        let [p, q] = mesh.triangle(a).bisection_edge();
        assert_eq!(mesh.violations(), [Violation::UnmatchedEdge(p.min(q), p.max(q))]);
    }

    #[test]
    fn a_hanging_node_is_reported() {
        let mut mesh = valid_mesh();
        let (a, b) = pair(&mesh);
        mesh.triangles[a.index()].raw_neighbours[0] = Neighbour::BOUNDARY;
        mesh.triangles[b.index()].raw_neighbours[0] = Neighbour::BOUNDARY;
        let node = NodeId::from_index(mesh.nodes.len());
        mesh.bisect_at_boundary(a);
        assert_eq!(mesh.violations(), [Violation::HangingNode { triangle: b, node }]);
    }

    #[test]
    fn a_jump_of_two_levels_is_reported() {
        let mut mesh = valid_mesh();
        let (a, b) = pair(&mesh);
        mesh.triangles[a.index()] = with_level(mesh.triangles[a.index()], mesh.triangle(b).level() + 2);
        assert_reported(&mesh, |v| *v == Violation::LevelJump(a.min(b), a.max(b)));
    }

    #[test]
    fn a_lost_area_is_reported() {
        let mut mesh = valid_mesh();
        let extent = mesh.lattice.extent();
        let corner = mesh.nodes.iter().position(|&n| n == extent).unwrap();
        mesh.nodes[corner].x -= 2;
        assert_reported(
            &mesh,
            |v| matches!(v, Violation::AreaNotConserved { covered, expected } if covered < expected),
        );
    }

    #[test]
    fn an_unused_node_and_one_on_top_of_another_are_reported() {
        let mut mesh = valid_mesh();
        let extra = NodeId::from_index(mesh.nodes.len());
        mesh.nodes.push(mesh.nodes[4]);
        assert_reported(&mesh, |v| *v == Violation::OrphanNode(extra));
        assert_reported(&mesh, |v| *v == Violation::CoincidentNodes(NodeId(4), extra));
    }

    #[test]
    fn a_lost_bucket_is_reported() {
        let mut mesh = valid_mesh();
        mesh.triangles.swap(2, 5);
        assert_reported(&mesh, |v| *v == Violation::LostBucket(TriangleId(2)));
        assert_reported(&mesh, |v| *v == Violation::LostBucket(TriangleId(5)));
    }

    #[test]
    fn a_wrong_entry_of_a_ledger_is_reported() {
        let mut mesh = valid_mesh();
        let elsewhere = mesh.triangles.iter().position(|t| !t.vertices.contains(&NodeId(4))).unwrap();
        mesh.triangle_at[4] = TriangleId::from_index(elsewhere);
        assert_eq!(mesh.violations(), [Violation::LostNode(NodeId(4))]);
        let mut mesh = valid_mesh();
        mesh.counts.0[7] += 1;
        let miscounted = Violation::Miscounted { level: 7, outside: false, noted: 1, counted: 0 };
        assert_eq!(mesh.violations(), [miscounted]);
        let mut mesh = valid_mesh();
        mesh.triangles[3].set_outside(true);
        assert_reported(&mesh, |v| matches!(v, Violation::Miscounted { outside: true, .. }));
    }
}
