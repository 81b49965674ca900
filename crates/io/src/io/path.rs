//! Paths as files: GeoJSON, and a table with the cost up to each point.

use std::io::{self, Write};

use glam::DVec2;

use super::Provenance;
use meshbrush_core::path::{PathSample, Solution};
use meshbrush_mesh::text::Number;

/// Lengths of a path, and the time that it takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathLengths {
    /// The length: in metres on the ellipsoid in the plane of a projection, otherwise in world units.
    pub length: f64,
    /// In the plane of a projection, the length there, in metres.
    pub in_plane: Option<f64>,
    /// The time at a speed that was asked for, in seconds.
    pub seconds: Option<f64>,
}

/// Writes a path as a GeoJSON feature with its figures. `points` are those to write, and `system` is the name
/// of their coordinate system, if they are no longitudes and latitudes on WGS 84.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_geojson(
    out: &mut dyn Write,
    solution: &Solution,
    points: &[DVec2],
    system: Option<&str>,
    lengths: &PathLengths,
    provenance: &Provenance,
) -> io::Result<()> {
    let Solution { cost, lower, upper, risk, highest_risk, .. } = solution;
    let PathLengths { length, in_plane, seconds } = lengths;
    let mut properties = serde_json::Map::new();
    let figures = [
        ("cost", cost),
        ("lower", lower),
        ("upper", upper),
        ("length", length),
        ("risk", risk),
        ("highest_risk", highest_risk),
    ];
    properties.extend(figures.map(|(name, &figure)| (name.to_owned(), figure.into())));
    let more = [("length_in_plane", in_plane), ("travel_seconds", seconds)];
    properties
        .extend(more.into_iter().filter_map(|(name, figure)| Some((name.to_owned(), (*figure)?.into()))));
    properties.extend(provenance.entries().map(|(key, text)| (key.to_owned(), text.into())));
    write!(out, "{{\"type\":\"Feature\",")?;
    if let Some(system) = system {
        let system = serde_json::json!({ "type": "name", "properties": { "name": system } });
        writeln!(out, "\"crs\":{system},")?;
    }
    write!(out, "\"properties\":")?;
    serde_json::to_writer(&mut *out, &properties)?;
    writeln!(out, ",\n\"geometry\":{{\"type\":\"LineString\",\"coordinates\":[")?;
    for (n, point) in points.iter().enumerate() {
        let end = if n + 1 < points.len() { "," } else { "" };
        writeln!(out, "[{},{}]{end}", Number(point.x), Number(point.y))?;
    }
    writeln!(out, "]}}}}")
}

/// Writes a table with a row for each sample: where it is, `points`, its distance from the start along the
/// path, what the path costs up to there, the risk, and the cost per unit of length.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_csv(out: &mut dyn Write, samples: &[PathSample], points: &[DVec2]) -> io::Result<()> {
    writeln!(out, "x,y,distance,cost,risk,density")?;
    for (sample, point) in samples.iter().zip(points) {
        let PathSample { distance, cost, risk, density, .. } = *sample;
        let [x, y, distance, cost, risk, density] =
            [point.x, point.y, distance, cost, risk, density].map(Number);
        writeln!(out, "{x},{y},{distance},{cost},{risk},{density}")?;
    }
    Ok(())
}
