//! The level of detail: triangles smaller than a pixel are drawn as the larger ones that they were bisected
//! from.
//!
//! A picture takes the colour of each pixel from one triangle, the one at the centre of the pixel. Where
//! triangles are smaller than pixels, drawing the others is wasted. So triangles finer than a *detail level*
//! are merged into their ancestors of that level, each of which has the colour of one triangle within it, its
//! *representative*. A picture with these is a picture of the same samples, each taken within the length of
//! the ancestor's bisection edge from where it would be taken otherwise.
//!
//! ```text
//!        ancestor at the detail level        its triangles; r is the representative
//!               /\                                   /|\
//!             /    \                               / |r/\
//!           /   r    \                           /\  |/   \
//!         /____________\                       /___\_|______\
//! ```
//!
//! At each bisection a coin decides which of the halves has the representative of the parent. So a triangle
//! represents an ancestor with the probability of its share of the area, and the mean colour of many
//! ancestors is that of their triangles. The coin is a function of the place, so the representatives are the
//! same in each frame, on the GPU and in software, and they do not depend on the order of the triangles.
//!
//! All follows from the level of a triangle and one point inside it. A triangle of level 2k is half of a cell
//! of the grid with side δ / 2ᵏ, and one of level 2k + 1 is a quarter of such a cell; mesh.wgsl has the same
//! functions.

use super::{Camera, LevelPaint, Style};
use meshbrush_mesh::geometry::{Lattice, LatticePoint};
use meshbrush_mesh::mesh::Triangle;

/// The coarsest detail level. Cells of coarser triangles can be as large as the lattice, so that four times
/// their side has no place in 32 bits, and such triangles are never small.
const COARSEST: u32 = 2;

/// Finer triangles than those of a level are merged into their ancestors of this level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detail {
    level: u32,
    halvings: u32,
}

impl Detail {
    /// Returns the detail level of a picture: the coarsest one whose triangles have legs of at most
    /// [`Style::merge_below_px`] and no visible edges. Returns `None` where nothing is merged.
    ///
    /// `camera` must be on the lattice of the mesh.
    pub fn of(camera: &Camera, style: &Style) -> Option<Self> {
        if style.merge_below_px <= 0.0 {
            return None;
        }
        let lattice = camera.lattice();
        let is_merged = |paint: &LevelPaint| paint.leg_px <= style.merge_below_px && paint.edge_alpha == 0.0;
        let paints = LevelPaint::all(camera, style);
        let merged = paints[COARSEST as usize..].iter().position(is_merged)?;
        let level = COARSEST + merged as u32;
        (level <= lattice.deepest_level()).then_some(Self { level, halvings: lattice.halvings() })
    }

    /// Returns the level.
    pub fn level(&self) -> u32 {
        self.level
    }

    /// Returns the corners of the ancestor that a triangle represents, or `None` if another triangle
    /// represents it. The triangle is given by its level, which must be finer than the detail level, and a
    /// point inside.
    #[inline]
    pub fn merged(&self, level: u32, inner: InnerPoint) -> Option<[LatticePoint; 3]> {
        let represents = (self.level + 1..=level).rev().all(|level| is_chosen(self.halvings, level, inner));
        represents.then(|| triangle_around(self.halvings, self.level, inner))
    }

    /// Returns the length of the bisection edges of merged triangles, rounded up to pixels: how far a
    /// triangle that changes can change the picture around it.
    pub fn reach_px(style: &Style) -> i32 {
        (std::f32::consts::SQRT_2 * style.merge_below_px).ceil() as i32
    }
}

/// Returns the coarsest detail level at which a triangle represents an ancestor, which may be itself.
#[inline]
pub fn coarsest_represented(lattice: &Lattice, level: u32, inner: InnerPoint) -> u32 {
    let mut coarsest = level;
    while coarsest > COARSEST && is_chosen(lattice.halvings(), coarsest, inner) {
        coarsest -= 1;
    }
    coarsest
}

