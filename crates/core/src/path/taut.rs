//! Paths pulled taut where the cost is constant: there they are as short as any near them.
//!
//! On the Earth a cost is constant where it is so per metre on the ellipsoid. There a straight line in the
//! plane is nearly the shortest way, and replaces another one where it costs less.

use glam::DVec2;

use super::integral::smooth_cost;
use super::walls::Walls;
use super::{CostDensity, CostRange};
use crate::geometry::{Rect, Side, side_of_points};

/// The most points that are looked at, as a multiple of the number of points of the path.
const MOST_VISITS: usize = 16;
/// Ways whose costs differ by less than this share cost the same: the difference is rounding.
const SAME_COST: f64 = 1e-12;

/// A polyline that the walls admit, pulled taut: where the cost around a point and its two neighbours is
/// constant, the shortest way between these neighbours replaces the way by the point.
///
/// ```text
///       v                 .
///      / \               / \            no wall in the triangle: the point v is left out
///     /   \     ─▶     c────d           walls: the way leads along their corners c, d
///    p     q          p      q
/// ```
pub(super) fn taut(points: &[DVec2], density: &dyn CostDensity, walls: &Walls) -> Vec<DVec2> {
    let mut left = MOST_VISITS * points.len();
    let mut pulled = vec![points[0]];
    // Points that are still to come, the next one last.
    let mut rest: Vec<DVec2> = points[1..].iter().rev().copied().collect();
    while let Some(at) = rest.pop() {
        let (Some(&before), Some(&after)) = (pulled.last(), rest.last()) else {
            pulled.push(at);
            continue;
        };
        if left == 0 || !density.range_on_ground(&around([before, at, after])).is_constant() {
            pulled.push(at);
            continue;
        }
        left -= 1;
        let chain = shortest(walls, [before, at, after]);
        match chain.filter(|chain| costs_less([before, at, after], chain, density)) {
            None => pulled.push(at),
            Some(chain) => {
                rest.extend(chain.iter().rev());
                // The angle at the point before is another one now.
                if pulled.len() > 1 {
                    rest.extend(pulled.pop());
                }
            }
        }
    }
    pulled
}

/// Whether costs are constant around all points of a path and their neighbours, so that a taut path is the
/// shortest one nearby. `range` returns those over a rectangle.
pub(super) fn is_constant_along(points: &[DVec2], range: impl Fn(&Rect) -> CostRange) -> bool {
    let is_constant = |three: [DVec2; 3]| range(&around(three)).is_constant();
    match *points {
        [p, q] => is_constant([p, p, q]),
        _ => points.windows(3).all(|three| is_constant([three[0], three[1], three[2]])),
    }
}

fn around([a, b, c]: [DVec2; 3]) -> Rect {
    Rect::new(a.min(b).min(c), a.max(b).max(c))
}

/// Whether the way between two points by a chain costs no more than that by a third one. In a plane without
/// a scale it does: it is shorter, and the cost is constant.
fn costs_less([p, at, q]: [DVec2; 3], chain: &[DVec2], density: &dyn CostDensity) -> bool {
    if density.range(&around([p, at, q])).is_constant() {
        return true;
    }
    let cost = |way: &[DVec2]| way.windows(2).map(|pair| smooth_cost(pair[0], pair[1], density)).sum::<f64>();
    let way: Vec<DVec2> = [p].into_iter().chain(chain.iter().copied()).chain([q]).collect();
    cost(&way) <= (1.0 + SAME_COST) * cost(&[p, at, q])
}

/// The points of the shortest way between two points that stays in the triangle with a third one, between
/// its ends. `None` where it leads by that third point, or rounding stands in the way.
fn shortest(walls: &Walls, [p, at, q]: [DVec2; 3]) -> Option<Vec<DVec2>> {
    if at == p || at == q || walls.admit(p, q) {
        return Some(Vec::new());
    }
    let corners = walls.corners_within(p, q, at);
    let beyond = side_of_points(p, q, at);
    let mut chain = Vec::new();
    let mut last = p;
    // Ends: each corner is taken once, and the last of the chain is q.
    for _ in 0..=corners.len() {
        let mut next = q;
        for &corner in corners.iter().filter(|&&corner| corner != last) {
            let side = side_of_points(last, next, corner);
            let is_farther = last.distance_squared(corner) > last.distance_squared(next);
            if side == beyond || (side == Side::On && is_farther && next != q) {
                next = corner;
            }
        }
        if next == q {
            break;
        }
        chain.push(next);
        last = next;
    }
    let way: Vec<DVec2> = [p].into_iter().chain(chain.iter().copied()).chain([q]).collect();
    let length = |way: &[DVec2]| way.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
    (length(&way) < length(&[p, at, q]) && walls.admit_all(&way)).then_some(chain)
}
