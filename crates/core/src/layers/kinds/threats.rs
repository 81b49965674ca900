//! Layers of threats.

use glam::DVec2;

use crate::geometry::Rect;
use crate::layers::engine::{Analytic, CompiledPlane, Function, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::risk_source::RiskSource;
use crate::layers::value_change::{LayerEdit, ValueChange};
use crate::layers::{LayerSlot, LayerSource, Quantity, Threat, Threats};
use crate::mesh::TargetChange::{Any, Coarser, Finer};
use crate::raster::TiledRaster;

impl LayerSource for Threats {
    fn label(&self) -> &'static str {
        "Threats"
    }

    fn change_title(&self) -> &'static str {
        "threats"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let risk = Analytic::new(Function::Threats(self.clone()), Quantity::Risk);
        (plane.reading(Quantity::Risk, 0.0), Values::Analytic(risk))
    }

    fn quantity(&self) -> Quantity {
        Quantity::Risk
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        vec![Self::shared_data(self)]
    }

    fn risk_at(&self, point: DVec2, _: Option<&TiledRaster>) -> Option<f64> {
        Some(Self::risk_at(self, point))
    }

    fn risks(&self, _: Option<&TiledRaster>) -> Option<RiskSource> {
        Some(RiskSource::Threats(self.clone()))
    }

    fn extent(&self, _: LayerSlot, _: &ExtentContext) -> Extent {
        Extent::of(self.list().iter().filter_map(|threat| reach(Some(threat))))
    }

    /// A threat that is replaced leaves, and the other one joins.
    fn change_since(&self, old: &dyn LayerSource, _: &LayerEdit) -> ValueChange {
        let Some(old) = old.get::<Self>() else { return ValueChange::Anywhere(Any) };
        let [mut finer, mut coarser] = [Vec::new(), Vec::new()];
        for (before, after) in changed_threats(self, old) {
            let [gains, loses] = match (before, after) {
                (Some(before), Some(after)) => {
                    let differs_in_peak = Threat { peak: before.peak, ..*after } == *before;
                    [
                        !differs_in_peak || after.peak > before.peak,
                        !differs_in_peak || after.peak < before.peak,
                    ]
                }
                (before, after) => [after.is_some(), before.is_some()],
            };
            finer.extend(reach(after).filter(|_| gains));
            coarser.extend(reach(before).filter(|_| loses));
        }
        ValueChange::Within(vec![(finer, Finer), (coarser, Coarser)])
    }
}

/// Rectangles on the union of which the risk of two lists of threats can differ.
pub fn areas_that_differ(new: &Threats, old: &Threats) -> Vec<Rect> {
    let changed = changed_threats(new, old).into_iter();
    changed.flat_map(|(before, after)| reach(before).into_iter().chain(reach(after))).collect()
}

/// Where a threat is felt, if there is one.
fn reach(threat: Option<&Threat>) -> Option<Rect> {
    threat.filter(|threat| threat.peak > 0.0).map(Threat::reach)
}

/// The threats of two lists that differ: those before and after, at the same place of the list.
fn changed_threats<'a>(new: &'a Threats, old: &'a Threats) -> Vec<(Option<&'a Threat>, Option<&'a Threat>)> {
    if new.shares_list_with(old) {
        return Vec::new();
    }
    let (new, old) = (new.list(), old.list());
    if new.len() == old.len() {
        let pairs = old.iter().zip(new).filter(|(before, after)| before != after);
        return pairs.map(|(before, after)| (Some(before), Some(after))).collect();
    }
    // Some left or joined: what is equal at the beginning and at the end of both lists does not count.
    let first = new.iter().zip(old).take_while(|(a, b)| a == b).count();
    let (new, old) = (&new[first..], &old[first..]);
    let last = new.iter().rev().zip(old.iter().rev()).take_while(|(a, b)| a == b).count();
    let left = old[..old.len() - last].iter().map(|before| (Some(before), None));
    left.chain(new[..new.len() - last].iter().map(|after| (None, Some(after)))).collect()
}
