//! The letters of the window's fonts as outlines, for drawings.

use meshbrush_study::drawing::{Letters, OutlinePart, TextOutline, Weight};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider as _};

use crate::theme::{INTER, INTER_SEMIBOLD, JETBRAINS_MONO};

/// The fonts in which the window writes text.
pub struct WindowLetters {
    regular: Vec<FontRef<'static>>,
    semi_bold: Vec<FontRef<'static>>,
}

impl Default for WindowLetters {
    fn default() -> Self {
        let fonts = |files: &[&'static [u8]]| -> Vec<FontRef<'static>> {
            files.iter().filter_map(|file| FontRef::new(file).ok()).collect()
        };
        Self {
            regular: fonts(&[INTER, JETBRAINS_MONO]),
            semi_bold: fonts(&[INTER_SEMIBOLD, INTER, JETBRAINS_MONO]),
        }
    }
}

impl Letters for WindowLetters {
    /// A sign that no font has is left out, with room for a letter.
    fn outline(&self, text: &str, size_px: f64, weight: Weight) -> TextOutline {
        let fonts = if weight == Weight::SemiBold { &self.semi_bold } else { &self.regular };
        let (size, location) = (Size::new(size_px as f32), LocationRef::default());
        let mut pen = LinePen::default();
        for sign in text.chars() {
            let found = fonts.iter().find_map(|font| Some((font, font.charmap().map(sign)?)));
            let Some((font, glyph)) = found else {
                pen.left += 0.5 * size_px;
                continue;
            };
            if let Some(outline) = font.outline_glyphs().get(glyph) {
                // What is drawn until an error stays.
                _ = outline.draw(DrawSettings::unhinted(size, location), &mut pen);
            }
            let advance = font.glyph_metrics(size, location).advance_width(glyph);
            pen.left += f64::from(advance.unwrap_or_default());
        }
        TextOutline { parts: pen.parts, width: pen.left }
    }
}

/// Takes the outlines of one letter after the other.
#[derive(Default)]
struct LinePen {
    parts: Vec<OutlinePart>,
    /// Where the present letter begins.
    left: f64,
}

impl LinePen {
    /// Returns a point of the present letter in the line: in a font, y is up.
    fn at(&self, x: f32, y: f32) -> [f64; 2] {
        [self.left + f64::from(x), -f64::from(y)]
    }
}

impl OutlinePen for LinePen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.parts.push(OutlinePart::Move(self.at(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.parts.push(OutlinePart::Line(self.at(x, y)));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.parts.push(OutlinePart::Quadratic([self.at(cx, cy), self.at(x, y)]));
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.parts.push(OutlinePart::Cubic([self.at(ax, ay), self.at(bx, by), self.at(x, y)]));
    }

    fn close(&mut self) {
        self.parts.push(OutlinePart::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns left, top, right and bottom of the points on an outline.
    fn bounds(outline: &TextOutline) -> [f64; 4] {
        let point = |part: &OutlinePart| match *part {
            OutlinePart::Move(at) | OutlinePart::Line(at) => Some(at),
            OutlinePart::Quadratic([_, at]) | OutlinePart::Cubic([_, _, at]) => Some(at),
            OutlinePart::Close => None,
        };
        let far = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        outline.parts.iter().filter_map(point).fold(far, |[left, top, right, bottom], [x, y]| {
            [left.min(x), top.min(y), right.max(x), bottom.max(y)]
        })
    }

    #[test]
    fn every_sign_of_names_and_sentences_has_an_outline_in_both_weights() {
        let letters = WindowLetters::default();
        for weight in [Weight::Regular, Weight::SemiBold] {
            for sign in "iībdnvNxS_β₁₂₃[]=−0123456789,;:.’abcABC()ℓ".chars() {
                let outline = letters.outline(&sign.to_string(), 20.0, weight);
                assert!(!outline.parts.is_empty() && outline.width > 1.0, "{sign} {weight:?}");
            }
        }
    }

    #[test]
    fn letters_stand_on_the_line_one_after_the_other_and_grow_with_their_size() {
        let letters = WindowLetters::default();
        let [one, two] = ["1", "11"].map(|text| letters.outline(text, 20.0, Weight::Regular));
        assert!((two.width - 2.0 * one.width).abs() < 1e-6 && two.parts.len() == 2 * one.parts.len());
        let [left, top, right, bottom] = bounds(&letters.outline("H", 100.0, Weight::SemiBold));
        assert!(left > 0.0 && right < 100.0 && bottom.abs() < 1.0, "{left} {right} {bottom}");
        assert!((-76.0..-68.0).contains(&top), "capitals are this high: {top}");
        let large = letters.outline("i = 57", 40.0, Weight::Regular);
        let small = letters.outline("i = 57", 20.0, Weight::Regular);
        assert!((large.width - 2.0 * small.width).abs() < 0.1, "{} {}", large.width, small.width);
    }
}
