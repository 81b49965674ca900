//! Plane sets given by edges, in horizontal slabs between all ends and crossings of edges: within a slab no
//! edges cross, so that a set is a row of trapezoids.

use glam::DVec2;

/// A directed edge.
pub type Edge = [DVec2; 2];

/// The slabs of two sets.
pub struct Slabs {
    slabs: Vec<Slab>,
    /// Longer side of the rectangle around everything.
    pub side: f64,
}

struct Slab {
    low: f64,
    high: f64,
    /// The edges through the slab, from left to right: the set, and the x at both ends of the slab.
    edges: Vec<(usize, [f64; 2])>,
}

/// A part of a row between two edges of one set, or beyond the last.
struct Span {
    slab: usize,
    /// x at its left and right end, below and above.
    left: [f64; 2],
    right: [f64; 2],
}

/// The connected parts of the complement of a set.
pub struct Parts {
    spans: Vec<Span>,
    /// For each span its part; 0 is the unbounded one.
    part_of: Vec<usize>,
    /// The area of each bounded part; the first is not used.
    pub areas: Vec<f64>,
}

impl Slabs {
    pub fn new(sets: [&[Edge]; 2]) -> Self {
        let all: Vec<(usize, Edge)> =
            sets.iter().enumerate().flat_map(|(n, set)| set.iter().map(move |&edge| (n, edge))).collect();
        let mut heights: Vec<f64> = all.iter().flat_map(|(_, [a, b])| [a.y, b.y]).collect();
        for &a in sets[0] {
            heights.extend(sets[1].iter().filter_map(|&b| crossing(a, b)).map(|p| p.y));
        }
        heights.sort_by(f64::total_cmp);
        heights.dedup();
        let xs = || all.iter().flat_map(|(_, [a, b])| [a.x, b.x]);
        let width = xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min);
        let side = width.max(heights[heights.len() - 1] - heights[0]);
        let slab = |ends: &[f64]| {
            let (low, high) = (ends[0], ends[1]);
            let middle = 0.5 * (low + high);
            let through = all.iter().filter(|(_, [a, b])| (a.y <= middle) != (b.y <= middle));
            let mut edges: Vec<(usize, [f64; 2])> =
                through.map(|&(set, edge)| (set, [low, high].map(|y| x_at(edge, y)))).collect();
            edges.sort_by(|a, b| (a.1[0] + a.1[1]).total_cmp(&(b.1[0] + b.1[1])));
            Slab { low, high, edges }
        };
        Self { slabs: heights.windows(2).map(slab).collect(), side }
    }

    /// Returns the parts of the complement of a set. Parts that only a point joins are several.
    pub fn complement(&self, set: usize) -> Parts {
        let mut spans: Vec<Span> = Vec::new();
        for (number, slab) in self.slabs.iter().enumerate() {
            let edges: Vec<[f64; 2]> = slab.edges.iter().filter(|e| e.0 == set).map(|e| e.1).collect();
            let mut left = [f64::NEG_INFINITY; 2];
            for pair in edges.chunks(2) {
                spans.push(Span { slab: number, left, right: pair[0] });
                left = pair[1];
            }
            spans.push(Span { slab: number, left, right: [f64::INFINITY; 2] });
        }
        let mut roots: Vec<usize> = (0..=spans.len()).collect();
        // Number 0 stands for what is below and above all slabs.
        let (first, last) = (spans[0].slab, spans[spans.len() - 1].slab);
        let mut below = 0..0;
        let mut start = 0;
        while start < spans.len() {
            let slab = spans[start].slab;
            let end = start + spans[start..].iter().take_while(|span| span.slab == slab).count();
            for n in start..end {
                for m in below.clone() {
                    let (a, b): (&Span, &Span) = (&spans[m], &spans[n]);
                    let overlap = a.right[1].min(b.right[0]) - a.left[1].max(b.left[0]);
                    if overlap > 1e-12 * self.side {
                        join(&mut roots, m + 1, n + 1);
                    }
                }
                let span = &spans[n];
                let is_beyond = span.left[0] == f64::NEG_INFINITY || span.right[0] == f64::INFINITY;
                let at_rim = |k: usize| span.right[k] - span.left[k] > 1e-12 * self.side;
                if is_beyond || (slab == first && at_rim(0)) || (slab == last && at_rim(1)) {
                    join(&mut roots, 0, n + 1);
                }
            }
            (below, start) = (start..end, end);
        }
        let outside = root(&mut roots, 0);
        let mut numbers = vec![usize::MAX; roots.len()];
        numbers[outside] = 0;
        let mut areas = vec![0.0];
        let mut part_of = Vec::new();
        for (n, span) in spans.iter().enumerate() {
            let root = root(&mut roots, n + 1);
            if numbers[root] == usize::MAX {
                numbers[root] = areas.len();
                areas.push(0.0);
            }
            part_of.push(numbers[root]);
            if numbers[root] > 0 {
                areas[numbers[root]] += self.area(span.slab, span.left, span.right);
            }
        }
        Parts { spans, part_of, areas }
    }

    /// Returns the area of each intersection of a bounded part with any part of another complement, as (part,
    /// other part, area).
    pub fn intersections(&self, parts: &Parts, others: &Parts) -> Vec<(usize, usize, f64)> {
        let mut found = Vec::new();
        let mut start = 0;
        for (n, span) in parts.spans.iter().enumerate().filter(|(n, _)| parts.part_of[*n] > 0) {
            while others.spans[start].slab < span.slab {
                start += 1;
            }
            let in_slab = others.spans[start..].iter().take_while(|other| other.slab == span.slab);
            for (m, other) in (start..).zip(in_slab) {
                let left = [0, 1].map(|k| span.left[k].max(other.left[k]));
                let right = [0, 1].map(|k| span.right[k].min(other.right[k]));
                let area = self.area(span.slab, left, right);
                if area > 0.0 {
                    found.push((parts.part_of[n], others.part_of[m], area));
                }
            }
        }
        found
    }

    fn area(&self, slab: usize, left: [f64; 2], right: [f64; 2]) -> f64 {
        let width = 0.5 * (right[0] - left[0] + right[1] - left[1]);
        width.max(0.0) * (self.slabs[slab].high - self.slabs[slab].low)
    }
}

fn root(roots: &mut [usize], mut n: usize) -> usize {
    while roots[n] != n {
        roots[n] = roots[roots[n]];
        n = roots[n];
    }
    n
}

fn join(roots: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(roots, a), root(roots, b));
    roots[a] = b;
}

fn x_at([a, b]: Edge, y: f64) -> f64 {
    let [low, high] = if a.y < b.y { [a, b] } else { [b, a] };
    low.lerp(high, ((y - low.y) / (high.y - low.y)).clamp(0.0, 1.0)).x
}

fn crossing([a, b]: Edge, [c, d]: Edge) -> Option<DVec2> {
    let (u, v) = (b - a, d - c);
    let cross = u.perp_dot(v);
    let (s, t) = ((c - a).perp_dot(v) / cross, (c - a).perp_dot(u) / cross);
    let within = |share: f64| (0.0..=1.0).contains(&share);
    (within(s) && within(t)).then(|| a.lerp(b, s))
}
