//! The order of nodes and triangles in files: along the Sierpiński curve.

use std::borrow::Cow;

use rayon::prelude::*;

use super::Extract;
use crate::geometry::{LATTICE_BITS, LatticePoint};
use crate::mesh::kernel::{Neighbour, NodeId, Triangle, TriangleId};

/// The side of the square of all lattices, in thirds of lattice steps: a centroid is then an integer.
const SIDE: i64 = 3 << LATTICE_BITS;

impl Extract<'_> {
    /// Returns the same triangles and nodes, numbered along the Sierpiński curve: triangles by their
    /// centroids, nodes as the triangles first use them. So neighbours have near numbers, and the numbers do
    /// not depend on the order of the mesh's entries. All threads work on it.
    ///
    /// ```text
    ///   o---o---o       The curve passes through one half of a triangle of the bisection tree before it
    ///   |\ 6|5 /|       enters the other half: its order is the one in which a walk through the tree
    ///   |7\ | /4|       visits the leaves.
    ///   o---o---o
    ///   |8/ | \3|
    ///   |/ 1|2 \|
    ///   o---o---o
    /// ```
    ///
    /// [`Self::place_of`] gives the new numbers. Takes 16 bytes a triangle while it works, and a copy
    /// of arrays that are the mesh's.
    pub fn along_curve(self) -> Extract<'static> {
        let CurveOrder { triangles: mut order, nodes } = self.curve_order();
        let mut numbers = vec![Neighbour::BOUNDARY; order.len()];
        for (number, &former) in order.iter().enumerate() {
            numbers[former as usize] = TriangleId::from_index(number).into();
        }
        let renumbered = |across: Neighbour| across.triangle().map_or(across, |id| numbers[id.index()]);
        let mut triangles = match self.triangles {
            Cow::Borrowed(of_mesh) => in_order(of_mesh, &order),
            Cow::Owned(mut own) => {
                put_in_order(&mut own, &mut order);
                own
            }
        };
        drop(order);
        let node_numbers = numbers_of(&nodes);
        triangles.par_iter_mut().for_each(|triangle| {
            triangle.raw_neighbours = triangle.raw_neighbours.map(renumbered);
            triangle.vertices = triangle.vertices.map(|node| node_numbers[node.index()]);
        });
        let coordinates = self.coordinates.map(|of| in_order(&of, &nodes));
        let places = match self.places {
            Some(mut places) => {
                places.par_iter_mut().for_each(|place| *place = renumbered(*place));
                places
            }
            None => numbers,
        };
        Extract {
            lattice: self.lattice,
            nodes: Cow::Owned(in_order(&self.nodes, &nodes)),
            triangles: Cow::Owned(triangles),
            places: Some(places),
            is_patched: self.is_patched,
            coordinates,
        }
    }

    /// Returns the order in which [`Self::along_curve`] has triangles and nodes.
    pub fn curve_order(&self) -> CurveOrder {
        let triangles = self.order_along_curve();
        let used = triangles.iter().flat_map(|&number| self.triangles[number as usize].vertices);
        let mut is_used = vec![false; self.nodes.len()];
        let mut nodes = Vec::with_capacity(self.nodes.len());
        for node in used {
            if !std::mem::replace(&mut is_used[node.index()], true) {
                nodes.push(node.index() as u32);
            }
        }
        CurveOrder { triangles, nodes }
    }

    /// Returns the numbers of the triangles in their order along the curve.
    fn order_along_curve(&self) -> Vec<u32> {
        let corners = |triangle: &Triangle| triangle.edge_nodes().map(|(from, _)| self.node(from));
        // Twelve bytes each, so that the order takes no more memory than other steps do.
        let placed = |(number, triangle)| {
            let place = place_along_curve(corners(triangle));
            [(place >> 32) as u32, place as u32, number as u32]
        };
        let mut placed: Vec<[u32; 3]> = self.triangles.par_iter().enumerate().map(placed).collect();
        // Two triangles have one place only where they are a few lattice steps large.
        let sorted_corners = |number: u32| {
            let mut corners = corners(&self.triangles[number as usize]);
            corners.sort_unstable();
            corners
        };
        let place = |[high, low, _]: &[u32; 3]| u64::from(*high) << 32 | u64::from(*low);
        placed.par_sort_unstable_by(|a, b| {
            place(a).cmp(&place(b)).then_with(|| sorted_corners(a[2]).cmp(&sorted_corners(b[2])))
        });
        placed.into_iter().map(|[_, _, number]| number).collect()
    }
}

/// The order of triangles and nodes along the Sierpiński curve ([`Extract::along_curve`]): the number that
/// each had before.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CurveOrder {
    triangles: Vec<u32>,
    nodes: Vec<u32>,
}

impl CurveOrder {
    /// Puts a value for each triangle in the order of the curve.
    ///
    /// # Panics
    /// Panics when there are fewer values than triangles.
    pub fn of_triangles<T: Copy + Send + Sync>(&self, values: &[T]) -> Vec<T> {
        in_order(values, &self.triangles)
    }

    /// Puts a value for each node in the order of the curve.
    ///
    /// # Panics
    /// Panics when there are fewer values than nodes.
    pub fn of_nodes<T: Copy + Send + Sync>(&self, values: &[T]) -> Vec<T> {
        in_order(values, &self.nodes)
    }
}

/// Returns the new number of each node, by its former one.
fn numbers_of(nodes: &[u32]) -> Vec<NodeId> {
    let mut numbers = vec![NodeId::from_index(0); nodes.len()];
    for (number, &former) in nodes.iter().enumerate() {
        numbers[former as usize] = NodeId::from_index(number);
    }
    numbers
}

