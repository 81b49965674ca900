//! A path as a route of longitudes and latitudes, for the formats that have these only.

use meshbrush_core::earth::{EarthPlane, RoutePoint};
use meshbrush_core::path::{PathSample, Solution, Waypoint};

/// A route with its name.
#[derive(Clone, Debug)]
pub struct RouteOnEarth<'a> {
    /// The name of the path.
    pub name: &'a str,
    /// The points, from the start to the goal.
    pub points: Vec<RoutePoint>,
    /// The places of the start, the via points and the goal among the points of the path.
    stops: &'a [usize],
}

impl<'a> RouteOnEarth<'a> {
    /// Returns the route of a path in a plane. `samples` are the points of the path.
    pub fn new(name: &'a str, plane: EarthPlane, solution: &'a Solution, samples: &[PathSample]) -> Self {
        let line: Vec<_> = samples.iter().map(|sample| sample.point).collect();
        Self { name, points: plane.route(&line), stops: &solution.stops }
    }

    /// Returns the name of a point that the path had to visit.
    pub fn stop_name(&self, point: &RoutePoint) -> Option<String> {
        let stop = self.stops.iter().position(|&stop| Some(stop) == point.corner)?;
        Some(match Waypoint::of(stop, self.stops.len()) {
            Waypoint::Start => "Start".to_owned(),
            Waypoint::Via(number) => format!("Via {number}"),
            Waypoint::Goal => "Goal".to_owned(),
        })
    }
}
