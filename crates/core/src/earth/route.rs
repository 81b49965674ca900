//! Lines of the plane as routes of longitudes and latitudes.

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::{EarthPlane, wrapped};

/// The mean radius of the Earth in metres: programs that draw routes take it for a sphere.
const RADIUS: f64 = 6_371_008.8;
/// Between two points farther apart than this angle, in radians, a point is always added.
const LONGEST: f64 = 0.03;
/// Places between two points at which the distance is measured, as shares.
const MEASURED: [f64; 3] = [0.25, 0.5, 0.75];
/// The part of the tolerance that the distance there may take: between these places it can be greater.
const CAREFUL: f64 = 0.8;
/// Most halvings of a piece of a line.
const MOST_HALVINGS: u32 = 16;
/// Beyond this latitude no program draws a line of one course.
const MOST_RHUMB: f64 = 89.0;

/// A point of a route.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoutePoint {
    /// Longitude (−180 to 180) and latitude, in degrees.
    pub at: DVec2,
    /// The number of the point of the line that it is; `None` for one between two of them.
    pub corner: Option<usize>,
}

impl EarthPlane {
    /// A route is no farther than this from its line in the plane, in metres, where programs draw it as great
    /// circles or as lines of one course.
    pub const ROUTE_TOLERANCE: f64 = 2.0;

    /// Returns a line of the plane as a route. Points are added until both ways to draw the route stay within
    /// [`Self::ROUTE_TOLERANCE`].
    pub fn route(self, line: &[DVec2]) -> Vec<RoutePoint> {
        let mut route = Vec::with_capacity(line.len());
        for (corner, &to) in line.iter().enumerate() {
            if let Some(before) = corner.checked_sub(1) {
                self.divide([line[before], to], MOST_HALVINGS, &mut route);
            }
            route.push(RoutePoint { at: self.geographic(to), corner: Some(corner) });
        }
        route
    }

    /// Adds the points that are needed between two others.
    fn divide(self, [from, to]: [DVec2; 2], halvings: u32, route: &mut Vec<RoutePoint>) {
        let ends = [from, to].map(|end| self.geographic(end));
        let middle = from.lerp(to, 0.5);
        let angle = direction(ends[0]).distance(direction(ends[1]));
        let is_close = || {
            let off = |&share: &f64| distance_from_drawn(self.geographic(from.lerp(to, share)), ends);
            MEASURED.iter().all(|share| off(share) <= CAREFUL * Self::ROUTE_TOLERANCE)
        };
        if halvings == 0 || middle == from || middle == to || (angle <= LONGEST && is_close()) {
            return;
        }
        self.divide([from, middle], halvings - 1, route);
        route.push(RoutePoint { at: self.geographic(middle), corner: None });
        self.divide([middle, to], halvings - 1, route);
    }
}

/// Returns the direction of a place from the middle of a sphere.
fn direction(at: DVec2) -> DVec3 {
    let [(sin_east, cos_east), (sin_north, cos_north)] =
        at.to_array().map(|angle| libm::sincos(angle.to_radians()));
    dvec3(cos_north * cos_east, cos_north * sin_east, sin_north)
}

/// Returns how far a place is, in metres, from the lines that programs draw between two others.
fn distance_from_drawn(place: DVec2, ends: [DVec2; 2]) -> f64 {
    from_great_circle(place, ends).max(from_rhumb_line(place, ends))
}

fn from_great_circle(place: DVec2, ends: [DVec2; 2]) -> f64 {
    let [a, b] = ends.map(direction);
    let (normal, place) = (a.cross(b), direction(place));
    let length = normal.length();
    let sine = if length > 1e-12 { place.dot(normal).abs() / length } else { place.distance(a) };
    RADIUS * libm::asin(sine.min(1.0))
}

/// A line of one course is straight on a map of Mercator's projection.
fn from_rhumb_line(place: DVec2, [from, to]: [DVec2; 2]) -> f64 {
    if [place, from, to].iter().any(|at| at.y.abs() > MOST_RHUMB) {
        return 0.0;
    }
    let up = |at: DVec2| libm::asinh(libm::tan(at.y.to_radians()));
    let on_map = |at: DVec2| dvec2(wrapped(at.x - from.x).to_radians(), up(at) - up(from));
    let (along, to_place) = (on_map(to), on_map(place));
    let length = along.length();
    let off = if length > 0.0 { along.perp_dot(to_place).abs() / length } else { to_place.length() };
    RADIUS * libm::cos(place.y.to_radians()) * off
}
