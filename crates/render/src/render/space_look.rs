//! How a picture of a surface in space looks.

use std::sync::Arc;

use crate::scene::{Light, NodeHeights, SpaceCamera, SpaceView, ViewDirection};
use meshbrush_mesh::geometry::Lattice;

/// The appearance of a picture in space.
#[derive(Clone, Debug)]
pub struct SpaceLook {
    /// From where.
    pub direction: ViewDirection,
    /// In which light.
    pub light: Light,
    /// World units that a unit of height has in the picture.
    pub exaggeration: f64,
    /// World units that a unit of height has in truth.
    pub metre: f64,
    /// The heights of the nodes of the extract.
    pub heights: Arc<NodeHeights>,
}

/// Space around a picture in space, as a share of its shorter side.
const SPACE_MARGIN: f64 = 0.04;
/// The minimum and the maximum height of a picture in space, as shares of its width.
const SPACE_PROPORTIONS: [f64; 2] = [0.25, 2.0];

impl SpaceLook {
    /// Returns the appearance of a surface over a lattice. Heights are multiplied by `factor`; without one,
    /// so that relief is visible. `metre` is [`Self::metre`].
    pub fn new(
        (direction, light): (ViewDirection, Light),
        factor: Option<f64>,
        metre: f64,
        heights: NodeHeights,
        lattice: &Lattice,
    ) -> Self {
        let default = || SpaceCamera::visible_exaggeration(lattice.bounds(), heights.relief());
        let exaggeration = factor.map_or_else(default, |factor| factor * metre);
        Self { direction, light, exaggeration, metre, heights: Arc::new(heights) }
    }

    /// Returns the whole surface over a lattice in a picture of a size in pixels, with space around it.
    pub(in crate::render) fn view_in(&self, lattice: &Lattice, size: [u32; 2]) -> SpaceView {
        self.view(lattice, size, SPACE_MARGIN * f64::from(size[0].min(size[1])))
    }

    /// Returns the whole surface over a lattice in a picture of a size, in pixels.
    fn view(&self, lattice: &Lattice, size: [u32; 2], margin_px: f64) -> SpaceView {
        let surface = (self.heights.scale, self.heights.ends());
        let camera = SpaceCamera::fit(lattice, surface, self.direction, self.exaggeration, size, margin_px);
        SpaceView { camera, light: self.light }
    }

    /// Returns the height of a picture as a share of its width.
    pub(super) fn proportion(&self, lattice: &Lattice) -> f64 {
        let size = self.view(lattice, [1000; 2], 0.0).camera.box_px();
        (size.y / size.x).clamp(SPACE_PROPORTIONS[0], SPACE_PROPORTIONS[1])
    }
}
