//! The colours of overlays. Legends show the same colours as the canvas and exported pictures: all take them
//! from here.

use super::{Ground, LevelColors, category_color};
use meshbrush_core::layers::LayerId;
use meshbrush_core::quality::QualityMeasure;

/// A colour as sRGB bytes, opaque.
pub type Opaque = [u8; 4];

/// Halvings from which on slack has its strongest colour.
pub const MOST_SLACK: f32 = 4.0;
/// The relative error of a depth that has the strongest colour.
pub const MOST_ERROR: f32 = 0.1;
/// The colours of water from the shore to the deepest place, at equal steps of [`OverlayPalette::water`].
const WATER: [Opaque; 5] = [
    [0xd3, 0xee, 0xe6, 0xff],
    [0x8c, 0xcf, 0xcb, 0xff],
    [0x4d, 0xa3, 0xb8, 0xff],
    [0x35, 0x6b, 0x9e, 0xff],
    [0x2b, 0x35, 0x6b, 0xff],
];
/// The colours of ground from the lowest to the highest place, at equal steps.
const GROUND: [Opaque; 5] = [
    [0x4f, 0x7d, 0x55, 0xff],
    [0x9c, 0xae, 0x6b, 0xff],
    [0xd9, 0xc8, 0x8f, 0xff],
    [0xb5, 0x89, 0x64, 0xff],
    [0xe9, 0xe4, 0xdd, 0xff],
];
/// The smallest angles, in degrees, with a neutral colour and with the strongest one.
pub const SMALLEST_ANGLES: [f32; 2] = [45.0, 15.0];
/// The same of the largest angles.
pub const LARGEST_ANGLES: [f32; 2] = [90.0, 150.0];
/// The same of the ratios of edges.
pub const EDGE_RATIOS: [f32; 2] = [1.5, 3.5];
/// The triangles at a node with a neutral colour, as in a mesh before nodes are fitted to an outline, and
/// with the strongest one, as solvers refuse more.
pub const VALENCES: [f32; 2] = [8.0, 10.0];
/// The lengths of links between cells by their size with a neutral colour, and with the strongest one: the
/// solver removes those.
pub const LINK_LENGTHS: [f32; 2] = [0.45, 0.09];
/// The cosines between links and edges with a neutral colour, and with the strongest one: the largest that
/// the solver accepts.
pub const LINK_COSINES: [f32; 2] = [0.0, 0.5];
/// Edits from which on a triangle counts as old.
pub const OLD_AGE: u32 = 10;

/// The colours of all overlays in one theme. They take the place of the colours of levels.
#[derive(Clone, Debug, PartialEq)]
pub struct OverlayPalette {
    ground: Ground,
    levels: LevelColors,
}

impl OverlayPalette {
    /// Returns the palette of a theme, with the colours that levels have in it.
    pub fn new(ground: Ground, levels: LevelColors) -> Self {
        Self { ground, levels }
    }

    /// Returns the colour where an overlay has nothing to show: that of level 0.
    pub fn neutral(&self) -> Opaque {
        self.levels.of(0)
    }

    /// Returns the colour of a level.
    pub fn level(&self, level: u8) -> Opaque {
        self.levels.of(level)
    }

    /// Returns the colour of a risk, 0 to 255: from neutral to a warm red.
    pub fn risk(&self, risk: u8) -> Opaque {
        let strongest = match self.ground {
            Ground::Dark => [0xd4, 0x39, 0x36, 0xff],
            Ground::Light => [0xd4, 0x2a, 0x24, 0xff],
        };
        mixed(self.neutral(), strongest, f32::from(risk) / 255.0)
    }

    /// Returns the colour of the layer that decides; neutral where none does.
    pub fn layer(&self, layer: Option<LayerId>) -> Opaque {
        layer.map_or(self.neutral(), |LayerId(id)| {
            let [r, g, b] = category_color(id);
            [r, g, b, 0xff]
        })
    }

    /// Returns the colour of a triangle that is finer than required by a number of halvings; neutral for NaN.
    pub fn slack(&self, halvings: f32) -> Opaque {
        let share = (halvings / MOST_SLACK).clamp(0.0, 1.0);
        self.emphasised(if share.is_nan() { 0.0 } else { share })
    }

