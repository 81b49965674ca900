//! What colours the triangles of a picture in place of their levels, with its legend.

mod measures;

use std::fmt;
use std::sync::Arc;

pub use self::measures::{measure_legend, measure_overlay};

use super::furniture::Legend;
use crate::scene::Overlay;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::MeshView;
use meshbrush_study::pixels::values_by_pixel;

/// Most pixels that colours are found for, where they are not those of whole triangles.
const MOST_PIXELS: f64 = 4e6;

/// What colours the triangles of a picture in place of their levels.
#[derive(Clone, Debug)]
pub struct PictureOverlay {
    /// What the colours mean.
    pub legend: Legend,
    /// The colour where there is nothing to show.
    pub neutral: [u8; 4],
    /// The colours.
    pub colors: OverlayColors,
}

/// Finds the colours of pixels over a rectangle in world units, of [columns, rows], row by row from the
/// lowest.
pub type PixelColors = dyn Fn(Rect, [u32; 2]) -> Vec<[u8; 4]> + Send + Sync;

/// The colours of an overlay, opaque.
#[derive(Clone)]
pub enum OverlayColors {
    /// One for each triangle of the extract that is drawn.
    Triangles(Arc<[[u8; 4]]>),
    /// Those of pixels.
    Pixels(Arc<PixelColors>),
}

impl fmt::Debug for OverlayColors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangles(colors) => f.debug_tuple("Triangles").field(&colors.len()).finish(),
            Self::Pixels(_) => f.write_str("Pixels"),
        }
    }
}

/// The colours of the pixels of a map.
pub(super) struct MapColors {
    bounds: Rect,
    size: [u32; 2],
    rgba: Vec<[u8; 4]>,
    beyond: [u8; 4],
}

impl MapColors {
    /// Returns them as what is laid over the map.
    pub(super) fn as_overlay(&self) -> Overlay<'_> {
        let Self { bounds, size: [columns, rows], ref rgba, beyond } = *self;
        Overlay { bounds, columns, rows, rgba, beyond, revision: 0 }
    }
}

impl PictureOverlay {
    /// Returns the colours of the pixels of a map over a rectangle in world units; `size` is [columns, rows].
    pub(super) fn on_map(&self, mesh: MeshView<'_>, bounds: Rect, size: [u32; 2]) -> MapColors {
        let beyond = self.neutral;
        match &self.colors {
            OverlayColors::Triangles(colors) => {
                let rgba = by_pixel(mesh, (bounds, size), colors, beyond);
                MapColors { bounds, size, rgba, beyond }
            }
            OverlayColors::Pixels(colors) => {
                let pixels = f64::from(size[0]) * f64::from(size[1]);
                let share = (MOST_PIXELS / pixels).sqrt().min(1.0);
                let size = size.map(|side| ((share * f64::from(side)).round() as u32).max(1));
                MapColors { bounds, size, rgba: colors(bounds, size), beyond }
            }
        }
    }
}

/// Returns the colour of the triangle at the centre of each pixel, or the one `beyond` them.
fn by_pixel(
    mesh: MeshView<'_>,
    pixels: (Rect, [u32; 2]),
    colors: &[[u8; 4]],
    beyond: [u8; 4],
) -> Vec<[u8; 4]> {
    // A colour is a whole number below 2²⁴, which is exact as an f32.
    let packed = |triangle: usize, _, _| {
        let [r, g, b, _] = *colors.get(triangle)?;
        Some(f64::from(u32::from_be_bytes([0, r, g, b])))
    };
    let unpacked = |number: &f32| {
        let [_, r, g, b] = (*number as u32).to_be_bytes();
        if number.is_nan() { beyond } else { [r, g, b, 0xff] }
    };
    let found = values_by_pixel(mesh, pixels, &|| true, packed);
    found.map_or_else(Vec::new, |found| found.values().iter().map(unpacked).collect())
}
