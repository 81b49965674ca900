//! Threats: places with a risk around them, such as radars, combined as independent probabilities.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec2;

use crate::field::Bounds;
use crate::geometry::{BoxGroup, BoxTree, Rect};

/// How the risk of a threat falls with the distance, from its peak to 0 at its range. All laws are
/// continuous, never rise, and are 0 beyond the range.
///
/// ```text
/// Radar     ------.           Gaussian  -.            Disc  ----------.
///                  \                      `.                           \
///                   `.                      \                           \
///                     `--.__                 `-.__                       `
///           0     1/2       1           0  1/3    1         0       3/4  1     distance / range
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThreatLaw {
    /// The power that a radar receives, which falls with r⁻⁴. The peak up to half the range R, then
    /// peak · ((R/r)⁴ − 1) / 15.
    #[default]
    Radar,
    /// A bell curve of standard deviation R/3, lowered so that it is 0 at the range:
    /// peak · (e^(−4.5 (r/R)²) − e^(−4.5)) / (1 − e^(−4.5)).
    Gaussian,
    /// The peak up to three quarters of the range, then a smooth rim: peak · t² (3 − 2t), t = 4 (1 − r/R).
    Disc,
}

impl ThreatLaw {
    /// Every law with its name in files.
    pub const ALL: [(Self, &str); 3] =
        [(Self::Radar, "radar"), (Self::Gaussian, "gaussian"), (Self::Disc, "disc")];

    /// Returns the name in files.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(law, _)| *law == self).map_or("radar", |(_, name)| name)
    }

    /// Returns the share of the peak at a distance, from the square of distance / range.
    pub(super) fn share(self, squared: f64) -> f64 {
        if squared >= 1.0 {
            return 0.0;
        }
        match self {
            Self::Radar => ((1.0 / (squared * squared) - 1.0) / 15.0).min(1.0),
            Self::Gaussian => {
                let rim = libm::exp(-4.5);
                ((libm::exp(-4.5 * squared) - rim) / (1.0 - rim)).clamp(0.0, 1.0)
            }
            Self::Disc => {
                let t = (4.0 * (1.0 - squared.sqrt())).min(1.0);
                t * t * (3.0 - 2.0 * t)
            }
        }
    }
}

/// A place with a risk around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threat {
    /// The position of the threat, in world units.
    pub at: DVec2,
    /// The distance from which on there is no risk, in world units.
    pub range: f64,
    /// The greatest risk, 0 to 1.
    pub peak: f64,
    /// How the risk falls with the distance.
    pub law: ThreatLaw,
}

/// Why a threat is not valid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ThreatError {
    /// The place is not finite.
    #[error("A threat lies at {x}, {y}; both must be finite numbers.")]
    Place {
        /// The number as it was given.
        x: f64,
        /// The number as it was given.
        y: f64,
    },
    /// The range is not positive, or reaches too far.
    #[error(
        "A threat has the range {0}; it must be a finite number above 0. To have no risk, set the peak to 0."
    )]
    Range(f64),
    /// The peak is not a risk.
    #[error("A threat has the peak {0}; it must be a risk from 0 to 1.")]
    Peak(f64),
}

impl Threat {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Fails with the first number that is not valid.
    pub fn check(&self) -> Result<(), ThreatError> {
        let box_is_finite = self.reach().min.is_finite() && self.reach().max.is_finite();
        if !self.at.is_finite() {
            return Err(ThreatError::Place { x: self.at.x, y: self.at.y });
        }
        if !(self.range > 0.0 && box_is_finite) {
            return Err(ThreatError::Range(self.range));
        }
        if !(0.0..=1.0).contains(&self.peak) {
            return Err(ThreatError::Peak(self.peak));
        }
        Ok(())
    }

    /// Returns the rectangle beyond which there is no risk, in world units.
    pub fn reach(&self) -> Rect {
        Rect::around(self.at, self.range)
    }

    /// Returns the risk at a point in world units.
    pub fn risk_at(&self, p: DVec2) -> f64 {
        self.risk_towards(p - self.at)
    }

