//! Meridians and parallels across an area of a plane.

use glam::{DVec2, dvec2};

use super::{DegreeStyle, EarthPlane, GeographicAxis, wrapped};
use crate::geometry::Rect;

/// Steps between lines in degrees, the largest first. Smaller ones are decimals of a degree.
const STEPS_IN_DEGREES: [f64; 6] = [30.0, 20.0, 10.0, 5.0, 2.0, 1.0];
/// Steps between lines in minutes of arc. Smaller ones are decimals of a minute.
const STEPS_IN_MINUTES: [f64; 13] =
    [1800.0, 900.0, 600.0, 300.0, 120.0, 60.0, 30.0, 15.0, 10.0, 5.0, 2.0, 1.0, 0.5];
/// Lines across the area, at least.
const LEAST_LINES: f64 = 4.0;
/// Pieces of a line.
const PIECES: u32 = 64;
/// Places along each side of the area whose longitudes and latitudes decide which lines cross it.
const SAMPLES: u32 = 16;
/// Least step, in degrees or minutes of arc: coordinates have no finer differences.
const LEAST_STEP: f64 = 1e-6;

/// A meridian or a parallel.
#[derive(Clone, Debug, PartialEq)]
pub struct GraticuleLine {
    /// Whether it is a meridian.
    pub is_meridian: bool,
    /// The longitude or latitude, for people.
    pub label: String,
    /// Points along it, in the plane.
    pub points: Vec<DVec2>,
}

impl GraticuleLine {
    /// Returns where the line crosses a line of the plane, on which x (axis 0) or y (axis 1) has a value.
    pub fn crossings(&self, axis: usize, value: f64) -> impl Iterator<Item = DVec2> + '_ {
        self.points.windows(2).filter_map(move |pair| {
            let [from, to] = [pair[0][axis] - value, pair[1][axis] - value];
            let is_crossed = from * to <= 0.0 && from != to;
            is_crossed.then(|| pair[0] + (pair[1] - pair[0]) * (from / (from - to)))
        })
    }
}

/// Returns the meridians and parallels across an area of a plane whose numbers are round in a style: from 4
/// to 11 of each; none where the area is too small to distinguish even these.
pub fn graticule(plane: EarthPlane, area: Rect, style: DegreeStyle) -> Vec<GraticuleLine> {
    let Some(extent) = extent(plane, area) else { return Vec::new() };
    let lines = |is_meridian: bool| {
        let place = usize::from(!is_meridian);
        let (from, to) = (extent.min[place], extent.max[place]);
        let axis = if is_meridian { GeographicAxis::Longitude } else { GeographicAxis::Latitude };
        values(from, to, style).map(move |(degrees, step)| GraticuleLine {
            is_meridian,
            label: style.text(axis, degrees, step),
            points: points(plane, extent, is_meridian, degrees),
        })
    };
    lines(true).chain(lines(false)).collect()
}

/// Returns the longitudes and latitudes of an area. Longitudes continue beyond 180° where the area does.
fn extent(plane: EarthPlane, area: Rect) -> Option<Rect> {
    let EarthPlane::Projected(projection) = plane else {
        return Some(Rect::new(area.min.max(dvec2(-720.0, -90.0)), area.max.min(dvec2(720.0, 90.0))));
    };
    let middle = projection.geographic_from_plane(area.center()).x;
    let share = |n: u32| f64::from(n) / f64::from(SAMPLES);
    let places =
        (0..=SAMPLES).flat_map(|row| (0..=SAMPLES).map(move |column| dvec2(share(column), share(row))));
    let geographic = places.map(|share| projection.geographic_from_plane(area.min + share * area.size()));
    let unwrapped = geographic.map(|at| dvec2(middle + wrapped(at.x - middle), at.y));
    Rect::holding(unwrapped.filter(|at| at.is_finite()))
}

/// Returns the multiples of a round step in a range of degrees, and the step, both in degrees.
fn values(from: f64, to: f64, style: DegreeStyle) -> impl Iterator<Item = (f64, f64)> {
    let (steps, per_degree) = match style {
        DegreeStyle::Decimal => (&STEPS_IN_DEGREES[..], 1.0),
        DegreeStyle::Minutes => (&STEPS_IN_MINUTES[..], 60.0),
    };
    let limit = per_degree * (to - from) / LEAST_LINES;
    let step = steps.iter().copied().find(|&step| step <= limit).unwrap_or_else(|| decimal_step(limit));
    let (first, last) = (per_degree * from / step, per_degree * to / step);
    let count = if limit >= LEAST_STEP { (last.floor() - first.ceil()) as i64 + 1 } else { 0 };
    (0..count.max(0)).map(move |n| ((first.ceil() + n as f64) * step / per_degree, step / per_degree))
}

