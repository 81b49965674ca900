use glam::DVec2;

use super::{Projection, wrapped};

/// An edge is divided while its middle in the plane is farther from that of longitude and latitude than this
/// share of the extent of the polygons.
const TOLERANCE: f64 = 1e-6;
/// An edge is halved so many times at most.
const MOST_HALVINGS: u32 = 12;

/// Returns polygons of longitudes and latitudes in the plane of a projection. A straight edge in degrees is
/// a curve in the plane: it is divided into edges that follow it.
///
/// A ring that goes around a pole along the edge of a map in degrees loses its corners at the pole.
pub fn projected_polygons(polygons: &[Vec<Vec<DVec2>>], projection: &Projection) -> Vec<Vec<Vec<DVec2>>> {
    let tolerance = tolerance(polygons.iter().flatten().flatten(), projection);
    let ring = |ring: &Vec<DVec2>| projected_ring(ring, projection, tolerance);
    polygons.iter().map(|polygon| polygon.iter().map(ring).collect()).collect()
}

/// Returns a line of longitudes and latitudes in the plane of a projection, as [`projected_polygons`] does.
pub fn projected_line(line: &[DVec2], projection: &Projection) -> Vec<DVec2> {
    let tolerance = tolerance(line.iter(), projection);
    let mut projected = Vec::with_capacity(line.len());
    for pair in line.windows(2) {
        push_edge([pair[0], pair[1]].map(canonical), projection, tolerance, &mut projected);
    }
    let last = line.last().map(|&corner| projection.plane_from_geographic(canonical(corner)));
    projected.extend(last.filter(|last| projected.last() != Some(last)));
    projected
}

/// Returns how far an edge may be from its curve, in metres.
fn tolerance<'a>(corners: impl Iterator<Item = &'a DVec2>, projection: &Projection) -> f64 {
    let corners = corners.map(|&corner| projection.plane_from_geographic(canonical(corner)));
    let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), corner| {
        (low.min(corner), high.max(corner))
    });
    TOLERANCE * (high - low).max_element()
}

fn projected_ring(ring: &[DVec2], projection: &Projection, tolerance: f64) -> Vec<DVec2> {
    let is_pole = |corner: &&DVec2| corner.y.abs() == 90.0;
    let corners: Vec<DVec2> =
        ring.iter().filter(|corner| !is_pole(corner)).map(|&corner| canonical(corner)).collect();
    let mut projected = Vec::with_capacity(corners.len());
    for (&from, &to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        push_edge([from, to], projection, tolerance, &mut projected);
    }
    if projected.len() > 1 && projected.first() == projected.last() {
        projected.pop();
    }
    projected
}

/// Adds an edge without its end.
fn push_edge([from, to]: [DVec2; 2], projection: &Projection, tolerance: f64, projected: &mut Vec<DVec2>) {
    let to = DVec2::new(from.x + wrapped(to.x - from.x), to.y);
    let ends = [from, to].map(|at| (at, projection.plane_from_geographic(at)));
    if projected.last() != Some(&ends[0].1) {
        projected.push(ends[0].1);
    }
    divide(projection, ends, tolerance, MOST_HALVINGS, projected);
}

/// One longitude for the antimeridian, so that polygons that were cut there have the same corners.
fn canonical(corner: DVec2) -> DVec2 {
    if corner.x == -180.0 { DVec2::new(180.0, corner.y) } else { corner }
}

/// Adds the points between the ends of an edge, which are given in degrees and in the plane.
fn divide(
    projection: &Projection,
    [from, to]: [(DVec2, DVec2); 2],
    tolerance: f64,
    halvings: u32,
    projected: &mut Vec<DVec2>,
) {
    let middle = 0.5 * (from.0 + to.0);
    let in_plane = projection.plane_from_geographic(middle);
    let is_straight = in_plane.distance(0.5 * (from.1 + to.1)) <= tolerance;
    if halvings == 0 || is_straight {
        return;
    }
    let middle = (middle, in_plane);
    divide(projection, [from, middle], tolerance, halvings - 1, projected);
    projected.push(in_plane);
    divide(projection, [middle, to], tolerance, halvings - 1, projected);
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::super::{GeographicExtent, ProjectionChoice};
    use super::*;

    fn projected(rings: &[Vec<DVec2>]) -> (Projection, Vec<Vec<DVec2>>) {
        let extent = GeographicExtent::of_rings(rings.iter().map(Vec::as_slice)).unwrap();
        let projection = ProjectionChoice::Automatic.projection(&extent).unwrap();
        let polygons: Vec<_> = rings.iter().map(|ring| vec![ring.clone()]).collect();
        (projection, projected_polygons(&polygons, &projection).into_iter().flatten().collect())
    }

    #[test]
    fn a_straight_side_in_degrees_follows_its_curve() {
        let ring = vec![dvec2(0.0, 50.0), dvec2(30.0, 50.0), dvec2(30.0, 60.0), dvec2(0.0, 60.0)];
        let (projection, rings) = projected(&[ring]);
        assert!(rings[0].len() > 100, "{}", rings[0].len());
        let on_a_side = |at: DVec2| {
            let at = projection.geographic_from_plane(at);
            [at.x, at.x - 30.0, at.y - 50.0, at.y - 60.0].into_iter().any(|off| off.abs() < 1e-9)
        };
        assert!(rings[0].iter().all(|&corner| on_a_side(corner)));
    }

    #[test]
    fn polygons_that_were_cut_at_the_antimeridian_meet() {
        let east = vec![dvec2(177.0, -18.0), dvec2(180.0, -18.0), dvec2(180.0, -16.0), dvec2(177.0, -16.0)];
        let west =
            vec![dvec2(-180.0, -18.0), dvec2(-178.3, -18.0), dvec2(-178.3, -16.0), dvec2(-180.0, -16.0)];
        let (_, rings) = projected(&[east, west]);
        let shared = rings[0].iter().filter(|corner| rings[1].contains(corner)).count();
        assert!(shared >= 2, "{shared}");
        let width = rings.iter().flatten().map(|corner| corner.x.abs()).fold(0.0, f64::max);
        assert!(width < 3e5, "{width} m");
    }

    #[test]
    fn a_ring_around_the_south_pole_has_no_corner_there() {
        let mut ring: Vec<DVec2> = (-18..=18).map(|n| dvec2(10.0 * f64::from(n), -65.0)).collect();
        ring.extend([dvec2(180.0, -90.0), dvec2(-180.0, -90.0)]);
        let (_, rings) = projected(&[ring]);
        assert!(rings[0].iter().all(|corner| corner.length() > 2.5e6));
        let first = rings[0][0];
        assert_eq!(rings[0].iter().filter(|&&corner| corner == first).count(), 1);
    }
}
