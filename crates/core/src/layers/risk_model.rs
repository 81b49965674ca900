//! Models of the risk over a rectangle, where it is smooth.

use super::models::ModelDomain;
use super::risk_source::RiskSource;
use super::{Combine, Coverage, RiskField};
use crate::field::TaylorModel;

impl RiskField {
    /// Returns a model of the risk over a rectangle. `None` where pixels or the rim of a mask count: the risk
    /// jumps there.
    pub(crate) fn model(&self, place: &ModelDomain) -> Option<TaylorModel> {
        let rectangle = place.rect();
        let seen = self.seen(&rectangle);
        let mut below = TaylorModel::constant(0.0);
        for layer in &self.layers {
            match layer.mask.as_ref().map(|mask| mask.classify(&seen)) {
                None | Some(Coverage::Inside) => {}
                Some(Coverage::Outside) => continue,
                Some(Coverage::Mixed) => return None,
            }
            let model = match &layer.source {
                RiskSource::Paint(_) | RiskSource::Raster(_) => return None,
                RiskSource::Formula(formula) => {
                    let [zero, one] = [0.0, 1.0].map(TaylorModel::constant);
                    formula.model(place.coordinates).max(&zero).min(&one)
                }
                // Threats that are not felt are no layer, which makes no difference to the greater risk.
                RiskSource::Threats(threats) if layer.combine == Combine::Finest => threats.model(place),
                RiskSource::Threats(_) => return None,
            };
            below = match layer.combine {
                Combine::Finest => below.max(&model),
                Combine::Floor => below.min(&model),
                Combine::Replace => model,
            };
        }
        below.remainder().is_finite().then_some(below)
    }
}
