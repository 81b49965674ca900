//! Contour lines of h̄ by marching squares.

use std::collections::HashMap;

use glam::DVec2;

use crate::raster::Raster;

/// A contour line of h̄.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// The first level that is fine enough on the finer side of the line.
    pub level: u32,
    /// The line in world units. The last point of a closed line equals the first.
    pub points: Vec<DVec2>,
}

/// A corner of a contour line is on an edge between two neighbouring pixel centres: twice the number of the
/// pixel at its lower or left end, plus one for an edge that runs upwards.
type EdgeId = usize;

/// Returns the lines along which h̄ equals one of `diameters`, in world units, from the largest: line `i`
/// separates the places where level `i` is fine enough from those that need a deeper one.
///
/// Between the centres of neighbouring pixels the logarithm of h̄ is taken as linear. Values that are not
/// positive and finite have no lines around them.
pub fn contours(target: &Raster, diameters: &[f64]) -> Vec<Contour> {
    let [columns, rows] = target.size();
    let mut segments: Vec<Vec<[EdgeId; 2]>> = vec![Vec::new(); diameters.len()];
    let pixel = |x: u32, y: u32| (y * columns + x) as usize;
    for y in 0..rows.saturating_sub(1) {
        let (lower, upper) = (target.row(y, 0..columns), target.row(y + 1, 0..columns));
        for x in 0..columns.saturating_sub(1) {
            let i = x as usize;
            let values = [lower[i], lower[i + 1], upper[i + 1], upper[i]].map(f64::from);
            if !values.iter().all(|&value| value > 0.0 && value.is_finite()) {
                continue;
            }
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(0.0, f64::max);
            let edges = [2 * pixel(x, y), 2 * pixel(x + 1, y) + 1, 2 * pixel(x, y + 1), 2 * pixel(x, y) + 1];
            // Diameters decrease: those within (least, most] are a range.
            let first = diameters.partition_point(|&diameter| diameter > most);
            let last = diameters.partition_point(|&diameter| diameter > least);
            for level in first..last {
                cross_cell(values, diameters[level], edges, &mut segments[level]);
            }
        }
    }
    let mut lines = Vec::new();
    for (level, segments) in segments.iter().enumerate() {
        let place = |edge: EdgeId| place_on_edge(target, edge, diameters[level]);
        let chained = chain(segments).into_iter();
        lines.extend(chained.map(|edges| Contour {
            level: level as u32 + 1,
            points: edges.into_iter().map(place).collect(),
        }));
    }
    lines
}

/// Adds the segments of a line within one cell. `values` and `edges` run anticlockwise from the lower left
/// corner and the lower edge.
fn cross_cell(values: [f64; 4], diameter: f64, edges: [EdgeId; 4], segments: &mut Vec<[EdgeId; 2]>) {
    let finer = values.map(|value| value < diameter);
    let crossed: Vec<usize> = (0..4).filter(|&i| finer[i] != finer[(i + 1) % 4]).collect();
    match crossed[..] {
        [a, b] => segments.push([edges[a], edges[b]]),
        [..] if crossed.len() == 4 => {
            // Two opposite corners are finer. The mean decides whether they are joined.
            let joined = values.iter().sum::<f64>() / 4.0 < diameter;
            let pairs = if joined == finer[0] { [[0, 1], [2, 3]] } else { [[3, 0], [1, 2]] };
            segments.extend(pairs.map(|[a, b]| [edges[a], edges[b]]));
        }
        _ => {}
    }
}

/// Returns where the line of a diameter crosses an edge, in world units.
fn place_on_edge(target: &Raster, edge: EdgeId, diameter: f64) -> DVec2 {
    let columns = target.size()[0] as usize;
    let (x, y) = ((edge / 2 % columns) as u32, (edge / 2 / columns) as u32);
    let [to_x, to_y] = if edge.is_multiple_of(2) { [x + 1, y] } else { [x, y + 1] };
    let [a, b] = [target.get(x, y), target.get(to_x, to_y)].map(|value| libm::log(f64::from(value)));
    let share = ((libm::log(diameter) - a) / (b - a)).clamp(0.0, 1.0);
    target.pixel_center(x, y).lerp(target.pixel_center(to_x, to_y), share)
}

