//! What a sheet shows, before it is laid out.

use glam::DVec2;

use super::axes::MapAxes;
use super::legend::Legend;
use super::space_axes::SpaceAxes;
use crate::colormap::Ground;
use meshbrush_mesh::text::LengthUnit;

/// What stands around a map.
#[derive(Clone, Debug)]
pub struct SheetContent {
    /// The legend.
    pub legend: Option<Legend>,
    /// The axes of a plan.
    pub axes: Option<MapAxes>,
    /// The axes of a view in space.
    pub space_axes: Option<SpaceAxes>,
    /// The scale bar.
    pub bar: Option<Bar>,
    /// The direction to the north in the picture, y upwards.
    pub north: Option<DVec2>,
    /// The colours.
    pub inks: Inks,
}

/// What a scale bar measures.
#[derive(Clone, Copy, Debug)]
pub struct Bar {
    /// World units of the map that a length of 1 has in the middle of the map.
    pub world_per_length: f64,
    /// The unit of lengths.
    pub unit: LengthUnit,
}

/// Colours of lines and texts.
#[derive(Clone, Copy, Debug)]
pub struct Inks {
    /// Of lines, and of what is read first.
    pub strong: [u8; 3],
    /// Of what stands beside it.
    pub quiet: [u8; 3],
}

impl Inks {
    /// Returns the colours on a ground.
    pub fn on(ground: Ground) -> Self {
        match ground {
            Ground::Dark => Self { strong: [0xe8, 0xea, 0xee], quiet: [0xa9, 0xaf, 0xba] },
            Ground::Light => Self { strong: [0x16, 0x18, 0x1d], quiet: [0x4c, 0x52, 0x5c] },
        }
    }
}
