use glam::{DVec2, dvec2};

use crate::field::f32_not_below;
use crate::geometry::nearest_share;
use crate::layers::Quantity;
use crate::mesh::TargetChange;
use crate::text::Number;

/// The effect of a brush on the pixels under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Medium {
    /// Moves the risk towards this value, 0 to 1. Each stroke moves it by the brush's strength.
    Risk(f64),
    /// Changes the target diameter to this value, in world units, if the change is of the given kind.
    Diameter(f64, DiameterChange),
    /// Sets the largest error from surfaces to this value, in their unit, where the brush covers a pixel by
    /// half or more.
    Error(f64),
    /// Removes risk, target diameter and error.
    Eraser,
}

impl Medium {
    /// Returns the medium that a program names: `quantity` is `risk`, `diameter` or `error` with its value,
    /// and anything else the eraser. `change`, which is `finer`, `coarser` or `any`, counts for diameters
    /// alone.
    ///
    /// # Errors
    /// Fails with a sentence for another change, and for a value that the quantity cannot have.
    pub fn named(quantity: &str, value: f64, change: &str) -> Result<Self, String> {
        let change = match change {
            "finer" => DiameterChange::Finer,
            "coarser" => DiameterChange::Coarser,
            "any" => DiameterChange::Any,
            word => {
                let advice = "write one of finer, coarser, any.";
                return Err(format!("change: \"{word}\" is not possible here; {advice}"));
            }
        };
        let refused = |rule: &str| Err(format!("{quantity}: {} cannot be used: {rule}.", Number(value)));
        match quantity {
            "diameter" if value > 0.0 && value.is_finite() => Ok(Self::Diameter(value, change)),
            "diameter" => refused("a length must be positive and finite"),
            "error" if value > 0.0 && value < f64::from(f32::MAX) => Ok(Self::Error(value)),
            "error" => refused("an error must be positive and finite"),
            "risk" if (0.0..=1.0).contains(&value) => Ok(Self::Risk(value)),
            "risk" => refused("a risk lies from 0 to 1"),
            _ => Ok(Self::Eraser),
        }
    }

    /// Returns the effect on the target diameters of pixels. `h_max` is the largest diameter, in world units.
    pub fn change(&self, h_max: f64) -> TargetChange {
        match *self {
            Self::Risk(aim) if aim >= 1.0 => TargetChange::Finer,
            // Towards the rim the new diameter grows to the largest, and beyond it where that is smaller.
            Self::Diameter(target, DiameterChange::Finer) if target <= h_max => TargetChange::Finer,
            Self::Risk(aim) if aim <= 0.0 => TargetChange::Coarser,
            Self::Diameter(_, DiameterChange::Coarser) | Self::Eraser => TargetChange::Coarser,
            Self::Risk(_) | Self::Diameter(..) | Self::Error(_) => TargetChange::Any,
        }
    }
}

/// The changes of a painted target diameter that a brush makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiameterChange {
    /// Only to a smaller diameter. Towards the soft rim the new diameter grows to the document's largest.
    Finer,
    /// Only to a larger diameter. Pixels that are not painted stay so.
    Coarser,
    /// To any other diameter. Towards the soft rim the new diameter approaches the old one.
    Any,
}

/// A round brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// The effect on a pixel.
    pub medium: Medium,
    /// Radius in world units.
    pub radius: f64,
    /// Fraction of the radius with full coverage, 0 to 1; from there the coverage falls to 0 at the rim.
    pub hardness: f64,
    /// Share of the way to the full effect that one stroke moves a pixel, 0 to 1.
    pub strength: f64,
}

impl Brush {
    /// Returns the radius of the core, in world units.
    pub(super) fn core_radius(&self) -> f64 {
        self.radius * self.hardness.clamp(0.0, 1.0)
    }

    /// Returns the coverage at a distance from the brush's centre, in world units: 1 in the core, 0 at the
    /// rim and beyond.
    pub fn coverage(&self, distance: f64) -> f64 {
        let core = self.core_radius();
        if distance <= core {
            1.0
        } else if distance >= self.radius {
            0.0
        } else {
            // Smoothstep from the rim to the core.
            let t = (self.radius - distance) / (self.radius - core);
            t * t * (3.0 - 2.0 * t)
        }
    }

