//! Layers of surfaces. They ask for no diameter: [`crate::surface`] has what they ask for.

use crate::layers::RasterSource;
use crate::layers::engine::{CompiledPlane, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::value_change::{LayerEdit, ValueChange};
use crate::layers::{LayerSlot, LayerSource, Surface, SurfaceSource};
use crate::mesh::TargetChange;

impl LayerSource for Surface {
    fn label(&self) -> &'static str {
        "Surface"
    }

    fn change_title(&self) -> &'static str {
        "surface"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        (plane.diameters(), Values::Nothing)
    }

    fn asks_for_diameters(&self) -> bool {
        false
    }

    fn raster_source(&self) -> Option<&RasterSource> {
        self.source.raster()
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        match &self.source {
            SurfaceSource::Raster(source) => vec![source.shared_data()],
            SurfaceSource::Formula(formula) => vec![(formula.address(), formula.bytes())],
        }
    }

    fn extent(&self, _: LayerSlot, _: &ExtentContext) -> Extent {
        Extent::NOTHING
    }

    fn change_since(&self, old: &dyn LayerSource, _: &LayerEdit) -> ValueChange {
        if old.is::<Self>() { ValueChange::Nothing } else { ValueChange::Anywhere(TargetChange::Any) }
    }
}
