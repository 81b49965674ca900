//! How far a source is from its mean in a triangle.

use glam::DVec2;

use super::bound::inner_rect;
use super::doubt::{Doubt, Doubts};
use super::element::points_of_rule;
use super::exact_error::rule_of_degree_5;
use super::problem::Values;
use crate::field::Formula;

/// The source of a problem, by models of degree 2 with a bound of the rest.
pub(crate) struct SourceRange<'a> {
    source: Values<'a>,
}

/// What is known of the source in a triangle.
pub(crate) struct SourceSpread {
    /// A bound of the norm of the source less its mean.
    pub spread: f64,
    /// A bound of the error of its integral.
    pub defect: f64,
    pub doubts: Doubts,
}

impl<'a> SourceRange<'a> {
    pub fn of(source: &'a Formula) -> Self {
        Self { source: Values::of(source) }
    }

    /// Returns what is known in a triangle, where the rule gave the integrals `loads`.
    pub fn over(&self, corners: [DVec2; 3], loads: [f64; 3], measure: f64) -> SourceSpread {
        if self.source.constant().is_some() {
            return SourceSpread { spread: 0.0, defect: 0.0, doubts: Doubts::default() };
        }
        let rect = inner_rect(corners);
        match self.source.formula().quadratic(&rect) {
            Some((model, rest)) if rest <= most_rest(&model) => {
                let (middle, half) = (rect.center(), 0.5 * rect.size());
                let value = |shares: [f64; 3]| {
                    let at = shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2];
                    let [u, v] = ((at - middle) / half).to_array();
                    let [_, by_u, by_v, by_uu, by_uv, by_vv] = model;
                    by_u * u + by_v * v + by_uu * u * u + by_uv * u * v + by_vv * v * v
                };
                // The rule integrates the square of a polynomial of degree 2.
                let values = rule_of_degree_5().map(|(shares, weight)| (weight, value(shares)));
                let add = |[mean, square]: [f64; 2], (weight, value): (f64, f64)| {
                    [mean + weight * value, square + weight * value * value]
                };
                let [mean, square] = values.fold([0.0; 2], add);
                let variance = (square - mean * mean).max(0.0) + 1e-14 * square;
                // The integral of the polynomial is exact in both; the rest can be wrong by itself each time.
                SourceSpread {
                    spread: measure.sqrt() * (variance.sqrt() + rest),
                    defect: 2.0 * measure * rest,
                    doubts: Doubts::default(),
                }
            }
            _ => self.by_samples(corners, loads, measure),
        }
    }

    /// Returns what a few values say, where there is no model.
    fn by_samples(&self, corners: [DVec2; 3], loads: [f64; 3], measure: f64) -> SourceSpread {
        let mean = (loads[0] + loads[1] + loads[2]) / measure;
        let values = points_of_rule(corners).map(|point| self.source.at(point));
        let away = values.into_iter().fold(0.0, |away: f64, value| away.max((value - mean).abs()));
        let mut doubts = Doubts::default();
        doubts.add(Doubt::Source);
        SourceSpread { spread: measure.sqrt() * away, defect: 0.0, doubts }
    }
}

/// Returns the rest of a model above which the triangle is too large to know the source in it, or the source
/// jumps: a share of what the polynomial varies, or what rounding leaves.
fn most_rest([constant, varying @ ..]: &[f64; 6]) -> f64 {
    0.5 * varying.iter().map(|coefficient| coefficient.abs()).sum::<f64>() + 1e-9 * constant.abs()
}
