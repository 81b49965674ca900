//! Layers given by a function of the point.

use glam::DVec2;

use crate::field::{Bounds, Formula, TaylorModel, f32_not_below};
use crate::geometry::{Lattice, Rect};
use crate::layers::models::{self, BoundedModel, ModelDomain, ModelId};
use crate::layers::near_segments::near;
use crate::layers::{FeatureSize, LineSizes, Quantity, Shapes, Straits, Threats};
use crate::raster::ValueRange;

use super::cells::{Cells, Cut};
use super::compiled::Carried;
use super::cone::Cone;
use super::convex::Convex;
use super::patch::TouchedCells;
use super::steepness::Slopes;

/// A function of the point, and what its values mean.
#[derive(Clone, Debug)]
pub struct Analytic {
    pub function: Function,
    pub quantity: Quantity,
    /// The key of what is kept about the function in squares, if that is something.
    kept: Option<ModelId>,
}

/// A function of the point, in world units.
#[derive(Clone, Debug)]
pub enum Function {
    Formula(Formula),
    /// The combined risk.
    Threats(Threats),
    /// A function of the distance from shapes.
    Distance {
        shapes: Shapes,
        profile: Profile,
    },
    /// A part of the width of straits, by the greatest scale.
    Straits(Straits, f64),
    /// A part of the width of the water, by the greatest scale.
    FeatureSize(FeatureSize, f64),
    /// What lines need, by the greatest scale.
    Lines(LineSizes, f64),
}

/// d₀ + s · distance up to a range, then infinity. The distance is that beyond `reach` from the shapes.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    pub reach: f64,
    pub at_zero: f64,
    pub slope: f64,
    pub range: f64,
    /// The diameters that gradation carries away from the shapes, if a closed form is known.
    pub graded: Option<Graded>,
}

/// Gradation of the function of a distance, in closed form.
///
/// ```text
///        s > g                         s ≤ g
///            /  .-'                        .-' g
///         s / .-' g                   _.--'
///          /-'                   __--' s
///   -------'  h_min           ---'  h_min         distance
/// ```
///
/// On the straight way to the nearest shape, h falls by s per unit of length. So it is best to go all the way
/// if s > g, and otherwise not at all, or to the range.
#[derive(Clone, Copy, Debug)]
pub struct Graded {
    gradation: f64,
    /// Up to this diameter; where more would be carried, the function is the one before gradation.
    pub most: f64,
}

impl Profile {
    /// Returns the profile of lengths on the Earth. Those in the plane are at most so much longer.
    pub fn on_earth(reach: f64, [at_zero, slope, range]: [f64; 3], greatest_scale: f64) -> Self {
        let [reach, range] = [reach, range].map(|length| length * greatest_scale);
        Self { reach, at_zero, slope: slope / greatest_scale, range, graded: None }
    }

    /// Returns the value at a distance from the shapes.
    fn at(&self, distance: f64) -> f64 {
        let beyond = distance - self.reach;
        let within = beyond <= self.range;
        let asked = if within { self.at_zero + self.slope * beyond.max(0.0) } else { f64::INFINITY };
        let Some(Graded { gradation, most }) = self.graded else { return asked };
        let flat = if self.slope <= gradation { beyond.min(self.range) } else { 0.0 };
        let carried = self.at_zero + self.slope * flat.max(0.0) + gradation * (beyond - flat).max(0.0);
        if carried < asked && carried <= most { carried } else { asked }
    }

    /// Returns bounds of the values from those of the distance.
    fn bounds(&self, Bounds { least, greatest, valid }: Bounds) -> Bounds {
        Bounds { least: self.at(least), greatest: self.at(greatest), valid }
    }

    /// Returns this function after gradation, where it is at least h_min. The shapes must be in the area
    /// where h̄ is wanted, so that the segments to them are.
    fn graded(self, gradation: f64, h_min: f64, most: f64) -> Self {
        let below = if self.slope > 0.0 { ((h_min - self.at_zero) / self.slope).max(0.0) } else { 0.0 };
        // Within that distance h is h_min.
        let below = below.min(self.range);
        Self {
            reach: self.reach + below,
            at_zero: self.at_zero.max(h_min),
            range: self.range - below,
            graded: Some(Graded { gradation, most }),
            ..self
        }
    }

