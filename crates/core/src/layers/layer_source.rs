//! What every kind of layer answers.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use glam::DVec2;

use super::engine::{CompiledPlane, Reading, Values};
use super::extent::{Extent, ExtentContext};
use super::risk_source::RiskSource;
use super::value_change::{LayerEdit, ValueChange};
use super::{LayerSlot, Quantity, RasterSource};
use crate::domain::{BoundaryMarks, Domain, Line};
use crate::mesh::TargetChange;
use crate::raster::TiledRaster;

/// What a layer of some kind asks for, and where that comes from.
///
/// Whoever adds a kind of layer implements this for its settings, and adds a line to the list of
/// [`LayerKind`](super::LayerKind). Three answers are needed: two names, and [`compile`](Self::compile), by
/// which the layer is asked for diameters. The other ones are right, if not quick, for a layer of diameters
/// that may ask for something anywhere, reads no file and depends on nothing outside of itself.
///
/// No question is asked for each pixel or triangle: [`compile`](Self::compile) and [`risks`](Self::risks)
/// are asked once, and give one of few forms that the searches know.
pub trait LayerSource: Any + Debug + Send + Sync {
    /// Returns the name of such a layer for people.
    fn label(&self) -> &'static str;

    /// Returns the name of a change of the settings of such a layer, for the history.
    fn change_title(&self) -> &'static str;

    /// Returns how the layer answers on a lattice: its values, and what they ask for. `slot` is that
    /// of the layer.
    fn compile(&self, slot: LayerSlot, plane: &CompiledPlane) -> (Reading, Values);

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

    /// Returns whether it changes with the lines of its document.
    fn follows_lines(&self) -> bool {
        false
    }

    /// Finds again what the settings have of the lines of their document.
    fn follow_lines(&mut self, _lines: &Arc<Vec<Line>>, _domain: &Domain) {}

    /// Finds again what the settings have of the domain of their document.
    fn follow_domain(&mut self, _domain: &Domain, _marks: &BoundaryMarks) {}

    /// Puts what the description of a size field has in the place of what only a document can have.
    fn enter_field(&mut self, _domain: &Domain, _marks: &BoundaryMarks) {}

    /// Returns where the layer can ask for something that matters to the mesh. `slot` is that of the layer;
    /// its mask, and depths that it uses, are looked at elsewhere.
    fn extent(&self, _slot: LayerSlot, _context: &ExtentContext) -> Extent {
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
