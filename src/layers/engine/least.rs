//! The least h̄ in a closed triangle, by branch and bound over rectangles of cells.

use glam::DVec2;

use crate::geometry::{LatticePoint, Rect};
use crate::layers::{PaintLayers, SizeField};

use super::cells::{Cells, Cut};
use super::gradation::TriangleInWorld;

/// The least h̄ in a closed triangle.
pub struct Least {
    /// In world units.
    pub target: f64,
    /// A point of the triangle that has it.
    pub at: DVec2,
    /// The nearest point whose diameter makes it so: the same point, or one from which gradation carries it.
    pub from: DVec2,
}

/// What is above the least value by less than this share of it is not searched.
const TOLERANCE: f64 = 1e-9;

/// How often [`nearest_pair`] projects from one shape to the other. Each projection brings the points nearer.
const PROJECTIONS: usize = 60;

/// The least h̄ in the closed triangle with these corners.
pub fn least_within(field: &SizeField, paint: &PaintLayers, corners: [LatticePoint; 3]) -> Least {
    let triangle = TriangleInWorld::new(corners, field.lattice());
    let mut search = Search { field, paint, triangle, slope: field.spec().gradation, best: None };
    let all = Cells::all(field.lattice().extent());
    search.visit(&search.part(all));
    let (target, cells) = search.best.unwrap_or((field.spec().unasked, all));
    let (at, from) = nearest_pair(&search.triangle, &cells.world_rect(field.lattice()));
    Least { target, at, from }
}

struct Search<'a> {
    field: &'a SizeField,
    paint: &'a PaintLayers,
    triangle: TriangleInWorld,
    slope: Option<f64>,
    /// The least value so far, and the cells that have it.
    best: Option<(f64, Cells)>,
}

/// A rectangle of cells, and what is known of it.
struct Part {
    cells: Cells,
    /// No point of the triangle has a lower value by these cells.
    bound: f64,
    /// Where to divide the cells to know more.
    cut: Option<Cut>,
}

impl Search<'_> {
    fn part(&self, cells: Cells) -> Part {
        let distance = self.triangle.distance(&cells, self.field.lattice());
        let carried = match self.slope {
            Some(slope) => slope * distance,
            None if distance > 0.0 => f64::INFINITY,
            None => 0.0,
        };
        let ([least, _], cut) = self.field.diameters(self.paint, &cells);
        Part { cells, bound: least + carried, cut }
    }

    fn visit(&mut self, part: &Part) {
        let limit = self.best.map_or(f64::INFINITY, |(best, _)| best * (1.0 - TOLERANCE));
        if part.bound >= limit {
            return;
        }
        let Some(cut) = part.cut else {
            self.best = Some((part.bound, part.cells));
            return;
        };
        let mut parts = part.cells.divided(cut).map(|cells| self.part(cells));
        if parts[1].bound < parts[0].bound {
            parts.swap(0, 1);
        }
        parts.iter().for_each(|part| self.visit(part));
    }
}

/// A point of the triangle and a point of the rectangle that are as near to each other as any; the same point
/// where the shapes meet. By alternating projections between convex sets.
fn nearest_pair(triangle: &TriangleInWorld, rect: &Rect) -> (DVec2, DVec2) {
    let mut at = triangle.centroid();
    let mut from = at.clamp(rect.min, rect.max);
    for _ in 0..PROJECTIONS {
        at = triangle.nearest(from);
        from = at.clamp(rect.min, rect.max);
    }
    (at, from)
}