    /// Returns the coverage of a pixel at `point` by the segment of a path, times the strength of the path.
    ///
    /// Size and strength change linearly along the segment; their values at the point nearest to the pixel
    /// count.
    #[inline]
    pub(super) fn coverage_of_segment(&self, point: DVec2, [from, to]: [PathPoint; 2]) -> f64 {
        let (share, distance) = nearest_on_path(point, [from.at, to.at]);
        let between = |a: f64, b: f64| a + share * (b - a);
        let radius = self.radius * between(from.size, to.size);
        between(from.strength, to.strength) * Self { radius, ..*self }.coverage(distance)
    }

    /// Returns the new value of a pixel from the old one, in a raster whose blank pixels have the value
    /// `blank`: 0 in a raster of risks, infinite in one of diameters, `f32::MAX` in one of errors.
    /// `coverage` is the coverage by the stroke, 0 to 1; `h_max` is the largest target diameter, in world
    /// units. A brush for another kind of raster changes nothing.
    #[inline]
    pub(super) fn painted_value(&self, coverage: f32, old: f32, blank: f32, h_max: f64) -> f32 {
        let amount = f64::from(coverage) * self.strength;
        let is_of = |quantity: Quantity| blank == quantity.blank();
        match self.medium {
            Medium::Risk(aim) if is_of(Quantity::Risk) => moved_risk(old, aim, amount),
            Medium::Diameter(target, change) if is_of(Quantity::Diameter) => {
                changed_diameter(old, target, change, amount, h_max)
            }
            Medium::Error(error) if is_of(Quantity::Error) && amount >= 0.5 => f32_not_below(error),
            Medium::Eraser if is_of(Quantity::Error) => {
                if amount >= 0.5 {
                    blank
                } else {
                    old
                }
            }
            Medium::Eraser if is_of(Quantity::Risk) => moved_risk(old, 0.0, amount),
            Medium::Eraser => raised_diameter(old, h_max, amount, h_max),
            _ => old,
        }
    }
}

/// Returns a risk moved towards `aim`. A remainder below a hundredth on the way to 0 becomes 0: it would keep
/// the mesh refined without being visible.
fn moved_risk(risk: f32, aim: f64, amount: f64) -> f32 {
    if aim == 0.0 {
        let left = f64::from(risk) * (1.0 - amount);
        return if left < 0.01 { 0.0 } else { left as f32 };
    }
    if amount >= 1.0 { aim as f32 } else { (f64::from(risk) + amount * (aim - f64::from(risk))) as f32 }
}

fn changed_diameter(old: f32, target: f64, change: DiameterChange, amount: f64, h_max: f64) -> f32 {
    match change {
        DiameterChange::Finer => {
            let graded = if amount >= 1.0 { target } else { h_max * libm::pow(target / h_max, amount) };
            old.min(f32_not_below(graded))
        }
        DiameterChange::Coarser => raised_diameter(old, target, amount, h_max),
        DiameterChange::Any if f64::from(old) < target => raised_diameter(old, target, amount, h_max),
        DiameterChange::Any => {
            let old = f64::from(old).min(h_max);
            let graded = if amount >= 1.0 { target } else { old * libm::pow(target / old, amount) };
            painted_or_blank(f32_not_below(graded), h_max)
        }
    }
}

/// Returns a diameter moved up towards `target`, on a logarithmic scale.
fn raised_diameter(old: f32, target: f64, amount: f64, h_max: f64) -> f32 {
    let diameter = f64::from(old);
    let raised = diameter * libm::pow((target / diameter).max(1.0), amount);
    let raised = if amount >= 1.0 { raised.max(target) } else { raised };
    painted_or_blank(f32_not_below(raised), h_max)
}

