//! Bounds of the derivatives of the risk over a rectangle.

use std::ops::ControlFlow;

use glam::DVec2;

use super::engine::cone::Cone;
use super::risk::RiskField;
use super::risk_source::RiskSource;
use super::{Combine, Coverage, Threat, ThreatLaw, Threats};
use crate::field::Bounds;
use crate::geometry::Rect;

const ZERO: Bounds = Bounds::new(0.0, 0.0);

/// Bound of the effect of rounding on a bound, as a share of it.
const ROUNDING: f64 = 1e-12;

impl RiskField {
    /// Returns bounds of the derivatives along x and y over a closed rectangle in world units. `None` where
    /// the risk may jump, or a derivative is not known. At kinks the bounds hold the derivatives on all
    /// sides.
    pub fn derivatives(&self, rectangle: &Rect) -> Option<[Bounds; 2]> {
        let (mut value, mut slopes) = (ZERO, [ZERO; 2]);
        let seen = self.seen(rectangle);
        for layer in &self.layers {
            match layer.mask.as_ref().map(|mask| mask.classify(&seen)) {
                Some(Coverage::Outside) => continue,
                Some(Coverage::Mixed) => return None,
                Some(Coverage::Inside) | None => {}
            }
            let risks = layer.source.range(rectangle, &seen);
            if risks.is_nowhere() {
                continue;
            }
            // The risk of threats falls continuously to 0 at their ranges, where the result is that of the
            // layers below.
            let is_continuous =
                matches!(layer.source, RiskSource::Threats(_)) && layer.combine == Combine::Finest;
            if !(risks.is_everywhere() || is_continuous) {
                return None;
            }
            let (own, own_slopes) =
                (Bounds::new(risks.least, risks.greatest), layer.source.slopes(rectangle, &risks)?);
            let joined = [0, 1].map(|axis: usize| slopes[axis].union(own_slopes[axis]));
            slopes = match layer.combine {
                Combine::Replace => own_slopes,
                Combine::Finest if own.greatest < value.least => slopes,
                Combine::Finest if own.least > value.greatest => own_slopes,
                Combine::Floor if own.least > value.greatest => slopes,
                Combine::Floor if own.greatest < value.least => own_slopes,
                Combine::Finest | Combine::Floor => joined,
            };
            value = risks.over(value, layer.combine);
        }
        Some(slopes)
    }
}

impl RiskSource {
    fn slopes(&self, rectangle: &Rect, risks: &super::risk::Risks) -> Option<[Bounds; 2]> {
        match self {
            // Pixels jump.
            _ if risks.least == risks.greatest => Some([ZERO; 2]),
            Self::Paint(_) | Self::Raster(_) => None,
            Self::Formula(formula) => {
                let bounds = formula.bounds(rectangle);
                let slopes = formula.derivatives(rectangle)?;
                let is_cut = bounds.least < 0.0 || bounds.greatest > 1.0;
                Some(if is_cut { slopes.map(|slope| slope.union(ZERO)) } else { slopes })
            }
            Self::Threats(threats) => Some(threats.slopes(rectangle)),
        }
    }
}

impl Threats {
    /// Returns bounds of the derivatives of the combined risk along x and y over a closed rectangle in world
    /// units: Σ ∂pᵢ Π (1 − pⱼ) over all other threats j.
    pub(super) fn slopes(&self, rect: &Rect) -> [Bounds; 2] {
        let mut near = Vec::new();
        let _ = self.visit_meeting(rect, |threat| {
            near.push(*threat);
            ControlFlow::Continue(())
        });
        let survived: Vec<Bounds> = near
            .iter()
            .map(|threat| {
                let risk = threat.bounds(rect);
                Bounds::new(1.0 - risk.greatest, 1.0 - risk.least)
            })
            .collect();
        // The products of all after each one.
        let mut after = vec![Bounds::new(1.0, 1.0); near.len() + 1];
        for n in (0..near.len()).rev() {
            after[n] = after[n + 1].times(survived[n]);
        }
        let (mut before, mut slopes) = (Bounds::new(1.0, 1.0), [ZERO; 2]);
        for (n, threat) in near.iter().enumerate() {
            let others = before.times(after[n + 1]);
            let own = threat.slopes(rect);
            slopes = [0, 1].map(|axis: usize| slopes[axis].plus(own[axis].times(others)));
            before = before.times(survived[n]);
        }
        let margin = ROUNDING * (near.len() + 1) as f64;
        slopes.map(|slope| slope.expanded(margin * slope.least.abs().max(slope.greatest.abs())))
    }

