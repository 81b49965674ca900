//! Lines of coast in a frame: joined where they meet, and closed along the frame.

use glam::DVec2;

use super::Ring;
use crate::geometry::{NumberMap, Rect};

/// How far apart ends may be that are joined, and how far from the frame an end may be that is on it, as a
/// share of the frame's size: files round their coordinates.
const MEETING: f64 = 1e-7;

/// Lines of coast in a frame.
#[derive(Clone, Debug, Default)]
pub(super) struct CoastLines {
    /// Closed lines, without the repeated last point.
    pub closed: Vec<Ring>,
    /// Lines from a point of the frame to another one.
    pub crossing: Vec<Vec<DVec2>>,
    /// Ends of other lines.
    pub loose_ends: Vec<DVec2>,
}

impl CoastLines {
    /// Returns the part of lines inside a frame, joined.
    pub fn new(lines: &[Vec<DVec2>], frame: &Rect) -> Self {
        let tolerance = MEETING * frame.size().max_element();
        let mut pieces = Vec::new();
        lines.iter().for_each(|line| pieces_inside(line, frame, tolerance, &mut pieces));
        let mut sorted = Self::default();
        for line in joined(pieces, frame, tolerance) {
            let ends = [line[0], line[line.len() - 1]];
            let is_loose = |at: &DVec2| !is_on_frame(*at, frame);
            if ends[0] == ends[1] {
                // There and back encloses nothing.
                sorted.closed.extend((line.len() > 3).then(|| line[1..].to_vec()));
            } else if ends.iter().any(is_loose) {
                sorted.loose_ends.extend(ends.into_iter().filter(is_loose));
            } else {
                sorted.crossing.push(line);
            }
        }
        sorted
    }

    /// Returns whether there are no lines in the frame.
    pub fn is_empty(&self) -> bool {
        self.closed.is_empty() && self.crossing.is_empty() && self.loose_ends.is_empty()
    }

    /// Returns the lines through the frame as rings: each continues along the frame, anticlockwise, from its
    /// end to its start.
    pub fn closed_along_frame(&self, frame: &Rect) -> Vec<Ring> {
        let corners = super::corners(frame);
        let ring = |line: &Vec<DVec2>| {
            let [start, end] = [line[0], line[line.len() - 1]].map(|at| place_on_frame(at, frame));
            let reach = (start - end).rem_euclid(4.0);
            let mut between: Vec<(f64, DVec2)> = corners
                .iter()
                .zip([0.0, 1.0, 2.0, 3.0])
                .map(|(&corner, place)| ((place - end).rem_euclid(4.0), corner))
                .filter(|&(place, _)| 0.0 < place && place < reach)
                .collect();
            between.sort_by(|a, b| a.0.total_cmp(&b.0));
            line.iter().copied().chain(between.into_iter().map(|(_, corner)| corner)).collect()
        };
        self.crossing.iter().map(ring).collect()
    }
}

/// Returns where a point of a frame is along it: 0 to 4 from the lower left corner, anticlockwise, 1 for each
/// side.
fn place_on_frame(at: DVec2, frame: &Rect) -> f64 {
    let share = (at - frame.min) / frame.size();
    if at.y == frame.min.y {
        share.x
    } else if at.x == frame.max.x {
        1.0 + share.y
    } else if at.y == frame.max.y {
        3.0 - share.x
    } else {
        (4.0 - share.y).rem_euclid(4.0)
    }
}

fn is_on_frame(at: DVec2, frame: &Rect) -> bool {
    at.x == frame.min.x || at.x == frame.max.x || at.y == frame.min.y || at.y == frame.max.y
}

/// Returns a point on the frame for one that is close to it.
fn moved_to_frame(at: DVec2, frame: &Rect, tolerance: f64) -> DVec2 {
    let near = |value: f64, low: f64, high: f64| match value {
        value if (value - low).abs() <= tolerance => low,
        value if (value - high).abs() <= tolerance => high,
        value => value,
    };
    DVec2::new(near(at.x, frame.min.x, frame.max.x), near(at.y, frame.min.y, frame.max.y))
}

