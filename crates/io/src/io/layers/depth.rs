//! The keys of layers of depths.

use super::checks::{number_where, positive_length};
use super::{SavedDepthSize, SavedKind, SavedLayer};
use crate::io::KeyFault;
use meshbrush_core::layers::{DepthRule, DepthSizes, PositiveDepth};

impl SavedLayer {
    /// Returns a layer that asks this of its depths, without a file.
    pub(super) fn of_depths(sizes: &DepthSizes) -> Self {
        let DepthSizes { positive, offset, between: [least, greatest], rule } = *sizes;
        let layer = Self {
            positive: Some(positive.into()),
            offset: (offset != 0.0).then_some(offset),
            depth_from: (least > 0.0).then_some(least),
            depth_to: greatest.is_finite().then_some(greatest),
            ..Self::of_kind(SavedKind::Depth)
        };
        match rule {
            DepthRule::Nothing => Self { size: Some(SavedDepthSize::Nothing), ..layer },
            DepthRule::Wavelength { period, triangles } => Self {
                size: Some(SavedDepthSize::Wavelength),
                period: Some(period),
                triangles: Some(triangles),
                ..layer
            },
            DepthRule::Slope { triangles, smoothing } => Self {
                size: Some(SavedDepthSize::Slope),
                triangles: Some(triangles),
                smoothing: (smoothing > 0.0).then_some(smoothing),
                ..layer
            },
            DepthRule::Courant { time_step, number } => Self {
                size: Some(SavedDepthSize::Courant),
                time_step: Some(time_step),
                courant: Some(number),
                ..layer
            },
        }
    }

    /// Returns what is asked of depths: nothing without `size`, and values are heights without `positive`.
    pub(super) fn depth_sizes(&self) -> Result<DepthSizes, KeyFault> {
        let size = self.size.unwrap_or(SavedDepthSize::Nothing);
        let is_of_rule = |key: &&str| SavedDepthSize::ALL.iter().any(|size| size.keys().contains(key));
        let foreign = |key: &&str| is_of_rule(key) && !size.keys().contains(key);
        if let Some(key) = self.given().find(foreign) {
            let sentence = format!("depths with size = \"{}\" have no `{key}`.", size.word());
            return Err(KeyFault::key(key, sentence));
        }
        let positive = |key, value: Option<f64>| {
            let value = self.needed(key, value)?;
            let rule = "it must be positive and finite";
            number_where(value, value > 0.0, rule).map_err(|fault| fault.within(key))
        };
        let rule = match size {
            SavedDepthSize::Nothing => DepthRule::Nothing,
            SavedDepthSize::Wavelength => DepthRule::Wavelength {
                period: positive("period", self.period)?,
                triangles: positive("triangles", self.triangles)?,
            },
            SavedDepthSize::Slope => DepthRule::Slope {
                triangles: positive("triangles", self.triangles)?,
                smoothing: self
                    .smoothing
                    .map_or(Ok(0.0), positive_length)
                    .map_err(|f| f.within("smoothing"))?,
            },
            SavedDepthSize::Courant => DepthRule::Courant {
                time_step: positive("time_step", self.time_step)?,
                number: positive("courant", self.courant)?,
            },
        };
        let least = self.depth_from.unwrap_or(0.0);
        number_where(least, least >= 0.0, "a depth must be 0 or more, and finite")
            .map_err(|fault| fault.within("depth_from"))?;
        let greatest = self.depth_to.unwrap_or(f64::INFINITY);
        if self.depth_to.is_some() {
            number_where(greatest, greatest > least, "it must be finite, and above depth_from")
                .map_err(|fault| fault.within("depth_to"))?;
        }
        let offset = self.offset.unwrap_or(0.0);
        number_where(offset, true, "it must be finite").map_err(|fault| fault.within("offset"))?;
        let positive = self.positive.map_or(PositiveDepth::Up, Into::into);
        Ok(DepthSizes { positive, offset, between: [least, greatest], rule })
    }
}