    fn risk_towards(&self, offset: DVec2) -> f64 {
        // Divided first, so that no square overflows.
        let share = offset / self.range;
        self.peak * self.law.share(share.x * share.x + share.y * share.y)
    }

    /// Returns bounds of the risk over a rectangle. Up to the law, every operation keeps order when it
    /// rounds.
    pub(super) fn bounds(&self, rect: &Rect) -> Bounds {
        let (low, high) = (rect.min - self.at, rect.max - self.at);
        let nearest = DVec2::ZERO.clamp(low, high);
        let farthest = low.abs().max(high.abs());
        let bounds = Bounds::new(self.risk_towards(farthest), self.risk_towards(nearest)).widened(8);
        Bounds { least: bounds.least.max(0.0), greatest: bounds.greatest.min(self.peak), ..bounds }
    }
}

/// Up to this risk p, 1 − p is rounded to 1: the threat changes no combined risk.
const NEGLIGIBLE: f64 = f64::EPSILON / 4.0;

/// Survival below this is lost when it is subtracted from 1, in whichever order it was multiplied: the risk
/// is 1.
pub(super) const NO_SURVIVAL: f64 = f64::EPSILON / 16.0;

/// Threats and their combined risk 1 − Π(1 − pᵢ): each is survived or not, independently of the others.
///
/// Clones share their data. The risk at a point depends on the list alone, to the last bit, and not on the
/// order of edits.
#[derive(Clone, Debug, Default)]
pub struct Threats(Arc<IndexedThreats>);

#[derive(Clone, Debug)]
struct IndexedThreats {
    threats: Vec<Threat>,
    tree: BoxTree,
    /// For each group of the tree, by level, the product of 1 − peak: at least this is survived.
    survival: Vec<Vec<f64>>,
}

impl Default for IndexedThreats {
    fn default() -> Self {
        Self { threats: Vec::new(), tree: BoxTree::new(&[]), survival: Vec::new() }
    }
}

impl PartialEq for Threats {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.threats == other.0.threats
    }
}

impl Threats {
    /// Indexes threats.
    ///
    /// # Errors
    /// Fails with the first threat that is not valid, with its number in the list.
    pub fn new(threats: Vec<Threat>) -> Result<Self, (usize, ThreatError)> {
        for (number, threat) in threats.iter().enumerate() {
            threat.check().map_err(|error| (number, error))?;
        }
        let reaches: Vec<Rect> = threats.iter().map(Threat::reach).collect();
        let tree = BoxTree::new(&reaches);
        let survival = tree.all_joined(|number| 1.0 - threats[number as usize].peak, PRODUCT);
        Ok(Self(Arc::new(IndexedThreats { threats, tree, survival })))
    }

    /// Returns the threats in the order in which they were given.
    pub fn list(&self) -> &[Threat] {
        &self.0.threats
    }

    /// Returns the address of the data that clones share, and their memory in bytes.
    pub fn shared_data(&self) -> (usize, usize) {
        let IndexedThreats { threats, tree, survival } = &*self.0;
        let survival: usize = survival.iter().map(|level| size_of_val(&**level)).sum();
        (Arc::as_ptr(&self.0).addr(), size_of_val(&**threats) + tree.bytes() + survival)
    }

    /// Replaces one threat. This keeps most of the index, so that a threat can be dragged among many. Data
    /// that clones share are copied first.
    ///
    /// # Errors
    /// Fails when the threat is not valid; nothing is changed then.
    ///
    /// # Panics
    /// Panics when there is no threat of this number.
    pub fn set(&mut self, number: usize, threat: Threat) -> Result<(), ThreatError> {
        threat.check()?;
        let indexed = Arc::make_mut(&mut self.0);
        indexed.threats[number] = threat;
        indexed.tree.set(number as u32, threat.reach());
        for group in indexed.tree.groups_of(number as u32) {
            indexed.survival[group.level][group.index] = indexed.survival_of(group);
        }
        Ok(())
    }

