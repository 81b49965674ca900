//! The colours of overlays. The legend shows the same colours as the canvas: both take them from here.

use crate::app::features::layers::layer_color32;
use meshbrush_core::layers::LayerId;
use meshbrush_render::colormap::{Ground, LevelColors};

/// A colour as sRGB bytes, opaque.
pub type Opaque = [u8; 4];

/// Halvings from which on slack has its strongest colour.
pub const MOST_SLACK: f32 = 4.0;
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
        layer.map_or(self.neutral(), |id| layer_color32(id).to_array())
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

    /// Returns a colour from neutral to one that stands out in the theme, by a share from 0 to 1.
    fn emphasised(&self, share: f32) -> Opaque {
        let strongest = match self.ground {
            Ground::Dark => [0xff; 4],
            Ground::Light => [0x1c, 0x2f, 0x74, 0xff],
        };
        mixed(self.neutral(), strongest, share)
    }
}

fn mixed(from: Opaque, to: Opaque, share: f32) -> Opaque {
    let mix = |i: usize| f32::from(from[i]) + share * (f32::from(to[i]) - f32::from(from[i]));
    std::array::from_fn(|i| mix(i).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshbrush_render::colormap::Colormap;

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
            ] {
                assert!(contrast(color, neutral) > 3.0, "{what} {ground:?}: {}", contrast(color, neutral));
            }
            let step = contrast(palette.age(Some(0)), palette.age(Some(3)));
            assert!(step > 1.5, "ages differ in {ground:?}: {step}");
            assert_eq!([palette.slack(0.0), palette.slack(f32::NAN), palette.age(None)], [neutral; 3]);
        }
    }
}
