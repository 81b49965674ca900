//! Random sets of lines in and around the unit square.

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::{Line, LineKind};

pub fn line(points: &[[f64; 2]], closed: bool) -> Line {
    Line {
        name: "line".into(),
        points: points.iter().map(|&[x, y]| dvec2(x, y)).collect(),
        closed,
        kind: LineKind::Edges,
    }
}

fn point(random: &mut Rng) -> DVec2 {
    dvec2(random.f64(), random.f64())
}

/// One to three lines of one to six edges each, some of them closed; parts may be outside the square.
pub fn lines(random: &mut Rng) -> Vec<Line> {
    let count = random.usize(1..4);
    let line = |n: usize, random: &mut Rng| {
        let mut points = vec![point(random)];
        for _ in 0..random.usize(1..7) {
            let (angle, length) = (random.f64() * std::f64::consts::TAU, 0.05 + 0.4 * random.f64());
            points.push(points[points.len() - 1] + length * DVec2::from_angle(angle));
        }
        Line { name: format!("line {n}"), points, closed: random.u8(..5) == 0, kind: LineKind::Edges }
    };
    (0..count).map(|n| line(n, random)).collect()
}

/// Lines that begin, end and meet where others have corners or edges, run along the sides of the square and
/// along each other, nearly or exactly, have repeated corners or no length, and leave the square.
pub fn hostile_lines(random: &mut Rng) -> Vec<Line> {
    let mut all = lines(random);
    for n in 0..random.usize(1..5) {
        let other = all[random.usize(..all.len())].clone();
        let at = |random: &mut Rng| {
            let k = random.usize(..other.points.len());
            let (a, b) = (other.points[k], other.points[(k + 1) % other.points.len()]);
            match random.u8(..5) {
                0 => a,
                1 => a.lerp(b, random.f64()),
                2 => a + 1e-12 * point(random),
                3 => (a * 8.0).round() / 8.0,
                _ => dvec2(random.f64(), f64::from(random.u8(..2))),
            }
        };
        let points: Vec<DVec2> = match random.u8(..6) {
            0 => other.points.iter().map(|&p| p + 1e-12 * (point(random) - 0.5)).collect(),
            1 => vec![at(random); random.usize(1..4)],
            2 => other.points.iter().flat_map(|&p| vec![p; random.usize(1..3)]).rev().collect(),
            3 => vec![dvec2(random.f64(), 0.0), dvec2(random.f64(), 0.0), at(random)],
            _ => (0..random.usize(2..5)).map(|_| at(random)).collect(),
        };
        all.push(Line {
            name: format!("hostile line {n}"),
            points,
            closed: random.bool(),
            kind: LineKind::Edges,
        });
    }
    all
}

/// The same lines in another order, some of them backwards, closed ones from another corner on.
pub fn in_other_order(lines: &[Line], random: &mut Rng) -> Vec<Line> {
    let mut others = lines.to_vec();
    random.shuffle(&mut others);
    for line in &mut others {
        if line.closed && !line.points.is_empty() {
            let by = random.usize(..line.points.len());
            line.points.rotate_left(by);
        }
        if random.bool() {
            line.points.reverse();
        }
    }
    others
}
