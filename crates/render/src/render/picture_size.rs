//! How large a picture is, and what is behind its mesh: as people write it.

use std::fmt;
use std::str::FromStr;

use crate::colormap::Ground;
use meshbrush_mesh::text::{Grouped, Number};

/// Greatest width and height of a picture, in pixels.
pub const LARGEST_PICTURE: u32 = 16_384;

/// The size of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureSize {
    /// Width in pixels, 1 to [`LARGEST_PICTURE`].
    pub width: u32,
    /// Height in pixels, 1 to [`LARGEST_PICTURE`]. With `None` it follows from the width and the proportions
    /// of the domain.
    pub height: Option<u32>,
    /// How large that is on paper, if it is known.
    pub on_paper: Option<PaperSize>,
}

/// The size of a picture on paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperSize {
    /// Pixels of an inch.
    pub dots_per_inch: f64,
    /// Width, in the unit.
    pub width: f64,
    /// The unit.
    pub unit: PaperUnit,
}

/// Units of sizes on paper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PaperUnit {
    /// Millimetres.
    #[default]
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Inches.
    Inch,
}

impl PaperUnit {
    /// All units.
    pub const ALL: [Self; 3] = [Self::Millimetre, Self::Centimetre, Self::Inch];

    /// Returns the symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Inch => "in",
        }
    }

    fn per_inch(self) -> f64 {
        match self {
            Self::Millimetre => 25.4,
            Self::Centimetre => 2.54,
            Self::Inch => 1.0,
        }
    }
}

/// Why a size cannot be that of a picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SizeError {
    /// The text is no size.
    #[error(
        "write a width, or width x height, as in 1600, 1600x900 or 160mm; each from 1 to {} pixels, or a length in mm, \
         cm or in.",
        Grouped(LARGEST_PICTURE as usize)
    )]
    Text,
    /// A length has too many pixels, or none.
    #[error(
        "{} {} are {} pixels at {} dots per inch, and a side has from 1 to {}. Change the length or the dots per inch.",
        Number(*.length), .unit.symbol(), Number(*.pixels), Number(*.dots_per_inch),
        Grouped(LARGEST_PICTURE as usize)
    )]
    Pixels {
        /// The length.
        length: f64,
        /// Its unit.
        unit: PaperUnit,
        /// Pixels of an inch.
        dots_per_inch: f64,
        /// Pixels of the length.
        pixels: f64,
    },
    /// The number of pixels of an inch is out of range.
    #[error(
        "{} dots per inch are not possible; write a number from {} to {}.",
        Number(*.0), Number(PictureSize::DOTS[0]), Number(PictureSize::DOTS[1])
    )]
    DotsPerInch(f64),
}

/// A side as typed: its number, and its unit if it has one.
struct TypedSide {
    number: f64,
    unit: Option<PaperUnit>,
}

impl TypedSide {
    fn read(text: &str) -> Option<Self> {
        let text = text.trim();
        let with_unit = PaperUnit::ALL.into_iter().find_map(|unit| {
            let number = text.strip_suffix(unit.symbol())?;
            Some((number, unit))
        });
        let (number, unit) = match with_unit {
            Some((number, unit)) => (number, Some(unit)),
            None => (text.strip_suffix("px").unwrap_or(text), None),
        };
        let number = number.trim();
        let is_plain = number.chars().all(|c| c.is_ascii_digit() || c == '.');
        let number = number.parse().ok().filter(|_| is_plain)?;
        Some(Self { number, unit })
    }

    fn pixels(&self) -> Option<u32> {
        let sides = 1.0..=f64::from(LARGEST_PICTURE);
        (self.number.fract() == 0.0 && sides.contains(&self.number)).then_some(self.number as u32)
    }
}

impl PictureSize {
    /// The usual width in pixels.
    pub const WIDTH: u32 = 1600;
    /// The range of pixels of an inch.
    pub const DOTS: [f64; 2] = [10.0, 4800.0];
    /// Pixels of an inch where none are given for a length.
    pub const USUAL_DOTS: f64 = 300.0;

    /// Returns the size of a width in pixels.
    pub fn of_width(width: u32) -> Self {
        Self { width, height: None, on_paper: None }
    }

    /// Reads a width, or width and height, in pixels or as lengths: `1600`, `1600x900`, `160mm`, `16x9cm`.
    /// `dots_per_inch` says how many pixels a length has, and how large pixels are.
    ///
    /// # Errors
    /// Fails with a sentence when the text is no size, or a number is out of range.
    pub fn parse(text: &str, dots_per_inch: Option<f64>) -> Result<Self, SizeError> {
        let is_usable = |dots: &f64| (Self::DOTS[0]..=Self::DOTS[1]).contains(dots);
        if let Some(dots) = dots_per_inch.filter(|dots| !is_usable(dots)) {
            return Err(SizeError::DotsPerInch(dots));
        }
        let text = text.trim().to_lowercase().replace("px", "");
        let (width, height) = match text.split_once(['x', '×']) {
            Some((width, height)) => (width, Some(height)),
            None => (&*text, None),
        };
        let width = TypedSide::read(width).ok_or(SizeError::Text)?;
        let height = height.map(|height| TypedSide::read(height).ok_or(SizeError::Text)).transpose()?;
        // A unit after both numbers is that of both.
        let unit = match &height {
            Some(height) if width.unit.is_some() && width.unit != height.unit => return Err(SizeError::Text),
            Some(height) => height.unit,
            None => width.unit,
        };
        let Some(unit) = unit else {
            let pixels = |side: &TypedSide| side.pixels().ok_or(SizeError::Text);
            let (width, height) = (pixels(&width)?, height.as_ref().map(pixels).transpose()?);
            let inches = |dots: f64| f64::from(width) / dots;
            let on_paper = dots_per_inch.map(|dots| PaperSize {
                dots_per_inch: dots,
                width: inches(dots),
                unit: PaperUnit::Inch,
            });
            return Ok(Self { width, height, on_paper });
        };
        let dots_per_inch = dots_per_inch.unwrap_or(Self::USUAL_DOTS);
        let pixels = |side: &TypedSide| {
            let pixels = (side.number / unit.per_inch() * dots_per_inch).round();
            let is_possible = (1.0..=f64::from(LARGEST_PICTURE)).contains(&pixels);
            let error = SizeError::Pixels { length: side.number, unit, dots_per_inch, pixels };
            is_possible.then_some(pixels as u32).ok_or(error)
        };
        Ok(Self {
            width: pixels(&width)?,
            height: height.as_ref().map(pixels).transpose()?,
            on_paper: Some(PaperSize { dots_per_inch, width: width.number, unit }),
        })
    }
}