    /// Returns the combined risk at a point in world units, 0 to 1.
    pub fn risk_at(&self, p: DVec2) -> f64 {
        // The product depends on its order to the last bit, so it follows the list.
        let (mut risks, mut survival) = (Vec::with_capacity(64), 1.0);
        let end = self.0.tree.visit_meeting(&Rect::new(p, p), |number| {
            let risk = self.0.threats[number as usize].risk_at(p);
            if risk > 0.0 {
                risks.push((number, risk));
                survival *= 1.0 - risk;
            }
            if survival < NO_SURVIVAL { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if end.is_break() {
            return 1.0;
        }
        risks.sort_unstable_by_key(|&(number, _)| number);
        1.0 - risks.iter().map(|(_, risk)| 1.0 - risk).product::<f64>()
    }

    /// Visits the threats whose reach meets a rectangle, in no particular order.
    pub(super) fn visit_meeting(
        &self,
        rect: &Rect,
        mut visit: impl FnMut(&Threat) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.0.tree.visit_meeting(rect, |number| visit(&self.0.threats[number as usize]))
    }

    /// Returns bounds of the combined risk over a closed rectangle in world units.
    ///
    /// Threats that lie in the rectangle with all of their reach are counted by groups, so that a large
    /// rectangle costs about the threats across its sides.
    pub fn bounds(&self, rect: &Rect) -> Bounds {
        let indexed = &*self.0;
        // What is survived: at least and at most.
        let (mut least, mut most, mut count) = (1.0, 1.0, 0);
        let (mut least_of_groups, mut count_in_groups) = (1.0, 0);
        let end = indexed.tree.descend(
            |group, reach| {
                let within = rect.contains(reach.min) && rect.contains(reach.max);
                if within {
                    // In a corner of the rectangle no threat of the group is felt.
                    least_of_groups *= indexed.survival[group.level][group.index];
                    count_in_groups += 8usize.pow(group.level as u32 + 1);
                }
                !within && reach.intersection(rect).is_some()
            },
            |number, reach| {
                if reach.intersection(rect).is_none() {
                    return ControlFlow::Continue(());
                }
                let risk = indexed.threats[number as usize].bounds(rect);
                if risk.greatest > NEGLIGIBLE {
                    least *= 1.0 - risk.greatest;
                    most *= 1.0 - risk.least;
                    count += 1;
                }
                if most < NO_SURVIVAL { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
        );
        if end.is_break() {
            return Bounds::one(1.0);
        }
        if count + count_in_groups == 0 {
            return Bounds::one(0.0);
        }
        // Each factor and each product is off by half an ulp at most, here and in the risk at a point.
        let margin = f64::EPSILON * (4.0 * (count + count_in_groups) as f64 + 8.0);
        let bounds = Bounds::new(1.0 - most * (1.0 + margin), 1.0 - least * least_of_groups * (1.0 - margin))
            .widened(2);
        Bounds { least: bounds.least.max(0.0), greatest: bounds.greatest.min(1.0), ..bounds }
    }

    /// Whether both are clones of one list.
    pub(super) fn shares_list_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl IndexedThreats {
    /// Returns the product of 1 − peak over a group, from that of its members.
    fn survival_of(&self, group: BoxGroup) -> f64 {
        let survival = |number: u32| 1.0 - self.threats[number as usize].peak;
        self.tree.joined(group, &self.survival, survival, PRODUCT)
    }
}

/// Survival is multiplied.
const PRODUCT: (f64, fn(f64, f64) -> f64) = (1.0, |a, b| a * b);

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::layers::{Layer, PaintLayers, RiskField};

    fn threat(random: &mut fastrand::Rng) -> Threat {
        let range = [0.02, 0.1, 0.7][random.usize(..3)] * (0.1 + random.f64());
        let peak = [random.f64(), 1.0, 0.0, 0.3][random.usize(..4)];
        Threat {
            at: dvec2(random.f64(), random.f64()),
            range,
            peak,
            law: ThreatLaw::ALL[random.usize(..3)].0,
        }
    }

    /// Returns the combined risk by the formulas of the documentation, over all threats.
    fn referee(threats: &[Threat], p: DVec2) -> f64 {
        let rim = (-4.5f64).exp();
        let survived = threats.iter().map(|t| {
            let u = ((p.x - t.at.x).powi(2) + (p.y - t.at.y).powi(2)).sqrt() / t.range;
            let share = match t.law {
                _ if u >= 1.0 => 0.0,
                ThreatLaw::Radar if u <= 0.5 => 1.0,
                ThreatLaw::Radar => (u.powi(-4) - 1.0) / 15.0,
                ThreatLaw::Gaussian => ((-0.5 * (3.0 * u).powi(2)).exp() - rim) / (1.0 - rim),
                ThreatLaw::Disc if u <= 0.75 => 1.0,
                ThreatLaw::Disc => {
                    let t = 4.0 * (1.0 - u);
                    3.0 * t * t - 2.0 * t * t * t
                }
            };
            1.0 - t.peak * share
        });
        1.0 - survived.product::<f64>()
    }

    fn place(random: &mut fastrand::Rng) -> DVec2 {
        dvec2(1.6 * random.f64() - 0.3, 1.6 * random.f64() - 0.3)
    }

    #[test]
    fn the_risk_is_that_of_independent_threats() {
        let mut random = fastrand::Rng::with_seed(51);
        let mut risky = 0;
        for count in [0, 1, 3, 40, 300] {
            let list: Vec<Threat> = (0..count).map(|_| threat(&mut random)).collect();
            let threats = Threats::new(list.clone()).unwrap();
            for _ in 0..2_000 {
                let p = place(&mut random);
                let (risk, expected) = (threats.risk_at(p), referee(&list, p));
                assert!((risk - expected).abs() < 1e-12, "{risk} {expected} at {p}");
                risky += usize::from(risk > 0.0 && risk < 1.0);
            }
        }
        assert!(risky > 500, "{risky}");
    }

    #[test]
    fn laws_are_continuous_and_fall() {
        for (law, name) in ThreatLaw::ALL {
            let threat = Threat { at: DVec2::ZERO, range: 2.0, peak: 0.8, law };
            assert_eq!((threat.risk_at(DVec2::ZERO), threat.risk_at(dvec2(0.0, 2.0))), (0.8, 0.0), "{name}");
            let mut before = 0.8;
            for n in 0..=10_000 {
                let risk = threat.risk_at(dvec2(2.2 * f64::from(n) / 10_000.0, 0.0));
                assert!(risk <= before + 1e-15 && before - risk < 2e-3, "{name} at {n}: {before} {risk}");
                before = risk;
            }
        }
    }

    #[test]
    fn bounds_hold_the_risk_at_every_point() {
        let mut random = fastrand::Rng::with_seed(52);
        let (mut points, mut informative) = (0, 0);
        for count in [1, 5, 60, 800] {
            let list: Vec<Threat> = (0..count).map(|_| threat(&mut random)).collect();
            let mut threats = Threats::new(list).unwrap();
            for round in 0..1_000 {
                if round % 10 == 0 {
                    threats.set(random.usize(..count), threat(&mut random)).unwrap();
                }
                let min = place(&mut random);
                let side = [0.0, 1e-3, 0.05, 0.5, 2.0][random.usize(..5)];
                let rect = Rect::new(min, min + side * dvec2(random.f64(), random.f64()));
                let bounds = threats.bounds(&rect);
                for n in 0..30 {
                    let share = dvec2(random.f64(), random.f64());
                    let corner = dvec2(f64::from(n & 1), f64::from(n >> 1 & 1));
                    let p = rect.min + rect.size() * if n < 4 { corner } else { share };
                    let risk = threats.risk_at(p.clamp(rect.min, rect.max));
                    assert!(bounds.contains(risk), "{risk} at {p}, {bounds:?} over {rect:?}");
                    points += 1;
                }
                informative += usize::from(bounds.least > 0.0 || bounds.greatest < 1.0);
                if side == 0.0 {
                    assert!(bounds.greatest - bounds.least < 1e-12, "{bounds:?}");
                }
            }
        }
        assert!(points == 120_000 && informative > 1_000, "{informative}");
    }

    #[test]
    fn beyond_all_threats_the_bounds_are_zero() {
        let mut random = fastrand::Rng::with_seed(55);
        let mut beside_a_rim = 0;
        for _ in 0..300 {
            let list: Vec<Threat> = (0..5).map(|_| threat(&mut random)).collect();
            let threats = Threats::new(list.clone()).unwrap();
            for _ in 0..50 {
                let min = place(&mut random);
                let rect = Rect::new(min, min + 0.1 * dvec2(random.f64(), random.f64()));
                let is_beyond = |t: &Threat| t.at.distance(t.at.clamp(rect.min, rect.max)) > 1.001 * t.range;
                if list.iter().all(is_beyond) {
                    assert_eq!(threats.bounds(&rect), Bounds::one(0.0), "{rect:?}");
                    beside_a_rim += usize::from(list.iter().any(|t| t.reach().intersection(&rect).is_some()));
                }
            }
        }
        assert!(beside_a_rim > 20, "{beside_a_rim}");
    }

    fn areas_that_differ(new: &Threats, old: &Threats) -> Vec<Rect> {
        let risk = |threats: &Threats| RiskField::new(&Layer::stack([threats.clone()]), PaintLayers::blank());
        risk(new).areas_that_differ(&risk(old)).unwrap()
    }

    #[test]
    fn a_dragged_threat_gives_the_risks_of_a_new_list() {
        let mut random = fastrand::Rng::with_seed(53);
        let mut list: Vec<Threat> = (0..200).map(|_| threat(&mut random)).collect();
        let mut dragged = Threats::new(list.clone()).unwrap();
        for _ in 0..300 {
            let number = random.usize(..list.len());
            list[number] = threat(&mut random);
            let before = dragged.clone();
            dragged.set(number, list[number]).unwrap();
            let fresh = Threats::new(list.clone()).unwrap();
            assert_eq!(dragged, fresh);
            let areas = areas_that_differ(&dragged, &before);
            for _ in 0..40 {
                let p = place(&mut random);
                assert_eq!(dragged.risk_at(p).to_bits(), fresh.risk_at(p).to_bits());
                if before.risk_at(p) != dragged.risk_at(p) {
                    assert!(areas.iter().any(|area| area.contains(p)), "{p} changed beyond {areas:?}");
                }
            }
        }
        assert_eq!(areas_that_differ(&dragged, &dragged.clone()), []);
    }

    #[test]
    fn added_and_removed_threats_change_their_reach_alone() {
        let mut random = fastrand::Rng::with_seed(54);
        let list: Vec<Threat> = (0..20).map(|_| Threat { peak: 0.5, ..threat(&mut random) }).collect();
        let all = Threats::new(list.clone()).unwrap();
        for removed in 0..list.len() {
            let mut fewer = list.clone();
            fewer.remove(removed);
            let fewer = Threats::new(fewer).unwrap();
            assert_eq!(areas_that_differ(&all, &fewer), [list[removed].reach()]);
            assert_eq!(areas_that_differ(&fewer, &all), [list[removed].reach()]);
        }
        assert_eq!(areas_that_differ(&all, &Threats::new(list).unwrap()), []);
    }

    #[test]
    fn invalid_threats_are_refused_with_a_sentence() {
        let good = Threat { at: DVec2::ONE, range: 1.0, peak: 0.5, law: ThreatLaw::Disc };
        for (bad, word) in [
            (Threat { at: dvec2(f64::NAN, 0.0), ..good }, "NaN, 0"),
            (Threat { range: 0.0, ..good }, "range 0"),
            (Threat { range: f64::INFINITY, ..good }, "range inf"),
            (Threat { range: f64::NAN, ..good }, "range NaN"),
            (Threat { peak: 1.5, ..good }, "peak 1.5"),
            (Threat { peak: f64::NAN, ..good }, "peak NaN"),
        ] {
            let (number, error) = Threats::new(vec![good, bad]).unwrap_err();
            assert!(number == 1 && error.to_string().contains(word), "{error}");
            let mut threats = Threats::new(vec![good]).unwrap();
            assert_eq!(threats.set(0, bad).map_err(|e| e.to_string()), Err(error.to_string()));
            assert_eq!(threats.list(), [good]);
        }
    }
}