    /// Returns the directions along which the combined risk does not grow, among them all those in which it
    /// falls most, in a closed rectangle in world units: away from the threats. `None` where they are too
    /// different, or there is no threat.
    pub(super) fn outward(&self, rect: &Rect) -> Option<Cone> {
        let mut all = None;
        let is_cut = self.visit_meeting(rect, |threat| {
            let own = Cone::from_point(threat.at, rect);
            all = match (all, own) {
                (Some(all), Some(own)) => Cone::with(all, own),
                _ => own,
            };
            if all.is_none() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        all.filter(|_| is_cut.is_continue())
    }
}

impl Threat {
    /// Returns bounds of the derivatives of the risk along x and y over a closed rectangle in world units.
    ///
    /// With s = (r/R)², ∂p/∂x = −2 (x/R) / R · peak · |law′(s)|.
    fn slopes(&self, rect: &Rect) -> [Bounds; 2] {
        let (low, high) = ((rect.min - self.at) / self.range, (rect.max - self.at) / self.range);
        let nearest = DVec2::ZERO.clamp(low, high).length_squared() * (1.0 - ROUNDING);
        let farthest = low.abs().max(high.abs()).length_squared() * (1.0 + ROUNDING);
        let fall = self.law.fall(nearest, farthest);
        let factor = -2.0 * self.peak / self.range;
        [0, 1].map(|axis: usize| {
            let slope = Bounds::new(low[axis], high[axis]).times(fall).times(Bounds::new(factor, factor));
            slope.expanded(16.0 * ROUNDING * slope.least.abs().max(slope.greatest.abs()))
        })
    }
}

impl ThreatLaw {
    /// Returns bounds of how fast the share of the peak falls with s, the square of distance / range, between
    /// two values of s.
    fn fall(self, least: f64, greatest: f64) -> Bounds {
        if least >= 1.0 {
            return ZERO;
        }
        let bounds = |rim: f64, slope: &dyn Fn(f64) -> f64| {
            // It falls less and less from the rim on; within it, and beyond the range, not at all.
            let is_all_sloped = least >= rim && greatest <= 1.0;
            let most = if greatest >= rim { slope(least.max(rim)) } else { 0.0 };
            Bounds::new(if is_all_sloped { slope(greatest) } else { 0.0 }, most)
        };
        match self {
            Self::Radar => bounds(0.25, &|s| 2.0 / (15.0 * s * s * s)),
            Self::Gaussian => bounds(0.0, &|s| 4.5 * libm::exp(-4.5 * s) / (1.0 - libm::exp(-4.5))),
            Self::Disc => {
                // 6 t (1 − t) · 2 / √s, with t from 1 to 0 on the rim.
                let [near, far] = [least.max(0.5625), greatest.clamp(0.5625, 1.0)].map(f64::sqrt);
                let [t_near, t_far] = [near, far].map(|share| (4.0 * (1.0 - share)).clamp(0.0, 1.0));
                let rise = |t: f64| 6.0 * t * (1.0 - t);
                let most = if t_far <= 0.5 && t_near >= 0.5 { 1.5 } else { rise(t_near).max(rise(t_far)) };
                let least = rise(t_near).min(rise(t_far));
                let is_all_sloped = greatest <= 1.0;
                Bounds::new(if is_all_sloped { least * 2.0 / far } else { 0.0 }, most * 2.0 / near)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::Formula;
    use crate::layers::{Layer, LayerKind, Mask, PaintLayers};

    fn random_stack(random: &mut fastrand::Rng) -> Vec<Layer> {
        let kinds = (0..random.usize(1..4)).map(|_| match random.u32(..4) {
            0 => LayerKind::risk(Formula::parse("x*y + 0.3*sin(9*x)").unwrap()),
            1 => LayerKind::risk(Formula::parse("0.7*gauss(hypot(x-0.3, y-0.6), 0.2)").unwrap()),
            _ => {
                let threat = |random: &mut fastrand::Rng| Threat {
                    at: dvec2(random.f64(), random.f64()),
                    range: 0.05 + 0.5 * random.f64(),
                    peak: random.f64(),
                    law: ThreatLaw::ALL[random.usize(..3)].0,
                };
                LayerKind::Threats(Threats::new((0..6).map(|_| threat(random)).collect()).unwrap())
            }
        });
        let kinds: Vec<LayerKind> = kinds.collect();
        let mut layers = Layer::stack(kinds);
        for layer in &mut layers {
            layer.combine = Combine::ALL[random.usize(..3)];
            if random.u32(..3) == 0 {
                let ring = [dvec2(0.1, 0.1), dvec2(0.9, 0.2), dvec2(0.5, 0.9)];
                layer.mask = Some(Mask::new(&[vec![ring.to_vec()]]).unwrap());
            }
        }
        layers
    }

    #[test]
    fn derivatives_enclose_differences_between_points() {
        let mut random = fastrand::Rng::with_seed(1411);
        let (mut known, mut narrow) = (0, 0);
        for _ in 0..400 {
            let field = RiskField::new(&random_stack(&mut random), PaintLayers::blank());
            for _ in 0..20 {
                let min = dvec2(random.f64(), random.f64());
                let side = [1e-4, 0.01, 0.1, 0.5][random.usize(..4)];
                let rect = Rect::new(min, min + side * (0.1 + dvec2(random.f64(), random.f64())));
                let Some(slopes) = field.derivatives(&rect) else { continue };
                known += 1;
                narrow +=
                    usize::from((0..2).all(|axis: usize| slopes[axis].greatest - slopes[axis].least < 0.1));
                for _ in 0..10 {
                    let [p, q] = [(); 2].map(|()| rect.min + rect.size() * dvec2(random.f64(), random.f64()));
                    let rise = field.at(q) - field.at(p);
                    let most: f64 = (0..2)
                        .map(|axis: usize| {
                            let step = q[axis] - p[axis];
                            (step * slopes[axis].least).max(step * slopes[axis].greatest)
                        })
                        .sum();
                    assert!(rise <= most + 1e-13, "{rise} {most} {slopes:?} over {rect:?}");
                }
            }
        }
        assert!(known > 4000 && narrow > 500, "{known} {narrow}");
    }

    #[test]
    fn jumps_have_no_derivatives() {
        let threat = Threat { at: dvec2(0.5, 0.5), range: 0.2, peak: 0.5, law: ThreatLaw::Disc };
        let mut layers = Layer::stack([
            LayerKind::risk(Formula::constant_of(0.25)),
            LayerKind::Threats(Threats::new(vec![threat]).unwrap()),
        ]);
        let rim = Rect::around(dvec2(0.7, 0.5), 0.02);
        let slopes = |layers: &[Layer]| RiskField::new(layers, PaintLayers::blank()).derivatives(&rim);
        assert!(slopes(&layers).is_some());
        layers[1].combine = Combine::Replace;
        assert_eq!(slopes(&layers), None);
    }
}