    /// Returns the greatest slope, where the function does not jump.
    pub fn steepness(&self) -> f64 {
        match self.graded {
            Some(Graded { gradation, .. }) => self.slope.min(gradation),
            None => self.slope,
        }
    }
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
            Self::Distance { shapes, profile } => profile.at(shapes.distance(point)),
            Self::Straits(straits, scale) => straits.diameter(straits.found.width_at(point)) / scale,
            Self::FeatureSize(size, scale) => size.diameter_at(point) / scale,
            Self::Lines(sizes, scale) => sizes.diameter_at(point) / scale,
        }
    }

    fn bounds(&self, rect: &Rect) -> Bounds {
        match self {
            Self::Formula(formula) => formula.bounds(rect),
            Self::Threats(threats) => threats.bounds(rect),
            Self::Distance { shapes, profile } => profile.bounds(shapes.bounds(rect)),
            Self::Straits(straits, scale) => {
                let Bounds { least, greatest, valid } = straits.found.bounds(rect);
                let [least, greatest] = [least, greatest].map(|width| straits.diameter(width) / scale);
                Bounds { least, greatest, valid }
            }
            Self::FeatureSize(size, scale) => divided(size.bounds(rect), *scale),
            Self::Lines(sizes, scale) => divided(sizes.bounds(rect), *scale),
        }
    }

    /// Returns whether something about squares is worth keeping: models, where they are cheaper than bounds,
    /// and the nearest segments.
    fn is_kept(&self) -> bool {
        match self {
            Self::Formula(formula) => formula.length() >= LONG_FORMULA,
            Self::Threats(threats) => threats.list().len() >= MANY_THREATS,
            Self::Distance { .. } => true,
            Self::Straits(..) | Self::FeatureSize(..) | Self::Lines(..) => false,
        }
    }

    fn model(&self, place: &ModelDomain) -> BoundedModel {
        match self {
            Self::Formula(formula) => BoundedModel::of(formula.model(place.coordinates)),
            Self::Threats(threats) => threats.bounded_model(place),
            Self::Distance { .. } | Self::Straits(..) | Self::FeatureSize(..) | Self::Lines(..) => {
                BoundedModel::of(TaylorModel::UNKNOWN)
            }
        }
    }

    /// Returns the function with what gradation carries, where a closed form is known: at least h_min, up to
    /// `most`.
    pub fn graded(&self, gradation: f64, h_min: f64, most: f64, bounds: &Rect) -> Option<Self> {
        let Self::Distance { shapes, profile } = self else { return None };
        self.carries_from_within(bounds).then(|| Self::Distance {
            shapes: shapes.clone(),
            profile: profile.graded(gradation, h_min, most),
        })
    }

    /// Returns whether there is a closed form of what gradation carries to a point, which comes from within
    /// bounds.
    pub fn carries_from_within(&self, bounds: &Rect) -> bool {
        match self {
            Self::Distance { shapes, .. } => {
                let extent = shapes.extent();
                bounds.contains(extent.min) && bounds.contains(extent.max)
            }
            Self::Straits(straits, _) => straits.found.are_in(bounds),
            Self::Formula(_) | Self::Threats(_) | Self::FeatureSize(..) | Self::Lines(..) => false,
        }
    }

    /// Returns the diameter that gradation carries to a point, and the point that it comes from, if a closed
    /// form is known. Those that are not below `limit` may be left out.
    pub fn carried_to(&self, point: DVec2, carried: Carried, limit: f64) -> Option<(f64, DVec2)> {
        let (shapes, profile) = match self {
            Self::Distance { shapes, profile } => (shapes, profile),
            Self::Straits(straits, scale) => {
                let diameter = |width| (straits.diameter(width) / scale).max(carried.h_min);
                return straits.found.carried_to(point, carried.slope, limit, diameter);
            }
            Self::Formula(_) | Self::Threats(_) | Self::FeatureSize(..) | Self::Lines(..) => return None,
        };
        let graded = profile.graded?;
        let nearest = shapes.nearest(point);
        let distance = nearest.distance(point);
        let source = profile.reach + if profile.slope <= graded.gradation { profile.range } else { 0.0 };
        let from = if source < distance { nearest.lerp(point, source / distance) } else { point };
        Some((profile.at(distance), from))
    }

    /// Returns bounds of the gradient over a rectangle; unknown where the function may jump, or they are not
    /// known.
    pub fn slopes(&self, rect: &Rect) -> Slopes {
        match self {
            Self::Formula(formula) => {
                formula.slopes(rect).map_or(Slopes::UNKNOWN, |(along, length)| Slopes::new(along, length))
            }
            // The risk falls away from each threat.
            Self::Threats(threats) => {
                Slopes::within(threats.slopes(rect), threats.outward(rect).map(Cone::opposite))
            }
            Self::Distance { profile, .. } => Slopes::up_to(profile.steepness()),
            Self::FeatureSize(size, scale) => Slopes::up_to(size.steepness() / scale),
            Self::Lines(sizes, scale) => Slopes::up_to(sizes.steepness() / scale),
            // The width jumps at the rims of the discs.
            Self::Straits(..) => Slopes::UNKNOWN,
        }
    }
}

fn divided(Bounds { least, greatest, valid }: Bounds, scale: f64) -> Bounds {
    Bounds { least: least / scale, greatest: greatest / scale, valid }
}

impl Analytic {
    pub fn new(function: Function, quantity: Quantity) -> Self {
        let kept = function.is_kept().then(ModelId::new);
        Self { function, quantity, kept }
    }

    /// Returns this function without models: searches use its bounds only.
    #[cfg(test)]
    pub fn without_models(self) -> Self {
        Self { kept: None, ..self }
    }

    /// Returns the value at a point in world units, as it counts: where it is not valid, that of nothing.
    pub fn at(&self, point: DVec2) -> f32 {
        self.value(self.function.at(point))
    }

