//! The cost of a path per unit of length.

use glam::DVec2;

use super::PathError;
use crate::field::{Bounds, CostFormula, TaylorModel};
use crate::geometry::Rect;
use crate::layers::{ModelDomain, RiskField};

/// A cost per unit of length, in world units: positive and finite.
///
/// On the Earth, where lengths are those on the ellipsoid, [`GroundCost`](super::GroundCost) converts a cost
/// per metre there into one.
///
/// Where it jumps, the smaller value counts (it is lower semicontinuous), so that a path of least cost
/// exists.
pub trait CostDensity: Send + Sync {
    /// Returns the cost at a point in world units.
    fn at(&self, point: DVec2) -> f64;

    /// Returns bounds of the cost over a closed rectangle in world units; they may be wider than the values.
    fn range(&self, rectangle: &Rect) -> CostRange;

    /// Returns bounds of the derivatives along x and y over a closed rectangle in world units; they may be
    /// wider than the values. `None` where the cost may jump, or its derivatives are not known.
    ///
    /// They must hold for the differences of costs as [`Self::at`] computes them, but for 10⁻¹² of the costs:
    /// a formula that loses more digits, such as `(1e15 + x) - 1e15`, has steps, and bounds that are derived
    /// from its derivatives can be wrong. The integral along a path notices such steps.
    fn derivatives(&self, _rectangle: &Rect) -> Option<[CostRange; 2]> {
        None
    }

    /// Returns a polynomial near the cost over a closed rectangle in world units, both of whose sides are
    /// longer than 0. `None` where none is known.
    fn model(&self, _rectangle: &Rect) -> Option<CostModel> {
        None
    }

    /// Returns the risk at a point in world units; 0 where the cost knows no risk.
    fn risk_at(&self, _point: DVec2) -> f64 {
        0.0
    }

    /// Returns bounds of the risk over a closed rectangle in world units; 0 where the cost knows no risk.
    fn risk_range(&self, _rectangle: &Rect) -> CostRange {
        CostRange { least: 0.0, greatest: 0.0 }
    }

    /// Returns the length on the Earth of a short line of length 1 at a point, in the plane of a projection:
    /// 1/k; 1 elsewhere.
    fn inverse_scale_at(&self, _point: DVec2) -> f64 {
        1.0
    }

    /// Returns bounds over a closed rectangle in world units of the cost per unit of length on the Earth. In
    /// a plane without a projection they are those of [`Self::range`].
    fn range_on_ground(&self, rectangle: &Rect) -> CostRange {
        self.range(rectangle)
    }
}

/// Bounds of the cost in a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostRange {
    /// A lower bound of the cost; −∞ if the cost may be NaN.
    pub least: f64,
    /// An upper bound of the cost; ∞ if the cost may be NaN.
    pub greatest: f64,
}

/// A polynomial of degree 2 near the cost in a rectangle.
///
/// ```text
/// p(u, v) = c₀ + c₁u + c₂v + c₃u² + c₄uv + c₅v²      u, v: from −1 to 1 along the sides
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// c₀ … c₅.
    pub coefficients: [f64; 6],
    /// No value of the cost, as computed, differs by more from the polynomial.
    pub remainder: f64,
}

impl CostModel {
    pub(crate) fn of(model: &TaylorModel) -> Self {
        Self { coefficients: model.coefficients(), remainder: model.remainder() }
    }

    /// Returns the mean of the polynomial over a segment whose middle is that of the rectangle. `way` leads
    /// from its start to its end, as shares of the sides.
    pub(super) fn mean_along(&self, way: DVec2) -> f64 {
        let [constant, _, _, uu, uv, vv] = self.coefficients;
        // From the middle, where u = v = 0, to the end: u = t · way.x and v = t · way.y, for t up to 1.
        constant + (uu * way.x * way.x + uv * way.x * way.y + vv * way.y * way.y) / 3.0
    }

    /// Returns the most by which the polynomial rises in the rectangle per unit of u and of v.
    pub(super) fn steepest(&self) -> DVec2 {
        let [_, u, v, uu, uv, vv] = self.coefficients.map(f64::abs);
        DVec2::new(u + 2.0 * uu + uv, v + 2.0 * vv + uv)
    }
}

impl CostRange {
    /// Returns whether the range has positive, finite numbers only.
    pub fn is_valid(&self) -> bool {
        self.least > 0.0 && self.greatest < f64::INFINITY
    }

