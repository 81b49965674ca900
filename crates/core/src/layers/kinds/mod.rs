//! The kinds of layers.
//!
//! Each kind has a file. It holds a struct with the settings of such a layer, unless that is a module of its
//! own, and its answers to the questions of [`LayerSource`]. The list at the end of this file makes
//! [`LayerKind`] of them: nothing else in this crate has a list of all kinds.

mod band;
mod depth;
mod distance;
mod feature_size;
mod formula;
mod lines;
mod paint;
mod raster;
mod straits;
mod surface;
mod threats;

pub use band::BandLayer;
pub use distance::{DistanceLayer, DistanceTo};
pub use formula::FormulaLayer;
pub use paint::PaintLayer;
pub use raster::{RasterLayer, RasterReading};
pub(super) use threats::areas_that_differ;

use std::ops::{Deref, DerefMut};

use glam::DVec2;

use super::{Depths, FeatureSize, LayerSource, LineSizes, Quantity, Straits, Surface, Threats};
use crate::field::Formula;
use crate::raster::TiledRaster;

/// Takes the list of kinds, an enum with a variant for each, and lets it answer as its variants do.
macro_rules! layer_kinds {
    (
        $(#[$of_all:meta])*
        pub enum $all:ident { $($(#[$of_one:meta])* $variant:ident($kind:ty),)* }
    ) => {
        $(#[$of_all])*
        pub enum $all {
            $($(#[$of_one])* $variant($kind),)*
        }

        impl Deref for $all {
            type Target = dyn LayerSource;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$variant(kind) => kind,)*
                }
            }
        }

        impl DerefMut for $all {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $(Self::$variant(kind) => kind,)*
                }
            }
        }

        /// Questions for each pixel of a picture and each sample of a surface: the kind is known.
        impl $all {
            pub(super) fn risk_at(&self, point: DVec2, pixels: Option<&TiledRaster>) -> Option<f64> {
                match self {
                    $(Self::$variant(kind) => LayerSource::risk_at(kind, point, pixels),)*
                }
            }

            pub(super) fn error_at(&self, point: DVec2, pixels: Option<&TiledRaster>) -> Option<f64> {
                match self {
                    $(Self::$variant(kind) => LayerSource::error_at(kind, point, pixels),)*
                }
            }
        }

        $(
            impl From<$kind> for $all {
                fn from(kind: $kind) -> Self {
                    Self::$variant(kind)
                }
            }
        )*
    };
}

layer_kinds! {
    /// The kind of a layer, which decides its target diameters. It has the questions of [`LayerSource`].
    #[derive(Clone, Debug, PartialEq)]
    pub enum LayerKind {
        /// Paint, whose pixels are in the document.
        Paint(PaintLayer),
        /// A formula in x and y.
        Formula(FormulaLayer),
        /// A raster.
        Raster(RasterLayer),
        /// Threats, combined as independent probabilities.
        Threats(Threats),
        /// h̄ grows with the distance.
        Distance(DistanceLayer),
        /// One diameter where a raster's value lies between two numbers.
        Band(BandLayer),
        /// Depths of water.
        Depth(Depths),
        /// At least a number of triangles across each strait.
        Straits(Straits),
        /// A number of triangles across the water, which grow with the way from it.
        FeatureSize(FeatureSize),
        /// What lines need, so that the mesh can have edges along them.
        Lines(LineSizes),
        /// A surface that the mesh is to be close to. It asks for no diameter.
        Surface(Surface),
    }
}

impl LayerKind {
    /// Returns paint of a quantity.
    pub const fn paint(quantity: Quantity) -> Self {
        Self::Paint(PaintLayer { quantity })
    }

    /// Returns a formula for the target diameter.
    pub fn target(formula: Formula) -> Self {
        Self::Formula(FormulaLayer { quantity: Quantity::Diameter, formula })
    }

    /// Returns a layer with one target diameter everywhere, in world units.
    pub fn constant(diameter: f64) -> Self {
        Self::target(Formula::constant_of(diameter))
    }

    /// Returns a formula for the risk.
    pub fn risk(formula: Formula) -> Self {
        Self::Formula(FormulaLayer { quantity: Quantity::Risk, formula })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_gives_its_settings_by_their_type() {
        let mut kind = LayerKind::constant(0.5);
        assert!(kind.is::<FormulaLayer>() && kind.get::<PaintLayer>().is_none() && !kind.is_of_risk());
        kind.get_mut::<FormulaLayer>().unwrap().quantity = Quantity::Risk;
        assert!(kind.is_of_risk() && kind == LayerKind::risk(Formula::constant_of(0.5)));
        assert_eq!(LayerKind::from(Threats::default()).name(), "Threats");
    }
}
