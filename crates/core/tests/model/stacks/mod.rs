//! Stacks of layers by their definition: h̄ on every rectangle between the lines of all layers.
//!
//! Shares no code with the core, except for the layers that are compared. All lines lie at multiples of a
//! [`GRAIN`], so that places are whole numbers.

use glam::{DVec2, dvec2};
use meshbrush_core::layers::Combine;

use super::closure::{Point, Triangle};

/// The domain's corner is 0, 0; all lines lie at multiples of this, in world units.
pub const GRAIN: f64 = 1.0 / 4096.0;

/// A layer as its definition has it.
pub struct Definition {
    pub combine: Combine,
    /// The target diameter at a point, in world units; infinite where nothing is asked for.
    pub diameter: Box<dyn Fn(DVec2) -> f64>,
    /// Where the diameter can change: x of vertical lines and y of horizontal ones, in grains.
    pub lines: [Vec<i64>; 2],
}

/// The bounds of h̄.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub h_min: f64,
    pub h_max: f64,
    pub unasked: f64,
    pub gradation: Option<f64>,
}

/// A closed rectangle with one diameter before gradation.
struct Piece {
    /// In grains.
    min: Point,
    max: Point,
    diameter: f64,
}

/// h̄ over a domain.
pub struct Field {
    /// By diameter, the smallest first.
    pieces: Vec<Piece>,
    gradation: Option<f64>,
    /// Lattice steps per grain.
    steps: i64,
}

impl Field {
    /// Returns the field of visible layers, from the bottom to the top, over a domain of [width, height]
    /// grains.
    pub fn new(layers: &[Definition], size: Point, bounds: &Bounds, steps: i64) -> Self {
        let [xs, ys] = [0, 1].map(|axis| {
            let mut lines: Vec<i64> = layers.iter().flat_map(|layer| layer.lines[axis].clone()).collect();
            lines.retain(|&line| 0 < line && line < size[axis]);
            lines.extend([0, size[axis]]);
            lines.sort_unstable();
            lines.dedup();
            lines
        });
        let mut pieces = Vec::new();
        for y in ys.windows(2) {
            for x in xs.windows(2) {
                let middle = dvec2((x[0] + x[1]) as f64, (y[0] + y[1]) as f64) * (0.5 * GRAIN);
                let diameter = combined(layers, bounds, middle);
                pieces.push(Piece { min: [x[0], y[0]], max: [x[1], y[1]], diameter });
            }
        }
        pieces.sort_by(|a, b| a.diameter.total_cmp(&b.diameter));
        Self { pieces, gradation: bounds.gradation, steps }
    }

    /// Returns the least h̄ over a closed triangle in lattice coordinates.
    pub fn least_within(&self, triangle: &Triangle) -> f64 {
        let mut least = f64::INFINITY;
        for piece in self.pieces.iter().take_while(|piece| piece.diameter < f64::INFINITY) {
            if piece.diameter >= least {
                break;
            }
            let [min, max] = [piece.min, piece.max].map(|corner| corner.map(|v| v * self.steps));
            if touches(triangle, min, max) {
                least = piece.diameter;
            } else if let Some(slope) = self.gradation {
                let world = |p: Point| dvec2(p[0] as f64, p[1] as f64) * (GRAIN / self.steps as f64);
                let distance = distance(triangle.map(world), world(min), world(max));
                least = least.min(piece.diameter + slope * distance);
            }
        }
        least
    }

    /// h̄ at a point in world units that lies on no line.
    pub fn at(&self, point: DVec2) -> f64 {
        let mut least = f64::INFINITY;
        for piece in &self.pieces {
            let corner = |[x, y]: Point| dvec2(x as f64, y as f64) * GRAIN;
            let distance = point.clamp(corner(piece.min), corner(piece.max)).distance(point);
            match self.gradation {
                Some(slope) => least = least.min(piece.diameter + slope * distance),
                None if distance == 0.0 => return piece.diameter,
                None => {}
            }
        }
        least
    }
}

/// Returns the target diameter of the visible layers at a point, before gradation.
pub fn combined(layers: &[Definition], bounds: &Bounds, point: DVec2) -> f64 {
    let mut target = f64::INFINITY;
    for layer in layers {
        let asked = (layer.diameter)(point);
        if asked == f64::INFINITY {
            continue;
        }
        target = match layer.combine {
            Combine::Finest => f64::min(target, asked),
            Combine::Floor => f64::max(target, asked),
            Combine::Replace => asked,
        };
    }
    if target == f64::INFINITY { bounds.unasked } else { target.max(bounds.h_min).min(bounds.h_max) }
}

/// Returns whether a closed triangle and a closed rectangle have a common point: no side of either separates
/// them.
pub fn touches(triangle: &Triangle, min: Point, max: Point) -> bool {
    for axis in 0..2 {
        let places = triangle.map(|corner| corner[axis]);
        if places.iter().all(|&v| v < min[axis]) || places.iter().all(|&v| v > max[axis]) {
            return false;
        }
    }
    let rectangle = [min, [max[0], min[1]], max, [min[0], max[1]]];
    (0..3).all(|n| {
        let [p, q, r] = [triangle[n], triangle[(n + 1) % 3], triangle[(n + 2) % 3]];
        let side = |c: Point| {
            let [a, b] = [[q[0] - p[0], q[1] - p[1]], [c[0] - p[0], c[1] - p[1]]];
            i128::from(a[0]) * i128::from(b[1]) - i128::from(a[1]) * i128::from(b[0])
        };
        let inner = side(r).signum();
        rectangle.iter().any(|&corner| side(corner) * inner >= 0)
    })
}

/// Returns the distance between a triangle and a rectangle without a common point.
fn distance(triangle: [DVec2; 3], min: DVec2, max: DVec2) -> f64 {
    let mut least = f64::INFINITY;
    for n in 0..3 {
        let (a, b) = (triangle[n], triangle[(n + 1) % 3]);
        least = least.min(a.clamp(min, max).distance(a));
        for corner in [min, dvec2(max.x, min.y), max, dvec2(min.x, max.y)] {
            let along = (corner - a).dot(b - a) / (b - a).length_squared();
            least = least.min((a + along.clamp(0.0, 1.0) * (b - a)).distance(corner));
        }
    }
    least
}