/// Returns the largest of 1, 2 and 5 times a power of ten that is at most a limit below 1.
fn decimal_step(limit: f64) -> f64 {
    let decade = |n: i32| libm::exp10(f64::from(-n));
    let steps = (1..9).flat_map(|n| [5.0, 2.0, 1.0].map(|factor| factor * decade(n)));
    steps.into_iter().find(|&step| step <= limit).unwrap_or(LEAST_STEP)
}

/// Returns points along the part of a meridian or parallel across an extent.
fn points(plane: EarthPlane, extent: Rect, is_meridian: bool, degrees: f64) -> Vec<DVec2> {
    let along = (0..=PIECES).map(|n| f64::from(n) / f64::from(PIECES));
    let at = along.map(|share| {
        let at = extent.min + share * extent.size();
        if is_meridian { dvec2(degrees, at.y) } else { dvec2(at.x, degrees) }
    });
    let in_plane = at.map(|at| match plane {
        EarthPlane::Degrees => at,
        EarthPlane::Projected(projection) => projection.plane_from_geographic(at),
    });
    in_plane.filter(|at| at.is_finite()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{GeographicExtent, ProjectionChoice};
    use super::*;

    #[test]
    fn from_four_to_eleven_lines_cross_any_extent() {
        let mut span = 1e-4;
        while span < 300.0 {
            for from in [-3.217, 0.0, 54.9] {
                for style in [DegreeStyle::Decimal, DegreeStyle::Minutes] {
                    let count = values(from, from + span, style).count();
                    assert!((4..=11).contains(&count), "{count} lines from {from} in {span}°");
                }
            }
            span *= 1.07;
        }
        assert_eq!(values(10.0, 10.0 + 1e-9, DegreeStyle::Minutes).count(), 0);
    }

    #[test]
    fn degrees_go_on_twice_round_the_earth_and_end_at_the_poles() {
        let rect = |w, s, e, n| Rect::new(dvec2(w, s), dvec2(e, n));
        for (area, expected) in [
            (rect(-1e4, -1e3, 1e4, 1e3), rect(-720.0, -90.0, 720.0, 90.0)),
            (rect(-10.0, 40.0, 20.0, 50.0), rect(-10.0, 40.0, 20.0, 50.0)),
            (rect(-700.0, -95.0, 100.0, 0.0), rect(-700.0, -90.0, 100.0, 0.0)),
        ] {
            assert_eq!(extent(EarthPlane::Degrees, area), Some(expected));
        }
    }

    #[test]
    fn lines_of_a_projection_are_meridians_and_parallels_through_the_area() {
        let corners = [dvec2(-7.0, 47.0), dvec2(0.0, 47.0), dvec2(0.0, 52.0), dvec2(-7.0, 52.0)];
        let extent = GeographicExtent::from_rings(std::iter::once(&corners[..])).unwrap();
        let projection = ProjectionChoice::Automatic.projection(&extent).unwrap();
        let plane = EarthPlane::Projected(projection);
        let area = Rect::new(dvec2(-238_000.0, 5_219_000.0), dvec2(238_000.0, 5_763_000.0));
        let lines = graticule(plane, area, DegreeStyle::Minutes);
        let labels: Vec<&str> = lines.iter().map(|line| line.label.as_str()).collect();
        assert_eq!(
            labels,
            ["6° W", "5° W", "4° W", "3° W", "2° W", "1° W", "48° N", "49° N", "50° N", "51° N"]
        );
        for (line, degrees) in lines.iter().zip([-6.0, -5.0, -4.0, -3.0, -2.0, -1.0, 48.0, 49.0]) {
            for &at in &line.points {
                let at = plane.geographic(at);
                let off = if line.is_meridian { at.x - degrees } else { at.y - degrees };
                assert!(off.abs() < 1e-9, "{}: {at}", line.label);
            }
            assert!(line.points.iter().any(|&at| area.contains(at)), "{} crosses the area", line.label);
        }
    }
}
