//! The colours of paths. None is like those of levels or of risk, and colour-blind people can tell them
//! apart.

use eframe::egui::Color32;

/// The colours of paths, in turn.
const PATHS: [[u8; 3]; 4] = [[0xe6, 0x1e, 0x9c], [0x5a, 0xcc, 0xff], [0xfa, 0xfa, 0xfa], [0x6a, 0x1c, 0xd8]];

/// The colour of the alternatives of a path.
pub const ALTERNATIVE_COLOR: Color32 = Color32::from_rgb(0x8a, 0x94, 0xa6);
/// The colour of the path that is pointed at in a list or a plot.
pub const POINTED_COLOR: Color32 = Color32::WHITE;

/// Returns the colour of the path with this number, from 0.
pub fn path_color(number: usize) -> Color32 {
    let [r, g, b] = PATHS[number % PATHS.len()];
    Color32::from_rgb(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshbrush_render::colormap::{Colormap, Ground, LevelColors};

    fn linear(color: [u8; 3]) -> [f32; 3] {
        color.map(|channel| (f32::from(channel) / 255.0).powf(2.2))
    }

    /// How a person sees a colour who lacks the receptor for green: F. Viénot, H. Brettel and J. D. Mollon,
    /// “Digital video colourmaps for checking the legibility of displays by dichromats”, 1999.
    fn without_green(color: [u8; 3]) -> [f32; 3] {
        let [r, g, b] = linear(color);
        let yellow = 0.292_75 * r + 0.707_25 * g;
        [yellow, yellow, -0.022_34 * r + 0.022_34 * g + b]
    }

    /// The distance of two colours by their cube roots, which are about even steps for the eye.
    fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
        let step = |i: usize| a[i].max(0.0).cbrt() - b[i].max(0.0).cbrt();
        (step(0).powi(2) + step(1).powi(2) + step(2).powi(2)).sqrt()
    }

    #[test]
    fn paths_differ_from_each_other_also_for_color_blind_people() {
        for (n, &a) in PATHS.iter().enumerate() {
            for &b in &PATHS[n + 1..] {
                assert!(distance(linear(a), linear(b)) > 0.3, "{a:?} {b:?}");
                let seen = distance(without_green(a), without_green(b));
                assert!(seen > 0.2, "{a:?} {b:?}: {seen}");
            }
        }
    }

    #[test]
    fn paths_differ_from_levels_and_from_risk() {
        for ground in [Ground::Dark, Ground::Light] {
            let levels = LevelColors::new(Colormap::Viridis, ground, 12);
            let risk = [0xff, 0x3a, 0x3c];
            let others = (1..=12).map(|level| levels.of(level)).map(|[r, g, b, _]| [r, g, b]).chain([risk]);
            for other in others {
                for path in PATHS {
                    let apart = distance(linear(path), linear(other));
                    assert!(apart > 0.25, "{path:?} {other:?} {ground:?}: {apart}");
                }
            }
        }
    }
}
