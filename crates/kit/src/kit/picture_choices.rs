//! What a person chooses for exported pictures.

use meshbrush_render::colormap::Ground;
use meshbrush_render::render::furniture::Furniture;
use meshbrush_render::render::picture_size::{
    LARGEST_PICTURE, PaperSize, PaperUnit, PictureGround, PictureSize,
};

/// Millimetres of an inch.
const INCH_MM: f64 = 25.4;

/// What a person chooses for exported pictures. It stays until it is changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureChoices {
    /// In what the width is given.
    pub width_in: WidthIn,
    /// The width in pixels.
    pub width_px: u32,
    /// The width in millimetres.
    pub width_mm: f64,
    /// Pixels of an inch of paper.
    pub dots_per_inch: f64,
    /// What is behind the mesh.
    pub ground: GroundChoice,
    /// What stands around the map.
    pub furniture: Furniture,
}

/// In what the width of a picture is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WidthIn {
    /// In pixels.
    Pixels,
    /// In millimetres, with pixels of an inch.
    Paper,
}

/// What is behind the mesh of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroundChoice {
    /// What the canvas shows.
    AsShown,
    /// White.
    White,
    /// Nothing.
    Transparent,
}

impl Default for PictureChoices {
    /// A picture has what the canvas shows around the mesh.
    fn default() -> Self {
        Self {
            width_in: WidthIn::Pixels,
            width_px: PictureSize::WIDTH,
            width_mm: 160.0,
            dots_per_inch: PictureSize::USUAL_DOTS,
            ground: GroundChoice::AsShown,
            furniture: Furniture::ALL,
        }
    }
}

impl PictureChoices {
    /// Returns the greatest width in millimetres at these pixels of an inch.
    pub fn largest_mm(&self) -> f64 {
        f64::from(LARGEST_PICTURE) / self.dots_per_inch * INCH_MM
    }

    /// Returns the size of a picture. A width beyond the limits is at its nearest end.
    pub fn size(&self) -> PictureSize {
        let pixels = match self.width_in {
            WidthIn::Pixels => f64::from(self.width_px),
            WidthIn::Paper => (self.width_mm / INCH_MM * self.dots_per_inch).round(),
        };
        let pixels = pixels.clamp(1.0, f64::from(LARGEST_PICTURE));
        let on_paper = (self.width_in == WidthIn::Paper).then(|| PaperSize {
            dots_per_inch: self.dots_per_inch,
            width: self.width_mm.min(self.largest_mm()),
            unit: PaperUnit::Millimetre,
        });
        PictureSize { width: pixels as u32, height: None, on_paper }
    }

    /// Returns the ground, in a window with a theme.
    pub fn ground_in(&self, theme: Ground) -> PictureGround {
        match self.ground {
            GroundChoice::AsShown => theme.into(),
            GroundChoice::White => PictureGround::White,
            GroundChoice::Transparent => PictureGround::Transparent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_on_paper_has_its_pixels_and_stays_within_the_limit() {
        let paper = |width_mm, dots_per_inch| {
            let choices =
                PictureChoices { width_in: WidthIn::Paper, width_mm, dots_per_inch, ..Default::default() };
            choices.size()
        };
        assert_eq!(paper(160.0, 254.0).width, 1600);
        assert_eq!(paper(160.0, 254.0).on_paper.map(|paper| paper.width), Some(160.0));
        let most = paper(5000.0, 254.0);
        let most_mm = most.on_paper.expect("a size on paper").width;
        assert!(most.width == LARGEST_PICTURE && (most_mm - 1638.4).abs() < 1e-9, "{most_mm}");
        assert_eq!(paper(1e-9, 10.0).width, 1);
        assert_eq!(PictureChoices::default().size(), PictureSize::of_width(1600));
    }
}