/// Joins segments that share an end into lines, in the order of their first segments.
fn chain(segments: &[[EdgeId; 2]]) -> Vec<Vec<EdgeId>> {
    const NONE: usize = usize::MAX;
    let mut at_edge: HashMap<EdgeId, [usize; 2]> = HashMap::with_capacity(segments.len());
    for (index, ends) in segments.iter().enumerate() {
        for end in ends {
            let both = at_edge.entry(*end).or_insert([NONE; 2]);
            both[usize::from(both[0] != NONE)] = index;
        }
    }
    let mut used = vec![false; segments.len()];
    let mut walk = |from: EdgeId, segment: usize| {
        let mut line = vec![from];
        let mut next = segment;
        while next != NONE && !std::mem::replace(&mut used[next], true) {
            let end = line[line.len() - 1];
            let [a, b] = segments[next];
            let other = if a == end { b } else { a };
            line.push(other);
            let [first, second] = at_edge[&other];
            next = if first == next { second } else { first };
        }
        line
    };
    let open = |[a, b]: &[EdgeId; 2]| [*a, *b].into_iter().find(|end| at_edge[end][1] == NONE);
    let starts = segments.iter().enumerate().filter_map(|(index, ends)| Some((open(ends)?, index)));
    let closed = segments.iter().enumerate().map(|(index, [a, _])| (*a, index));
    let walked: Vec<Vec<EdgeId>> = starts.chain(closed).map(|(from, index)| walk(from, index)).collect();
    walked.into_iter().filter(|line| line.len() > 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;
    use glam::dvec2;

    fn raster(size: u32, value: impl Fn(DVec2) -> f64) -> Raster {
        let bounds = Rect::new(dvec2(-1.0, -1.0), dvec2(1.0, 1.0));
        let mut raster = Raster::filled(bounds, [size; 2], 1.0);
        for (x, y) in raster.all().pixels() {
            let at = raster.pixel_center(x, y);
            raster.set(x, y, value(at) as f32);
        }
        raster
    }

    #[test]
    fn the_line_around_a_point_is_one_closed_circle() {
        let raster = raster(128, |p| 0.1 + p.length());
        let lines = contours(&raster, &[0.8, 0.4]);
        assert_eq!(lines.iter().map(|line| line.level).collect::<Vec<_>>(), [1, 2]);
        for (line, radius) in lines.iter().zip([0.7, 0.3]) {
            assert_eq!(line.points.first(), line.points.last());
            let worst = line.points.iter().map(|p| (p.length() - radius).abs()).fold(0.0, f64::max);
            assert!(worst < 0.003, "{worst}");
        }
    }

    #[test]
    fn a_line_that_leaves_the_field_ends_there() {
        let raster = raster(32, |p| 2.0 + p.x);
        let lines = contours(&raster, &[2.3]);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].points.len(), 32);
        assert!(lines[0].points.iter().all(|p| (p.x - 0.3).abs() < 0.01), "{:?}", lines[0].points);
        assert_ne!(lines[0].points.first(), lines[0].points.last());
    }

    #[test]
    fn saddles_and_values_that_are_no_lengths_give_no_broken_line() {
        let saddle = raster(16, |p| 1.0 + p.x * p.y);
        let ends: usize = contours(&saddle, &[1.0 + 1e-9]).iter().map(|line| line.points.len()).sum();
        assert!(ends > 16);
        let holes = raster(16, |p| if p.x > 0.0 { f64::NAN } else { 1.5 + p.y });
        assert!(contours(&holes, &[1.5]).iter().flat_map(|line| &line.points).all(|p| p.is_finite()));
        assert_eq!(contours(&raster(8, |_| 1.0), &[2.0, 1.0, 0.5]), []);
    }
}
