//! The cost of paths on the Earth, in the plane of a projection.

use std::sync::Arc;

use glam::DVec2;

use super::{CostDensity, CostRange};
use crate::earth::{Ground, InverseScale};
use crate::geometry::Rect;

/// A cost per metre on the ellipsoid as one per metre in the plane of a projection: c / k.
///
/// So the integral of the cost along a line in the plane is that over its length on the ellipsoid.
#[derive(Clone, Debug)]
pub struct GroundCost<C> {
    /// The cost per metre on the ellipsoid.
    pub cost: C,
    /// 1/k.
    pub inverse_scale: Arc<InverseScale>,
}

/// Returns a cost per unit of length on the ground as one in the plane.
pub fn in_plane(cost: impl CostDensity + 'static, ground: &Ground) -> Arc<dyn CostDensity> {
    match ground.inverse_scale() {
        Some(scale) => Arc::new(GroundCost { cost, inverse_scale: Arc::clone(scale) }),
        None => Arc::new(cost),
    }
}

impl<C: CostDensity> CostDensity for GroundCost<C> {
    fn at(&self, point: DVec2) -> f64 {
        self.cost.at(point) * self.inverse_scale.at(point)
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let CostRange { least, greatest } = self.cost.range(rectangle);
        let scale = self.inverse_scale.range(rectangle);
        // The scale is positive; bounds of the cost may be negative or infinite.
        let low = if least < 0.0 { scale[1] } else { scale[0] };
        CostRange { least: least * low, greatest: greatest * scale[1] }
    }

    /// (c / k)′ = c′ / k + c (1/k)′.
    fn derivatives(&self, rectangle: &Rect) -> Option<[CostRange; 2]> {
        let of_cost = self.cost.derivatives(rectangle)?;
        let of_scale = self.inverse_scale.slopes(rectangle)?;
        let (cost, scale) = (self.cost.range(rectangle), self.inverse_scale.range(rectangle));
        if !(cost.least.is_finite() && cost.greatest.is_finite()) {
            return None;
        }
        let scale = CostRange { least: scale[0], greatest: scale[1] };
        Some([0, 1].map(|axis| {
            let slope = CostRange { least: of_scale[axis][0], greatest: of_scale[axis][1] };
            let (a, b) = (of_cost[axis].times(scale), cost.times(slope));
            CostRange { least: a.least + b.least, greatest: a.greatest + b.greatest }
        }))
    }

    fn risk_at(&self, point: DVec2) -> f64 {
        self.cost.risk_at(point)
    }

    fn risk_range(&self, rectangle: &Rect) -> CostRange {
        self.cost.risk_range(rectangle)
    }

    fn inverse_scale_at(&self, point: DVec2) -> f64 {
        self.inverse_scale.at(point)
    }

    fn range_on_ground(&self, rectangle: &Rect) -> CostRange {
        self.cost.range(rectangle)
    }
}