/// Puts each entry where the order has its number. The order is used up.
fn put_in_order<T: Copy>(of: &mut [T], order: &mut [u32]) {
    for start in 0..of.len() {
        if order[start] as usize == start {
            continue;
        }
        // Around a cycle of the permutation.
        let (first, mut at) = (of[start], start);
        loop {
            let from = std::mem::replace(&mut order[at], at as u32) as usize;
            if from == start {
                of[at] = first;
                break;
            }
            of[at] = of[from];
            at = from;
        }
    }
}

fn in_order<T: Copy + Send + Sync>(of: &[T], order: &[u32]) -> Vec<T> {
    order.par_iter().map(|&number| of[number as usize]).collect()
}

/// Returns how far along the curve through the square of all lattices the centroid of a triangle is: for
/// each level of a bisection tree of the square, whether the centroid is in the second half.
fn place_along_curve(corners: [LatticePoint; 3]) -> u64 {
    let [x, y] = [|p: LatticePoint| p.x, |p: LatticePoint| p.y]
        .map(|of: fn(LatticePoint) -> u32| corners.iter().map(|&p| i64::from(of(p))).sum::<i64>());
    let mut is_second = y > x;
    // From the start of the hypotenuse: along the first leg, and along the second one.
    let (mut first, mut second) = if is_second { (SIDE - x, SIDE - y) } else { (x, y) };
    let mut place = u64::from(is_second);
    for _ in 1..u64::BITS {
        let (sum, difference) = (first + second, first - second);
        // Halves have their right angle at the middle of the hypotenuse, and legs half as long in units
        // that are twice as fine.
        is_second = sum > SIDE;
        (first, second) = if is_second { (SIDE - difference, sum - SIDE) } else { (sum, difference) };
        place = place << 1 | u64::from(is_second);
    }
    place
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::DVec2;

    use super::*;
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::MeshPatch;
    use crate::mesh::kernel::{Element, Limits, Mesh};

    fn mesh(spacing: f64, level: impl Fn(DVec2) -> u32) -> Mesh {
        let limits = Limits::default();
        let lattice = Lattice::covering(Rect::UNIT, spacing, limits.max_triangles).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &limits).unwrap();
        let exceeds = |element: &Element| {
            let [a, b, c] = element.world_corners();
            element.triangle.level() < level((a + b + c) / 3.0)
        };
        mesh.refine(&limits, exceeds).unwrap();
        mesh
    }

    type Corners = [LatticePoint; 3];

    fn corners(extract: &Extract, triangle: &Triangle) -> Corners {
        triangle.vertices.map(|node| extract.node(node))
    }

    /// The neighbours of each triangle by their corners: what the numbers do not matter for.
    fn by_place(extract: &Extract) -> HashMap<Corners, [Option<Corners>; 3]> {
        let place = |id: TriangleId| corners(extract, &extract.triangles()[id.index()]);
        let neighbours = |t: &Triangle| t.raw_neighbours.map(|across| across.triangle().map(place));
        extract.triangles().iter().map(|t| (corners(extract, t), neighbours(t))).collect()
    }

    #[test]
    fn only_numbers_change_and_they_are_told() {
        let mesh = mesh(0.1, |at| if at.x > 0.6 && at.y < 0.3 { 9 } else { 3 });
        for patch in [MeshPatch::default(), all_but_one(&mesh)] {
            let made = mesh.extract_with(&patch);
            let ordered = made.clone().along_curve();
            assert_eq!(by_place(&made), by_place(&ordered));
            assert_eq!(made.nodes().len(), ordered.nodes().len());
            for index in 0..mesh.raw_triangle_count() {
                let id = TriangleId::from_index(index);
                let at = ordered.place_of(id).map(|id| corners(&ordered, &ordered.triangles()[id.index()]));
                assert_eq!(at, made.place_of(id).map(|_| mesh.triangle(id).vertices.map(|v| mesh.node(v))));
            }
            let first_uses = ordered.triangles().iter().flat_map(|triangle| triangle.vertices);
            let order = made.curve_order();
            assert_eq!(order.of_nodes(made.nodes()), ordered.nodes());
            let levels =
                |extract: &Extract| extract.triangles().iter().map(Triangle::level).collect::<Vec<_>>();
            assert_eq!(order.of_triangles(&levels(&made)), levels(&ordered));
            let highest = first_uses.fold(0, |next, node| {
                assert!(node.index() <= next, "nodes are numbered as they are first used");
                next.max(node.index() + 1)
            });
            assert_eq!(highest, ordered.nodes().len());
        }
    }

    /// A patch that removes a triangle.
    fn all_but_one(mesh: &Mesh) -> MeshPatch {
        let removed = TriangleId::from_index(mesh.raw_triangle_count() / 2);
        MeshPatch { changed: vec![(removed, 0..0)], ..MeshPatch::default() }
    }

    /// Each triangle is beside the one before it, however the sizes vary. In every other coarse cell the
    /// diagonal is not that of the tree, so that this begins at level 1.
    #[test]
    fn the_next_triangle_is_a_neighbour() {
        for spacing in [0.5, 0.25, 0.0625] {
            for finest in [1, 4, 11] {
                let mesh = mesh(spacing, |at| if at.distance(DVec2::splat(0.3)) < 0.1 { finest } else { 2 });
                let extract = mesh.extract().along_curve();
                for (number, cell) in extract.cells().enumerate().skip(1) {
                    assert!(cell.opposite.contains(&Some(number - 1)), "{spacing}, {finest}: {number}");
                }
            }
        }
    }
}
