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

use std::any::Any;
use std::fmt::Debug;
use std::ops::{Deref, DerefMut};

use glam::DVec2;

use super::difference::{LayerEdit, ValueChange};
use super::engine::{CompiledPlane, Reading, Values};
use super::extent::{Extent, ExtentContext};
use super::risk::RiskSource;
use super::{Depths, FeatureSize, Layer, Quantity, RasterSource, Straits, Surface, Threats};
use crate::domain::{BoundaryMarks, Domain};
use crate::field::Formula;
use crate::mesh::TargetChange;
use crate::raster::TiledRaster;

/// What a layer of some kind asks for, and where that comes from.
///
/// Whoever adds a kind of layer implements this for its settings, and adds a line to the list of
/// [`LayerKind`]. Three answers are needed: two names, and [`compile`](Self::compile), by which the layer is
/// asked for diameters. The other ones are right, if not quick, for a layer of diameters that may ask for
/// something anywhere, reads no file and depends on nothing outside of itself.
///
/// No question is asked for each pixel or triangle: [`compile`](Self::compile) and [`risks`](Self::risks)
/// are asked once, and give one of few forms that the searches know.
pub trait LayerSource: Any + Debug + Send + Sync {
    /// Returns the name of such a layer for people.
    fn label(&self) -> &'static str;

    /// Returns the name of a change of the settings of such a layer, for the history.
    fn change_title(&self) -> &'static str;

    /// Returns how the layer answers on a lattice: its values, and what they ask for. `layer` has these
    /// settings.
    fn compile(&self, layer: &Layer, plane: &CompiledPlane) -> (Reading, Values);

    /// Returns the meaning of the values. What the layer makes of others than these does not count: a curve
    /// of depths gives diameters.
    fn quantity(&self) -> Quantity {
        Quantity::Diameter
    }

    /// Returns whether it is for diameters; without them, it is of use for something else.
    fn asks_for_diameters(&self) -> bool {
        self.quantity() != Quantity::Error
    }

    /// Returns whether its values are diameters as somebody gave them: one that equals the limit is meant so.
    fn says_diameters(&self) -> bool {
        false
    }

    /// Returns whether it asks for diameters in metres, whatever the unit of the document is.
    fn needs_metres(&self) -> bool {
        false
    }

    /// Returns the raster that the layer reads, if it reads one.
    fn raster_source(&self) -> Option<&RasterSource> {
        None
    }

    /// Returns the name of the file that the data come from, for a person, if they come from one.
    fn file_name(&self) -> Option<&str> {
        self.raster_source().map(|source| &*source.name)
    }

    /// Returns the data that other layers may share: the address of each and its size in bytes.
    fn shared_data(&self) -> Vec<(usize, usize)> {
        self.raster_source().map(RasterSource::shared_data).into_iter().collect()
    }

    /// Returns the risk at a point in world units, if the layer is one of risk with a value there. `pixels`
    /// are those painted on the layer.
    fn risk_at(&self, _point: DVec2, _pixels: Option<&TiledRaster>) -> Option<f64> {
        None
    }

    /// Returns where risks come from, if the layer is one of risk. `pixels` are those painted on the layer.
    fn risks(&self, _pixels: Option<&TiledRaster>) -> Option<RiskSource> {
        None
    }

    /// Returns the number that a layer of errors has at a point in world units: infinity where it says
    /// nothing. `pixels` are those painted on the layer.
    fn error_at(&self, _point: DVec2, _pixels: Option<&TiledRaster>) -> Option<f64> {
        None
    }

    /// Returns whether it depends on the depth of the water.
    fn uses_depth(&self) -> bool {
        false
    }

    /// Returns whether it changes with the boundary of the domain.
    fn follows_outline(&self) -> bool {
        false
    }

    /// Returns whether it changes with the names and types of the pieces of the boundary.
    fn follows_pieces(&self) -> bool {
        false
    }

    /// Returns whether it asks for the distance to the whole boundary of the domain.
    fn is_of_outline(&self) -> bool {
        false
    }

    /// Finds again what the settings have of the domain of their document.
    fn follow_domain(&mut self, _domain: &Domain, _marks: &BoundaryMarks) {}

    /// Puts what the description of a size field has in the place of what only a document can have.
    fn enter_field(&mut self, _domain: &Domain, _marks: &BoundaryMarks) {}

    /// Returns where the layer can ask for something that matters to the mesh. `layer` has these settings;
    /// its mask is looked at elsewhere.
    fn extent(&self, _layer: &Layer, _context: &ExtentContext) -> Extent {
        Extent::Everywhere
    }

    /// Returns how the diameters change from other settings in the same layer to these, which differ, or are
    /// measured to another outline.
    fn change_since(&self, _old: &dyn LayerSource, _edit: &LayerEdit) -> ValueChange {
        ValueChange::Anywhere(TargetChange::Any)
    }
}

impl dyn LayerSource {
    /// Returns whether the layer is of a kind.
    pub fn is<K: LayerSource>(&self) -> bool {
        (self as &dyn Any).is::<K>()
    }

    /// Returns the settings of a layer of a kind; `None` for other kinds.
    pub fn get<K: LayerSource>(&self) -> Option<&K> {
        (self as &dyn Any).downcast_ref()
    }

    /// Returns the settings of a layer of a kind to change them; `None` for other kinds.
    pub fn get_mut<K: LayerSource>(&mut self) -> Option<&mut K> {
        (self as &mut dyn Any).downcast_mut()
    }

    /// Returns whether its values are risks, so that the transfer curve matters.
    pub fn is_of_risk(&self) -> bool {
        self.quantity() == Quantity::Risk
    }

    /// Returns whether it says how large errors from surfaces may be. Then it asks for no diameter.
    pub fn is_of_errors(&self) -> bool {
        self.quantity() == Quantity::Error
    }

    /// Returns the name of a new layer of this kind: that of its file, if it has one.
    pub fn name(&self) -> String {
        self.file_name().unwrap_or(self.label()).to_owned()
    }
}

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
