//! A search for paths on a grid with steps in many directions. It shares no code with what it checks.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::Rect;

/// Returns the least cost between two places over a grid of n × n squares of a rectangle, where a step goes
/// to any square at most `reach` away in both directions, by Dijkstra's algorithm. The cost of a step is the
/// mean at a few of its points.
pub fn directions(
    density: &dyn Fn(DVec2) -> f64,
    bounds: Rect,
    [from, to]: [DVec2; 2],
    n: i32,
    reach: i32,
) -> f64 {
    let place =
        |x: i32, y: i32| bounds.min + bounds.size() * dvec2(f64::from(x), f64::from(y)) / f64::from(n);
    let nearest = |p: DVec2| {
        let share = (p - bounds.min) / bounds.size() * f64::from(n);
        (share.x.round() as i32, share.y.round() as i32)
    };
    let steps: Vec<(i32, i32)> = (-reach..=reach)
        .flat_map(|x| (-reach..=reach).map(move |y| (x, y)))
        .filter(|&(x, y)| greatest_divisor(x.abs(), y.abs()) == 1)
        .collect();
    let index = |(x, y): (i32, i32)| (y * (n + 1) + x) as usize;
    let mut best = vec![f64::INFINITY; ((n + 1) * (n + 1)) as usize];
    let mut heap = BinaryHeap::new();
    best[index(nearest(from))] = 0.0;
    heap.push(Reverse((0u64, nearest(from))));
    while let Some(Reverse((key, at))) = heap.pop() {
        let value = f64::from_bits(key);
        if at == nearest(to) {
            return value;
        }
        if value > best[index(at)] {
            continue;
        }
        for &(dx, dy) in &steps {
            let next = (at.0 + dx, at.1 + dy);
            if !(0..=n).contains(&next.0) || !(0..=n).contains(&next.1) {
                continue;
            }
            let (p, q) = (place(at.0, at.1), place(next.0, next.1));
            let mean = (0..4).map(|k| density(p.lerp(q, (f64::from(k) + 0.5) / 4.0))).sum::<f64>() / 4.0;
            let total = value + mean * p.distance(q);
            if total < best[index(next)] {
                best[index(next)] = total;
                heap.push(Reverse((total.to_bits(), next)));
            }
        }
    }
    f64::INFINITY
}

fn greatest_divisor(a: i32, b: i32) -> i32 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}
