//! Hatching of areas on the canvas.

use egui::{Pos2, Rect, pos2};

/// Vertical distance of the lines of the hatching, in points.
const SPACING: f32 = 11.0;

/// Returns the parts inside rings of the diagonals x + y = n · [`SPACING`] that cross a view. A point is
/// inside where a line to it crosses an odd number of edges.
pub fn hatching(rings: &[Vec<Pos2>], view: Rect) -> Vec<[Pos2; 2]> {
    let height = |p: Pos2| (p.x + p.y) / SPACING;
    let (first, last) = (height(view.min).ceil(), height(view.max).floor());
    let count = (last - first + 1.0).max(0.0) as usize;
    // Where each diagonal crosses edges, as x.
    let mut crossings: Vec<Vec<f32>> = vec![Vec::new(); count];
    for ring in rings {
        for (n, &from) in ring.iter().enumerate() {
            let to = ring[(n + 1) % ring.len()];
            let (low, high) = if height(from) <= height(to) { (from, to) } else { (to, from) };
            // An end on a diagonal counts as below it, so that edges that meet there cross it once or twice.
            let [start, end] = [low, high].map(|p| ((height(p) - first).floor() + 1.0).max(0.0) as usize);
            let (start, end) = (start.min(count), end.min(count));
            for (line, crossings) in (start..).zip(&mut crossings[start..end]) {
                let share = (first + line as f32 - height(low)) / (height(high) - height(low));
                crossings.push(low.x + share * (high.x - low.x));
            }
        }
    }
    let mut hatching = Vec::new();
    for (line, xs) in crossings.iter_mut().enumerate() {
        xs.sort_by(f32::total_cmp);
        let sum = (first + line as f32) * SPACING;
        let ends = xs.chunks_exact(2).map(|x| [pos2(x[0], sum - x[0]), pos2(x[1], sum - x[1])]);
        hatching.extend(ends.filter(|&[a, b]| Rect::from_two_pos(a, b).intersects(view)));
    }
    hatching
}

#[cfg(test)]
mod tests {
    use egui::vec2;

    use super::*;

    /// Returns whether a point is inside rings, by the edges that a horizontal ray crosses.
    fn is_inside(rings: &[Vec<Pos2>], p: Pos2) -> bool {
        let edges =
            rings.iter().flat_map(|ring| (0..ring.len()).map(|n| (ring[n], ring[(n + 1) % ring.len()])));
        let crossed = edges.filter(|(a, b)| {
            (a.y <= p.y) != (b.y <= p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x
        });
        crossed.count() % 2 == 1
    }

    #[test]
    fn hatching_covers_exactly_the_inside_of_the_rings() {
        let mut random = fastrand::Rng::with_seed(17);
        let view = Rect::from_min_size(pos2(100.0, 50.0), vec2(300.0, 200.0));
        for _ in 0..50 {
            let mut ring = |count| -> Vec<Pos2> {
                (0..count).map(|_| pos2(600.0 * random.f32() - 50.0, 500.0 * random.f32() - 50.0)).collect()
            };
            let rings = vec![ring(5), ring(3), ring(8)];
            let lines = hatching(&rings, view);
            for n in 14..59 {
                let sum = n as f32 * SPACING;
                let on_line: Vec<_> = lines.iter().filter(|[a, _]| (a.x + a.y - sum).abs() < 0.01).collect();
                for x in 0..300 {
                    let at = pos2(100.25 + x as f32, sum - 100.25 - x as f32);
                    let ends = on_line.iter().flat_map(|ends| ends.iter());
                    if !view.contains(at) || ends.clone().any(|end| (end.x - at.x).abs() < 0.1) {
                        continue;
                    }
                    let covered = on_line.iter().any(|[a, b]| (a.x..b.x).contains(&at.x));
                    assert_eq!(covered, is_inside(&rings, at), "{at}");
                }
            }
        }
    }
}
