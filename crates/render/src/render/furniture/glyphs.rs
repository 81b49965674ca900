//! Letters as outlines: text that every reader of a picture draws alike, without a font.

use std::sync::LazyLock;

use glam::{DVec2, dvec2};
use meshbrush_study::drawing::OutlinePart;

/// Height of capital letters and of digits, as a share of the size of a text.
pub const CAPITAL: f64 = 0.727;

/// The bar of h̄, which stands over the letter before it.
const BAR_ABOVE: char = '\u{304}';
/// Height of the letters that the font makes the bar for, as a share of the size of a text.
const BELOW_BAR: f64 = 0.545;

/// Outlines of the letters of a font, by letter.
static GLYPHS: LazyLock<Vec<Glyph>> =
    LazyLock::new(|| include_str!("../../../assets/glyphs.txt").lines().filter_map(Glyph::read).collect());

/// A letter, in shares of the size of a text, from the left end of its baseline.
struct Glyph {
    letter: char,
    advance: f64,
    outline: Vec<OutlinePart>,
}

impl Glyph {
    /// Reads a line of the table; a remark is none.
    fn read(line: &str) -> Option<Self> {
        let mut words = line.split(' ');
        let letter = char::from_u32(words.next()?.parse().ok()?)?;
        let advance = thousandths(&mut words)?;
        let mut outline = Vec::new();
        while let Some(word) = words.next() {
            outline.push(match word {
                "M" => OutlinePart::Move(point(&mut words)?),
                "L" => OutlinePart::Line(point(&mut words)?),
                "Q" => OutlinePart::Quadratic([point(&mut words)?, point(&mut words)?]),
                _ => OutlinePart::Close,
            });
        }
        Some(Self { letter, advance, outline })
    }

    /// Returns how far it reaches above the baseline.
    fn top(&self) -> f64 {
        let ends = self.outline.iter().filter_map(|part| part.letter_and_points().1.last().copied());
        ends.fold(0.0, |top, [_, y]| top.max(-y))
    }

    /// Returns a letter; a question mark for one that the table has not.
    fn of(letter: char) -> &'static Self {
        let place = |letter: char| GLYPHS.binary_search_by_key(&letter, |glyph| glyph.letter).ok();
        let index = place(letter).or_else(|| place('?')).unwrap_or(0);
        &GLYPHS[index]
    }
}

fn thousandths<'a>(words: &mut impl Iterator<Item = &'a str>) -> Option<f64> {
    Some(words.next()?.parse::<f64>().ok()? / 1000.0)
}

fn point<'a>(words: &mut impl Iterator<Item = &'a str>) -> Option<[f64; 2]> {
    Some([thousandths(words)?, thousandths(words)?])
}

/// Returns the width of a letter and where it begins within it: digits are equally wide, so that numbers
/// stand below each other.
fn advance(letter: char) -> (f64, f64) {
    let own = Glyph::of(letter).advance;
    if !letter.is_ascii_digit() {
        return (own, 0.0);
    }
    let widest = Glyph::of('4').advance;
    (widest, 0.5 * (widest - own))
}

/// Returns the width of a text of a size, in pixels.
pub fn width(text: &str, size_px: f64) -> f64 {
    size_px * text.chars().map(|letter| advance(letter).0).sum::<f64>()
}

/// Returns the outline of a text of a size in pixels, from the left end of its baseline. Contours are filled
/// by the nonzero rule.
pub fn outline(text: &str, at: DVec2, size_px: f64) -> Vec<OutlinePart> {
    let mut parts = Vec::new();
    let (mut pen, mut top) = (at, 0.0);
    for letter in text.chars() {
        let (width, from) = advance(letter);
        // Over a tall letter, the bar is as much higher.
        let rise = if letter == BAR_ABOVE { (top - BELOW_BAR).max(0.0) } else { 0.0 };
        let begin = pen + dvec2(from, -rise) * size_px;
        top = Glyph::of(letter).top();
        let of_letter = Glyph::of(letter).outline.iter();
        parts.extend(of_letter.map(|part| part.map(|point| (begin + size_px * DVec2::from(point)).into())));
        pen.x += width * size_px;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_every_letter_that_furniture_is_written_with() {
        assert!(GLYPHS.is_sorted_by_key(|glyph| glyph.letter), "it is searched by halving");
        let letters = "Level, diameter in km, count 0123456789.,-−°′″ NSEWM×≈ h̄ ≤≥ Größe Łódź Ψθ “–”";
        for letter in letters.chars() {
            assert_eq!(Glyph::of(letter).letter, letter);
            assert!(letter == ' ' || !Glyph::of(letter).outline.is_empty(), "{letter}");
        }
        assert_eq!(Glyph::of('語').letter, '?');
    }

    #[test]
    fn the_bar_of_h_is_over_it_and_takes_no_room() {
        let points = |text: &str| -> Vec<DVec2> {
            let parts = outline(text, DVec2::ZERO, 100.0);
            parts.iter().flat_map(|part| part.letter_and_points().1.to_vec()).map(DVec2::from).collect()
        };
        let (alone, with_bar) = (points("h"), points("h̄"));
        let top = alone.iter().map(|at| at.y).fold(0.0, f64::min);
        let bar = &with_bar[alone.len()..];
        assert!(!bar.is_empty() && bar.iter().all(|at| at.y < top && at.x > 0.0 && at.x < width("h", 100.0)));
        assert_eq!(width("h̄", 100.0), width("h", 100.0));
    }

    #[test]
    fn letters_are_within_the_width_and_the_height_of_their_text() {
        let (size, at) = (20.0, dvec2(30.0, 50.0));
        let text = "N 48°";
        let ends = outline(text, at, size).into_iter().filter_map(|part| match part {
            OutlinePart::Move(at) | OutlinePart::Line(at) => Some(DVec2::from(at)),
            OutlinePart::Quadratic([_, at]) | OutlinePart::Cubic([_, _, at]) => Some(DVec2::from(at)),
            OutlinePart::Close => None,
        });
        for end in ends {
            assert!(end.x >= at.x && end.x <= at.x + width(text, size), "{end}");
            assert!(end.y <= at.y + 0.02 * size && end.y >= at.y - 1.05 * CAPITAL * size, "{end}");
        }
        assert_eq!(width("11", size), width("80", size), "digits stand below each other");
    }
}
