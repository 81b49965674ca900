//! Finds the differences of two tiled rasters.

use super::TiledRaster;
use crate::geometry::Rect;

impl TiledRaster {
    /// Returns rectangles in world units whose closed union contains all points where two rasters differ;
    /// they may be larger than the differing pixels. Returns `None` if the rasters have other pixels or
    /// another blank value.
    ///
    /// Tiles that both share are skipped.
    pub fn areas_that_differ(&self, other: &Self) -> Option<Vec<Rect>> {
        if self.grid != other.grid || self.blank != other.blank {
            return None;
        }
        let mut areas = Vec::new();
        for (place, tile) in self.tiles() {
            match other.tile(place) {
                Some(before) if std::sync::Arc::ptr_eq(tile, before) => {}
                Some(before) => {
                    let pixels = tile.difference(before);
                    areas.extend(pixels.map(|pixels| place.area_of_pixels(pixels, &self.grid)));
                }
                None => areas.push(place.area(&self.grid)),
            }
        }
        let removed = other.tiles().filter(|(place, _)| self.tile(*place).is_none());
        areas.extend(removed.map(|(place, _)| place.area(&self.grid)));
        Some(areas)
    }
}
