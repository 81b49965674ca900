//! A drawing as outlines with colours: lengths in pixels, x to the right and y down. Text is drawn as the
//! outlines of its letters, so that it looks alike everywhere.

mod svg;

use std::ops::Range;

/// A part of an outline: each begins where the one before it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutlinePart {
    /// Begins a new piece.
    Move([f64; 2]),
    /// A straight line.
    Line([f64; 2]),
    /// A quadratic Bézier curve: its control point and its end.
    Quadratic([[f64; 2]; 2]),
    /// A cubic Bézier curve: its control points and its end.
    Cubic([[f64; 2]; 3]),
    /// A straight line to where the piece began.
    Close,
}

impl OutlinePart {
    /// Returns the part with `f` applied to each of its points.
    pub fn map(self, f: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        match self {
            Self::Move(to) => Self::Move(f(to)),
            Self::Line(to) => Self::Line(f(to)),
            Self::Quadratic(points) => Self::Quadratic(points.map(f)),
            Self::Cubic(points) => Self::Cubic(points.map(f)),
            Self::Close => Self::Close,
        }
    }

    /// Returns the letter of the part in the language of paths of SVG, and its points.
    pub fn letter_and_points(&self) -> (char, &[[f64; 2]]) {
        match self {
            Self::Move(to) => ('M', std::slice::from_ref(to)),
            Self::Line(to) => ('L', std::slice::from_ref(to)),
            Self::Quadratic(points) => ('Q', points),
            Self::Cubic(points) => ('C', points),
            Self::Close => ('Z', &[]),
        }
    }
}

/// The outlines of a line of text that begins at 0, 0 on its baseline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextOutline {
    /// The outlines of all letters.
    pub parts: Vec<OutlinePart>,
    /// How far the text advances.
    pub width: f64,
}

/// How heavy letters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// As in running text.
    Regular,
    /// As in names.
    SemiBold,
}

/// Letters as outlines, such as those of a font.
pub trait Letters {
    /// Returns the outlines of a text whose letters have a size in pixels.
    fn outline(&self, text: &str, size_px: f64, weight: Weight) -> TextOutline;
}

/// Height of capital letters and digits over the size of letters.
const CAPITALS: f64 = 0.727;
/// Width of the halo of a text on each side, over the size of its letters.
const HALO: f64 = 0.14;
/// Distance of the control points of a quarter of a circle from its ends, over the radius.
const QUARTER: f64 = 0.552_284_75;

/// An outline with its colours, red, green, blue and opacity. The line is drawn over the filling.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnShape {
    /// The outline.
    pub parts: Vec<OutlinePart>,
    /// The colour within it.
    pub fill: Option<[u8; 4]>,
    /// The colour of a line along it, and its width.
    pub line: Option<([u8; 4], f64)>,
}

/// Shapes that belong together, from the lowest to the topmost.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawingGroup {
    /// Its name.
    pub name: &'static str,
    /// Its shapes.
    pub shapes: Vec<DrawnShape>,
    /// The texts among them, with the shapes that draw each.
    pub texts: Vec<(String, Range<usize>)>,
}

/// A drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Width and height.
    pub size: [f64; 2],
    /// What it shows.
    pub title: String,
    /// The colour behind everything.
    pub ground: [u8; 3],
    /// From the lowest to the topmost.
    pub groups: Vec<DrawingGroup>,
}

/// How a text is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextStyle {
    /// The size of letters.
    pub size: f64,
    /// How heavy they are.
    pub weight: Weight,
    /// Their colour.
    pub color: [u8; 3],
    /// The colour of what separates them from what is below.
    pub halo: Option<[u8; 3]>,
}

impl TextStyle {
    /// Returns the width and height that a text takes, with its halo.
    pub fn room(&self, letters: &dyn Letters, text: &str) -> [f64; 2] {
        let around = if self.halo.is_some() { 2.0 * HALO * self.size } else { 0.0 };
        let width = letters.outline(text, self.size, self.weight).width;
        // Brackets, commas and ȷ reach below the baseline.
        [width + around, (CAPITALS + 0.2) * self.size + around]
    }
}

