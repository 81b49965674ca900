//! Colours of levels and neighbours, and measures of contrast.
//!
//! Colours are sRGB bytes: `[red, green, blue]`, or with an alpha of 255 after them.

mod categories;
pub mod overlay_palette;
mod tables;

use std::str::FromStr;
use std::sync::LazyLock;

pub use categories::category_color;

/// Number of levels that a mesh can have. The lattice allows no deeper ones.
pub const LEVELS: usize = 64;

/// A colour map: a colour for each number from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Colormap {
    /// Violet over green to yellow. Perceptually uniform, safe for colour-blind people.
    #[default]
    Viridis,
    /// Black over purple and orange to pale yellow. Perceptually uniform.
    Magma,
    /// Navy to yellow. Looks nearly the same with and without red-green blindness.
    Cividis,
    /// Blue over green to red. Many distinguishable steps, but not perceptually uniform.
    Turbo,
    /// Dark to light grey, for print.
    Greys,
}

/// The error for a name that no colour map has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("There is no colormap `{0}`; choose Viridis, Magma, Cividis, Turbo or Greys.")]
pub struct UnknownColormap(String);

impl Colormap {
    /// All colour maps, in menu order.
    pub const ALL: [Self; 5] = [Self::Viridis, Self::Magma, Self::Cividis, Self::Turbo, Self::Greys];

    /// Returns the name in menus; [`Colormap::from_str`] reads it, in upper or lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Viridis => "Viridis",
            Self::Magma => "Magma",
            Self::Cividis => "Cividis",
            Self::Turbo => "Turbo",
            Self::Greys => "Greys",
        }
    }

    /// Returns the colour at `t`, interpolated between the two nearest of 256 entries.
    ///
    /// Below 0 and for NaN it is the first entry, above 1 the last one.
    ///
    /// ```
    /// use meshbrush_render::colormap::Colormap;
    ///
    /// assert_eq!(Colormap::Viridis.sample(0.0), [0x44, 0x01, 0x54]);
    /// assert_eq!(Colormap::Viridis.sample(7.0), [0xfd, 0xe7, 0x25]);
    /// ```
    pub fn sample(self, t: f64) -> [u8; 3] {
        let table = self.table();
        let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        let position = t * 255.0;
        let below = position as usize;
        let (a, b) = (rgb(table[below]), rgb(table[(below + 1).min(255)]));
        let fraction = position - below as f64;
        std::array::from_fn(|i| {
            let (a, b) = (f64::from(a[i]), f64::from(b[i]));
            (a + (b - a) * fraction).round() as u8
        })
    }

    fn table(self) -> &'static [u32; 256] {
        match self {
            Self::Viridis => &tables::VIRIDIS,
            Self::Magma => &tables::MAGMA,
            Self::Cividis => &tables::CIVIDIS,
            Self::Turbo => &tables::TURBO,
            Self::Greys => &tables::GREYS,
        }
    }

    /// Returns the positions of level 1 and of the deepest level on the map.
    ///
    /// Finer levels contrast more with the ground: they get lighter on the dark ground and darker on the
    /// light one. No map uses the end that would not contrast with the ground. Turbo, which is read by hue,
    /// runs from blue to red on both grounds, without its dark ends.
    fn span(self, ground: Ground) -> (f64, f64) {
        match (self, ground) {
            (Self::Turbo, _) => (0.12, 0.9),
            (Self::Magma, Ground::Dark) => (0.22, 1.0),
            (Self::Magma, Ground::Light) => (0.88, 0.1),
            (_, Ground::Dark) => (0.12, 1.0),
            (_, Ground::Light) => (0.88, 0.0),
        }
    }
}

impl FromStr for Colormap {
    type Err = UnknownColormap;

    /// Reads a name in upper or lower case; `grays`, `grey` and `gray` are Greys.
    fn from_str(name: &str) -> Result<Self, UnknownColormap> {
        let wanted = name.trim();
        let known = Self::ALL.into_iter().find(|map| map.name().eq_ignore_ascii_case(wanted));
        let grey = ["grays", "grey", "gray"].iter().any(|other| other.eq_ignore_ascii_case(wanted));
        known
            .or(grey.then_some(Self::Greys))
            .ok_or_else(|| UnknownColormap(wanted.chars().take(40).collect()))
    }
}

