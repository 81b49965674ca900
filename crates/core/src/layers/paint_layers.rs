use std::collections::BTreeMap;
use std::sync::Arc;

use super::LayerId;
use crate::raster::TiledRaster;

/// The painted pixels of all paint layers of a document.
///
/// Cloning shares all pixels. A layer that is not listed is blank.
#[derive(Clone, Debug, Default)]
pub struct PaintLayers {
    rasters: BTreeMap<LayerId, Arc<TiledRaster>>,
}

/// Equal pixels on every layer. A layer without pixels equals one on which nothing is painted.
impl PartialEq for PaintLayers {
    fn eq(&self, other: &Self) -> bool {
        self.painted().eq(other.painted())
    }
}

impl PaintLayers {
    /// Returns paint without pixels on any layer.
    pub fn blank() -> &'static Self {
        static BLANK: PaintLayers = PaintLayers { rasters: BTreeMap::new() };
        &BLANK
    }

    /// Returns the pixels of some layers alone. They are shared.
    pub fn of_layers(&self, ids: impl IntoIterator<Item = LayerId>) -> Self {
        let pixels = |id| Some((id, self.rasters.get(&id)?.clone()));
        Self { rasters: ids.into_iter().filter_map(pixels).collect() }
    }

    /// Returns the pixels of a layer, if it has any.
    #[inline]
    pub fn get(&self, id: LayerId) -> Option<&TiledRaster> {
        self.rasters.get(&id).map(|raster| &**raster)
    }

    /// Returns the pixels of a layer, to change them. They are copied only while a clone shares them.
    pub fn get_mut(&mut self, id: LayerId) -> Option<&mut TiledRaster> {
        self.rasters.get_mut(&id).map(Arc::make_mut)
    }

    /// Returns the pixels of a layer, to change them; a layer without any begins with `blank`.
    pub fn get_or_insert(&mut self, id: LayerId, blank: impl FnOnce() -> TiledRaster) -> &mut TiledRaster {
        Arc::make_mut(self.rasters.entry(id).or_insert_with(|| Arc::new(blank())))
    }

    /// Gives a layer these pixels.
    pub fn insert(&mut self, id: LayerId, raster: TiledRaster) {
        self.rasters.insert(id, Arc::new(raster));
    }

    /// Removes the pixels of a layer.
    pub fn remove(&mut self, id: LayerId) -> Option<Arc<TiledRaster>> {
        self.rasters.remove(&id)
    }

    /// Returns the layers with pixels, in the order of their identifiers.
    pub fn iter(&self) -> impl Iterator<Item = (LayerId, &TiledRaster)> {
        self.rasters.iter().map(|(&id, raster)| (id, &**raster))
    }

    /// Returns the layers on which something is painted, in the order of their identifiers.
    fn painted(&self) -> impl Iterator<Item = (LayerId, &TiledRaster)> {
        self.iter().filter(|(_, raster)| !raster.is_blank())
    }

    /// Returns whether nothing is painted on any layer.
    pub fn is_blank(&self) -> bool {
        self.painted().next().is_none()
    }

    /// Returns the memory of the pixels, in bytes.
    pub fn bytes(&self) -> usize {
        self.rasters.values().map(|raster| raster.bytes()).sum()
    }
}