/// A point strictly inside a triangle and, for each ancestor, strictly inside that one and off the diagonals
/// of its cell that pass through it. In quarters of a lattice step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InnerPoint {
    x: u32,
    y: u32,
}

impl InnerPoint {
    /// Returns the mean of the corners in which the apex counts twice.
    #[inline]
    pub fn of(triangle: &Triangle, nodes: &[LatticePoint]) -> Self {
        let [a, b, c] = triangle.vertices.map(|vertex| nodes[vertex.index()]);
        let apex = nodes[triangle.apex().index()];
        // Below 2³²: the lattice has 30 bits, and not all corners are at its far end.
        let sum = |a: u32, b: u32, c: u32, apex: u32| a.wrapping_add(b).wrapping_add(c).wrapping_add(apex);
        Self { x: sum(a.x, b.x, c.x, apex.x), y: sum(a.y, b.y, c.y, apex.y) }
    }
}

/// A point in a square cell of the grid.
struct CellPoint {
    cell: [u32; 2],
    /// From the lower left corner of the cell, in quarters of a lattice step.
    at: [u32; 2],
    /// The side of the cell in quarters of a lattice step.
    side: u32,
}

impl CellPoint {
    /// Returns the place of a point in the cell of triangles of `level`.
    #[inline]
    fn of(halvings: u32, level: u32, inner: InnerPoint) -> Self {
        let bits = halvings + 2 - level / 2;
        let side = 1 << bits;
        let InnerPoint { x, y } = inner;
        Self { cell: [x >> bits, y >> bits], at: [x & (side - 1), y & (side - 1)], side }
    }

    /// Returns whether the point lies to the lower right of the diagonal that rises.
    #[inline]
    fn is_right(&self) -> bool {
        self.at[0] > self.at[1]
    }

    /// Returns whether the point lies to the lower left of the diagonal that falls.
    #[inline]
    fn is_low(&self) -> bool {
        self.at[0] < self.side - self.at[1]
    }
}

/// Returns whether the triangle of `level` around a point has the representative of its parent.
#[inline]
fn is_chosen(halvings: u32, level: u32, inner: InnerPoint) -> bool {
    // The halves of a half are quarters of the same cell. The halves of a quarter are on both sides of the
    // middle of the cell's side.
    let place = CellPoint::of(halvings, level - 1, inner);
    let (right, low) = (place.is_right(), place.is_low());
    let is_along_x = right == low;
    let (half, parent) = if level % 2 == 1 {
        (is_along_x, 0)
    } else {
        let along = place.at[usize::from(!is_along_x)];
        (along >= place.side / 2, 1 + 2 * u32::from(right) + u32::from(low))
    };
    half == coin(place.cell, 8 * level + parent)
}

/// Returns a random bit for a triangle: a function of its cell and number.
#[inline]
fn coin([x, y]: [u32; 2], number: u32) -> bool {
    let mut hash =
        x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ number.wrapping_mul(0xc2b2_ae3d);
    hash = (hash ^ hash >> 15).wrapping_mul(0x2c1b_3c6d);
    hash = (hash ^ hash >> 12).wrapping_mul(0x297a_2d39);
    hash >> 31 == 1
}

