//! Layers given by a function of the point.

use glam::DVec2;

use crate::field::{Bounds, Formula, Quadratic, f32_not_below};
use crate::geometry::{Lattice, Rect};
use crate::layers::models::{self, ModelId, Place};
use crate::layers::{Quantity, Shapes, Threats};
use crate::raster::ValueRange;

use super::cells::{Cells, Cut};

/// A function of the point, and what its values mean.
#[derive(Clone, Debug)]
pub struct Analytic {
    pub function: Function,
    pub quantity: Quantity,
    /// Where models of the function are kept, if it has any.
    models: Option<ModelId>,
}

/// A function of the point, in world units.
#[derive(Clone, Debug)]
pub enum Function {
    Formula(Formula),
    /// The combined risk.
    Threats(Threats),
    /// d₀ + s · distance up to a range, then infinity. The distance is that beyond `reach` from the shapes.
    Distance {
        shapes: Shapes,
        reach: f64,
        at_zero: f64,
        slope: f64,
        range: f64,
    },
}

/// Squares of this many cells along a side of the lattice at most: the value of a function is constant on
/// each.
pub const FINEST_LOG: u32 = 15;

/// Binary logarithm of the side of the squares on which functions are constant, in lattice steps.
pub fn square_bits(lattice: &Lattice) -> u32 {
    let extent = lattice.extent();
    (extent.x.max(extent.y).next_power_of_two().ilog2()).saturating_sub(FINEST_LOG)
}

/// Number of these squares along the longer side of the lattice.
pub fn squares_along(lattice: &Lattice) -> u32 {
    let extent = lattice.extent();
    extent.x.max(extent.y).div_ceil(1 << square_bits(lattice))
}

/// Formulas with this many instructions or more are asked by models.
const LONG_FORMULA: usize = 24;

/// Lists with this many threats or more are asked by models.
const MANY_THREATS: usize = 8;

impl Function {
    fn at(&self, point: DVec2) -> f64 {
        match self {
            Self::Formula(formula) => formula.eval(point.x, point.y),
            Self::Threats(threats) => threats.risk_at(point),
            Self::Distance { shapes, .. } => self.at_distance(shapes.distance(point)),
        }
    }

    fn bounds(&self, rect: &Rect) -> Bounds {
        match self {
            Self::Formula(formula) => formula.bounds(rect),
            Self::Threats(threats) => threats.bounds(rect),
            Self::Distance { shapes, .. } => {
                let Bounds { least, greatest, valid } = shapes.bounds(rect);
                let [least, greatest] = [least, greatest].map(|distance| self.at_distance(distance));
                Bounds { least, greatest, valid }
            }
        }
    }

    /// Whether models of the function are cheaper than its bounds.
    fn has_models(&self) -> bool {
        match self {
            Self::Formula(formula) => formula.length() >= LONG_FORMULA,
            Self::Threats(threats) => threats.list().len() >= MANY_THREATS,
            Self::Distance { .. } => false,
        }
    }

    fn model(&self, place: &Place) -> Quadratic {
        match self {
            Self::Formula(formula) => formula.model(place.coordinates),
            Self::Threats(threats) => threats.model(place),
            Self::Distance { .. } => Quadratic::UNKNOWN,
        }
    }

    /// The value at a distance from the shapes.
    fn at_distance(&self, distance: f64) -> f64 {
        match self {
            Self::Distance { reach, at_zero, slope, range, .. } if distance - reach <= *range => {
                at_zero + slope * (distance - reach).max(0.0)
            }
            _ => f64::INFINITY,
        }
    }
}

impl Analytic {
    pub fn new(function: Function, quantity: Quantity) -> Self {
        let models = function.has_models().then(ModelId::new);
        Self { function, quantity, models }
    }

    /// The same, asked by its own bounds only.
    #[cfg(test)]
    pub fn without_models(self) -> Self {
        Self { models: None, ..self }
    }

    /// The value at a point in world units, as it counts: where it is not valid, that of nothing.
    pub fn at(&self, point: DVec2) -> f32 {
        self.value(self.function.at(point))
    }

