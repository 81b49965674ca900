//! Refuses polygons whose overlay would take too much time or memory: too many corners, crossings or long
//! edges.

use glam::DVec2;

use super::{Polygon, RegionError};
use crate::geometry::Rect;

/// Most corners that the polygons of a domain may have together.
pub const MOST_CORNERS: usize = 1_000_000;

/// Most crossings of the edges of a domain's polygons.
pub const MOST_CROSSINGS: usize = 200_000;

/// Edges are sorted into at most one square per edge, with columns and rows chosen so that there are about
/// this many pairs of a square and an edge. The teeth of a comb get few rows and many columns.
const MOST_ENTRIES: f64 = 8e6;
/// Most pairs of edges that are tested. If the squares have more pairs, every k-th is tested and a crossing
/// counts k times.
const MOST_PAIRS: usize = 100_000_000;

/// Refuses polygons that are too complex to overlay.
///
/// # Errors
/// Fails with the limit that they exceed.
pub(super) fn check_complexity(polygons: &[Polygon], bounds: &Rect) -> Result<(), RegionError> {
    let corners = polygons.iter().flatten().map(Vec::len).sum();
    if corners > MOST_CORNERS {
        return Err(RegionError::TooManyCorners { corners });
    }
    // Into the unit square.
    let place = |p: DVec2| (p - bounds.min) / bounds.size();
    let edges: Vec<[DVec2; 2]> =
        polygons.iter().flatten().flat_map(|ring| edges_of(ring)).map(|ends| ends.map(place)).collect();
    let mut entries = sorted_into_squares(&edges, squares_for(&edges));
    entries.sort_unstable();
    let squares = || entries.chunk_by(|a, b| a.0 == b.0);
    let pairs: usize = squares().map(|square| square.len() * (square.len() - 1) / 2).sum();
    let step = pairs.div_ceil(MOST_PAIRS).max(1);
    let mut crossings = 0;
    for square in squares() {
        for (n, &(_, a)) in square.iter().enumerate() {
            let others = square[..n].iter().skip(n % step).step_by(step);
            crossings += step * others.filter(|&&(_, b)| cross(edges[a as usize], edges[b as usize])).count();
            if crossings > MOST_CROSSINGS {
                return Err(RegionError::TooManyCrossings);
            }
        }
    }
    // The overlay takes 72 bytes for each column that an edge passes through; it has as many columns as the
    // square root of the number of edges.
    let width: f64 = edges.iter().map(|[from, to]| (to.x - from.x).abs()).sum();
    if width * (edges.len() as f64).sqrt() > MOST_ENTRIES {
        return Err(RegionError::TooManyLongEdges { edges: edges.len() });
    }
    Ok(())
}

/// Returns the columns and rows of squares over the unit square.
fn squares_for(edges: &[[DVec2; 2]]) -> [f64; 2] {
    let length: DVec2 = edges.iter().map(|[from, to]| (*to - *from).abs()).sum();
    let count = edges.len() as f64;
    let most = DVec2::splat(MOST_ENTRIES) / length.max(DVec2::splat(1e-9));
    let side = |most: f64, wanted: f64| most.min(wanted).floor().max(1.0);
    if length.x > length.y {
        let columns = side(most.x, count.sqrt());
        [columns, side(most.y, count / columns)]
    } else {
        let rows = side(most.y, count.sqrt());
        [side(most.x, count / rows), rows]
    }
}

fn edges_of(ring: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> {
    ring.iter().zip(ring.iter().skip(1).chain(ring.first())).map(|(&from, &to)| [from, to])
}

/// Pairs of a square and an edge that passes through it or near it, column by column of each edge.
fn sorted_into_squares(edges: &[[DVec2; 2]], [columns, rows]: [f64; 2]) -> Vec<(u32, u32)> {
    let mut entries = Vec::new();
    for (n, edge) in edges.iter().enumerate() {
        let [from, to] = edge.map(|p| p * DVec2::new(columns, rows));
        let [left, right] = if from.x <= to.x { [from, to] } else { [to, from] };
        let column = |x: f64| x.floor().clamp(0.0, columns - 1.0);
        let (first, end) = (column(left.x), column(right.x));
        for column in first as u32..=end as u32 {
            // The part of the edge in this column, extended a little at both ends.
            let at = |x: f64| {
                let part = (x - left.x) / (right.x - left.x);
                if part.is_finite() { left.y + part.clamp(0.0, 1.0) * (right.y - left.y) } else { left.y }
            };
            let steep = end == first;
            let (a, b) =
                if steep { (left.y, right.y) } else { (at(f64::from(column)), at(f64::from(column) + 1.0)) };
            let row = |y: f64| y.floor().clamp(0.0, rows - 1.0) as u32;
            for row in row(a.min(b) - 1e-6)..=row(a.max(b) + 1e-6) {
                entries.push((row * columns as u32 + column, n as u32));
            }
        }
    }
    entries
}

/// Returns whether two edges cross at an inner point of both, up to rounding: this is an estimate and decides
/// no geometry.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let turn = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Domain;
    use glam::dvec2;

    fn zigzag(teeth: usize) -> Vec<DVec2> {
        (0..teeth).map(|k| dvec2(libm::sin(k as f64 * 12.9898), libm::cos(k as f64 * 78.233))).collect()
    }

    #[test]
    fn crossing_edges_are_refused_and_a_long_outline_is_not() {
        assert_eq!(Domain::of_polygons(&[vec![zigzag(20_000)]]), Err(RegionError::TooManyCrossings));
        assert!(Domain::of_polygons(&[vec![zigzag(50)]]).is_ok());
        let angle = |k: usize| f64::from(k as u32) * std::f64::consts::TAU / 400_000.0;
        let coast = |k: usize| {
            let radius = 1.0 + 0.1 * libm::sin(40_000.0 * angle(k));
            radius * dvec2(libm::cos(angle(k)), libm::sin(angle(k)))
        };
        assert!(Domain::of_polygons(&[vec![(0..400_000).map(coast).collect()]]).is_ok());
        let tooth = |k: usize| [dvec2(k as f64, 1.0), dvec2(k as f64 + 0.5, 9000.0)];
        let comb = |teeth: usize| -> Vec<DVec2> {
            (0..teeth).flat_map(tooth).chain([dvec2(teeth as f64, 0.0), DVec2::ZERO]).collect()
        };
        assert!(Domain::of_polygons(&[vec![comb(100_000)]]).is_ok(), "long edges that never cross");
        let lying = comb(100_000).iter().map(|p| dvec2(p.y, p.x)).collect();
        let error = Domain::of_polygons(&[vec![lying]]).unwrap_err();
        assert_eq!(error, RegionError::TooManyLongEdges { edges: 200_002 });
        let too_many = vec![vec![DVec2::ZERO; MOST_CORNERS], vec![DVec2::ONE]];
        let error = Domain::of_polygons(&[too_many]).unwrap_err();
        assert_eq!(error, RegionError::TooManyCorners { corners: MOST_CORNERS + 1 });
    }

    #[test]
    fn polygons_without_area_are_refused() {
        let line = vec![vec![DVec2::ZERO, DVec2::ONE, dvec2(2.0, 2.0)]];
        for polygons in [vec![], vec![vec![]], vec![vec![vec![DVec2::ONE]]], vec![line]] {
            assert_eq!(Domain::of_polygons(&polygons), Err(RegionError::NoArea));
        }
        let far = vec![vec![DVec2::splat(-f64::MAX), DVec2::splat(f64::MAX), DVec2::ZERO]];
        assert_eq!(Domain::of_polygons(&[far]), Err(RegionError::Extent));
    }
}
