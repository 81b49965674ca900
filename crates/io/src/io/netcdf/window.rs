//! The part of a grid that a window needs, also where it crosses the seam of a grid around the Earth.

use std::ops::Range;

/// Evenly spaced coordinates of the centres of pixels, in the order of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) first: f64,
    /// Negative where coordinates decrease.
    pub(super) step: f64,
    /// At least two.
    pub(super) count: u64,
}

/// Degrees around the Earth.
const AROUND: f64 = 360.0;
/// Pixels that are read beyond each side of a window, for the interpolation at its sides.
const MARGIN: i64 = 1;
/// How far the pixels around the Earth may end from where they began, as a share of a pixel.
const MOST_GAP: f64 = 0.05;
/// Pixels farther than this from a grid are not counted.
const FAR: f64 = 1e12;

/// A row of pixels that are read along an axis, with increasing coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Span {
    /// The outer edges.
    pub(super) bounds: [f64; 2],
    pub(super) count: u64,
    /// Whether coordinates decrease in the file.
    pub(super) is_reversed: bool,
    /// Parts that lie together in the file. Pixels between them have no value.
    pub(super) pieces: Vec<PixelRun>,
}

/// Pixels that lie together in the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PixelRun {
    /// Their numbers in the file.
    pub(super) file: Range<u64>,
    /// The number of the first one in the span.
    pub(super) at: u64,
}

impl Span {
    /// Returns the numbers in the file of some pixels of a span in one piece, counted from its first pixel.
    pub(super) fn rows(&self, from: u64, count: u64) -> Range<u64> {
        let Range { start, end } = self.pieces[0].file;
        if self.is_reversed { end - from - count..end - from } else { start + from..start + from + count }
    }
}

impl Axis {
    /// Returns the span of all pixels.
    pub(super) fn whole(&self) -> Span {
        let all = 0..self.count as i64;
        self.span(0, all.clone(), vec![all])
    }

    /// Returns the outer edges of all pixels.
    pub(super) fn bounds(&self) -> [f64; 2] {
        let (low, step) = (self.low(), self.step.abs());
        [low, low + self.count as f64 * step]
    }

    /// Returns the pixels that meet a window, and one more beyond each side; `None` where there is none.
    /// Longitudes repeat: pixels are where the window is.
    ///
    /// A window of `most` pixels or more may give less than all pixels.
    pub(super) fn within(&self, window: [f64; 2], is_longitude: bool, most: u64) -> Option<Span> {
        if !is_longitude {
            return self.plain(window, 0.0);
        }
        let around = AROUND / self.step.abs();
        if (around - around.round()).abs() > MOST_GAP || around.round() < 2.0 {
            return self.nearest_turn(window);
        }
        let around = around.round() as i64;
        let pixels = self.pixels(window, 0.0);
        let pixels = pixels.start..pixels.end.min(pixels.start.saturating_add(most as i64 + 1));
        let mut parts = Vec::new();
        let mut next = pixels.start;
        while next < pixels.end {
            let number = next.rem_euclid(around);
            let length = around.min(self.count as i64) - number;
            if length > 0 {
                let end = (next + length).min(pixels.end);
                parts.push(next..end);
                next = end;
            } else {
                next += around - number;
            }
        }
        let all = parts.first()?.start..parts.last()?.end;
        Some(self.span(around, all, parts))
    }

    /// Returns the pixels in a window, for the whole number of turns after which most of them are in it.
    fn nearest_turn(&self, window: [f64; 2]) -> Option<Span> {
        let [low, high] = self.bounds();
        let middle = ((window[0] + window[1] - low - high) / (2.0 * AROUND)).round();
        let spans = [0.0, -1.0, 1.0].map(|further| self.plain(window, AROUND * (middle + further)));
        spans.into_iter().flatten().reduce(|best, span| if span.count > best.count { span } else { best })
    }

    fn plain(&self, window: [f64; 2], shift: f64) -> Option<Span> {
        let pixels = self.pixels(window, shift);
        let all = pixels.start.max(0)..pixels.end.min(self.count as i64);
        if all.is_empty() {
            return None;
        }
        let mut span = self.span(0, all.clone(), vec![all]);
        span.bounds = span.bounds.map(|bound| bound + shift);
        Some(span)
    }

    /// Returns the numbers of pixels in a window, as if there were pixels everywhere; that with the lowest
    /// coordinate is 0.
    fn pixels(&self, [low, high]: [f64; 2], shift: f64) -> Range<i64> {
        let number = |at: f64| ((at - shift - self.low()) / self.step.abs()).clamp(-FAR, FAR);
        number(low).floor() as i64 - MARGIN..number(high).ceil() as i64 + MARGIN
    }

    /// The lowest edge.
    fn low(&self) -> f64 {
        let step = self.step.abs();
        let lowest = if self.step < 0.0 { self.first - step * (self.count - 1) as f64 } else { self.first };
        lowest - step / 2.0
    }

