//! Models of the combined risk of threats.

use std::ops::ControlFlow;

use super::Threats;
use super::models::{BoundedModel, ModelDomain};
use super::threat_series::{Series, Squared};
use super::threats::NO_SURVIVAL;
use crate::field::{Bounds, TaylorModel};

impl Threats {
    /// Returns a model of the combined risk.
    pub(super) fn model(&self, place: &ModelDomain) -> TaylorModel {
        self.bounded_model(place).polynomial
    }

    /// Returns a model of the combined risk, and bounds that are closer where a threat is at its peak.
    pub(super) fn bounded_model(&self, place: &ModelDomain) -> BoundedModel {
        let (mut survival, mut is_felt) = (Survival::default(), false);
        let certain = self.visit_meeting(&place.rect(), |threat| {
            let squared = Squared::new(threat, place);
            let Some(risk) = threat.series(&squared) else { return ControlFlow::Continue(()) };
            is_felt = true;
            survival.meet(&squared, &risk, threat.peak);
            if survival.is_lost() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let one = TaylorModel::constant(1.0);
        match certain {
            // Exactly: a risk of rounding errors would ask for more than none does.
            ControlFlow::Continue(()) if !is_felt => BoundedModel::of(TaylorModel::constant(0.0)),
            ControlFlow::Continue(()) => {
                BoundedModel { polynomial: one.minus(&survival.model()), bounds: survival.risk_bounds() }
            }
            ControlFlow::Break(()) => BoundedModel::of(one),
        }
    }
}

/// How much a logarithm may change over a place to be added up: beyond, the series of ln (1 − z) converges
/// slowly.
const MOST_CHANGE: f64 = 0.5;

/// A smaller product may have lost digits.
const LEAST_PRODUCT: f64 = 1e-290;

/// The probability to survive all threats: Π (1 − pᵢ).
///
/// Most threats vary little over a place, and there are many: of them, the values in the middle are
/// multiplied, and the changes of the logarithms ln (1 − pᵢ) from there are added up as polynomials of the
/// coordinates u and v in the place. This takes one division a threat, and no logarithm. The others are
/// multiplied as models.
struct Survival {
    /// The probability to survive in the middle of the rectangle.
    middle: f64,
    /// The coefficients of u, v, u², uv and v² of the logarithm.
    change: [f64; 5],
    /// The largest distance from that polynomial.
    rest: f64,
    /// The product for threats that vary much.
    others: TaylorModel,
    /// No value of that is greater.
    most_of_others: f64,
    /// The products of what is survived of each threat at least, and at most.
    range: [f64; 2],
    /// The number of threats.
    count: u32,
}

impl Default for Survival {
    fn default() -> Self {
        Self {
            middle: 1.0,
            change: [0.0; 5],
            rest: 0.0,
            others: TaylorModel::constant(1.0),
            most_of_others: 1.0,
            range: [1.0; 2],
            count: 0,
        }
    }
}

impl Survival {
    /// Joins a threat.
    ///
    /// With y = p − p(middle) = slope · d + bend · d² ± rest for a step d of the square of distance / range,
    /// and z = y / (1 − p(middle)): ln (1 − p) − ln (1 − p(middle)) = ln (1 − z) = −z − z²/2 − …, where what
    /// follows is |z|³ / (3 (1 − |z|)) at most.
    fn meet(&mut self, squared: &Squared, risk: &Series, peak: f64) {
        let step = squared.step();
        let reach = (risk.slope.abs() + risk.bend.abs() * step) * step + risk.rest;
        let [least, greatest] = [(risk.value - reach).max(0.0), (risk.value + reach).min(peak)];
        self.range = [self.range[0] * (1.0 - greatest), self.range[1] * (1.0 - least)];
        self.count += 1;
        let inverse = 1.0 / (1.0 - risk.value);
        let (slope, bend, rest) = (inverse * risk.slope, inverse * risk.bend, inverse * risk.rest);
        let linear_change = slope.abs() * step;
        let change = linear_change + bend.abs() * step * step + rest;
        if !(inverse > 0.0 && change <= MOST_CHANGE) {
            let risk = squared.model().composed([risk.value, risk.slope, risk.bend], 0.0, risk.rest);
            self.others = self.others.times(&TaylorModel::constant(1.0).minus(&risk));
            self.most_of_others = self.others.size();
            return;
        }
        self.middle *= 1.0 - risk.value;
        let beyond_square = 0.5 * (change * change - linear_change * linear_change);
        let beyond = rest + beyond_square + change * change * change / (3.0 * (1.0 - change));
        self.add(squared, -slope, -bend - 0.5 * slope * slope, beyond);
    }

    /// Adds slope · d + bend · d² ± rest to the logarithm, for d = L + C with L = au + bv, C = pu² + qv² ± r.
    ///
    /// Of d², the product 2LC is of degree 3. As u³ = ¾u ± ¼ and uv² = ½u ± ½, it is near a line, too:
    /// LC = a (¾p + ½q) u + b (½p + ¾q) v, up to |a| (¼p + ½q) + |b| (½p + ¼q).
    fn add(&mut self, squared: &Squared, slope: f64, bend: f64, rest: f64) {
        let ([a, b], [p, q], r) = (squared.linear, squared.bend, squared.rest);
        let twice = 2.0 * bend;
        let terms = [
            a * (slope + twice * (0.75 * p + 0.5 * q)),
            b * (slope + twice * (0.5 * p + 0.75 * q)),
            slope * p + bend * a * a,
            twice * a * b,
            slope * q + bend * b * b,
        ];
        for (sum, term) in self.change.iter_mut().zip(terms) {
            *sum += term;
        }
        let (slope, bend, [a, b]) = (slope.abs(), bend.abs(), [a.abs(), b.abs()]);
        let product = a * (0.25 * p + 0.5 * q) + b * (0.5 * p + 0.25 * q);
        let curved = p + q + r;
        let step = a + b + curved;
        let cut_off = slope * r + bend * (2.0 * product + 2.0 * (a + b) * r + curved * curved);
        // Rounding in the terms, in their sum, and in the factors of the product, here and in the risk.
        let rounding = 64.0 * f64::EPSILON * (0.25 + (slope + bend * step) * step);
        self.rest += rest + cut_off + rounding;
    }

    /// Returns an upper bound of the difference of a logarithm from the one in the middle.
    fn most_change(&self) -> f64 {
        self.change.iter().map(|term| term.abs()).sum::<f64>() + self.rest
    }

    /// Returns whether nothing is survived anywhere in the place.
    fn is_lost(&self) -> bool {
        let most = self.middle * self.most_of_others;
        most < NO_SURVIVAL && 2.0 * most * libm::exp(self.most_change()) < NO_SURVIVAL
    }

    /// Returns bounds of the risk from those of each threat: where one is at its peak and no other is felt,
    /// the risk is not greater than that.
    fn risk_bounds(&self) -> Bounds {
        // Each factor and each product is off by half an ulp at most, here and in the risk at a point.
        let margin = f64::EPSILON * (8.0 * f64::from(self.count) + 8.0);
        let [least, most] = self.range;
        let bounds = Bounds::new(1.0 - most * (1.0 + margin), 1.0 - least * (1.0 - margin)).widened(2);
        Bounds { least: bounds.least.max(0.0), greatest: bounds.greatest.min(1.0), ..bounds }
    }

    /// Returns the series as a model.
    fn model(&self) -> TaylorModel {
        let [u, v, uu, uv, vv] = self.change;
        let logarithm = TaylorModel::new([0.0, u, v, uu, uv, vv], self.rest);
        let Bounds { least, greatest, valid } = logarithm.bounds();
        if !valid || self.middle < LEAST_PRODUCT {
            return TaylorModel::UNKNOWN;
        }
        let [least, greatest] = [libm::exp(least), libm::exp(greatest)];
        let factor = logarithm
            .composed([1.0, 1.0, 0.5], greatest / 6.0, 0.0)
            .or_bounds(|| Bounds::new(least, greatest).widened(4));
        factor.times(&TaylorModel::constant(self.middle)).times(&self.others)
    }
}