/// Returns the diameter, or the blank value if it is almost as large as the largest one.
fn painted_or_blank(diameter: f32, h_max: f64) -> f32 {
    if f64::from(diameter) >= 0.99 * h_max { f32::INFINITY } else { diameter }
}

/// A point of a stroke's path, with the brush there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Position in world units.
    pub at: DVec2,
    /// Radius in proportion to that of the brush.
    pub size: f64,
    /// Strength in proportion to that of the brush, 0 to 1.
    pub strength: f64,
}

impl From<DVec2> for PathPoint {
    /// Returns a point with the whole size and strength of the brush.
    fn from(at: DVec2) -> Self {
        Self { at, size: 1.0, strength: 1.0 }
    }
}

impl PathPoint {
    /// Returns whether all numbers of the point are finite.
    pub fn is_finite(&self) -> bool {
        self.at.is_finite() && self.size.is_finite() && self.strength.is_finite()
    }
}

/// The lines in which a stroke is repeated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mirror {
    /// The x of a vertical line, in world units.
    pub x: Option<f64>,
    /// The y of a horizontal line, in world units.
    pub y: Option<f64>,
}

impl Mirror {
    /// Returns the point itself, and its images: one, two or four points.
    pub fn images(&self, point: DVec2) -> impl Iterator<Item = DVec2> + use<> {
        let x = self.x.map(|x| 2.0 * x - point.x);
        let y = self.y.map(|y| 2.0 * y - point.y);
        let columns = [Some(point.x), x].into_iter().flatten();
        columns.flat_map(move |x| [Some(point.y), y].into_iter().flatten().map(move |y| dvec2(x, y)))
    }

    /// Returns a segment of a path, and its images.
    pub(super) fn segments(
        &self,
        [from, to]: [PathPoint; 2],
    ) -> impl Iterator<Item = [PathPoint; 2]> + use<> {
        let ends = self.images(from.at).zip(self.images(to.at));
        ends.map(move |(a, b)| [PathPoint { at: a, ..from }, PathPoint { at: b, ..to }])
    }
}

/// Returns the point of a segment that is nearest to `point`: its share of the segment, 0 to 1, and its
/// distance.
#[inline]
pub(super) fn nearest_on_path(point: DVec2, [a, b]: [DVec2; 2]) -> (f64, f64) {
    let share = nearest_share(point, [a, b]);
    (share, (point - a - (b - a) * share).length())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_medium_is_named_by_words_and_values_that_its_quantity_can_have() {
        let values = [-1.0, -0.0, 0.0, 1e-300, 0.5, 1.0, 1.0f64.next_up(), 1e39, f64::INFINITY, f64::NAN];
        for value in values {
            let named = |quantity| Medium::named(quantity, value, "coarser");
            let is_length = value > 0.0 && value < f64::INFINITY;
            assert_eq!(named("diameter").is_ok(), is_length, "{value}");
            assert_eq!(named("risk").is_ok(), (0.0..=1.0).contains(&value), "{value}");
            assert_eq!(named("error").is_ok(), is_length && value < 1e39, "{value}");
            assert_eq!(named("eraser"), Ok(Medium::Eraser));
            for quantity in ["diameter", "risk", "error"] {
                let sentence = named(quantity).err().unwrap_or_default();
                assert!(
                    sentence.is_empty() || sentence.starts_with(&format!("{quantity}: {}", Number(value)))
                );
            }
        }
        assert_eq!(Medium::named("risk", 0.25, "finer"), Ok(Medium::Risk(0.25)));
        assert_eq!(Medium::named("error", 2.0, "finer"), Ok(Medium::Error(2.0)));
        let diameter = |word| Medium::named("diameter", 2.0, word);
        assert_eq!(diameter("finer"), Ok(Medium::Diameter(2.0, DiameterChange::Finer)));
        assert_eq!(diameter("coarser"), Ok(Medium::Diameter(2.0, DiameterChange::Coarser)));
        assert_eq!(diameter("any"), Ok(Medium::Diameter(2.0, DiameterChange::Any)));
        assert!(diameter("smaller").unwrap_err().starts_with("change: \"smaller\" is not possible here"));
    }
}
