//! How fast h̄ can change before gradation.

use glam::DVec2;

use crate::field::Bounds;
use crate::layers::{Combine, PaintLayers};

use super::asked::Ternary;
use super::cells::Cells;
use super::compiled::CompiledLayer;
use super::cone::Cone;
use super::counting::Counting;
use super::reading::Diameters;
use super::stack::Stack;

/// Bounds of slopes are rounded up. Where h is steeper than g by this share of g alone, gradation takes at
/// most this share of h̄ away: it carries values of at least 0 over distances up to h̄ / g.
const MARGIN: f64 = 1e-9;

/// A function counts as falling only if it falls by more than this share of the slopes, since they are
/// rounded.
const DIRECTION_MARGIN: f64 = 1e-6;

/// Bounds of the gradient of a function in a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes {
    /// Bounds of the derivatives along x and y.
    along: [Bounds; 2],
    /// Upper bound of the length of the gradient; infinite if the function may jump, or no bound is known.
    length: f64,
    /// Each gradient is also the sum of a vector of the cone and one that `beside` bounds.
    cone: Option<Cone>,
    beside: [Bounds; 2],
}

const NONE: [Bounds; 2] = [Bounds::new(0.0, 0.0); 2];

impl Slopes {
    /// The slopes of a constant.
    pub const FLAT: Self = Self { along: NONE, length: 0.0, cone: None, beside: NONE };

    /// The slopes of a function that may jump: nothing is known.
    pub const UNKNOWN: Self = Self {
        along: [Bounds::ANYTHING; 2],
        length: f64::INFINITY,
        cone: None,
        beside: [Bounds::ANYTHING; 2],
    };

    /// Returns slopes from bounds along the axes and the largest length. All must be numbers.
    pub fn new(along: [Bounds; 2], length: f64) -> Self {
        Self { along, length, cone: None, beside: along }
    }

    /// Returns slopes from bounds along the axes, and a cone of all gradients if one is known.
    pub fn within(along: [Bounds; 2], cone: Option<Cone>) -> Self {
        let length = DVec2::from(along.map(|slope| slope.abs().greatest)).length();
        Self { along, length, cone, beside: if cone.is_some() { NONE } else { along } }
    }

    /// Returns slopes in any direction, up to a length.
    pub fn up_to(length: f64) -> Self {
        Self::new([Bounds::new(-length, length); 2], length)
    }

    /// Returns the slopes of a function of this function, from the bounds of its derivative.
    pub fn times(self, factor: Bounds) -> Self {
        let length = self.length * factor.abs().greatest;
        let scaled = |slopes: [Bounds; 2]| slopes.map(|slope| slope.times(factor));
        let is_number = |slope: &Bounds| slope.valid && slope.least.is_finite() && slope.greatest.is_finite();
        let along = scaled(self.along);
        if !(along.iter().all(is_number) && length.is_finite()) {
            return Self::UNKNOWN;
        }
        let cone = match self.cone {
            Some(cone) if factor.least >= 0.0 => Some(cone),
            Some(cone) if factor.greatest <= 0.0 => Some(cone.opposite()),
            _ => None,
        };
        Self { along, length, cone, beside: if cone.is_some() { scaled(self.beside) } else { along } }
    }

    /// Returns slopes that hold for both of two functions.
    pub fn or(self, other: Self) -> Self {
        let union = |a: [Bounds; 2], b: [Bounds; 2]| [0, 1].map(|axis: usize| a[axis].union(b[axis]));
        let cone = match (self.cone, other.cone) {
            (Some(a), Some(b)) => a.with(b),
            (a, b) => a.or(b),
        };
        let along = union(self.along, other.along);
        let beside = if cone.is_some() { union(self.beside, other.beside) } else { along };
        Self { along, length: self.length.max(other.length), cone, beside }
    }

    /// Returns an upper bound of the length of the gradient.
    #[cfg(test)]
    pub fn longest(&self) -> f64 {
        self.length
    }

    /// Returns whether the function may change by more than `slope` per unit of length.
    pub fn exceed(&self, slope: f64) -> bool {
        self.length > slope * (1.0 + MARGIN)
    }