/// The background of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Ground {
    /// The dark theme's canvas.
    #[default]
    Dark,
    /// The light theme's canvas, and paper.
    Light,
}

impl Ground {
    /// Returns the colour of the canvas.
    pub const fn canvas(self) -> [u8; 3] {
        match self {
            Self::Dark => [0x0b, 0x0d, 0x10],
            Self::Light => [0xf4, 0xf5, 0xf7],
        }
    }

    /// Returns the colour of level 0: close to that of the canvas, so that refined parts stand out.
    pub const fn level_0(self) -> [u8; 3] {
        match self {
            Self::Dark => [0x1d, 0x21, 0x2b],
            Self::Light => [0xe9, 0xec, 0xf1],
        }
    }

    /// Colours of the three neighbours of a triangle on a dark halo over the colour of any level, the
    /// bisection neighbour first.
    pub const ON_LEVELS: [[u8; 3]; 3] = Self::Dark.neighbours();

    /// Returns colours of the three neighbours of a triangle in panels, the bisection neighbour first.
    pub const fn neighbours(self) -> [[u8; 3]; 3] {
        match self {
            Self::Dark => [[0xf4, 0xb9, 0x42], [0x5a, 0xd1, 0xc0], [0xf0, 0x8a, 0xd8]],
            Self::Light => [[0xb3, 0x74, 0x00], [0x00, 0x86, 0x75], [0xb8, 0x36, 0x80]],
        }
    }
}

/// The colour of every level, from 0 to 63.
///
/// The colour of a level depends on the map, the ground and the deepest level of the legend, but not on a
/// mesh: it does not change while the mesh is edited.
///
/// ```
/// use meshbrush_render::colormap::{Colormap, Ground, LevelColors};
///
/// let colors = LevelColors::new(Colormap::Viridis, Ground::Dark, 12);
/// assert_eq!(colors.of(0), [0x1d, 0x21, 0x2b, 255]);
/// assert_eq!(colors.of(12), [0xfd, 0xe7, 0x25, 255]);
/// assert_eq!(colors.of(40), colors.of(12));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LevelColors {
    rgba: [[u8; 4]; LEVELS],
}

impl LevelColors {
    /// Distributes levels 1 to `deepest` evenly over the map; deeper levels have the last colour.
    ///
    /// If `deepest` is 0 or 1, every level from 1 on has the last colour. Values above 63 count as 63.
    pub fn new(map: Colormap, ground: Ground, deepest: u8) -> Self {
        let (first, last) = map.span(ground);
        let steps = deepest.clamp(1, 63) - 1;
        let color = |level: usize| {
            let step = (level - 1).min(steps.into());
            let t = if step == usize::from(steps) {
                last
            } else {
                first + (last - first) * step as f64 / f64::from(steps)
            };
            opaque(map.sample(t))
        };
        let mut rgba = [opaque(ground.level_0()); LEVELS];
        for (level, entry) in rgba.iter_mut().enumerate().skip(1) {
            *entry = color(level);
        }
        Self { rgba }
    }

    /// Returns the colour of a level. Levels above 63 have the colour of level 63.
    pub fn of(&self, level: u8) -> [u8; 4] {
        self.rgba[usize::from(level.min(63))]
    }

    /// Returns the colours of all levels, in the order of the levels.
    pub fn as_table(&self) -> &[[u8; 4]; LEVELS] {
        &self.rgba
    }
}

impl From<[[u8; 4]; LEVELS]> for LevelColors {
    /// Takes the colours level by level: red, green, blue as sRGB bytes. The fourth byte is not used.
    fn from(rgba: [[u8; 4]; LEVELS]) -> Self {
        Self { rgba }
    }
}

