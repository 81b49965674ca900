//! The kinds of layers as texts have them: a file for each, with a struct whose fields are the keys of the
//! kind. What a text says about them (words, keys, sentences) follows from the list below.

mod band;
mod depth;
mod distance;
mod formula;
mod grid;
mod kind_keys;
mod lines;
mod paint;
mod raster;
mod surface;
mod threats;
mod widths;

use std::fmt;
use std::ops::{Deref, DerefMut};

use serde::de::{EnumAccess, Error as _, VariantAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub use band::{BandKeys, StepKeys};
pub use depth::{
    CourantKeys, DatumKeys, DepthKeys, DepthRangeKeys, DepthSizeKeys, SlopeKeys, WavelengthKeys,
};
pub use distance::{BoundaryKeys, CorridorKeys, DistanceKeys, GrowthKeys, ShapeKeys, StripKeys, TargetKeys};
pub use formula::FormulaKeys;
pub use grid::GridKeys;
pub use kind_keys::KindKeys;
use kind_keys::LoadKind;
pub use lines::LineSizeKeys;
pub use paint::PaintKeys;
pub use raster::{RasterKeys, ReadingKeys, SavedKnot};
pub use surface::{GoalKeys, SurfaceKeys};
pub use threats::ThreatKeys;
pub use widths::{FeatureSizeKeys, StraitKeys, WidthKeys};

use super::{KeyGroup, LayerData, LayerOrigin, TableEntries};
use crate::io::KeyFault;
use meshbrush_core::layers::{DistanceTo, Layer, LayerKind};

/// Makes the kinds of layers from their list of names and of the structs of their keys.
macro_rules! saved_kinds {
    ($($(#[$doc:meta])* $kind:ident($keys:ty),)+) => {
        /// The kinds of layers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum SavedKind {
            $($(#[$doc])* $kind,)+
        }

        impl SavedKind {
            /// All kinds.
            pub const ALL: &[Self] = &[$(Self::$kind),+];

            /// The words of all kinds.
            pub const WORDS: &[&str] = &[$(<$keys>::WORD),+];

            /// Returns the word.
            pub fn word(self) -> &'static str {
                match self { $(Self::$kind => <$keys>::WORD),+ }
            }

            /// Returns the name of a layer that is given none.
            pub fn default_name(self) -> &'static str {
                match self { $(Self::$kind => <$keys>::NAME),+ }
            }

            /// Returns the keys of this kind alone.
            pub fn keys(self) -> Vec<&'static str> {
                match self { $(Self::$kind => <$keys as KeyGroup>::names()),+ }
            }
        }

        /// The keys of a layer that are those of its kind.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        #[serde(untagged)]
        pub enum LayerKeys {
            $($(#[$doc])* $kind($keys),)+
        }

        impl LayerKeys {
            /// Returns the kind.
            pub fn kind(&self) -> SavedKind {
                match self { $(Self::$kind(_) => SavedKind::$kind),+ }
            }

            /// Takes the keys of a kind out of a table.
            pub(super) fn take(kind: SavedKind, entries: &mut TableEntries<'_>) -> Result<Self, KeyFault> {
                match kind {
                    $(SavedKind::$kind => {
                        let mut keys = <$keys as KeyGroup>::take(entries)?;
                        keys.read_lengths(entries.context())?;
                        Ok(Self::$kind(keys))
                    })+
                }
            }

            pub(super) fn load<D: LayerData>(
                &self,
                origin: &LayerOrigin,
                data: &mut D,
            ) -> Result<LayerKind, D::Error> {
                match self { $(Self::$kind(keys) => keys.load(origin, data)),+ }
            }
        }

        impl Deref for LayerKeys {
            type Target = dyn KindKeys;

            fn deref(&self) -> &Self::Target {
                match self { $(Self::$kind(keys) => keys),+ }
            }
        }

        impl DerefMut for LayerKeys {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self { $(Self::$kind(keys) => keys),+ }
            }
        }

        $(impl From<$keys> for LayerKeys {
            fn from(keys: $keys) -> Self {
                Self::$kind(keys)
            }
        })+
    };
}

saved_kinds! {
    /// Paint.
    Paint(PaintKeys),
    /// A formula in x and y.
    Formula(FormulaKeys),
    /// Values by pixel.
    Raster(RasterKeys),
    /// Points with a range.
    Threats(ThreatKeys),
    /// The distance to shapes.
    Distance(DistanceKeys),
    /// The distance to a strip along lines.
    Corridor(CorridorKeys),
    /// One diameter where a raster's value lies between two numbers.
    Band(BandKeys),
    /// Depths of water.
    Depth(DepthKeys),
    /// Triangles across straits.
    Straits(StraitKeys),
    /// Triangles across the water.
    FeatureSize(FeatureSizeKeys),
    /// What lines need.
    Lines(LineSizeKeys),
    /// A surface that the mesh is to be close to.
    Surface(SurfaceKeys),
}

impl SavedKind {
    /// Returns the kind of a layer of a stack.
    pub fn of(layer: &Layer) -> Self {
        LayerKeys::of(layer).kind()
    }
}

impl Serialize for SavedKind {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.word())
    }
}

impl<'de> Deserialize<'de> for SavedKind {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_enum("SavedKind", Self::WORDS, KindVisitor)
    }
}

struct KindVisitor;

impl<'de> Visitor<'de> for KindVisitor {
    type Value = SavedKind;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("the kind of a layer")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, from: A) -> Result<SavedKind, A::Error> {
        let (word, rest): (String, _) = from.variant()?;
        rest.unit_variant()?;
        let found = SavedKind::ALL.iter().copied().find(|kind| kind.word() == word);
        found.ok_or_else(|| A::Error::unknown_variant(&word, SavedKind::WORDS))
    }
}

impl LayerKeys {
    /// Returns the keys of a layer of a stack without its lists, and without the file of its data.
    pub(super) fn of(layer: &Layer) -> Self {
        match &layer.kind {
            LayerKind::Paint(paint) => PaintKeys::of(paint).into(),
            LayerKind::Formula(formula) => FormulaKeys::of(formula).into(),
            LayerKind::Raster(raster) => RasterKeys::of(raster).into(),
            LayerKind::Threats(_) => ThreatKeys::default().into(),
            LayerKind::Distance(distance) => match distance.to {
                DistanceTo::Corridor { width, .. } => CorridorKeys::of(distance, width).into(),
                _ => DistanceKeys::of(distance).into(),
            },
            LayerKind::Band(band) => BandKeys::of(band).into(),
            LayerKind::Depth(depths) => DepthKeys::of(depths.sizes()).into(),
            LayerKind::Surface(surface) => SurfaceKeys::of(surface).into(),
            LayerKind::Straits(straits) => StraitKeys::of(straits).into(),
            LayerKind::FeatureSize(feature_size) => FeatureSizeKeys::of(feature_size).into(),
            LayerKind::Lines(sizes) => LineSizeKeys::of(sizes).into(),
        }
    }
}