impl DrawingGroup {
    /// Creates a group without shapes.
    pub fn new(name: &'static str) -> Self {
        Self { name, shapes: Vec::new(), texts: Vec::new() }
    }

    /// Adds a polygon.
    pub fn polygon(&mut self, corners: &[[f64; 2]], fill: Option<[u8; 4]>, line: Option<([u8; 4], f64)>) {
        let mut parts = path(corners);
        parts.push(OutlinePart::Close);
        self.shapes.push(DrawnShape { parts, fill, line });
    }

    /// Adds a line through points.
    pub fn line(&mut self, points: &[[f64; 2]], color: [u8; 4], width: f64) {
        self.shapes.push(DrawnShape { parts: path(points), fill: None, line: Some((color, width)) });
    }

    /// Adds a disc.
    pub fn disc(&mut self, [x, y]: [f64; 2], radius: f64, fill: [u8; 4], line: ([u8; 4], f64)) {
        let at = |dx: f64, dy: f64| [x + radius * dx, y + radius * dy];
        let quarter = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2]| {
            let from = at(ax + QUARTER * bx, ay + QUARTER * by);
            OutlinePart::Cubic([from, at(bx + QUARTER * ax, by + QUARTER * ay), at(bx, by)])
        };
        let ends = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]];
        let mut parts = vec![OutlinePart::Move(at(1.0, 0.0))];
        parts.extend(ends.windows(2).map(|ends| quarter(ends[0], ends[1])));
        parts.push(OutlinePart::Close);
        self.shapes.push(DrawnShape { parts, fill: Some(fill), line: Some(line) });
    }

    /// Adds a text with its middle at a place.
    pub fn centered(&mut self, letters: &dyn Letters, text: &str, [x, y]: [f64; 2], style: &TextStyle) {
        let width = letters.outline(text, style.size, style.weight).width;
        self.text(letters, text, [x - 0.5 * width, y + 0.5 * CAPITALS * style.size], style);
    }

    /// Adds a text that begins at a place on its baseline: below it its halo, as a copy with a wide line.
    pub fn text(&mut self, letters: &dyn Letters, text: &str, [x, y]: [f64; 2], style: &TextStyle) {
        let outline = letters.outline(text, style.size, style.weight);
        let moved = |[dx, dy]: [f64; 2]| [x + dx, y + dy];
        let parts: Vec<OutlinePart> = outline.parts.into_iter().map(|part| part.map(moved)).collect();
        let first = self.shapes.len();
        if let Some(halo) = style.halo.map(opaque) {
            let line = Some((halo, 2.0 * HALO * style.size));
            self.shapes.push(DrawnShape { parts: parts.clone(), fill: Some(halo), line });
        }
        self.shapes.push(DrawnShape { parts, fill: Some(opaque(style.color)), line: None });
        self.texts.push((text.to_owned(), first..self.shapes.len()));
    }
}

/// Returns a colour through which nothing is seen.
pub fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 0xff]
}

fn path(points: &[[f64; 2]]) -> Vec<OutlinePart> {
    let part = |(at, &point): (usize, &[f64; 2])| match at {
        0 => OutlinePart::Move(point),
        _ => OutlinePart::Line(point),
    };
    points.iter().enumerate().map(part).collect()
}

