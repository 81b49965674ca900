//! What lines are for solvers: weirs with crests.

use glam::DVec2;

use super::Line;
use crate::geometry::{BoxTree, Rect, nearest_on_segment};
use crate::text::{Number, short_name};

/// What a line is for the solvers that files are written for. The mesh does not depend on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum LineKind {
    /// Edges with a name.
    #[default]
    Edges,
    /// A weir or levee: water crosses it where it is higher than the crest.
    Weir(Weir),
}

/// A weir or levee along a line inside the domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Weir {
    /// The height of the crest.
    pub crest: Crest,
    /// The coefficient of the flow across it where the water beyond is high enough to hold it back.
    pub subcritical: f64,
    /// The coefficient of free flow across it.
    pub supercritical: f64,
}

/// The height of a crest in metres, positive upwards from the level from which depths are positive downwards.
#[derive(Clone, Debug, PartialEq)]
pub enum Crest {
    /// One height everywhere.
    Height(f64),
    /// Pairs of a share of the length of the line, from 0 to 1 and ascending, and the height there. It is
    /// linear between them, and constant beyond the first and the last.
    Profile(Vec<[f64; 2]>),
}

/// Why a weir is of no use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WeirError {
    /// A height is not a finite number.
    #[error("a crest of {} is no height: write a finite number of metres, positive upwards.", Number(*.0))]
    Height(f64),
    /// A profile without a height.
    #[error(
        "the profile of the crest is empty: write pairs of a share of the length and a height, as in [[0, 2.5], [1, 3]]."
    )]
    EmptyProfile,
    /// A share beyond the line, or before the one ahead of it.
    #[error("the profile of the crest has the share {} of the length: shares are from 0 to 1, in ascending order.", Number(*.0))]
    Share(f64),
    /// A coefficient is not a positive number.
    #[error("a coefficient of {} cannot be one of a flow: it is positive and finite, and usually 1.", Number(*.0))]
    Coefficient(f64),
}

/// Why a line cannot be the weir that it is said to be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("The line “{}” cannot be a weir: {problem}", short_name(line))]
pub struct LineWeirError {
    /// The name of the line.
    pub line: String,
    /// Why.
    pub problem: WeirError,
}

impl Line {
    /// Checks the weirs among lines.
    ///
    /// # Errors
    /// Fails for the first one that is of no use.
    pub fn check_all(lines: &[Self]) -> Result<(), LineWeirError> {
        lines.iter().try_for_each(|line| {
            let checked = line.weir().map_or(Ok(()), Weir::check);
            checked.map_err(|problem| LineWeirError { line: line.name.clone(), problem })
        })
    }
}

impl Weir {
    /// The coefficients that ADCIRC's manual calls typical.
    pub const USUAL_COEFFICIENT: f64 = 1.0;

    /// Returns a weir with this crest and the usual coefficients.
    pub fn with_crest(crest: Crest) -> Self {
        Self { crest, subcritical: Self::USUAL_COEFFICIENT, supercritical: Self::USUAL_COEFFICIENT }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// Fails for the first one that is of no use.
    pub fn check(&self) -> Result<(), WeirError> {
        self.crest.check()?;
        let coefficients = [self.subcritical, self.supercritical];
        match coefficients.into_iter().find(|value| !(*value > 0.0 && value.is_finite())) {
            Some(value) => Err(WeirError::Coefficient(value)),
            None => Ok(()),
        }
    }
}

impl Crest {
    /// Checks the numbers.
    ///
    /// # Errors
    /// Fails for the first one that is of no use.
    pub fn check(&self) -> Result<(), WeirError> {
        let pairs: &[[f64; 2]] = match self {
            Self::Height(height) => &[[0.0, *height]],
            Self::Profile(pairs) => pairs,
        };
        let mut last = 0.0;
        for &[share, height] in pairs {
            if !(last..=1.0).contains(&share) {
                return Err(WeirError::Share(share));
            }
            if !height.is_finite() {
                return Err(WeirError::Height(height));
            }
            last = share;
        }
        if pairs.is_empty() { Err(WeirError::EmptyProfile) } else { Ok(()) }
    }

    /// Returns the crest with minus the heights, for those that were depths.
    pub fn negated(self) -> Self {
        match self {
            Self::Height(height) => Self::Height(-height),
            Self::Profile(pairs) => {
                Self::Profile(pairs.into_iter().map(|[at, height]| [at, -height]).collect())
            }
        }
    }