    /// Whether a value is one that a layer may have.
    pub fn is_valid(&self, value: f64) -> bool {
        match self.quantity {
            // Infinity asks for nothing.
            Quantity::Diameter => value > 0.0,
            Quantity::Risk => !value.is_nan(),
        }
    }

    /// Whether all values in a rectangle, in world units, are certainly valid.
    pub fn is_valid_within(&self, rect: &Rect) -> bool {
        let Bounds { least, valid, .. } = self.function.bounds(rect);
        valid && (self.quantity == Quantity::Risk || least > 0.0)
    }

    /// What [`Self::is_valid`] demands, for a message.
    pub fn rule(&self) -> &'static str {
        match self.quantity {
            Quantity::Diameter => "a target diameter must be positive; write inf where it asks for nothing",
            Quantity::Risk => "a risk must be a number from 0 to 1",
        }
    }

    /// The number itself, unchecked.
    pub fn raw(&self, point: DVec2) -> f64 {
        self.function.at(point)
    }

    /// Rounded up: rounding to nearest could ask for one level more.
    fn value(&self, value: f64) -> f32 {
        match self.quantity {
            Quantity::Diameter if value > 0.0 => f32_not_below(value),
            Quantity::Diameter => f32::INFINITY,
            Quantity::Risk if value.is_nan() => 0.0,
            Quantity::Risk => value.clamp(0.0, 1.0) as f32,
        }
    }

    /// The range of the values of some cells, and where to divide them to know more. The values of a square
    /// of `1 << bits` cells are that at its centre.
    pub fn range(&self, cells: &Cells, lattice: &Lattice, bits: u32) -> (ValueRange, Option<Cut>) {
        let Some(cut) = cut_between_squares(cells, bits) else {
            return (ValueRange::one(self.at(center(cells, lattice, bits))), None);
        };
        let range = self.enclosed(self.bounds(&cells.rounded_out(bits), lattice, bits));
        (range, (!range.is_one()).then_some(cut))
    }

    /// Bounds of the numbers at the centres of squares of `1 << bits` cells.
    fn bounds(&self, cells: &Cells, lattice: &Lattice, bits: u32) -> Bounds {
        let own = || self.function.bounds(&cells.world_rect(lattice));
        match self.models {
            None => own(),
            Some(id) => models::bounds(id, cells, lattice, bits, |place| self.function.model(place), own),
        }
    }

    /// The range of the values that count, from the bounds of the numbers.
    pub fn enclosed(&self, bounds: Bounds) -> ValueRange {
        let Bounds { least, greatest, valid } = bounds;
        match self.quantity {
            Quantity::Risk => {
                let least = if valid { self.value(least) } else { 0.0 };
                ValueRange { least, greatest: self.value(greatest) }
            }
            Quantity::Diameter => {
                let all = valid && least > 0.0;
                let greatest = if all { self.value(greatest) } else { f32::INFINITY };
                // Zero and less count as nothing, but values just above zero ask for the smallest diameter.
                let least = if least > 0.0 { f32_not_below(least) } else { 0.0 };
                ValueRange { least, greatest }
            }
        }
    }
}

/// A cut between two squares of `1 << bits` cells, through the side with more of them; `None` where the cells
/// lie within one square.
pub fn cut_between_squares(cells: &Cells, bits: u32) -> Option<Cut> {
    let ends = |axis: usize| [cells.min[axis] >> bits, (cells.max[axis] - 1) >> bits];
    let count = |axis: usize| ends(axis)[1] - ends(axis)[0];
    let axis = usize::from(count(1) > count(0));
    let [first, last] = ends(axis);
    if first == last {
        return None;
    }
    // At the highest bit in which they differ, so that the parts of different rectangles coincide.
    let bit = (first ^ last).ilog2();
    Some(Cut { axis, at: (last >> bit << bit) << bits })
}

/// The centre of the square of `1 << bits` cells that holds the cells, in world units.
pub fn center(cells: &Cells, lattice: &Lattice, bits: u32) -> DVec2 {
    let half = 0.5 * (1i64 << bits) as f64;
    let corner = cells.min.map(|v| (v >> bits << bits) as f64 + half);
    lattice.bounds().min + DVec2::from(corner) * lattice.step()
}
