use serde::{Deserialize, Serialize};

use super::super::checks::number_where;
use super::super::{KeyGroup, LayerData, LayerOrigin, SavedDepthSize, SavedPositive, Stored, TableEntries};
use super::GridKeys;
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::layers::key_group::group_of_groups;
use crate::io::lengths::SavedLength;
use crate::io::{KeyFault, ValueFacts, ValueUnit};
use meshbrush_core::layers::{DepthRule, DepthSizes, Depths, LayerKind, PositiveDepth};
use meshbrush_core::raster::RasterValues;

/// The keys of depths.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DepthKeys {
    /// Which raster it is.
    #[serde(flatten)]
    pub grid: GridKeys,
    /// What its values are.
    #[serde(flatten)]
    pub datum: DatumKeys,
    /// How the depth decides the target diameter.
    #[serde(flatten)]
    pub size: DepthSizeKeys,
    /// Where it does.
    #[serde(flatten)]
    pub between: DepthRangeKeys,
}

group_of_groups!(DepthKeys {
    grid: GridKeys,
    datum: DatumKeys,
    size: DepthSizeKeys,
    between: DepthRangeKeys
});

/// What the values of a grid of depths are.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DatumKeys {
    /// Whether values are heights or depths; without it, what the file says, or else heights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub positive: Option<SavedPositive>,
    /// What is added to depths, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
}

/// The depths at which something is asked for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthRangeKeys {
    /// The least depth, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_from: Option<f64>,
    /// The greatest depth, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_to: Option<f64>,
}

/// How the depth decides the target diameter: `size` says which keys there are.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(tag = "size", rename_all = "lowercase")]
pub enum DepthSizeKeys {
    /// It does not.
    #[default]
    Nothing,
    /// By the length of a wave.
    Wavelength(WavelengthKeys),
    /// By the topographic length.
    Slope(SlopeKeys),
    /// By the distance that a wave travels in a time step.
    Courant(CourantKeys),
}

/// Triangles in the length of a wave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WavelengthKeys {
    /// The period of the wave, in seconds.
    pub period: f64,
    /// Triangles in its length.
    pub triangles: f64,
}

/// Triangles in the topographic length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlopeKeys {
    /// Triangles in the length.
    pub triangles: f64,
    /// The side of the square over which heights are averaged, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<SavedLength>,
}

/// A Courant number of a wave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CourantKeys {
    /// A time step, in seconds.
    pub time_step: f64,
    /// The Courant number.
    pub courant: f64,
}

/// The key that says how the depth decides the target diameter.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SizeTag {
    #[serde(default)]
    size: SavedDepthSize,
}

impl SavedDepthSize {
    /// Returns the keys of this rule alone.
    fn keys(self) -> Vec<&'static str> {
        match self {
            Self::Nothing => Vec::new(),
            Self::Wavelength => WavelengthKeys::names(),
            Self::Slope => SlopeKeys::names(),
            Self::Courant => CourantKeys::names(),
        }
    }
}

impl KeyGroup for DepthSizeKeys {
    fn names() -> Vec<&'static str> {
        let mut names = SizeTag::names();
        for key in SavedDepthSize::ALL.into_iter().flat_map(SavedDepthSize::keys) {
            if !names.contains(&key) {
                names.push(key);
            }
        }
        names
    }

    fn take(entries: &mut TableEntries<'_>) -> Result<Self, KeyFault> {
        let SizeTag { size } = SizeTag::take(entries)?;
        let (all, own) = (Self::names(), size.keys());
        let is_foreign = |key: &str| all.contains(&key) && !own.contains(&key);
        if let Some(key) = entries.keys().find(|key| is_foreign(key)) {
            let sentence = format!("depths with size = \"{}\" have no `{key}`.", size.word());
            return Err(KeyFault::key(key.to_owned(), sentence));
        }
        Ok(match size {
            SavedDepthSize::Nothing => Self::Nothing,
            SavedDepthSize::Wavelength => Self::Wavelength(KeyGroup::take(entries)?),
            SavedDepthSize::Slope => Self::Slope(KeyGroup::take(entries)?),
            SavedDepthSize::Courant => Self::Courant(KeyGroup::take(entries)?),
        })
    }
}

impl DepthSizeKeys {
    fn of(rule: &DepthRule) -> Self {
        match *rule {
            DepthRule::Nothing => Self::Nothing,
            DepthRule::Wavelength { period, triangles } => {
                Self::Wavelength(WavelengthKeys { period, triangles })
            }
            DepthRule::Slope { triangles, smoothing } => {
                Self::Slope(SlopeKeys { triangles, smoothing: (smoothing > 0.0).then_some(smoothing.into()) })
            }
            DepthRule::Courant { time_step, number } => {
                Self::Courant(CourantKeys { time_step, courant: number })
            }
        }
    }

