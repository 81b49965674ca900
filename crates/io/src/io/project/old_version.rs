//! Projects of version 1, which had one base field and two rasters of paint in place of the layers.

use std::ops::RangeInclusive;
use std::sync::Arc;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::super::Flaw;
use super::super::error::PlacedFlaw;
use super::settings::{Parts, Saved, checked_size, formula, rect};
use meshbrush_core::layers::{Layer, LayerId, LayerKind, Quantity, RasterReading, RasterSource};
use meshbrush_core::raster::RasterPyramid;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::Grouped;

/// Pixels along the longer side of the paint in projects of version 1.
const OLD_RESOLUTIONS: RangeInclusive<u32> = 16..=2048;

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum SavedBase {
    Constant(f64),
    Formula(String),
    /// A picture, whose pixels are in the part `base.risk`.
    RiskImage(SavedRaster),
    /// A grid, whose pixels are in the part `base.diameter`.
    DiameterGrid(SavedRaster),
}

/// A raster without its pixels.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedRaster {
    name: String,
    bounds: [f64; 4],
    columns: u32,
    rows: u32,
}

impl SavedRaster {
    /// Returns the place and the size of the raster.
    fn checked(&self) -> Result<(Rect, [u32; 2]), PlacedFlaw> {
        let size = checked_size([self.columns, self.rows])?;
        Ok((rect("base", self.bounds)?, size))
    }
}

/// The layers of paint in version 1, by their place in the stack: diameters and risks.
pub(super) const OLD_PAINT: [LayerId; 2] = [LayerId(1), LayerId(2)];

impl SavedBase {
    /// Returns the layers that version 1 had: the base, and paint over it.
    pub(super) fn into_layers(self, parts: &mut impl Parts) -> Result<Vec<Layer>, PlacedFlaw> {
        let mut raster = |saved: SavedRaster, reading: RasterReading| -> Result<_, PlacedFlaw> {
            let (bounds, size) = saved.checked()?;
            let raster = Arc::new(RasterPyramid::new(parts.base(bounds, size, &reading)?));
            Ok(LayerKind::Raster { source: RasterSource { name: saved.name, raster }, reading })
        };
        let base = match self {
            Self::Constant(diameter) => LayerKind::constant(diameter),
            Self::Formula(text) => LayerKind::target(formula("base", &text)?),
            Self::RiskImage(saved) => raster(saved, RasterReading::Risk)?,
            Self::DiameterGrid(saved) => raster(saved, RasterReading::Diameter)?,
        };
        let layers = Layer::usual(base);
        debug_assert!(layers[1].id == OLD_PAINT[0] && layers[1].paints() == Some(Quantity::Diameter));
        Ok(layers)
    }
}

impl Saved {
    /// Returns the size of the paint in a project of version 1: [columns, rows]. `None` in newer ones.
    ///
    /// # Errors
    /// Fails when the resolution is one that no such project had.
    pub(super) fn old_paint_size(&self) -> Result<Option<[u32; 2]>, PlacedFlaw> {
        let Some(resolution) = self.resolution else { return Ok(None) };
        if !OLD_RESOLUTIONS.contains(&resolution) {
            let (given, most) = (Grouped(resolution as usize), Grouped(*OLD_RESOLUTIONS.end() as usize));
            let problem = format!(
                "\"resolution\" is {given}, and must be between {} and {most}.",
                OLD_RESOLUTIONS.start()
            );
            return Err(Flaw::Syntax(problem).into());
        }
        let [x0, y0, x1, y1] = self.domain.bounds;
        let size = DVec2::new(x1 - x0, y1 - y0);
        let per_unit = f64::from(resolution) / size.max_element();
        Ok(Some([size.x, size.y].map(|side| ((side * per_unit).round() as u32).clamp(1, resolution))))
    }
}