    /// Returns a span from numbers of pixels, which repeat after so many pixels.
    fn span(&self, around: i64, all: Range<i64>, parts: Vec<Range<i64>>) -> Span {
        let (low, step) = (self.low(), self.step.abs());
        let piece = |part: &Range<i64>| {
            let start = if around > 0 { part.start.rem_euclid(around) } else { part.start } as u64;
            let count = (part.end - part.start) as u64;
            let start = if self.step < 0.0 { self.count - start - count } else { start };
            PixelRun { file: start..start + count, at: (part.start - all.start) as u64 }
        };
        Span {
            bounds: [all.start, all.end].map(|edge| low + edge as f64 * step),
            count: (all.end - all.start) as u64,
            is_reversed: self.step < 0.0,
            pieces: parts.iter().map(piece).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: u64 = 65_536;

    fn pieces(span: &Span) -> Vec<(Range<u64>, u64)> {
        span.pieces.iter().map(|piece| (piece.file.clone(), piece.at)).collect()
    }

    #[test]
    fn a_window_takes_the_pixels_that_it_meets_and_one_more() {
        let axis = Axis { first: 10.5, step: 1.0, count: 20 };
        let span = axis.within([13.2, 15.0], false, MOST).unwrap();
        assert_eq!((span.bounds, span.count, pieces(&span)), ([12.0, 16.0], 4, vec![(2..6, 0)]));
        let turned = Axis { first: 29.5, step: -1.0, count: 20 };
        let span = turned.within([13.2, 15.0], false, MOST).unwrap();
        assert_eq!((span.bounds, pieces(&span)), ([12.0, 16.0], vec![(14..18, 0)]));
        let all = axis.within([-1e300, 1e300], false, MOST).unwrap();
        assert_eq!((all.clone(), axis.bounds()), (axis.whole(), [10.0, 30.0]));
        assert_eq!(axis.within([40.0, 50.0], false, MOST), None);
        assert_eq!(axis.within([40.0, 50.0], true, MOST), None);
    }

    #[test]
    fn a_window_across_the_seam_joins_two_parts() {
        // 0 to 360, and −180 to 180, in both orders.
        for first in [0.5, -179.5] {
            let up = Axis { first, step: 1.0, count: 360 };
            let down = Axis { first: first + 359.0, step: -1.0, count: 360 };
            for window in [[350.0, 370.0], [-10.0, 10.0], [170.0, 190.0], [-190.0, -170.0], [0.0, 20.0]] {
                for axis in [up, down] {
                    let span = axis.within(window, true, MOST).unwrap();
                    assert_eq!((span.bounds, span.count), ([window[0] - 1.0, window[1] + 1.0], 22));
                    let mut found = vec![f64::NAN; 22];
                    for piece in &span.pieces {
                        let numbers: Vec<u64> = match axis.step > 0.0 {
                            true => piece.file.clone().collect(),
                            false => piece.file.clone().rev().collect(),
                        };
                        for (to, from) in found[piece.at as usize..].iter_mut().zip(numbers) {
                            *to = axis.first + axis.step * from as f64;
                        }
                    }
                    for (number, longitude) in found.into_iter().enumerate() {
                        let expected = window[0] - 0.5 + number as f64;
                        assert_eq!((longitude - expected).rem_euclid(360.0), 0.0, "{axis:?} {window:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn nodes_that_repeat_at_the_seam_are_read_once() {
        let axis = Axis { first: -180.0, step: 1.0, count: 361 };
        let span = axis.within([178.0, 182.0], true, MOST).unwrap();
        // Pixels around 177 to 183; the one around 180 is the first in the file.
        assert_eq!((span.bounds, span.count), ([176.5, 183.5], 7));
        assert_eq!(pieces(&span), [(357..360, 0), (0..4, 3)]);
    }

    #[test]
    fn a_grid_of_a_part_of_the_earth_lies_where_the_window_is() {
        let axis = Axis { first: 350.05, step: 0.1, count: 200 };
        let span = axis.within([-8.0, -7.0], true, MOST).unwrap();
        assert!((span.bounds[0] + 8.1).abs() < 1e-9 && (span.bounds[1] + 6.9).abs() < 1e-9, "{span:?}");
        // From both sides of the seam of the window, with no values between.
        let axis = Axis { first: 170.5, step: 1.0, count: 20 };
        let span = axis.within([-180.0, 180.0], true, MOST).unwrap();
        assert_eq!(pieces(&span), [(9..20, 0), (0..11, 351)]);
        // Steps that do not meet after a turn.
        let odd = Axis { first: 200.0, step: 0.7, count: 10 };
        let span = odd.within([-200.0, 0.0], true, MOST).unwrap();
        assert_eq!((span.count, pieces(&span)), (10, vec![(0..10, 0)]));
        assert!((span.bounds[0] + 160.35).abs() < 1e-9, "{span:?}");
    }

    #[test]
    fn a_window_of_any_width_ends() {
        for step in [1e-7, 1.0, 100.0, 359.0, 1e5] {
            let axis = Axis { first: 0.0, step, count: 3 };
            for window in [[-1e300, 1e300], [-1e9, 1e9], [f64::MIN, f64::MAX], [f64::NAN, 1.0]] {
                let span = axis.within(window, true, MOST);
                assert!(span.is_none_or(|span| span.pieces.len() as u64 <= MOST), "{step} {window:?}");
            }
        }
    }
}