    /// Returns whether all costs are the same.
    pub fn is_constant(&self) -> bool {
        self.least == self.greatest
    }

    /// Returns the range of products of a number of each.
    pub(super) fn times(self, other: Self) -> Self {
        let Self { least: a, greatest: b } = self;
        let Self { least: c, greatest: d } = other;
        let products = [a * c, a * d, b * c, b * d];
        Self {
            least: products.into_iter().fold(f64::INFINITY, f64::min),
            greatest: products.into_iter().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Returns the range of the costs of both.
    pub fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), greatest: self.greatest.max(other.greatest) }
    }
}

impl From<Bounds> for CostRange {
    fn from(Bounds { least, greatest, valid }: Bounds) -> Self {
        match valid {
            true => Self { least, greatest },
            false => Self { least: f64::NEG_INFINITY, greatest: f64::INFINITY },
        }
    }
}

/// How much length and risk count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// λ: the cost of a unit of length without risk.
    pub length: f64,
    /// κ: the cost of a unit of length at risk 1, beside that.
    pub risk: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { length: 1.0, risk: 10.0 }
    }
}

/// The cost density λ + κ · risk.
#[derive(Clone, Debug)]
pub struct WeightedCost {
    weights: Weights,
    risk: RiskField,
}

impl WeightedCost {
    /// Returns the cost of a risk with the given weights.
    ///
    /// # Errors
    /// Fails when a weight is negative, NaN or infinite, or both are zero.
    pub fn new(weights: Weights, risk: RiskField) -> Result<Self, PathError> {
        let Weights { length, risk: of_risk } = weights;
        let is_weight = |weight: f64| (0.0..f64::INFINITY).contains(&weight);
        if !(is_weight(length) && is_weight(of_risk) && length + of_risk > 0.0) {
            return Err(PathError::InvalidWeights { length, risk: of_risk });
        }
        Ok(Self { weights, risk })
    }

    fn of_risk(&self, risk: f64) -> f64 {
        // Rounding keeps order, so bounds of the risk give bounds of the cost.
        self.weights.length + self.weights.risk * risk
    }
}

impl CostDensity for WeightedCost {
    fn at(&self, point: DVec2) -> f64 {
        self.of_risk(self.risk.at(point))
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let Bounds { least, greatest, .. } = self.risk.range(rectangle);
        CostRange { least: self.of_risk(least), greatest: self.of_risk(greatest) }
    }

    fn derivatives(&self, rectangle: &Rect) -> Option<[CostRange; 2]> {
        let weight = Bounds::one(self.weights.risk);
        let slopes = self.risk.derivatives(rectangle)?.map(|slope| CostRange::from(slope.times(weight)));
        slopes.iter().all(|slope| slope.greatest - slope.least < f64::INFINITY).then_some(slopes)
    }

    fn model(&self, rectangle: &Rect) -> Option<CostModel> {
        let [length, weight] = [self.weights.length, self.weights.risk].map(TaylorModel::constant);
        let risk = self.risk.model(&ModelDomain::of_rectangle(rectangle))?;
        Some(CostModel::of(&weight.times(&risk).plus(&length)))
    }

    fn risk_at(&self, point: DVec2) -> f64 {
        self.risk.at(point)
    }

    fn risk_range(&self, rectangle: &Rect) -> CostRange {
        self.risk.range(rectangle).into()
    }
}

/// A formula of x, y and the risk as cost density.
#[derive(Clone, Debug)]
pub struct FormulaCost {
    /// The formula.
    pub formula: CostFormula,
    /// The risk in it.
    pub risk: RiskField,
}

// The risk is not looked up for a formula without it.
impl CostDensity for FormulaCost {
    fn at(&self, point: DVec2) -> f64 {
        let risk = if self.formula.uses_risk() { self.risk.at(point) } else { 0.0 };
        self.formula.eval(point.x, point.y, risk)
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let uses_risk = self.formula.uses_risk();
        let risk = if uses_risk { self.risk.range(rectangle) } else { Bounds::one(0.0) };
        self.formula.bounds(rectangle, risk).into()
    }

    fn derivatives(&self, rectangle: &Rect) -> Option<[CostRange; 2]> {
        let (risk, risk_slopes) = match self.formula.uses_risk() {
            true => (self.risk.range(rectangle), self.risk.derivatives(rectangle)),
            false => (Bounds::one(0.0), None),
        };
        let slopes = self.formula.derivatives(rectangle, risk, risk_slopes)?;
        Some(slopes.map(CostRange::from))
    }

