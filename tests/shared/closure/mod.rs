//! The smallest conforming refinement, found by brute force: bisect every triangle that breaks a rule until
//! none does.
//!
//! Shares no code with the core. A triangle is its three corners as whole numbers, the right angle first: no
//! vertex order, no levels stored, no neighbours, no numbering. Slow, and short enough to be believed.

use std::collections::HashSet;

/// A point in whole lattice coordinates.
pub type Point = [i64; 2];

/// Corners: the right angle, then the ends of the longest edge.
pub type Triangle = [Point; 3];

/// Returns a grid of `columns` × `rows` cells of side `cell`, each cut from its upper left to its lower
/// right; a half is kept when `contains` is true at its corners, given as (column, row).
pub fn coarse(columns: i64, rows: i64, cell: i64, contains: impl Fn(i64, i64) -> bool) -> Vec<Triangle> {
    let mut kept = Vec::new();
    for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
        let upper_left = [column, row + 1];
        let lower_right = [column + 1, row];
        for right_angle in [[column, row], [column + 1, row + 1]] {
            let triangle = [right_angle, upper_left, lower_right];
            if triangle.iter().all(|&[x, y]| contains(x, y)) {
                kept.push(triangle.map(|[x, y]| [x * cell, y * cell]));
            }
        }
    }
    kept
}

/// Returns how many bisections made the triangle from a coarse one: each halves the square of its longest
/// edge.
pub fn level(cell: i64, [_, a, b]: &Triangle) -> u32 {
    let square = i128::from(a[0] - b[0]).pow(2) + i128::from(a[1] - b[1]).pow(2);
    (2 * i128::from(cell).pow(2) / square).ilog2()
}

/// Bisects every triangle that `exceeds` its target or has a node in the middle of an edge, until there is
/// none.
///
/// Both reasons are forced, and bisecting one triangle never takes away the reason to bisect another: the
/// result is the smallest conforming refinement, in any order.
pub fn refine(mut triangles: Vec<Triangle>, exceeds: impl Fn(&Triangle) -> bool) -> Vec<Triangle> {
    let mut nodes: HashSet<Point> = triangles.iter().flatten().copied().collect();
    loop {
        let before = triangles.len();
        let mut next = Vec::with_capacity(before);
        for triangle in triangles {
            if exceeds(&triangle) || hangs(&triangle, &nodes) {
                let [right_angle, a, b] = triangle;
                let middle = midpoint(a, b).expect("the lattice is deep enough");
                nodes.insert(middle);
                next.extend([[middle, right_angle, a], [middle, right_angle, b]]);
            } else {
                next.push(triangle);
            }
        }
        triangles = next;
        if triangles.len() == before {
            return triangles;
        }
    }
}

fn hangs(&[a, b, c]: &Triangle, nodes: &HashSet<Point>) -> bool {
    [(a, b), (b, c), (c, a)].iter().any(|&(p, q)| midpoint(p, q).is_some_and(|m| nodes.contains(&m)))
}

fn midpoint(p: Point, q: Point) -> Option<Point> {
    let sum = [p[0] + q[0], p[1] + q[1]];
    (sum[0] % 2 == 0 && sum[1] % 2 == 0).then_some([sum[0] / 2, sum[1] / 2])
}

/// Returns the triangles as a set, independent of their order and that of their corners.
pub fn set_of(triangles: impl IntoIterator<Item = Triangle>) -> Vec<Triangle> {
    let sorted = |mut t: Triangle| {
        t.sort_unstable();
        t
    };
    let mut set: Vec<Triangle> = triangles.into_iter().map(sorted).collect();
    set.sort_unstable();
    set
}