    /// Returns the height at a share of the length of the line; NaN for an empty profile.
    pub fn at(&self, share: f64) -> f64 {
        let pairs = match self {
            Self::Height(height) => return *height,
            Self::Profile(pairs) => pairs,
        };
        let after = pairs.partition_point(|pair| pair[0] <= share);
        match (after.checked_sub(1).map(|before| pairs[before]), pairs.get(after)) {
            (Some([from, low]), Some([to, high])) => low + (share - from) / (to - from) * (high - low),
            (Some([_, height]), None) | (None, Some(&[_, height])) => height,
            (None, None) => f64::NAN,
        }
    }
}

/// Where points lie along a line.
pub(crate) struct LineMeasure {
    ends: Vec<[DVec2; 2]>,
    /// The length before each edge, and the whole length.
    lengths: Vec<f64>,
    tree: BoxTree,
}

impl LineMeasure {
    /// Measures the edges of a line. Corners that are not finite are left out.
    pub(crate) fn new(line: &Line) -> Self {
        let ends: Vec<[DVec2; 2]> =
            line.edges().filter(|[a, b]| a.is_finite() && b.is_finite() && a != b).collect();
        let mut lengths = vec![0.0];
        for [a, b] in &ends {
            lengths.push(lengths[lengths.len() - 1] + a.distance(*b));
        }
        let boxes: Vec<Rect> = ends.iter().map(|[a, b]| Rect::new(a.min(*b), a.max(*b))).collect();
        Self { ends, lengths, tree: BoxTree::new(&boxes) }
    }

    /// Returns the share of the length before the place of the line that is nearest to a point; 0 on a line
    /// without length.
    pub(crate) fn share(&self, p: DVec2) -> f64 {
        let on = |edge: u32| nearest_on_segment(p, self.ends[edge as usize]);
        let nearest = self.tree.nearest(p, |edge| on(edge).distance_squared(p));
        let Some((edge, _)) = nearest else { return 0.0 };
        let along = self.lengths[edge as usize] + self.ends[edge as usize][0].distance(on(edge));
        (along / self.lengths[self.ends.len()]).clamp(0.0, 1.0)
    }

    /// Returns the edges, each with the shares of the length before its ends.
    pub(crate) fn edges(&self) -> impl Iterator<Item = ([DVec2; 2], [f64; 2])> + '_ {
        let whole = self.lengths[self.ends.len()];
        let shares = self.lengths.windows(2).map(move |pair| [pair[0] / whole, pair[1] / whole]);
        self.ends.iter().copied().zip(shares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn a_profile_is_linear_between_its_heights_and_constant_beyond() {
        let crest = Crest::Profile(vec![[0.25, 2.0], [0.75, 4.0], [0.75, 5.0]]);
        assert_eq!(crest.check(), Ok(()));
        for (share, height) in [(0.0, 2.0), (0.25, 2.0), (0.5, 3.0), (0.75, 5.0), (1.0, 5.0)] {
            assert_eq!(crest.at(share), height, "{share}");
        }
        assert_eq!(Crest::Height(-3.0).at(0.4), -3.0);
        assert!(Crest::Profile(Vec::new()).at(0.5).is_nan());
    }

    #[test]
    fn numbers_of_no_use_are_named() {
        let crest = |pairs: &[[f64; 2]]| Crest::Profile(pairs.to_vec()).check().unwrap_err().to_string();
        assert!(crest(&[]).contains("is empty"));
        assert!(crest(&[[0.5, 1.0], [0.4, 1.0]]).contains("share 0.4"));
        assert!(crest(&[[0.5, 1.0], [1.5, 1.0]]).contains("share 1.5"));
        assert!(crest(&[[f64::NAN, 1.0]]).contains("share NaN"));
        assert!(crest(&[[0.5, f64::INFINITY]]).contains("a crest of inf"));
        let weir = Weir { supercritical: 0.0, ..Weir::with_crest(Crest::Height(1.0)) };
        assert_eq!(weir.check(), Err(WeirError::Coefficient(0.0)));
    }

    #[test]
    fn shares_are_those_of_the_length_along_the_line() {
        let points = vec![dvec2(0.0, 0.0), dvec2(3.0, 0.0), dvec2(3.0, 1.0)];
        let line = Line { name: "line".into(), points, closed: false, kind: LineKind::Edges };
        let measure = LineMeasure::new(&line);
        for (p, share) in [([0.0, 0.5], 0.0), ([1.5, -0.2], 0.375), ([3.2, 0.5], 0.875), ([9.0, 9.0], 1.0)] {
            assert!((measure.share(p.into()) - share).abs() < 1e-15, "{p:?}");
        }
        let point = Line { points: vec![DVec2::ONE; 2], ..line };
        assert_eq!(LineMeasure::new(&point).share(DVec2::ZERO), 0.0);
    }
}
