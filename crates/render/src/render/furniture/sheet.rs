//! A picture with a map and what stands around it, as plain data.

use glam::DVec2;

use super::glyphs;

/// A picture with a map and what stands around it. Places are in pixels from the upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The upper left corner of the map.
    pub map_at: [u32; 2],
    /// Width and height of the map.
    pub map_size: [u32; 2],
    /// What is drawn over both, in this order.
    pub marks: Vec<SheetMark>,
}

/// Something around a map. Colours are red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetMark {
    /// A filled rectangle, from its upper left to its lower right corner.
    Fill {
        /// Both corners.
        corners: [DVec2; 2],
        /// Its colour.
        color: [u8; 3],
    },
    /// A line through points.
    Line {
        /// Its points.
        points: Vec<DVec2>,
        /// Its width.
        width: f64,
        /// Its colour.
        color: [u8; 3],
    },
    /// A text.
    Text {
        /// The left end of its baseline.
        at: DVec2,
        /// The height of its font.
        size: f64,
        /// What it says.
        text: String,
        /// Its colour.
        color: [u8; 3],
    },
}

impl SheetMark {
    /// Returns the upper left and the lower right corner of the place of a text, without the tails of letters
    /// below its baseline; `None` for other marks.
    pub fn text_box(&self) -> Option<[DVec2; 2]> {
        let Self::Text { at, size, text, .. } = self else { return None };
        let above = DVec2::new(0.0, glyphs::CAPITAL * size);
        Some([*at - above, *at + DVec2::new(glyphs::width(text, *size), 0.0)])
    }
}
