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
    /// What the triangles are coloured by.
    pub colors: PictureColors,
    /// What stands around the map.
    pub furniture: Furniture,
}

/// The choices as they are stored: whether the width is one on paper, the width in pixels and in millimetres,
/// pixels of an inch, the ground, the furniture, and whether the levels are shown in any case.
pub type KeptPictures = (bool, u32, f64, f64, String, String, bool);

/// What the triangles of a picture are coloured by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureColors {
    /// What the canvas shows: an overlay, or levels.
    #[default]
    AsShown,
    /// Levels.
    Levels,
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

impl GroundChoice {
    /// All grounds with their names in the storage.
    const NAMES: [(Self, &'static str); 3] =
        [(Self::AsShown, "as shown"), (Self::White, "white"), (Self::Transparent, "transparent")];

    fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(ground, _)| *ground == self).map_or("", |(_, name)| name)
    }

    fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(_, known)| *known == name).map(|(ground, _)| *ground)
    }
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
            colors: PictureColors::AsShown,
            furniture: Furniture::ALL,
        }
    }
}

impl PictureChoices {
    /// Returns the choices as they are stored.
    pub fn kept(&self) -> KeptPictures {
        let Self { width_in, width_px, width_mm, dots_per_inch, ground, colors, furniture } = *self;
        let (is_on_paper, shows_levels) = (width_in == WidthIn::Paper, colors == PictureColors::Levels);
        let (ground, furniture) = (ground.name().into(), furniture.to_string());
        (is_on_paper, width_px, width_mm, dots_per_inch, ground, furniture, shows_levels)
    }

    /// Returns choices that were stored; `None` where they have a value that nobody can choose.
    pub fn of_kept(
        (is_on_paper, width_px, width_mm, dots_per_inch, ground, furniture, shows_levels): KeptPictures,
    ) -> Option<Self> {
        let is_length = |value: f64| value.is_finite() && value > 0.0;
        let is_size =
            (1..=LARGEST_PICTURE).contains(&width_px) && is_length(width_mm) && is_length(dots_per_inch);
        let (ground, furniture) = (GroundChoice::named(&ground)?, furniture.parse().ok()?);
        let width_in = if is_on_paper { WidthIn::Paper } else { WidthIn::Pixels };
        let colors = if shows_levels { PictureColors::Levels } else { PictureColors::AsShown };
        is_size.then_some(Self { width_in, width_px, width_mm, dots_per_inch, ground, colors, furniture })
    }

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
    fn choices_are_kept_and_impossible_ones_are_not_taken() {
        for furniture in [Furniture::NONE, Furniture::ALL, Furniture { legend: true, ..Furniture::NONE }] {
            for (ground, _) in GroundChoice::NAMES {
                for colors in [PictureColors::AsShown, PictureColors::Levels] {
                    let width_in = WidthIn::Paper;
                    let choices =
                        PictureChoices { width_in, ground, colors, furniture, ..Default::default() };
                    assert_eq!(PictureChoices::of_kept(choices.kept()), Some(choices));
                }
            }
        }
        let kept = PictureChoices::default().kept();
        for broken in [
            (kept.0, 0, kept.2, kept.3, kept.4.clone(), kept.5.clone(), kept.6),
            (kept.0, kept.1, f64::NAN, kept.3, kept.4.clone(), kept.5.clone(), kept.6),
            (kept.0, kept.1, kept.2, kept.3, "pink".into(), kept.5.clone(), kept.6),
            (kept.0, kept.1, kept.2, kept.3, kept.4.clone(), "palms".into(), kept.6),
        ] {
            assert_eq!(PictureChoices::of_kept(broken), None);
        }
    }

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
