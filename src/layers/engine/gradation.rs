//! The largest field that changes by no more than a given slope and never exceeds what the layers ask for:
//! h̄(x) = min over y of h(y) + g |x − y|.

use glam::DVec2;

use crate::geometry::{Lattice, LatticePoint, Octagon, Rect, nearest_on_segment};
use crate::layers::{PaintLayers, SizeField};

use super::cells::Cells;

/// Whether a cell of the lattice, at distance d from the closed triangle, has h + g d < `length`.
///
/// Branch and bound over rectangles of cells: a rectangle is skipped when even the least diameter in it, at
/// the distance of the rectangle, is not below; the search ends when the greatest one is.
pub fn any_below(
    field: &SizeField,
    paint: &PaintLayers,
    corners: [LatticePoint; 3],
    slope: f64,
    length: f64,
) -> bool {
    let lattice = field.lattice();
    let triangle = TriangleInWorld::new(corners, lattice);
    // Nothing is finer than h_min, so nothing beyond this distance matters.
    let reach = (length - field.spec().transfer.h_min) / slope;
    let Some(around) = cells_within(&triangle.bounds(), reach, lattice) else { return false };
    let search = Search { field, paint, triangle, slope, length };
    search.any(around)
}

struct Search<'a> {
    field: &'a SizeField,
    paint: &'a PaintLayers,
    triangle: TriangleInWorld,
    slope: f64,
    length: f64,
}

impl Search<'_> {
    fn any(&self, cells: Cells) -> bool {
        let (diameters, cut) = self.field.diameters(self.paint, &cells);
        if diameters[0] >= self.length {
            return false;
        }
        let distance = self.triangle.distance(&cells, self.field.lattice());
        if diameters[0] + self.slope * distance >= self.length {
            return false;
        }
        if diameters[1] + self.slope * distance < self.length {
            return true;
        }
        let Some(cut) = cut else { return false };
        let [low, high] = cells.divided(cut);
        self.any(low) || self.any(high)
    }
}

/// The least h + g d over all cells, at distance d from a point in world units, and the place of that cell.
pub fn least(field: &SizeField, paint: &PaintLayers, point: DVec2, slope: f64, start: f64) -> (f64, DVec2) {
    let lattice = field.lattice();
    let mut best = (start, point);
    let reach = (start - field.spec().transfer.h_min) / slope;
    let bounds = Rect::new(point, point);
    if let Some(around) = cells_within(&bounds, reach, lattice) {
        search_least(field, paint, point, slope, around, &mut best);
    }
    best
}

fn search_least(
    field: &SizeField,
    paint: &PaintLayers,
    point: DVec2,
    slope: f64,
    cells: Cells,
    best: &mut (f64, DVec2),
) {
    let (diameters, cut) = field.diameters(paint, &cells);
    let rect = cells.world_rect(field.lattice());
    let nearest = point.clamp(rect.min, rect.max);
    let distance = nearest.distance(point);
    if diameters[0] + slope * distance >= best.0 {
        return;
    }
    let sure = diameters[1] + slope * distance;
    if sure < best.0 {
        *best = (sure, nearest);
    }
    if let Some(cut) = cut {
        let mut parts = cells.divided(cut);
        // The nearer part first: it is more likely to have the least value.
        let middle = parts.map(|part| part.world_rect(field.lattice()).center().distance_squared(point));
        if middle[1] < middle[0] {
            parts.swap(0, 1);
        }
        parts.into_iter().for_each(|part| search_least(field, paint, point, slope, part, best));
    }
}

/// The cells of the lattice within a distance of a rectangle, and some more.
fn cells_within(bounds: &Rect, reach: f64, lattice: &Lattice) -> Option<Cells> {
    let around = lattice.rect_around(&bounds.expanded(reach))?;
    let [min, max] = [around.min, around.max].map(|p| [i64::from(p.x), i64::from(p.y)]);
    Cells { min: min.map(|v| v - 1), max: max.map(|v| v + 1) }.intersection(&Cells::all(lattice.extent()))
}

/// A triangle in units of the world, with the corner of the lattice as origin.
pub struct TriangleInWorld {
    corners: [DVec2; 3],
    octagon: Octagon,
    origin: DVec2,
}

impl TriangleInWorld {
    pub fn new(corners: [LatticePoint; 3], lattice: &Lattice) -> Self {
        Self {
            octagon: Octagon::triangle(corners),
            corners: corners.map(|c| c.as_dvec2() * lattice.step()),
            origin: lattice.bounds().min,
        }
    }

    pub fn centroid(&self) -> DVec2 {
        self.origin + self.corners.iter().sum::<DVec2>() / 3.0
    }

    /// The point of the closed triangle that is nearest to `point`, both in world units.
    pub fn nearest(&self, point: DVec2) -> DVec2 {
        let p = point - self.origin;
        let [a, b, c] = self.corners;
        let edges = [[a, b], [b, c], [c, a]];
        let sides = edges.map(|[from, to]| (to - from).perp_dot(p - from));
        if sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0) {
            return point;
        }
        let nearest = edges.map(|edge| nearest_on_segment(p, edge));
        let closer = |a: DVec2, b: DVec2| if b.distance_squared(p) < a.distance_squared(p) { b } else { a };
        self.origin + nearest.into_iter().fold(nearest[0], closer)
    }

    fn bounds(&self) -> Rect {
        let [a, b, c] = self.corners.map(|corner| corner + self.origin);
        Rect::new(a.min(b).min(c), a.max(b).max(c))
    }

    /// The distance between the closed triangle and the closed rectangle of some cells, in world units.
    pub fn distance(&self, cells: &Cells, lattice: &Lattice) -> f64 {
        if self.octagon.meets(&cells.octagon()) {
            return 0.0;
        }
        let corner = |[x, y]: [i64; 2]| DVec2::new(x as f64, y as f64) * lattice.step();
        let (min, max) = (corner(cells.min), corner(cells.max));
        let [a, b, c] = self.corners;
        // Of two convex polygons without a common point, a corner of one is nearest to the other.
        let to_rect = |p: DVec2| p.distance_squared(p.clamp(min, max));
        let mut least = to_rect(a).min(to_rect(b)).min(to_rect(c));
        for p in [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)] {
            for edge in [[a, b], [b, c], [c, a]] {
                least = least.min(p.distance_squared(nearest_on_segment(p, edge)));
            }
        }
        least.sqrt()
    }
}