    /// Returns the colour of a triangle that came so many edits ago; neutral for old ones, and for those from
    /// before the first edit.
    pub fn age(&self, edits_ago: Option<u32>) -> Opaque {
        let age = edits_ago.map_or(OLD_AGE, |age| age.min(OLD_AGE));
        self.emphasised((OLD_AGE - age) as f32 / OLD_AGE as f32)
    }

    /// Returns the colour of a triangle by whether only compatibility asked for it.
    pub fn forced(&self, is_forced: bool) -> Opaque {
        match (is_forced, self.ground) {
            (false, _) => self.neutral(),
            (true, Ground::Dark) => [0xff, 0x8a, 0x1e, 0xff],
            (true, Ground::Light) => [0xd6, 0x5a, 0x00, 0xff],
        }
    }

    /// Returns the colour of water by its depth, as a share of the deepest: shallow water has most of the
    /// colours.
    pub fn water(&self, share: f32) -> Opaque {
        between(&WATER, share.clamp(0.0, 1.0).sqrt())
    }

    /// Returns the colour of ground by its height, as a share of the way from the lowest to the highest
    /// place.
    pub fn height(&self, share: f32) -> Opaque {
        between(&GROUND, share.clamp(0.0, 1.0))
    }

    /// Returns the colour of land.
    pub fn land(&self) -> Opaque {
        match self.ground {
            Ground::Dark => [0x6e, 0x66, 0x55, 0xff],
            Ground::Light => [0xdb, 0xd2, 0xbd, 0xff],
        }
    }

    /// Returns the colour of a relative difference of depths: blue where the mesh is deeper, red where it is
    /// shallower. Neutral for NaN.
    pub fn depth_error(&self, difference: f32) -> Opaque {
        let share = (difference / MOST_ERROR).clamp(-1.0, 1.0);
        let strongest = match (share > 0.0, self.ground) {
            (true, Ground::Dark) => [0x4c, 0x9d, 0xff, 0xff],
            (true, Ground::Light) => [0x0b, 0x54, 0xc4, 0xff],
            (false, Ground::Dark) => [0xff, 0x5c, 0x4d, 0xff],
            (false, Ground::Light) => [0xc4, 0x24, 0x16, 0xff],
        };
        mixed(self.neutral(), strongest, if share.is_nan() { 0.0 } else { share.abs() })
    }

    /// Returns the colour of an error as a share of the one that is allowed: red where the mesh is higher
    /// than the surface, blue where it is lower. Neutral for NaN.
    pub fn surface_error(&self, share: f32) -> Opaque {
        self.depth_error(-MOST_ERROR * share)
    }

    /// Returns the colour of a number of a triangle: neutral where it is good, red where it is bad. An edge
    /// by h̄ is blue where the triangle is finer than asked, and a time step is one by the least.
    pub fn quality(&self, measure: QualityMeasure, number: f32) -> Opaque {
        let [good, bad] = match measure {
            QualityMeasure::TargetRatio => return self.depth_error(-MOST_ERROR * number.log2()),
            QualityMeasure::TimeStep => {
                return self.warned(1.0 - number.log2() / MOST_SLACK);
            }
            QualityMeasure::SmallestAngle => SMALLEST_ANGLES,
            QualityMeasure::LargestAngle => LARGEST_ANGLES,
            QualityMeasure::EdgeRatio => EDGE_RATIOS,
            QualityMeasure::Valence => VALENCES,
            QualityMeasure::LinkLength => LINK_LENGTHS,
            QualityMeasure::LinkCosine => LINK_COSINES,
        };
        self.warned((number - good) / (bad - good))
    }

    /// Returns a colour from neutral to a warm red, by a share from 0 to 1.
    fn warned(&self, share: f32) -> Opaque {
        self.risk((255.0 * share.clamp(0.0, 1.0)) as u8)
    }

    /// Returns a colour from neutral to one that stands out in the theme, by a share from 0 to 1.
    fn emphasised(&self, share: f32) -> Opaque {
        let strongest = match self.ground {
            Ground::Dark => [0xff; 4],
            Ground::Light => [0x1c, 0x2f, 0x74, 0xff],
        };
        mixed(self.neutral(), strongest, share)
    }
}