/// Breaks a text between words into lines of at most a width.
pub fn wrapped(letters: &dyn Letters, text: &str, width: f64, style: &TextStyle) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        let fits = |line: &String| letters.outline(line, style.size, style.weight).width <= width;
        match (lines.last_mut(), longer.filter(fits)) {
            (Some(last), Some(longer)) => *last = longer,
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Letters of boxes, each 0.6 times as wide as high.
#[cfg(test)]
pub struct BoxLetters;

#[cfg(test)]
impl Letters for BoxLetters {
    fn outline(&self, text: &str, size_px: f64, _: Weight) -> TextOutline {
        let mut group = DrawingGroup::new("letters");
        let count = text.chars().count();
        for letter in 0..count {
            let left = 0.6 * size_px * letter as f64;
            let [right, top] = [left + 0.5 * size_px, -0.7 * size_px];
            group.polygon(&[[left, 0.0], [right, 0.0], [right, top], [left, top]], None, None);
        }
        let parts = group.shapes.into_iter().flat_map(|shape| shape.parts).collect();
        TextOutline { parts, width: 0.6 * size_px * count as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STYLE: TextStyle =
        TextStyle { size: 10.0, weight: Weight::Regular, color: [1, 2, 3], halo: Some([9; 3]) };

    fn points(shape: &DrawnShape) -> Vec<[f64; 2]> {
        let point = |part: &OutlinePart| match *part {
            OutlinePart::Move(at) | OutlinePart::Line(at) => Some(at),
            OutlinePart::Quadratic([_, at]) | OutlinePart::Cubic([_, _, at]) => Some(at),
            OutlinePart::Close => None,
        };
        shape.parts.iter().filter_map(point).collect()
    }

    #[test]
    fn a_text_lies_around_its_middle_over_its_halo() {
        let mut group = DrawingGroup::new("names");
        group.centered(&BoxLetters, "i = 57", [100.0, 50.0], &STYLE);
        let [halo, letters] = &group.shapes[..] else { panic!("{:?}", group.shapes) };
        assert_eq!(halo.parts, letters.parts);
        assert_eq!((halo.fill, letters.fill), (Some([9, 9, 9, 255]), Some([1, 2, 3, 255])));
        assert!(halo.line.is_some_and(|(color, width)| color == [9, 9, 9, 255] && width > 1.0));
        assert_eq!(letters.line, None);
        let all = points(letters);
        let ends = |axis: usize| {
            let values = all.iter().map(|point| point[axis]);
            (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
        };
        let [(left, right), (top, bottom)] = [ends(0), ends(1)];
        assert!((left - 82.0).abs() < 0.01 && (right - 117.0).abs() < 0.01, "{left} to {right}");
        assert!((0.5 * (top + bottom) - 50.0).abs() < 0.5, "{top} to {bottom}");
        let [width, height] = STYLE.room(&BoxLetters, "i = 57");
        assert!(width > right - left && height > bottom - top);
        assert_eq!(group.texts, [("i = 57".to_owned(), 0..2)]);
    }

    #[test]
    fn a_disc_is_round() {
        let mut group = DrawingGroup::new("nodes");
        group.disc([10.0, 20.0], 5.0, [0; 4], ([0; 4], 1.0));
        let shape = &group.shapes[0];
        for [x, y] in points(shape) {
            assert!((libm::hypot(x - 10.0, y - 20.0) - 5.0).abs() < 1e-9);
        }
        let mut last = [15.0, 20.0];
        for part in &shape.parts {
            let OutlinePart::Cubic([a, b, end]) = *part else { continue };
            let middle = [0, 1].map(|axis| (last[axis] + 3.0 * (a[axis] + b[axis]) + end[axis]) / 8.0);
            let radius = libm::hypot(middle[0] - 10.0, middle[1] - 20.0);
            assert!((radius - 5.0).abs() < 0.01, "{radius}");
            last = end;
        }
        assert_eq!(last, [15.0, 20.0]);
    }

    #[test]
    fn lines_break_between_words_and_are_not_wider_than_asked() {
        let text = "The edge of triangle 78 is on the boundary";
        let lines = wrapped(&BoxLetters, text, 90.0, &STYLE);
        assert_eq!(lines.join(" "), text);
        assert!(lines.len() >= 3 && lines.iter().all(|line| line.len() <= 15), "{lines:?}");
        assert_eq!(wrapped(&BoxLetters, "unbreakable", 10.0, &STYLE), ["unbreakable"]);
    }
}
