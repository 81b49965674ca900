//! Whether polygons can be made sense of in reasonable time: the edges of most cross never, those of some cross everywhere.

use glam::DVec2;

use super::{Polygon, RegionError};
use crate::geometry::Rect;

/// Most corners that the polygons of a domain may have together.
pub const MOST_CORNERS: usize = 1_000_000;

/// How often the edges of a domain's polygons may cross.
pub const MOST_CROSSINGS: usize = 200_000;

/// Most squares along a side of the grid that edges are sorted into.
const MOST_SQUARES: f64 = 1024.0;
/// Most entries of squares and edges: a comb whose teeth all pass through all squares of a column stays below.
const MOST_ENTRIES: usize = 64_000_000;
/// Most pairs of edges that are looked at; where so many lie in one square without crossing, an overlay is no more work.
const MOST_PAIRS: usize = 400_000_000;

/// Refuses polygons that are too many or too tangled to be overlaid.
pub(super) fn check_tangle(polygons: &[Polygon], bounds: &Rect) -> Result<(), RegionError> {
    let corners = polygons.iter().flatten().map(Vec::len).sum();
    if corners > MOST_CORNERS {
        return Err(RegionError::TooManyCorners { corners });
    }
    let edges: Vec<[DVec2; 2]> = polygons.iter().flatten().flat_map(|ring| edges_of(ring)).collect();
    let squares = (corners as f64).sqrt().ceil().clamp(1.0, MOST_SQUARES);
    let mut entries = sorted_into_squares(&edges, bounds, squares).ok_or(RegionError::Tangled)?;
    entries.sort_unstable();
    let (mut crossings, mut pairs) = (0, 0);
    for square in entries.chunk_by(|a, b| a.0 == b.0) {
        for (n, &(_, a)) in square.iter().enumerate() {
            pairs += n;
            crossings +=
                square[..n].iter().filter(|&&(_, b)| cross(edges[a as usize], edges[b as usize])).count();
            if crossings > MOST_CROSSINGS {
                return Err(RegionError::Tangled);
            }
            if pairs > MOST_PAIRS {
                return Ok(());
            }
        }
    }
    Ok(())
}

fn edges_of(ring: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> {
    ring.iter().zip(ring.iter().skip(1).chain(ring.first())).map(|(&from, &to)| [from, to])
}

/// Each edge with the numbers of the squares round it, column by column; `None` where there are too many.
fn sorted_into_squares(edges: &[[DVec2; 2]], bounds: &Rect, squares: f64) -> Option<Vec<(u32, u32)>> {
    let mut entries = Vec::new();
    let scale = DVec2::splat(squares) / bounds.size();
    for (n, &[from, to]) in edges.iter().enumerate() {
        let [from, to] = [from, to].map(|p| (p - bounds.min) * scale);
        let [left, right] = if from.x <= to.x { [from, to] } else { [to, from] };
        let last = squares - 1.0;
        let column = |x: f64| x.floor().clamp(0.0, last);
        let (first, end) = (column(left.x), column(right.x));
        for column in first as u32..=end as u32 {
            // The part of the edge in this column, a little beyond its ends.
            let at = |x: f64| {
                let part = (x - left.x) / (right.x - left.x);
                if part.is_finite() { left.y + part.clamp(0.0, 1.0) * (right.y - left.y) } else { left.y }
            };
            let steep = end == first;
            let (a, b) =
                if steep { (left.y, right.y) } else { (at(f64::from(column)), at(f64::from(column) + 1.0)) };
            let row = |y: f64| y.floor().clamp(0.0, last) as u32;
            for row in row(a.min(b) - 1e-6)..=row(a.max(b) + 1e-6) {
                entries.push((row * squares as u32 + column, n as u32));
            }
        }
        if entries.len() > MOST_ENTRIES {
            return None;
        }
    }
    Some(entries)
}

/// Whether two edges cross at a point inside both. To rounding: this is a measure, and decides no geometry.
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
    fn a_tangle_is_refused_and_a_long_outline_is_not() {
        assert_eq!(Domain::of_polygons(&[vec![zigzag(20_000)]]), Err(RegionError::Tangled));
        assert!(Domain::of_polygons(&[vec![zigzag(50)]]).is_ok());
        let round = |k: usize| f64::from(k as u32) * std::f64::consts::TAU / 400_000.0;
        let coast = |k: usize| {
            let radius = 1.0 + 0.1 * libm::sin(40_000.0 * round(k));
            radius * dvec2(libm::cos(round(k)), libm::sin(round(k)))
        };
        assert!(Domain::of_polygons(&[vec![(0..400_000).map(coast).collect()]]).is_ok());
        let too_many = vec![vec![DVec2::ZERO; MOST_CORNERS], vec![DVec2::ONE]];
        let error = Domain::of_polygons(&[too_many]).unwrap_err();
        assert_eq!(error, RegionError::TooManyCorners { corners: MOST_CORNERS + 1 });
    }

    #[test]
    fn nothing_encloses_nothing() {
        let line = vec![vec![DVec2::ZERO, DVec2::ONE, dvec2(2.0, 2.0)]];
        for polygons in [vec![], vec![vec![]], vec![vec![vec![DVec2::ONE]]], vec![line]] {
            assert_eq!(Domain::of_polygons(&polygons), Err(RegionError::NoArea));
        }
        let far = vec![vec![DVec2::splat(-f64::MAX), DVec2::splat(f64::MAX), DVec2::ZERO]];
        assert_eq!(Domain::of_polygons(&[far]), Err(RegionError::TooLarge));
    }
}