/// What is behind the mesh of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureGround {
    /// The canvas of the dark theme.
    #[default]
    Dark,
    /// The canvas of the light theme.
    Light,
    /// White, with lines and texts for paper.
    White,
    /// Nothing, with lines and texts for paper.
    Transparent,
}

impl PictureGround {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Dark, Self::Light, Self::White, Self::Transparent];

    /// Returns the name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Light => "light",
            Self::White => "white",
            Self::Transparent => "transparent",
        }
    }

    /// Returns the theme that colours, lines and texts are from.
    pub fn theme(self) -> Ground {
        match self {
            Self::Dark => Ground::Dark,
            Self::Light | Self::White | Self::Transparent => Ground::Light,
        }
    }

    /// Returns red, green and blue; of a transparent ground those that stand for it below lines.
    pub fn color(self) -> [u8; 3] {
        match self {
            Self::Dark | Self::Light => self.theme().canvas(),
            Self::White | Self::Transparent => [0xff; 3],
        }
    }

    /// Returns whether nothing is behind the mesh.
    pub fn is_transparent(self) -> bool {
        self == Self::Transparent
    }

    /// Returns red, green, blue and opacity, premultiplied.
    pub fn rgba(self) -> [u8; 4] {
        let [r, g, b] = self.color();
        if self.is_transparent() { [0; 4] } else { [r, g, b, 0xff] }
    }
}

impl From<Ground> for PictureGround {
    fn from(ground: Ground) -> Self {
        match ground {
            Ground::Dark => Self::Dark,
            Ground::Light => Self::Light,
        }
    }
}

impl fmt::Display for PictureGround {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The error for a word that names no ground.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("“{0}” is no ground; use dark, light, white or transparent.")]
pub struct UnknownGround(String);

impl FromStr for PictureGround {
    type Err = UnknownGround;

    fn from_str(text: &str) -> Result<Self, UnknownGround> {
        let named = Self::ALL.into_iter().find(|ground| ground.name() == text.trim());
        named.ok_or_else(|| UnknownGround(text.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_in_pixels_and_in_lengths() {
        let size = |text: &str, dots| {
            let size = PictureSize::parse(text, dots).unwrap();
            (size.width, size.height, size.on_paper.map(|paper| (paper.width, paper.unit.symbol())))
        };
        assert_eq!(size("1600", None), (1600, None, None));
        assert_eq!(size(" 1600 X 900 ", None), (1600, Some(900), None));
        assert_eq!(size("1600px×900px", None), (1600, Some(900), None));
        assert_eq!(size("1500", Some(300.0)), (1500, None, Some((5.0, "in"))));
        assert_eq!(size("160mm", None), (1890, None, Some((160.0, "mm"))));
        assert_eq!(size("160x90mm", Some(254.0)), (1600, Some(900), Some((160.0, "mm"))));
        assert_eq!(size("16 cm x 9 cm", Some(254.0)), (1600, Some(900), Some((16.0, "cm"))));
        assert_eq!(size("6.3in", Some(100.0)), (630, None, Some((6.3, "in"))));
        assert_eq!(size("16384", None), (16_384, None, None));
    }

    #[test]
    fn sizes_that_no_picture_has_are_refused_with_the_rule() {
        for text in
            ["", "0", "16385", "1600.5", "-3", "x", "100x", "x100", "10mmx5cm", "10mmx5", "1e3", "nan", "∞"]
        {
            assert_eq!(PictureSize::parse(text, None), Err(SizeError::Text), "{text}");
        }
        let error = |text: &str, dots| PictureSize::parse(text, Some(dots)).unwrap_err().to_string();
        assert_eq!(
            error("2000mm", 300.0),
            "2000 mm are 23622 pixels at 300 dots per inch, and a side has from 1 to 16,384. Change the length or the \
             dots per inch."
        );
        assert!(error("0mm", 300.0).starts_with("0 mm are 0 pixels"));
        for dots in [0.0, 9.9, 4801.0, f64::NAN, f64::INFINITY, -300.0] {
            assert!(error("1600", dots).contains("write a number from 10 to 4800"), "{dots}");
        }
    }

    #[test]
    fn grounds_have_names() {
        for ground in PictureGround::ALL {
            assert_eq!(ground.to_string().parse(), Ok(ground));
        }
        assert!("Dark".parse::<PictureGround>().is_err());
    }
}