    /// Returns whether a value is one that a layer may have.
    pub fn is_valid(&self, value: f64) -> bool {
        match self.quantity {
            // Infinity asks for nothing.
            Quantity::Diameter | Quantity::Error => value > 0.0,
            Quantity::Risk => !value.is_nan(),
        }
    }

    /// Returns whether all values in a rectangle, in world units, are certainly valid.
    pub fn is_valid_within(&self, rect: &Rect) -> bool {
        self.are_valid(self.function.bounds(rect))
    }

    /// Returns whether all numbers within bounds are valid.
    pub fn are_valid(&self, Bounds { least, valid, .. }: Bounds) -> bool {
        valid && (self.quantity == Quantity::Risk || least > 0.0)
    }

    /// Returns the rule that [`Self::is_valid`] checks, for a message.
    pub fn rule(&self) -> &'static str {
        match self.quantity {
            Quantity::Diameter => "a target diameter must be positive; write inf where it asks for nothing",
            Quantity::Error => "an error must be positive; write inf where nothing is asked",
            Quantity::Risk => "a risk must be a number from 0 to 1",
        }
    }

    /// Returns the number itself, unchecked.
    pub fn raw(&self, point: DVec2) -> f64 {
        self.function.at(point)
    }

    /// Returns a number as it counts. Rounded up: rounding to nearest could ask for one level more.
    pub fn value(&self, value: f64) -> f32 {
        match self.quantity {
            Quantity::Diameter | Quantity::Error if value > 0.0 => f32_not_below(value),
            Quantity::Diameter | Quantity::Error => f32::INFINITY,
            Quantity::Risk if value.is_nan() => 0.0,
            Quantity::Risk => value.clamp(0.0, 1.0) as f32,
        }
    }

    /// Returns the range of the values of some cells, and where to divide them to know more. A cell has the
    /// value at its centre.
    pub fn range(&self, cells: &Cells, lattice: &Lattice) -> (ValueRange, Option<Cut>) {
        let Some(cut) = cells.middle() else {
            return (ValueRange::one(self.at(cells.center(lattice))), None);
        };
        let range = self.enclosed(self.bounds(cells, lattice));
        (range, (!range.is_one()).then_some(cut))
    }

    /// Returns bounds of the numbers at the centres of some cells.
    fn bounds(&self, cells: &Cells, lattice: &Lattice) -> Bounds {
        // A model of threats already has the bounds of each that varies much, but near the rims of the
        // threats it does not say where no threat is.
        let own = |model: Bounds| match self.function {
            Function::Threats(_) if model.valid && model.least > 0.0 => model,
            _ => self.function.bounds(&cells.centers(lattice)),
        };
        match (&self.function, self.kept) {
            (_, None) => own(Bounds::ANYTHING),
            (Function::Distance { shapes, profile }, Some(id)) => {
                let (near, centers) = (near(id, shapes, cells, lattice), cells.centers(lattice));
                let centers = Convex::rect(centers.min, centers.max);
                profile.bounds(shapes.bounds_within(&centers, near.as_deref()))
            }
            (_, Some(id)) => models::bounds(id, cells, lattice, |place| self.function.model(place), own),
        }
    }

    /// Returns a narrower range of the values of some cells than [`Self::range`], if one is known.
    pub fn range_in(&self, patch: &TouchedCells, lattice: &Lattice) -> Option<ValueRange> {
        let cut = patch.cut_centers(lattice);
        let bounds = match &self.function {
            Function::Distance { shapes, profile } => {
                let near = near(self.kept?, shapes, &patch.cells, lattice);
                profile.bounds(shapes.bounds_within(&cut?, near.as_deref()))
            }
            Function::Formula(_) | Function::Threats(_) if patch.is_small() => {
                let centers = patch.cells.centers(lattice);
                let place = ModelDomain::of_rectangle(&centers);
                let BoundedModel { polynomial, bounds } = self.function.model(&place);
                let corners = cut.unwrap_or(Convex::rect(centers.min, centers.max));
                let corners = corners.corners().iter().map(|&corner| place.coordinates_of(corner));
                polynomial.bounds_in(corners).intersection(bounds)
            }
            _ => return None,
        };
        Some(self.enclosed(bounds))
    }

    /// Returns the range of the values that count, from the bounds of the numbers.
    pub fn enclosed(&self, bounds: Bounds) -> ValueRange {
        let Bounds { least, greatest, valid } = bounds;
        match self.quantity {
            Quantity::Risk => {
                let least = if valid { self.value(least) } else { 0.0 };
                ValueRange { least, greatest: self.value(greatest) }
            }
            Quantity::Diameter | Quantity::Error => {
                let all = valid && least > 0.0;
                let greatest = if all { self.value(greatest) } else { f32::INFINITY };
                // Zero and less count as nothing, but values just above zero ask for the smallest diameter.
                let least = if least > 0.0 { f32_not_below(least) } else { 0.0 };
                ValueRange { least, greatest }
            }
        }
    }
}