/// Returns relative luminance from 0 (black) to 1 (white), as WCAG 2 defines it.
pub fn luminance(color: [u8; 3]) -> f64 {
    let [r, g, b] = linear_rgb(color);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Returns contrast of two colours in either order, from 1 to 21, as WCAG 2 defines it.
///
/// Text needs at least 4.5, large text and shapes at least 3.
///
/// ```
/// use meshbrush_render::colormap::contrast_ratio;
///
/// assert_eq!(contrast_ratio([0; 3], [255; 3]), 21.0);
/// assert_eq!(contrast_ratio([90; 3], [90; 3]), 1.0);
/// ```
pub fn contrast_ratio(a: [u8; 3], b: [u8; 3]) -> f64 {
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}

/// Returns the linear intensity of each channel from 0 to 1: inverts the sRGB transfer function (IEC
/// 61966-2-1).
fn linear_rgb(color: [u8; 3]) -> [f64; 3] {
    static LINEAR: LazyLock<[f64; 256]> = LazyLock::new(|| {
        std::array::from_fn(|byte| {
            let v = byte as f64 / 255.0;
            if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
        })
    });
    color.map(|byte| LINEAR[usize::from(byte)])
}

fn rgb(hex: u32) -> [u8; 3] {
    let [_, r, g, b] = hex.to_be_bytes();
    [r, g, b]
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUNDS: [Ground; 2] = [Ground::Dark, Ground::Light];

    /// Converts linear light to CIE L*, a*, b* (white D65).
    fn lab([r, g, b]: [f64; 3]) -> [f64; 3] {
        let f = |t: f64| {
            if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 }
        };
        let x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
        let y = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b);
        let z = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn lightness(color: [u8; 3]) -> f64 {
        lab(linear_rgb(color))[0]
    }

    /// Returns colour difference by CIE 1976: about 2.3 is just noticeable.
    fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
        let (a, b) = (lab(a), lab(b));
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// Simulates deuteranopia, the absence of medium-wavelength cones (Machado, Oliveira and Fernandes 2009).
    fn deuteranopia([r, g, b]: [f64; 3]) -> [f64; 3] {
        [
            0.367322 * r + 0.860646 * g - 0.227968 * b,
            0.280085 * r + 0.672501 * g + 0.047413 * b,
            -0.011820 * r + 0.042940 * g + 0.968881 * b,
        ]
        .map(|v| v.clamp(0.0, 1.0))
    }

    fn level(colors: &LevelColors, level: u8) -> [u8; 3] {
        let [r, g, b, a] = colors.of(level);
        assert_eq!(a, 255);
        [r, g, b]
    }

    fn every_scale() -> impl Iterator<Item = (Colormap, Ground, u8, LevelColors)> {
        let grounds = |map| GROUNDS.map(|ground| (map, ground));
        let scales = Colormap::ALL.into_iter().flat_map(grounds);
        scales.flat_map(|(map, ground)| {
            (1..=16).map(move |deepest| {
                let colors = LevelColors::new(map, ground, deepest);
                (map, ground, deepest, colors)
            })
        })
    }

    #[test]
    fn tables_have_the_published_entries() {
        let hex = |map: Colormap, i: usize| map.table()[i];
        assert_eq!(hex(Colormap::Viridis, 0), 0x440154);
        assert_eq!(hex(Colormap::Viridis, 128), 0x21918c);
        assert_eq!(hex(Colormap::Viridis, 255), 0xfde725);
        assert_eq!(hex(Colormap::Magma, 0), 0x000004);
        assert_eq!(hex(Colormap::Magma, 255), 0xfcfdbf);
        assert_eq!(hex(Colormap::Cividis, 0), 0x00224e);
        assert_eq!(hex(Colormap::Cividis, 255), 0xfee838);
        assert_eq!(hex(Colormap::Turbo, 0), 0x30123b);
        assert_eq!(hex(Colormap::Turbo, 255), 0x7a0403);
    }

    #[test]
    fn samples_are_entries_or_between_entries() {
        for map in Colormap::ALL {
            for i in 0..=255_u8 {
                let entry = rgb(map.table()[usize::from(i)]);
                assert_eq!(map.sample(f64::from(i) / 255.0), entry, "{map:?} {i}");
            }
            assert_eq!(map.sample(f64::NAN), map.sample(0.0));
            assert_eq!(map.sample(f64::NEG_INFINITY), map.sample(0.0));
            assert_eq!(map.sample(f64::INFINITY), map.sample(1.0));
        }
        let [a, b] = [0, 1].map(|i| rgb(tables::TURBO[i])[2]);
        let between = Colormap::Turbo.sample(0.5 / 255.0)[2];
        assert!(a < between && between < b, "{a} {between} {b}");
    }

    #[test]
    fn uniform_maps_get_lighter_from_end_to_end() {
        for map in [Colormap::Viridis, Colormap::Magma, Colormap::Cividis, Colormap::Greys] {
            let lightness: Vec<f64> = map.table().iter().map(|&c| lightness(rgb(c))).collect();
            let steps = lightness.windows(2).map(|w| w[1] - w[0]);
            // Because of rounding to bytes, a single step may be zero or slightly negative.
            assert!(steps.clone().all(|step| step > -0.25), "{map:?}");
            let strides = lightness.windows(9).map(|w| w[8] - w[0]);
            assert!(strides.clone().all(|s| s > 0.5), "{map:?}");
        }
    }

    #[test]
    fn neighbouring_levels_are_distinguishable() {
        for (map, ground, deepest, colors) in every_scale() {
            for l in 1..=deepest {
                let pair = [l - 1, l].map(|l| linear_rgb(level(&colors, l)));
                let seen = difference(pair[0], pair[1]);
                assert!(seen > 4.0, "{map:?} {ground:?} {l} of {deepest}: {seen:.2}");
                let pair = pair.map(deuteranopia);
                let seen = difference(pair[0], pair[1]);
                assert!(
                    seen > 2.5 || map == Colormap::Turbo,
                    "{map:?} {ground:?} {l} of {deepest}, colour-blind: {seen:.2}"
                );
            }
        }
    }

    #[test]
    fn deeper_levels_stand_out_more_from_the_canvas() {
        for (map, ground, deepest, colors) in every_scale() {
            let contrast = |l| contrast_ratio(level(&colors, l), ground.canvas());
            assert!(contrast(0) < 1.3, "{ground:?}");
            assert!(contrast(deepest) > 3.0, "{map:?} {ground:?}");
            if map != Colormap::Turbo {
                assert!(contrast(deepest) > 7.0, "{map:?} {ground:?}");
                let grows = (1..=deepest).all(|l| contrast(l) > contrast(l - 1));
                assert!(grows, "{map:?} {ground:?} {deepest}");
            }
        }
    }

    #[test]
    fn levels_past_the_deepest_keep_its_color() {
        for (_, _, deepest, colors) in every_scale() {
            assert!((deepest..=255).all(|l| colors.of(l) == colors.of(deepest)));
        }
        let [none, one] = [0, 1].map(|d| LevelColors::new(Colormap::Magma, Ground::Dark, d));
        assert_eq!(none, one);
        let [all, more] = [63, 255].map(|d| LevelColors::new(Colormap::Magma, Ground::Dark, d));
        assert_eq!(all, more);
        assert_eq!(all.of(63)[..3], Colormap::Magma.sample(1.0));
        assert_eq!(all.as_table()[1][..3], Colormap::Magma.sample(0.22));
    }

    #[test]
    fn colours_of_neighbours_are_distinguishable_with_colour_blindness() {
        let neighbours = Ground::Dark.neighbours();
        for (i, a) in neighbours.iter().enumerate() {
            for b in &neighbours[..i] {
                let (a, b) = (linear_rgb(*a), linear_rgb(*b));
                assert!(difference(a, b) > 40.0);
                let seen = difference(deuteranopia(a), deuteranopia(b));
                // 2 and 3 are closest, at 14.3; chips and pins also show the number.
                assert!(seen > 10.0, "{i}: {seen:.1}");
            }
        }
    }

    #[test]
    fn names_are_read_in_upper_and_lower_case() {
        for map in Colormap::ALL {
            assert_eq!(map.name().parse(), Ok(map));
            assert_eq!(map.name().to_uppercase().parse(), Ok(map));
        }
        assert_eq!("gray".parse(), Ok(Colormap::Greys));
        let e = "jet".parse::<Colormap>().unwrap_err();
        assert!(e.to_string().starts_with("There is no colormap `jet`"));
    }

    #[test]
    fn contrast_is_that_of_wcag() {
        let grey = contrast_ratio([0x76; 3], [0xff; 3]);
        assert!((grey - 4.54).abs() < 0.01, "{grey}");
        assert!((luminance([255, 0, 0]) - 0.2126).abs() < 1e-12);
    }
}
