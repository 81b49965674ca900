use glam::DVec2;
use rayon::prelude::*;

use super::{Reprojection, wrapped};

/// Largest distance of an edge from its curve, as a share of the extent of the polygons.
const TOLERANCE: f64 = 1e-6;
/// Most halvings of an edge.
const MOST_HALVINGS: u32 = 12;
/// Corners that a thread places at a time.
const GRAIN: usize = 1024;

/// A point in the coordinates of its file, and where it is in the plane.
type Placed = (DVec2, DVec2);

/// Returns polygons in the plane of a projection. A straight edge between longitudes and latitudes, or in
/// another plane, is a curve in the plane: it is divided into edges that follow it.
///
/// A ring that goes around a pole along the edge of a map in degrees loses its corners at the pole.
pub fn projected_polygons(polygons: &[Vec<Vec<DVec2>>], reprojection: &Reprojection) -> Vec<Vec<Vec<DVec2>>> {
    if reprojection.is_identity() {
        return polygons.to_vec();
    }
    let is_geographic = reprojection.from.are_degrees();
    let is_pole = |corner: &&DVec2| is_geographic && corner.y.abs() == 90.0;
    let ring = |ring: &Vec<DVec2>| {
        let corners: Vec<DVec2> = ring.iter().filter(|corner| !is_pole(corner)).copied().collect();
        let mut placed = placed(&corners, reprojection);
        placed.extend(placed.first().copied());
        placed
    };
    let placed: Vec<Vec<Vec<Placed>>> =
        polygons.iter().map(|polygon| polygon.iter().map(ring).collect()).collect();
    let tolerance = tolerance(placed.iter().flatten().flatten());
    let ring = |corners: &Vec<Placed>| {
        let mut ring = curved(corners, reprojection, tolerance);
        // The last point is the first one again.
        ring.pop();
        ring
    };
    placed.iter().map(|polygon| polygon.iter().map(ring).collect()).collect()
}

/// Returns a line in the plane of a projection, as [`projected_polygons`] does.
pub fn projected_line(line: &[DVec2], reprojection: &Reprojection) -> Vec<DVec2> {
    if reprojection.is_identity() {
        return line.to_vec();
    }
    let corners = placed(line, reprojection);
    curved(&corners, reprojection, tolerance(corners.iter()))
}

/// Places corners in the plane, on all threads.
fn placed(corners: &[DVec2], reprojection: &Reprojection) -> Vec<Placed> {
    let is_geographic = reprojection.from.are_degrees();
    let placed = |&corner: &DVec2| {
        let corner = if is_geographic { canonical(corner) } else { corner };
        (corner, reprojection.in_plane(corner))
    };
    corners.par_iter().with_min_len(GRAIN).map(placed).collect()
}

/// Returns how far an edge may be from its curve, in metres.
fn tolerance<'a>(corners: impl Iterator<Item = &'a Placed>) -> f64 {
    let start = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = corners.fold(start, |(low, high), (_, at)| (low.min(*at), high.max(*at)));
    TOLERANCE * (high - low).max_element()
}

/// Returns the corners in the plane, with points between them where edges are curved. Neighbours differ.
fn curved(corners: &[Placed], reprojection: &Reprojection, tolerance: f64) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = Vec::with_capacity(corners.len());
    points.extend(corners.first().map(|(_, at)| at));
    for pair in corners.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        if from.1 == to.1 {
            continue;
        }
        let mut to = to;
        if reprojection.from.are_degrees() {
            // The shorter way round the Earth.
            to.0.x = from.0.x + wrapped(to.0.x - from.0.x);
        }
        divide(reprojection, [from, to], tolerance, MOST_HALVINGS, &mut points);
        points.push(to.1);
    }
    points
}

/// One longitude for the antimeridian, so that polygons that were cut there have the same corners.
fn canonical(corner: DVec2) -> DVec2 {
    if corner.x == -180.0 { DVec2::new(180.0, corner.y) } else { corner }
}

/// Adds the points between the ends of an edge.
fn divide(
    reprojection: &Reprojection,
    [from, to]: [Placed; 2],
    tolerance: f64,
    halvings: u32,
    points: &mut Vec<DVec2>,
) {
    let middle = 0.5 * (from.0 + to.0);
    let middle = (middle, reprojection.in_plane(middle));
    let is_straight = middle.1.distance(0.5 * (from.1 + to.1)) <= tolerance;
    if halvings == 0 || is_straight {
        return;
    }
    divide(reprojection, [from, middle], tolerance, halvings - 1, points);
    points.push(middle.1);
    divide(reprojection, [middle, to], tolerance, halvings - 1, points);
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::super::{Coordinates, GeographicExtent, Projection, ProjectionChoice};
    use super::*;

    fn projected(rings: &[Vec<DVec2>]) -> (Projection, Vec<Vec<DVec2>>) {
        let extent = GeographicExtent::from_rings(rings.iter().map(Vec::as_slice)).unwrap();
        let projection = ProjectionChoice::Automatic.projection(&extent).unwrap();
        let polygons: Vec<_> = rings.iter().map(|ring| vec![ring.clone()]).collect();
        let reprojection = Reprojection { from: Coordinates::Geographic, to: projection };
        (projection, projected_polygons(&polygons, &reprojection).into_iter().flatten().collect())
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
    fn a_straight_side_in_another_plane_follows_its_curve() {
        let zone = Coordinates::of_epsg(32633).unwrap();
        let to = "+proj=lcc +lat_0=57 +lat_1=57 +lon_0=20 +ellps=WGS84 +units=m".parse().unwrap();
        let reprojection = Reprojection { from: zone, to };
        let [west, east, south, north] = [3e5, 9e5, 6e6, 6.6e6];
        let ring = vec![dvec2(west, south), dvec2(east, south), dvec2(east, north), dvec2(west, north)];
        let polygons = projected_polygons(&[vec![ring.clone()]], &reprojection);
        let corners = &polygons[0][0];
        assert!(corners.len() > 40, "{}", corners.len());
        for (at, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let distance = |at: DVec2| {
                let at = reprojection.from_plane(at);
                [at.x - west, at.x - east, at.y - south, at.y - north]
                    .map(f64::abs)
                    .into_iter()
                    .reduce(f64::min)
            };
            assert!(distance(*at).unwrap() < 1e-6);
            assert!(distance(0.5 * (*at + *next)).unwrap() < 2.0, "{at}");
        }
        let same = Reprojection { from: Coordinates::Plane(to), to };
        assert_eq!(projected_polygons(&[vec![ring.clone()]], &same), [[ring.clone()]]);
        assert_eq!(projected_line(&ring, &same), ring);
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
