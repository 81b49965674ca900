//! What the sources of a field ask for by pixel: sampled once, and shared between fields.

use std::sync::Arc;

use super::{Source, TargetFieldSpec, TransferTable, f32_not_below, smallest_target};
use crate::geometry::Rect;
use crate::mesh::InvalidTarget;
use crate::raster::{PixelRect, Raster};

/// The smallest diameter that the sources ask for at the centre of each pixel.
///
/// Lengths and risks are kept apart. The coarse spacing changes neither; the transfer curve changes the risks
/// only. So a field with another of these can share what an earlier one has sampled ([`Self::reusing`]).
#[derive(Clone, Debug)]
pub(super) struct SourceSamples {
    /// The smallest of the constants; infinite where there are none.
    constant: f32,
    lengths: Samples,
    risks: Samples,
    /// How often a source was evaluated.
    evaluations: u64,
}

/// The smallest diameter that the sources of one kind ask for, by pixel.
#[derive(Clone, Debug)]
enum Samples {
    /// There are no sources of this kind.
    NoSources,
    /// Row by row, as far as the field is filled.
    Sampling(Raster),
    Complete(Arc<Raster>),
}

/// Kinds of sources, by what their samples depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Constant,
    /// Formulas and rasters of diameters: independent of the transfer curve.
    Length,
    Risk,
}

impl Kind {
    fn of(source: &Source) -> Self {
        match source {
            Source::Constant(_) => Self::Constant,
            Source::TargetFormula(_) | Source::TargetRaster(_) => Self::Length,
            Source::RiskFormula(_) | Source::RiskRaster(_) => Self::Risk,
        }
    }
}

/// The sources of one kind, in their order.
fn of_kind(spec: &TargetFieldSpec, kind: Kind) -> impl Iterator<Item = &Source> {
    spec.sources.iter().filter(move |source| Kind::of(source) == kind)
}

impl Samples {
    fn new(spec: &TargetFieldSpec, kind: Kind, bounds: Rect) -> Self {
        match of_kind(spec, kind).next() {
            // Zeros cost nothing until they are written over, slice by slice.
            Some(_) => Self::Sampling(Raster::filled(bounds, spec.size, 0.0)),
            None => Self::NoSources,
        }
    }

    /// The samples for another field, if they are complete.
    fn shared(&self) -> Option<Self> {
        match self {
            Self::Complete(raster) => Some(Self::Complete(raster.clone())),
            Self::NoSources | Self::Sampling(_) => None,
        }
    }

    fn raster(&self) -> Option<&Raster> {
        match self {
            Self::NoSources => None,
            Self::Sampling(raster) => Some(raster),
            Self::Complete(raster) => Some(raster),
        }
    }

    fn complete(&mut self) {
        *self = match std::mem::replace(self, Self::NoSources) {
            Self::Sampling(raster) => Self::Complete(Arc::new(raster)),
            other => other,
        };
    }
}

impl SourceSamples {
    /// Nothing is sampled yet.
    pub(super) fn new(spec: &TargetFieldSpec, bounds: Rect) -> Self {
        Self {
            constant: f32::INFINITY,
            lengths: Samples::new(spec, Kind::Length, bounds),
            risks: Samples::new(spec, Kind::Risk, bounds),
            evaluations: 0,
        }
    }

    /// As [`Self::new`], with the samples of an earlier field over the same bounds where these are the same.
    pub(super) fn reusing(
        spec: &TargetFieldSpec,
        bounds: Rect,
        earlier: &Self,
        earlier_spec: &TargetFieldSpec,
    ) -> Self {
        let mut samples = Self::new(spec, bounds);
        let same = |kind| of_kind(spec, kind).eq(of_kind(earlier_spec, kind));
        if spec.size == earlier_spec.size {
            if same(Kind::Length)
                && let Some(shared) = earlier.lengths.shared()
            {
                samples.lengths = shared;
            }
            if same(Kind::Risk)
                && spec.transfer == earlier_spec.transfer
                && let Some(shared) = earlier.risks.shared()
            {
                samples.risks = shared;
            }
        }
        samples
    }

    /// Evaluates the sources at the pixels of `rows`, but for those whose samples are shared.
    ///
    /// # Errors
    /// When a source gives NaN, infinity, zero or less.
    pub(super) fn sample(
        &mut self,
        spec: &TargetFieldSpec,
        table: &TransferTable,
        pixel_center: impl Fn(u32, u32) -> glam::DVec2,
        rows: PixelRect,
    ) -> Result<(), InvalidTarget> {
        let [x, y] = rows.min;
        self.constant =
            f32_not_below(smallest_target(of_kind(spec, Kind::Constant), pixel_center(x, y), table)?);
        for (samples, kind) in [(&mut self.lengths, Kind::Length), (&mut self.risks, Kind::Risk)] {
            let Samples::Sampling(raster) = samples else { continue };
            let sources: Vec<&Source> = of_kind(spec, kind).collect();
            for (x, y) in rows.pixels() {
                let value = smallest_target(sources.iter().copied(), pixel_center(x, y), table)?;
                // Rounded up: rounding to nearest could ask for one level more.
                raster.set(x, y, f32_not_below(value));
                self.evaluations += sources.len() as u64;
            }
        }
        Ok(())
    }

    /// To be called once all rows are sampled: from then on the samples can be shared.
    pub(super) fn complete(&mut self) {
        self.lengths.complete();
        self.risks.complete();
    }

    /// The smallest diameters that the sources ask for at pixels of row `y`, from column `x` on, in world
    /// units; infinite where no source does.
    pub(super) fn row<const N: usize>(&self, x: u32, y: u32, count: usize) -> [f32; N] {
        let mut smallest = [self.constant; N];
        for raster in [&self.lengths, &self.risks].into_iter().filter_map(|samples| samples.raster()) {
            let asked = raster.row(y, x..x + count as u32);
            smallest.iter_mut().zip(asked).for_each(|(smallest, &asked)| *smallest = smallest.min(asked));
        }
        smallest
    }

    pub(super) fn evaluations(&self) -> u64 {
        self.evaluations
    }
}