/// Adds the pieces of a line inside a frame. Edges along the frame are not inside.
fn pieces_inside(line: &[DVec2], frame: &Rect, tolerance: f64, pieces: &mut Vec<Vec<DVec2>>) {
    let mut piece: Vec<DVec2> = Vec::new();
    let mut finish = |piece: &mut Vec<DVec2>| {
        if piece.len() > 1 {
            pieces.push(std::mem::take(piece));
        }
        piece.clear();
    };
    let mut points = line.iter().map(|&at| moved_to_frame(at, frame, tolerance)).collect::<Vec<_>>();
    points.dedup();
    for ends in points.windows(2) {
        let Some([from, to]) = edge_inside([ends[0], ends[1]], frame) else {
            finish(&mut piece);
            continue;
        };
        if piece.last() != Some(&from) {
            finish(&mut piece);
            piece.push(from);
        }
        piece.push(to);
        if is_on_frame(to, frame) {
            finish(&mut piece);
        }
    }
    finish(&mut piece);
}

/// Returns the part of an edge inside a frame (Liang and Barsky); `None` for none, a point, or a part along a
/// side.
fn edge_inside([from, to]: [DVec2; 2], frame: &Rect) -> Option<[DVec2; 2]> {
    let along = to - from;
    let (mut first, mut last) = ((0.0, None), (1.0, None));
    for axis in 0..2 {
        let (low, high) = (frame.min[axis], frame.max[axis]);
        if along[axis] == 0.0 {
            if from[axis] <= low || from[axis] >= high {
                return None;
            }
            continue;
        }
        let (near, far) = if along[axis] > 0.0 { (low, high) } else { (high, low) };
        let [enters, leaves] = [near, far].map(|value| (value - from[axis]) / along[axis]);
        if enters > first.0 {
            first = (enters, Some((axis, near)));
        }
        if leaves < last.0 {
            last = (leaves, Some((axis, far)));
        }
    }
    let at = |(share, side): (f64, Option<(usize, f64)>), end: DVec2| {
        let Some((axis, value)) = side else { return end };
        let mut at = from + share * along;
        at[axis] = value;
        at.clamp(frame.min, frame.max)
    };
    (first.0 < last.0).then(|| [at(first, from), at(last, to)]).filter(|[from, to]| from != to)
}

/// Joins lines whose ends meet inside the frame. The first and the last point of a closed line are the same.
fn joined(pieces: Vec<Vec<DVec2>>, frame: &Rect, tolerance: f64) -> Vec<Vec<DVec2>> {
    let mut ends = LineEnds::default();
    let mut lines: Vec<Option<Vec<DVec2>>> = Vec::new();
    for mut line in pieces {
        for _ in 0..2 {
            let end = line[line.len() - 1];
            if line[0] != end && !is_on_frame(end, frame) {
                let waiting = ends.take(end, tolerance, &lines).and_then(|other| lines[other].take());
                waiting.into_iter().for_each(|other| append(&mut line, other, tolerance));
                close(&mut line, tolerance);
            }
            line.reverse();
        }
        if line[0] != line[line.len() - 1] {
            [line[0], line[line.len() - 1]].into_iter().for_each(|end| ends.add(end, tolerance, lines.len()));
        }
        lines.push(Some(line));
    }
    lines.into_iter().flatten().collect()
}

/// Appends a line that begins or ends where another one ends.
fn append(line: &mut Vec<DVec2>, mut next: Vec<DVec2>, tolerance: f64) {
    if next[0].distance(line[line.len() - 1]) > tolerance {
        next.reverse();
    }
    line.extend_from_slice(&next[1..]);
}

/// Makes the last point of a line the first one, if they meet.
fn close(line: &mut [DVec2], tolerance: f64) {
    if let [first, _, .., last] = line
        && first.distance(*last) <= tolerance
    {
        *last = *first;
    }
}

/// The ends of lines, by squares of the plane.
#[derive(Default)]
struct LineEnds(NumberMap<[i64; 2], Vec<usize>>);

impl LineEnds {
    fn square(at: DVec2, tolerance: f64) -> [i64; 2] {
        [at.x, at.y].map(|value| (value / (4.0 * tolerance)).floor() as i64)
    }

    fn add(&mut self, end: DVec2, tolerance: f64, line: usize) {
        self.0.entry(Self::square(end, tolerance)).or_default().push(line);
    }

    /// Returns a line that ends at a place, and removes it from there.
    fn take(&mut self, at: DVec2, tolerance: f64, lines: &[Option<Vec<DVec2>>]) -> Option<usize> {
        let [x, y] = Self::square(at, tolerance);
        let squares = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        let ends_there = |line: &usize| {
            let Some(points) = &lines[*line] else { return false };
            [points[0], points[points.len() - 1]].iter().any(|end| end.distance(at) <= tolerance)
        };
        for square in squares {
            let Some(waiting) = self.0.get_mut(&square) else { continue };
            if let Some(n) = waiting.iter().position(ends_there) {
                return Some(waiting.swap_remove(n));
            }
        }
        None
    }
}