    fn checked(&self) -> Result<DepthRule, KeyFault> {
        let positive = |key, value| {
            number_where(value, value > 0.0, "it must be positive and finite")
                .map_err(|fault| fault.within(key))
        };
        Ok(match *self {
            Self::Nothing => DepthRule::Nothing,
            Self::Wavelength(WavelengthKeys { period, triangles }) => DepthRule::Wavelength {
                period: positive("period", period)?,
                triangles: positive("triangles", triangles)?,
            },
            Self::Slope(SlopeKeys { triangles, smoothing }) => DepthRule::Slope {
                triangles: positive("triangles", triangles)?,
                smoothing: smoothing.map_or(Ok(0.0), |side| side.checked("smoothing"))?,
            },
            Self::Courant(CourantKeys { time_step, courant }) => DepthRule::Courant {
                time_step: positive("time_step", time_step)?,
                number: positive("courant", courant)?,
            },
        })
    }
}

impl DepthRangeKeys {
    fn checked(&self) -> Result<[f64; 2], KeyFault> {
        let least = self.depth_from.unwrap_or(0.0);
        number_where(least, least >= 0.0, "a depth must be 0 or more, and finite")
            .map_err(|fault| fault.within("depth_from"))?;
        let greatest = self.depth_to.map(|greatest| {
            number_where(greatest, greatest > least, "it must be finite, and above depth_from")
                .map_err(|fault| fault.within("depth_to"))
        });
        Ok([least, greatest.transpose()?.unwrap_or(f64::INFINITY)])
    }
}

impl DepthKeys {
    pub(super) fn of(sizes: &DepthSizes) -> Self {
        let DepthSizes { positive, offset, between: [least, greatest], rule } = sizes;
        Self {
            grid: GridKeys::default(),
            datum: DatumKeys {
                positive: Some((*positive).into()),
                offset: (*offset != 0.0).then_some(*offset),
            },
            size: DepthSizeKeys::of(rule),
            between: DepthRangeKeys {
                depth_from: (*least > 0.0).then_some(*least),
                depth_to: greatest.is_finite().then_some(*greatest),
            },
        }
    }

    fn checked(&self) -> Result<DepthSizes, KeyFault> {
        let (rule, between) = (self.size.checked()?, self.between.checked()?);
        let offset = self.datum.offset.unwrap_or(0.0);
        number_where(offset, true, "it must be finite").map_err(|fault| fault.within("offset"))?;
        let positive = self.datum.positive.map_or(PositiveDepth::Up, Into::into);
        Ok(DepthSizes { positive, offset, between, rule })
    }

    /// Returns the direction in which depths grow, as the file says it where the keys do not, and tells a
    /// person what does not suit depths.
    fn direction<D: LayerData>(&self, file: &str, facts: &ValueFacts, data: &mut D) -> Option<PositiveDepth> {
        if let ValueUnit::Other(unit) = &facts.unit {
            let problem = "its values are taken as metres, and it says that their unit is";
            data.note(format!("{file}: {problem} “{unit}”."));
        }
        let own = facts.positive?;
        let given = self.datum.positive.map(PositiveDepth::from);
        if given.is_some_and(|given| given != own) {
            let [said, other] = match own {
                PositiveDepth::Down => ["depths, positive downwards", "heights"],
                PositiveDepth::Up => ["heights, positive upwards", "depths"],
            };
            data.note(format!(
                "{file}: its values are taken as {other}, as `positive` says; the file says that they are {said}."
            ));
        }
        given.or(Some(own))
    }
}

impl KindKeys for DepthKeys {
    fn check(&self, stored: Stored) -> Result<(), KeyFault> {
        self.grid.check(Self::missing, stored)?;
        self.checked().map(|_| ())
    }

    fn grid(&self) -> Option<&GridKeys> {
        Some(&self.grid)
    }

    fn grid_mut(&mut self) -> Option<&mut GridKeys> {
        Some(&mut self.grid)
    }
}

impl LoadKind for DepthKeys {
    const WORD: &str = "depth";
    const NAME: &str = "Depth";

    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error> {
        let (sizes, (source, facts)) = (self.checked()?, origin.raster(&self.grid, RasterValues::Any, data)?);
        let positive = self.direction(&origin.file_name(), &facts, data).unwrap_or(sizes.positive);
        Ok(LayerKind::Depth(Depths::new(source, DepthSizes { positive, ..sizes })))
    }
}
