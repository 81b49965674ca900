use std::collections::BTreeMap;

use crate::layers::LayerId;
use crate::raster::TiledRaster;

/// What is painted: a raster for each paint layer. Clones share all tiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PaintLayers(BTreeMap<LayerId, TiledRaster>);

impl PaintLayers {
    /// The raster of a layer.
    pub fn get(&self, id: LayerId) -> Option<&TiledRaster> {
        self.0.get(&id)
    }

    /// The raster of a layer, to paint on it.
    pub fn get_mut(&mut self, id: LayerId) -> Option<&mut TiledRaster> {
        self.0.get_mut(&id)
    }

    /// Puts the raster of a layer, and returns the one that it had.
    pub fn insert(&mut self, id: LayerId, raster: TiledRaster) -> Option<TiledRaster> {
        self.0.insert(id, raster)
    }

    /// Removes the raster of a layer, and returns it.
    pub fn remove(&mut self, id: LayerId) -> Option<TiledRaster> {
        self.0.remove(&id)
    }

    /// All rasters, in the order of their layers' ids.
    pub fn iter(&self) -> impl Iterator<Item = (LayerId, &TiledRaster)> {
        self.0.iter().map(|(&id, raster)| (id, raster))
    }

    /// Memory of all rasters, in bytes.
    pub fn bytes(&self) -> usize {
        self.0.values().map(TiledRaster::bytes).sum()
    }

    /// Whether nothing is painted.
    pub fn is_blank(&self) -> bool {
        self.0.values().all(TiledRaster::is_blank)
    }
}

impl FromIterator<(LayerId, TiledRaster)> for PaintLayers {
    fn from_iter<I: IntoIterator<Item = (LayerId, TiledRaster)>>(rasters: I) -> Self {
        Self(rasters.into_iter().collect())
    }
}