/// Returns the corners of the triangle of `level` around a point.
#[inline]
fn triangle_around(halvings: u32, level: u32, inner: InnerPoint) -> [LatticePoint; 3] {
    let place = CellPoint::of(halvings, level, inner);
    let side = place.side / 4;
    let corner = |x: u32, y: u32| {
        let [column, row] = place.cell;
        LatticePoint::new(column * side + x * side, row * side + y * side)
    };
    let (right, low) = (place.is_right(), place.is_low());
    if level % 2 == 1 {
        let middle = corner(0, 0);
        let middle = LatticePoint::new(middle.x + side / 2, middle.y + side / 2);
        return match (right, low) {
            (true, true) => [middle, corner(0, 0), corner(1, 0)],
            (true, false) => [middle, corner(1, 0), corner(1, 1)],
            (false, false) => [middle, corner(1, 1), corner(0, 1)],
            (false, true) => [middle, corner(0, 1), corner(0, 0)],
        };
    }
    // The diagonal joins the corners whose sum of columns and rows is even.
    if (place.cell[0] + place.cell[1]).is_multiple_of(2) {
        [corner(u32::from(right), u32::from(!right)), corner(0, 0), corner(1, 1)]
    } else {
        [corner(u32::from(!low), u32::from(!low)), corner(1, 0), corner(0, 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshbrush_mesh::geometry::Rect;
    use meshbrush_mesh::mesh::{Limits, Mesh, TreeTriangle, TriangleId};
    use std::collections::HashMap;

    fn graded() -> Mesh {
        let lattice =
            Lattice::covering(Rect::new(glam::DVec2::ZERO, glam::dvec2(3.0, 2.0)), 1.0, 1000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        mesh.refine(&Limits::default(), |element| {
            let off = |p: glam::DVec2| (p.y - 0.5 - 0.37 * p.x).abs();
            let nearest = element.world_corners().map(off).into_iter().fold(f64::MAX, f64::min);
            element.diameter() > (0.3 * nearest).max(0.011)
        })
        .unwrap();
        mesh
    }

    fn key(corners: [LatticePoint; 3]) -> [(u32, u32); 3] {
        let mut key = corners.map(|p| (p.x, p.y));
        key.sort_unstable();
        key
    }

    #[test]
    fn each_ancestor_has_exactly_one_representative() {
        let mesh = graded();
        assert!(mesh.level_counts().len() > 12, "{:?}", mesh.level_counts());
        for level in COARSEST..14 {
            let detail = Detail { level, halvings: mesh.lattice().halvings() };
            let (mut drawn, mut ancestors) = (HashMap::new(), HashMap::new());
            for (index, triangle) in mesh.raw_triangles().iter().enumerate() {
                if triangle.level() <= level {
                    continue;
                }
                let inner = InnerPoint::of(triangle, mesh.raw_nodes());
                let tree = TreeTriangle::from_mesh(&mesh, TriangleId::from_index(index));
                let ancestor = tree.ancestors(mesh.lattice())[level as usize];
                *ancestors.entry(key(ancestor.corners())).or_insert(0) += 1;
                let merged = detail.merged(triangle.level(), inner);
                let coarsest = coarsest_represented(mesh.lattice(), triangle.level(), inner);
                assert_eq!(merged.is_some(), coarsest <= level);
                if let Some(merged) = merged {
                    assert_eq!(key(merged), key(ancestor.corners()), "level {level}");
                    *drawn.entry(key(merged)).or_insert(0) += 1;
                }
            }
            assert_eq!(drawn.len(), ancestors.len(), "level {level}");
            assert!(drawn.values().all(|&count| count == 1), "level {level}");
        }
    }

    #[test]
    fn a_triangle_represents_as_often_as_its_share_of_the_area_says() {
        let mesh = graded();
        let detail = Detail { level: 5, halvings: mesh.lattice().halvings() };
        let (mut finest, mut area, mut merged) = (0, 0.0, 0);
        for triangle in mesh.raw_triangles().iter().filter(|triangle| triangle.level() > 5) {
            let is_fine = triangle.level() > 8;
            let inner = InnerPoint::of(triangle, mesh.raw_nodes());
            if is_fine {
                area += 0.5f64.powi(triangle.level() as i32 - 5);
            }
            if detail.merged(triangle.level(), inner).is_some() {
                merged += 1;
                finest += usize::from(is_fine);
            }
        }
        let (share, expected) = (finest as f64 / f64::from(merged), area / f64::from(merged));
        assert!((share - expected).abs() < 0.1 && expected > 0.1, "{share} of {merged}, expected {expected}");
    }
}