/// Returns a colour in a light from 0 (black) over 1 (as it is).
pub fn lit([r, g, b, a]: Opaque, light: f32) -> Opaque {
    let [r, g, b] = [r, g, b].map(|channel| (f32::from(channel) * light).min(255.0) as u8);
    [r, g, b, a]
}

/// Returns the colour at a share from 0 to 1 of the way along some colours.
fn between(colors: &[Opaque], share: f32) -> Opaque {
    let along = share * (colors.len() - 1) as f32;
    let below = (along as usize).min(colors.len() - 2);
    mixed(colors[below], colors[below + 1], along - below as f32)
}

fn mixed(from: Opaque, to: Opaque, share: f32) -> Opaque {
    let mix = |i: usize| f32::from(from[i]) + share * (f32::from(to[i]) - f32::from(from[i]));
    std::array::from_fn(|i| mix(i).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colormap::Colormap;

    /// Relative luminance of WCAG 2, from 0 to 1.
    fn luminance([r, g, b, _]: Opaque) -> f32 {
        let [r, g, b] = [r, g, b].map(|channel| {
            let c = f32::from(channel) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    fn contrast(a: Opaque, b: Opaque) -> f32 {
        let [low, high] = { [luminance(a).min(luminance(b)), luminance(a).max(luminance(b))] };
        (high + 0.05) / (low + 0.05)
    }

    #[test]
    fn what_overlays_show_stands_out_in_both_themes() {
        for ground in [Ground::Dark, Ground::Light] {
            let palette = OverlayPalette::new(ground, LevelColors::new(Colormap::Viridis, ground, 10));
            let neutral = palette.neutral();
            for (what, color) in [
                ("slack", palette.slack(MOST_SLACK)),
                ("age", palette.age(Some(0))),
                ("forced", palette.forced(true)),
                ("risk", palette.risk(255)),
                ("a mesh that is too deep", palette.depth_error(MOST_ERROR)),
                ("a mesh that is too shallow", palette.depth_error(-MOST_ERROR)),
                ("a small angle", palette.quality(QualityMeasure::SmallestAngle, 10.0)),
                ("a large angle", palette.quality(QualityMeasure::LargestAngle, 170.0)),
                ("a long triangle", palette.quality(QualityMeasure::EdgeRatio, 4.0)),
                ("an edge longer than h̄", palette.quality(QualityMeasure::TargetRatio, 2.0)),
                ("many triangles at a node", palette.quality(QualityMeasure::Valence, 10.0)),
                ("a short link", palette.quality(QualityMeasure::LinkLength, 0.09)),
                ("a skewed link", palette.quality(QualityMeasure::LinkCosine, 0.5)),
                ("the least time step", palette.quality(QualityMeasure::TimeStep, 1.0)),
            ] {
                assert!(contrast(color, neutral) > 3.0, "{what} {ground:?}: {}", contrast(color, neutral));
            }
            let step = contrast(palette.age(Some(0)), palette.age(Some(3)));
            assert!(step > 1.5, "ages differ in {ground:?}: {step}");
            let depths: Vec<f32> = (0..=8).map(|n| luminance(palette.water(n as f32 / 8.0))).collect();
            assert!(depths.windows(2).all(|pair| pair[1] < pair[0]), "deeper is darker: {depths:?}");
            assert_eq!([palette.depth_error(f32::NAN), palette.depth_error(0.0)], [neutral; 2]);
            assert_eq!([palette.slack(0.0), palette.slack(f32::NAN), palette.age(None)], [neutral; 3]);
            let good = [
                (QualityMeasure::SmallestAngle, 45.0),
                (QualityMeasure::LargestAngle, 90.0),
                (QualityMeasure::EdgeRatio, 1.42),
                (QualityMeasure::TargetRatio, 1.0),
                (QualityMeasure::TimeStep, 16.0),
                (QualityMeasure::Valence, 8.0),
                (QualityMeasure::LinkLength, 0.5),
                (QualityMeasure::LinkCosine, 0.0),
            ];
            for (measure, number) in good {
                assert_eq!(palette.quality(measure, number), neutral, "{measure:?}");
            }
        }
    }
}