    fn model(&self, rectangle: &Rect) -> Option<CostModel> {
        let place = ModelDomain::of_rectangle(rectangle);
        let uses_risk = self.formula.uses_risk();
        let risk = if uses_risk { self.risk.model(&place)? } else { TaylorModel::constant(0.0) };
        let model = self.formula.model(place.coordinates, risk);
        model.remainder().is_finite().then(|| CostModel::of(&model))
    }

    fn risk_at(&self, point: DVec2) -> f64 {
        self.risk.at(point)
    }

    fn risk_range(&self, rectangle: &Rect) -> CostRange {
        self.risk.range(rectangle).into()
    }
}

/// How often a rectangle is quartered to find valid bounds of its costs.
const QUARTERINGS: u32 = 6;

/// Returns the range of a cost density over a rectangle, checked.
///
/// # Errors
/// Fails when the cost is zero, negative, NaN or infinite at a place, or its bounds are.
pub fn checked_range(
    density: &(impl CostDensity + ?Sized),
    rectangle: &Rect,
) -> Result<CostRange, PathError> {
    let range = density.range(rectangle);
    if range.is_valid() {
        return Ok(range);
    }
    divided_range(density, rectangle, QUARTERINGS)
}

#[cold]
fn divided_range(
    density: &(impl CostDensity + ?Sized),
    rectangle: &Rect,
    quarterings: u32,
) -> Result<CostRange, PathError> {
    let range = density.range(rectangle);
    if range.is_valid() {
        return Ok(range);
    }
    let Rect { min, max } = *rectangle;
    let at = rectangle.center();
    for place in [at, min, max, DVec2::new(min.x, max.y), DVec2::new(max.x, min.y)] {
        let value = density.at(place);
        if !(value > 0.0 && value < f64::INFINITY) {
            return Err(PathError::InvalidCost { at: place, value });
        }
    }
    let Some(quarterings) = quarterings.checked_sub(1) else { return Err(PathError::UnboundedCost { at }) };
    let quarters = [min, max, DVec2::new(min.x, max.y), DVec2::new(max.x, min.y)];
    let mut joined: Option<CostRange> = None;
    for corner in quarters {
        let range = divided_range(density, &Rect::spanning(corner, at), quarterings)?;
        joined = Some(joined.map_or(range, |joined| joined.union(range)));
    }
    joined.ok_or(PathError::UnboundedCost { at })
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::Formula;
    use crate::layers::{Combine, Layer, LayerKind, PaintLayers, Threat, ThreatLaw, Threats};

    fn risk(formula: &str) -> RiskField {
        let stack = Layer::stack([LayerKind::risk(Formula::parse(formula).unwrap())]);
        RiskField::new(&stack, PaintLayers::blank())
    }

    fn formula(cost: &str, of_risk: &str) -> FormulaCost {
        FormulaCost { formula: CostFormula::parse(cost).unwrap(), risk: risk(of_risk) }
    }

    #[test]
    fn weights_make_a_cost_of_the_risk() {
        let cost = WeightedCost::new(Weights { length: 2.0, risk: 4.0 }, risk("0.25 + 0.5*x")).unwrap();
        assert_eq!(cost.at(dvec2(0.5, 0.0)), 4.0);
        assert_eq!(cost.range(&Rect::UNIT), CostRange { least: 3.0, greatest: 5.0 });
        for (length, of_risk) in [(0.0, 0.0), (-1.0, 2.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            let refused = WeightedCost::new(Weights { length, risk: of_risk }, risk("x"));
            assert!(matches!(refused, Err(PathError::InvalidWeights { .. })), "{length} {of_risk}");
        }
    }

    #[test]
    fn a_union_has_the_costs_of_both() {
        let range = |least, greatest| CostRange { least, greatest };
        assert_eq!(range(1.0, 3.0).union(range(2.0, 5.0)), range(1.0, 5.0));
        assert_eq!(range(2.0, 5.0).union(range(1.0, 3.0)), range(1.0, 5.0));
        assert_eq!(range(1.0, 5.0).union(range(2.0, 3.0)), range(1.0, 5.0));
    }

    #[test]
    fn a_formula_uses_the_risk_and_only_costs_may() {
        let cost = formula("1 + 20*risk^2 + y", "x");
        assert_eq!(cost.at(dvec2(0.5, 1.0)), 7.0);
        assert_eq!(cost.range(&Rect::UNIT), CostRange { least: 1.0, greatest: 22.0 });
        let refused = Formula::parse("1 + risk").unwrap_err().to_string();
        assert!(refused.starts_with("There is no `risk`"), "{refused}");
        let refused = CostFormula::parse("1 + risky").unwrap_err().to_string();
        assert!(refused.contains("`risk`"), "{refused}");
    }

    #[test]
    fn a_bad_cost_is_refused_with_its_place() {
        for bad in ["x - 0.5", "1/(x-0.5)", "0", "-1", "0/0", "inf", "sqrt(x-0.5)"] {
            let Err(PathError::InvalidCost { at, value }) = checked_range(&formula(bad, "0"), &Rect::UNIT)
            else {
                panic!("{bad}")
            };
            assert!(Rect::UNIT.contains(at) && !(value > 0.0 && value < f64::INFINITY), "{bad}");
        }
        let narrow = checked_range(&formula("1 - 0.999999*max(0, 1-1e9*(x-0.3)^2)*2", "0"), &Rect::UNIT);
        assert!(narrow.is_err());
        // Too wide over the square, and positive over its parts.
        let range = checked_range(&formula("x*x - x + 0.3", "0"), &Rect::UNIT).unwrap();
        assert!(range.least > 0.0 && range.least <= 0.05);
    }

    #[test]
    fn no_cost_is_farther_from_its_model_than_that_says() {
        let mut random = fastrand::Rng::with_seed(1471);
        let threat = |random: &mut fastrand::Rng| Threat {
            at: dvec2(random.f64(), random.f64()),
            range: 0.1 + 0.25 * random.f64(),
            peak: 0.3 + 0.7 * random.f64(),
            law: ThreatLaw::ALL[random.usize(..3)].0,
        };
        let (mut known, mut close) = (0, 0);
        for round in 0..400 {
            let threats = Threats::new((0..3).map(|_| threat(&mut random)).collect()).unwrap();
            let hills = "max(gauss(hypot(x-0.3, y-0.6), 0.2), 0.8*gauss(hypot(x-0.7, y-0.2), 0.1))";
            let formula = |text: &str| LayerKind::risk(Formula::parse(text).unwrap());
            let mut kinds = vec![LayerKind::Threats(threats), formula(hills), formula("3*x - y")];
            random.shuffle(&mut kinds);
            kinds.truncate(random.usize(1..=3));
            let mut stack = Layer::stack(kinds);
            for layer in &mut stack {
                layer.combine = [Combine::Finest, Combine::Floor, Combine::Replace][random.usize(..3)];
            }
            let risk = RiskField::new(&stack, PaintLayers::blank()).within(&Rect::UNIT);
            let weighted = WeightedCost::new(Weights { length: 1.0, risk: 7.0 }, risk.clone()).unwrap();
            let of_formula = CostFormula::parse("1 + x*y + 20*risk^2").unwrap();
            let of_formula = FormulaCost { formula: of_formula, risk };
            let cost: &dyn CostDensity = if round % 2 == 0 { &weighted } else { &of_formula };
            let middle = dvec2(random.f64(), random.f64());
            let half = libm::exp2(-9.0 * random.f64()) * dvec2(0.1 + random.f64(), 0.1 + random.f64());
            let rectangle = Rect::new(middle - half, middle + half);
            let Some(CostModel { coefficients: [c, cu, cv, cuu, cuv, cvv], remainder }) =
                cost.model(&rectangle)
            else {
                continue;
            };
            let mut most = 0.0_f64;
            for _ in 0..100 {
                let [u, v] = [(); 2].map(|()| 2.0 * random.f64() - 1.0);
                let point = rectangle.center() + dvec2(u, v) * 0.5 * rectangle.size();
                let model = c + cu * u + cv * v + cuu * u * u + cuv * u * v + cvv * v * v;
                most = most.max((cost.at(point) - model).abs());
            }
            assert!(most <= remainder * (1.0 + 1e-9) + 1e-12, "{most} {remainder} {stack:?} {rectangle:?}");
            known += 1;
            close += usize::from(remainder < 0.1 * (cu.abs() + cv.abs()));
        }
        assert!(known > 200 && close > 50, "{known} {close}");
    }
}
