//! Where a cell has its water level: MeshKernel's rule, which Delft3D-FM follows.

use glam::{DVec2, dvec2};

/// Steps of the search for the centre of a quadrilateral, and the share of the way of each.
const STEPS: usize = 100;
const SHARE: f64 = 0.1;
/// The search ends where a round moves the centre by less than this share of the size of the cell.
const SETTLED: f64 = 1e-12;

/// Returns the centre of a cell. `corners` are anticlockwise, in a plane; `is_inner` says of each edge, from
/// a corner to the next one, whether there is a cell beyond it.
///
/// The centre of a triangle is its circumcentre; that of a quadrilateral the place that is as near as can be
/// to the perpendicular bisectors of its inner edges. Where that lies outside the cell, the centre is where
/// the line from the middle leaves it.
pub(super) fn center(corners: &[DVec2], is_inner: &[bool]) -> DVec2 {
    let middle = mass_center(corners);
    let wanted = match corners {
        &[a, b, c] => circumcenter([a, b, c]).unwrap_or(middle),
        _ => nearest_to_bisectors(corners, is_inner, middle),
    };
    middle + share_inside(corners, middle, wanted) * (wanted - middle)
}

/// Returns the circumcentre of a triangle; `None` where its corners lie on one line.
fn circumcenter([a, b, c]: [DVec2; 3]) -> Option<DVec2> {
    let (u, v) = (b - a, c - a);
    let doubled_area = u.perp_dot(v);
    let (u2, v2) = (u.length_squared(), v.length_squared());
    let across = dvec2(v.y * u2 - u.y * v2, u.x * v2 - v.x * u2);
    (doubled_area != 0.0).then(|| a + across / (2.0 * doubled_area))
}

/// Goes from the middle towards the bisector of one inner edge after the other, in small steps.
fn nearest_to_bisectors(corners: &[DVec2], is_inner: &[bool], middle: DVec2) -> DVec2 {
    let edges: Vec<(DVec2, DVec2)> = (0..corners.len())
        .filter(|&k| is_inner[k])
        .map(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            (0.5 * (from + to), (to - from).normalize_or_zero())
        })
        .collect();
    if edges.len() < 2 {
        return middle;
    }
    let size = corners[0].distance(corners[corners.len() / 2]);
    let mut place = middle;
    for _ in 0..STEPS {
        let before = place;
        for (halfway, along) in &edges {
            place -= SHARE * (place - *halfway).dot(*along) * *along;
        }
        if before.distance(place) < SETTLED * size {
            break;
        }
    }
    place
}

/// Returns the centre of mass.
fn mass_center(corners: &[DVec2]) -> DVec2 {
    let origin = corners[0];
    let (mut doubled_area, mut moment) = (0.0, DVec2::ZERO);
    for pair in corners[1..].windows(2) {
        let (u, v) = (pair[0] - origin, pair[1] - origin);
        let part = u.perp_dot(v);
        doubled_area += part;
        moment += part * (u + v) / 3.0;
    }
    if doubled_area == 0.0 { origin } else { origin + moment / doubled_area }
}

/// Returns how far one can go from a place inside a convex cell to another one, 1 for all the way.
fn share_inside(corners: &[DVec2], inside: DVec2, to: DVec2) -> f64 {
    (0..corners.len()).fold(1.0, |share: f64, k| {
        let (from, next) = (corners[k], corners[(k + 1) % corners.len()]);
        let left = |place: DVec2| (next - from).perp_dot(place - from);
        let (start, end) = (left(inside), left(to));
        if end < 0.0 && start > 0.0 { share.min(start / (start - end)) } else { share }
    })
}
