//! The appearance of triangles in space.

use super::style::{FADED_EDGE, edge_color, edge_fade, fill_color};
use super::{Light, NodeHeights, SpaceCamera, Style};
use crate::colormap::LEVELS;
use meshbrush_mesh::mesh::{Mesh, PatchPieces};

/// A surface in space as a person sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceView {
    /// From where.
    pub camera: SpaceCamera,
    /// In which light.
    pub light: Light,
}

/// The mesh of a picture in space, with the heights of its nodes.
#[derive(Clone, Copy, Debug)]
pub struct ShownSurface<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Pieces of a patch of this mesh.
    pub pieces: Option<&'a PatchPieces>,
    /// The heights of their nodes.
    pub heights: &'a NodeHeights,
}

/// The colours of the triangles of one level in space, on level ground. Channels from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpacePaint {
    /// Colour inside.
    pub fill: [f32; 3],
    /// Colour of the edges.
    pub edge: [f32; 3],
    /// Opacity of the edges of large triangles.
    pub edge_alpha: f32,
}

impl SpacePaint {
    /// Returns the colours of every level, from 0.
    pub fn all(style: &Style) -> [Self; LEVELS] {
        std::array::from_fn(|level| {
            let level = level as u32;
            let fill = fill_color(level, style);
            let strength = if style.shows(level) { 1.0 } else { FADED_EDGE };
            let edge_alpha = if style.edges { strength } else { 0.0 };
            Self { fill, edge: edge_color(fill, style), edge_alpha }
        })
    }

    /// Returns the opacity of the edges of a triangle whose least height in the picture is `least_px`
    /// pixels: that of a triangle of the plan with this height.
    #[inline]
    pub fn alpha_at(&self, least_px: f32, style: &Style) -> f32 {
        if self.edge_alpha == 0.0 {
            return 0.0;
        }
        self.edge_alpha * edge_fade(std::f32::consts::SQRT_2 * least_px, style)
    }
}