    /// Returns whether the function falls along one direction all over the rectangle, if a gradient is added
    /// to its own: one that differs from `added` by at most `spread`. `permitted` changes a direction into
    /// one that the step may have.
    pub fn fall_with(&self, added: DVec2, spread: f64, permitted: impl Fn(DVec2) -> DVec2) -> bool {
        let falls = |bounds: &[Bounds; 2], cone: Option<Cone>| {
            let [least, greatest] = [bounds.map(|slope| slope.least), bounds.map(|slope| slope.greatest)];
            let [least, greatest] = [least, greatest].map(DVec2::from);
            let (middle, half) = (least.midpoint(greatest) + added, 0.5 * (greatest - least));
            let rise = permitted(cone.map_or(middle, |cone| cone.turned(middle)));
            let length = rise.length();
            let margin = DIRECTION_MARGIN * (half.element_sum() + middle.length() + spread);
            let is_permitted = cone.is_none_or(|cone| cone.rises_along(rise));
            is_permitted && middle.dot(rise) > rise.abs().dot(half) + (spread + margin) * length
        };
        falls(&self.along, None) || (self.cone.is_some() && falls(&self.beside, self.cone))
    }
}

/// What layers ask for in some cells.
struct AskedDiameters<'a> {
    /// The number of each layer that counts, the layer, and the diameters.
    layers: Vec<(usize, &'a CompiledLayer, Diameters)>,
    /// Whether the finest of all counts.
    is_minimum: bool,
}

impl<'a> AskedDiameters<'a> {
    /// Asks the layers that can count, and takes those out of `counting` that do not: without a diameter in
    /// the cells, below a layer that replaces all of them, and floors below which nothing is.
    fn of(stack: &'a Stack, paint: &PaintLayers, cells: &Cells, counting: &mut Counting) -> Self {
        let (mut layers, mut is_minimum) = (Vec::new(), true);
        for (number, layer) in stack.counting(*counting) {
            let diameters = layer.diameters(paint, cells, stack.lattice()).0;
            let is_alone = layers.is_empty();
            match (diameters.present, layer.combine) {
                (Ternary::Never, _) => continue,
                (_, Combine::Floor) if is_alone => continue,
                (Ternary::Always, Combine::Replace) => {
                    layers.clear();
                    is_minimum = true;
                }
                (_, Combine::Finest) => {}
                (_, Combine::Replace | Combine::Floor) => is_minimum &= is_alone,
            }
            layers.push((number, layer, diameters));
        }
        *counting = counting.only(layers.iter().map(|&(number, ..)| number));
        Self { layers, is_minimum }
    }
}

/// Returns bounds of the gradient of h̄ before gradation in some cells and on their border, unknown where it
/// may jump; and which layers can count there, of those that can count around.
///
/// A layer whose values are above those of another one all over does not count where the finest counts.
pub fn slopes(
    stack: &Stack,
    paint: &PaintLayers,
    cells: &Cells,
    mut counting: Counting,
) -> (Slopes, Counting) {
    // Values on both sides of the border count.
    let cells = &cells.with_neighbours(stack.lattice().extent());
    let AskedDiameters { layers: asked, is_minimum } = AskedDiameters::of(stack, paint, cells, &mut counting);
    let all = asked.iter().filter(|(_, _, diameters)| diameters.present == Ternary::Always);
    let decides = all.map(|(_, _, diameters)| diameters.greatest).fold(f64::INFINITY, f64::min);
    for (number, _, diameters) in &asked {
        if is_minimum && diameters.least > decides {
            counting = counting.without(*number);
        }
    }
    // Where nothing asks, h̄ is h_max: as if a layer asked for it.
    let h_max = stack.limits().h_max;
    let background = is_minimum.then_some(h_max).filter(|&h_max| stack.limits().unasked >= h_max);
    let decides = background.map_or(decides, |h_max| decides.min(h_max));
    let deciding = asked.iter().filter(|(_, _, diameters)| !is_minimum || diameters.least < decides);
    let deciding = || deciding.clone().map(|(_, layer, diameters)| (*layer, diameters));
    let is_smooth = |layer: &CompiledLayer, diameters: &Diameters| match background {
        _ if diameters.present == Ternary::Always => !layer.jumps(diameters),
        Some(h_max) => layer.fades_to(h_max, cells, stack.lattice()),
        None => false,
    };
    if !deciding().all(|(layer, diameters)| is_smooth(layer, diameters)) {
        return (Slopes::UNKNOWN, counting);
    }
    let limits = stack.limits().h_min..=h_max;
    let slopes = deciding().map(|(layer, diameters)| {
        let own = layer.slopes(cells, diameters, stack.lattice());
        // Beyond the limits, h̄ is a limit.
        let is_within = limits.contains(&diameters.least) && limits.contains(&diameters.greatest);
        if is_within { own } else { own.or(Slopes::FLAT) }
    });
    (slopes.reduce(Slopes::or).unwrap_or(Slopes::FLAT), counting)
}
