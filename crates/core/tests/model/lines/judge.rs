//! A checker that reads nodes, triangles and lines, and shares no code with what makes them.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, dvec2};
use meshbrush_core::domain::Line;
use meshbrush_mesh::mesh::Extract;

/// What a checker finds in a mesh with lines.
#[derive(Clone, Debug, Default)]
pub struct Found {
    pub triangles: usize,
    pub area: f64,
    /// In degrees.
    pub smallest_angle: f64,
    pub longest_edge: f64,
    /// For each line, its length on edges, in world units.
    pub on_edges: Vec<f64>,
}

/// The edges of a line, without those of no length or with corners that are not finite.
pub fn edges(line: &Line) -> Vec<[DVec2; 2]> {
    let count = line.points.len();
    let last = if line.closed { count } else { count.saturating_sub(1) };
    let all = (0..last).map(|k| [line.points[k], line.points[(k + 1) % count]]);
    all.filter(|[a, b]| a.is_finite() && b.is_finite() && a.distance(*b) > 0.0).collect()
}

/// Checks that the triangles run anticlockwise and meet in whole edges, and measures.
pub fn judge(extract: &Extract, lines: &[Line], name: &str) -> Found {
    let nodes: Vec<DVec2> = extract.world_nodes().collect();
    let mut found = Found { smallest_angle: 180.0, ..Found::default() };
    let mut owners = HashMap::new();
    for (n, cell) in extract.cells().enumerate() {
        let [a, b, c] = cell.corners;
        let doubled = (nodes[b] - nodes[a]).perp_dot(nodes[c] - nodes[a]);
        assert!(doubled > 0.0, "{name}: triangle {n} has the area {doubled}");
        found.area += 0.5 * doubled;
        found.triangles += 1;
        for (at, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert_eq!(owners.insert([at, from], n), None, "{name}: two triangles on one side of an edge");
            let angle = (nodes[from] - nodes[at]).angle_to(nodes[to] - nodes[at]).to_degrees();
            found.smallest_angle = found.smallest_angle.min(angle);
            found.longest_edge = found.longest_edge.max(nodes[at].distance(nodes[from]));
        }
    }
    for cell in extract.cells() {
        let [a, b, c] = cell.corners;
        let across = [[c, b], [a, c], [b, a]].map(|edge| owners.get(&edge).copied());
        assert_eq!(cell.opposite, across, "{name}: neighbours");
    }
    let used: HashSet<usize> = owners.keys().flatten().copied().collect();
    assert_eq!(used.len(), nodes.len(), "{name}: every node is used");
    let ends: Vec<[DVec2; 2]> = owners
        .keys()
        .filter(|[a, b]| a < b || !owners.contains_key(&[*b, *a]))
        .map(|e| e.map(|v| nodes[v]))
        .collect();
    let tolerance = 3.0 * extract.lattice().step().max_element();
    found.on_edges =
        lines.iter().map(|line| edges(line).iter().map(|e| covered(*e, &ends, tolerance)).sum()).collect();
    found
}

/// Returns the length of the part of a segment that edges cover.
fn covered([p, q]: [DVec2; 2], edges: &[[DVec2; 2]], tolerance: f64) -> f64 {
    let (length, along) = (p.distance(q), (q - p).normalize());
    let mut parts = Vec::new();
    for [a, b] in edges {
        let is_on = |c: DVec2| along.perp_dot(c - p).abs() <= tolerance;
        if is_on(*a) && is_on(*b) {
            let [s, t] = [*a, *b].map(|c| along.dot(c - p).clamp(0.0, length));
            parts.push([s.min(t), s.max(t)]);
        }
    }
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut covered, mut end) = (0.0, 0.0f64);
    for [s, t] in parts {
        covered += (t - s.max(end)).max(0.0);
        end = end.max(t);
    }
    covered
}

/// Returns the smallest angle at which lines, or a line and the unit square, meet, in degrees.
pub fn smallest_angle(lines: &[Line]) -> f64 {
    let all: Vec<[DVec2; 2]> = lines.iter().flat_map(edges).chain(frame()).collect();
    let mut smallest = 180.0f64;
    for (n, &[a, b]) in all.iter().enumerate() {
        for &[c, d] in &all[n + 1..] {
            if distance([a, b], [c, d]) > 1e-7 {
                continue;
            }
            let angle = |p: DVec2, q: DVec2| p.angle_to(q).abs().to_degrees();
            let same = |p: DVec2, q: DVec2| p.distance(q) < 1e-7;
            let turned = [[a, b, c, d], [a, b, d, c], [b, a, c, d], [b, a, d, c]];
            smallest = smallest.min(match turned.into_iter().find(|[p, _, q, _]| same(*p, *q)) {
                Some([p, q, _, r]) => angle(q - p, r - p),
                None => angle(b - a, d - c).min(angle(b - a, c - d)),
            });
        }
    }
    smallest
}

/// Returns the smallest distance between parts of lines that do not meet, between their corners and
/// crossings, and from those to the unit square.
pub fn smallest_feature(lines: &[Line]) -> f64 {
    let all: Vec<[DVec2; 2]> = lines.iter().flat_map(edges).collect();
    let mut parts: Vec<[DVec2; 2]> = Vec::new();
    for &[a, b] in &all {
        let mut shares = vec![0.0, 1.0];
        for &[c, d] in &all {
            let scale = (b - a).perp_dot(d - c);
            let (s, t) = ((c - a).perp_dot(d - c) / scale, (c - a).perp_dot(b - a) / scale);
            if scale != 0.0 && s > 1e-9 && s < 1.0 - 1e-9 && t > -1e-9 && t < 1.0 + 1e-9 {
                shares.push(s);
            }
        }
        shares.sort_by(f64::total_cmp);
        parts.extend(shares.windows(2).map(|pair| [a.lerp(b, pair[0]), a.lerp(b, pair[1])]));
    }
    let mut smallest = f64::INFINITY;
    for (n, &part) in parts.iter().enumerate() {
        smallest = smallest.min(part[0].distance(part[1]));
        for p in part {
            smallest = frame().iter().map(|side| distance([p, p], *side)).fold(smallest, f64::min);
        }
        for &other in &parts[n + 1..] {
            let meet = part.iter().any(|p| other.iter().any(|q| p.distance(*q) < 1e-7));
            smallest = if meet { smallest } else { smallest.min(distance(part, other)) };
        }
    }
    smallest
}

fn frame() -> [[DVec2; 2]; 4] {
    let corners = [dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(1.0, 1.0), dvec2(0.0, 1.0)];
    [0, 1, 2, 3].map(|k| [corners[k], corners[(k + 1) % 4]])
}

/// Returns the distance of two segments.
fn distance([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> f64 {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
        return 0.0;
    }
    let to = |p: DVec2, [a, b]: [DVec2; 2]| {
        let squared = (b - a).length_squared();
        let share = if squared > 0.0 { ((p - a).dot(b - a) / squared).clamp(0.0, 1.0) } else { 0.0 };
        p.distance(a.lerp(b, share))
    };
    to(a, [c, d]).min(to(b, [c, d])).min(to(c, [a, b])).min(to(d, [a, b]))
}
