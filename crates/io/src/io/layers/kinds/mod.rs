//! The kinds of layers as texts have them: a file for each, with a struct whose fields are the keys of the
//! kind. What a text says about them (words, keys, sentences) follows from the list below.

mod band;
mod depth;
mod distance;
mod formula;
mod grid;
mod paint;
mod raster;
mod surface;
mod threats;
mod widths;

use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub use band::{BandKeys, StepKeys};
pub use depth::{
    CourantKeys, DatumKeys, DepthKeys, DepthRangeKeys, DepthSizeKeys, SlopeKeys, WavelengthKeys,
};
pub use distance::{BoundaryKeys, CorridorKeys, DistanceKeys, GrowthKeys, ShapeKeys, StripKeys, TargetKeys};
pub use formula::FormulaKeys;
pub use grid::GridKeys;
pub use paint::PaintKeys;
pub use raster::{RasterKeys, ReadingKeys, SavedKnot};
pub use surface::{GoalKeys, SurfaceKeys};
pub use threats::ThreatKeys;
pub use widths::{FeatureSizeKeys, StraitKeys, WidthKeys};

use super::{Entries, KeyGroup, LayerData, SavedLayer, Stored};
use crate::io::KeyFault;
use crate::io::lengths::TextContext;
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_core::raster::RasterValues;

/// What the keys of a kind of layer say.
pub trait KindKeys {
    /// Checks every value. Files are not read.
    ///
    /// # Errors
    /// Fails for the first key that is missing, or has a value that cannot be used.
    fn check(&self, stored: Stored) -> Result<(), KeyFault>;

    /// Returns the place of a raster, for a kind that reads one.
    fn grid(&self) -> Option<&GridKeys> {
        None
    }

    /// Returns the place of a raster, for a kind that reads one.
    fn grid_mut(&mut self) -> Option<&mut GridKeys> {
        None
    }

    /// Returns the file with the data, if one is given.
    fn file(&self) -> Option<&Path> {
        self.grid()?.file.as_deref()
    }

    /// Returns the key for the file with the data, for a kind that has one.
    fn file_key(&mut self) -> Option<&mut Option<PathBuf>> {
        self.grid_mut().map(|grid| &mut grid.file)
    }

    /// Returns the kind of the values of its raster, if it reads one.
    fn raster_values(&self) -> Option<RasterValues> {
        self.grid().map(|_| RasterValues::Any)
    }

    /// Returns whether it asks for risk.
    fn is_risk(&self) -> bool {
        false
    }

    /// Returns whether it needs both ends of the scale from the smallest to the largest target diameter.
    fn uses_scale(&self) -> bool {
        self.is_risk()
    }

    /// Returns whether it needs the depth of the water of another layer.
    fn uses_depth(&self) -> bool {
        false
    }
}

/// Keys that make a layer of a stack.
pub(super) trait LoadKind {
    /// Returns the kind, with its data. The keys are those of `layer`.
    fn load<D: LayerData>(&self, layer: &SavedLayer, data: &mut D) -> Result<LayerKind, D::Error>;

    /// Reads lengths in the place of something else.
    fn read_lengths(&mut self, _: &TextContext) -> Result<(), KeyFault> {
        Ok(())
    }
}

/// Makes the kinds of layers from their list: names, words, names of layers, and the structs of their keys.
macro_rules! saved_kinds {
    ($($(#[$doc:meta])* $kind:ident($keys:ty) $word:literal $name:literal,)+) => {
        /// The kinds of layers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        pub enum SavedKind {
            $($(#[$doc])* #[serde(rename = $word)] $kind,)+
        }

        impl SavedKind {
            /// All kinds.
            pub const ALL: &[Self] = &[$(Self::$kind),+];

            /// Returns the word.
            pub fn word(self) -> &'static str {
                match self { $(Self::$kind => $word),+ }
            }

            /// Returns the name of a layer that is given none.
            pub fn default_name(self) -> &'static str {
                match self { $(Self::$kind => $name),+ }
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
            pub(super) fn take(kind: SavedKind, entries: &mut Entries<'_>) -> Result<Self, KeyFault> {
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
                layer: &SavedLayer,
                data: &mut D,
            ) -> Result<LayerKind, D::Error> {
                match self { $(Self::$kind(keys) => keys.load(layer, data)),+ }
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
    Paint(PaintKeys) "paint" "Paint",
    /// A formula in x and y.
    Formula(FormulaKeys) "formula" "Formula",
    /// Values by pixel.
    Raster(RasterKeys) "raster" "Raster",
    /// Points with a range.
    Threats(ThreatKeys) "threats" "Threats",
    /// The distance to shapes.
    Distance(DistanceKeys) "distance" "Distance",
    /// The distance to a strip along lines.
    Corridor(CorridorKeys) "corridor" "Corridor",
    /// One diameter where a raster's value lies between two numbers.
    Band(BandKeys) "band" "Band",
    /// Depths of water.
    Depth(DepthKeys) "depth" "Depth",
    /// Triangles across straits.
    Straits(StraitKeys) "straits" "Straits",
    /// Triangles across the water.
    FeatureSize(FeatureSizeKeys) "feature-size" "Feature size",
    /// A surface that the mesh is to be close to.
    Surface(SurfaceKeys) "surface" "Surface",
}

impl SavedKind {
    /// Returns the kind of a layer of a stack.
    pub fn of(layer: &Layer) -> Self {
        LayerKeys::of(layer).kind()
    }

    /// Returns the fault of a kind that lacks something. `needs` is a verb with its object.
    pub(super) fn missing(self, needs: &str) -> KeyFault {
        KeyFault::entry("kind", format!("a layer of the kind \"{}\" {needs}.", self.word()))
    }

    /// Returns the value of a key, which this kind needs.
    fn needed<T>(self, key: &'static str, value: Option<T>) -> Result<T, KeyFault> {
        value.ok_or_else(|| self.missing(&format!("needs `{key}`")))
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
            LayerKind::Distance(distance) => distance::of(distance),
            LayerKind::Band(band) => BandKeys::of(band).into(),
            LayerKind::Depth(depths) => DepthKeys::of(depths.sizes()).into(),
            LayerKind::Surface(surface) => SurfaceKeys::of(surface).into(),
            LayerKind::Straits(straits) => StraitKeys::of(straits).into(),
            LayerKind::FeatureSize(feature_size) => FeatureSizeKeys::of(feature_size).into(),
        }
    }
}
