//! Paths as files: GeoJSON, and a table with the cost up to each point.

use std::io::{self, Write};

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

/// Writes a path as a GeoJSON feature with its figures. `samples` are the points to write.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_geojson(
    out: &mut dyn Write,
    solution: &Solution,
    samples: &[PathSample],
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
    write!(out, "{{\"type\":\"Feature\",\"properties\":")?;
    serde_json::to_writer(&mut *out, &properties)?;
    writeln!(out, ",\n\"geometry\":{{\"type\":\"LineString\",\"coordinates\":[")?;
    for (n, sample) in samples.iter().enumerate() {
        let end = if n + 1 < samples.len() { "," } else { "" };
        writeln!(out, "[{},{}]{end}", Number(sample.point.x), Number(sample.point.y))?;
    }
    writeln!(out, "]}}}}")
}

/// Writes a table with a row for each point: where it is, its distance from the start along the path, what
/// the path costs up to there, the risk, and the cost per unit of length.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_csv(out: &mut dyn Write, samples: &[PathSample]) -> io::Result<()> {
    writeln!(out, "x,y,distance,cost,risk,density")?;
    for sample in samples {
        let PathSample { point, distance, cost, risk, density } = *sample;
        let [x, y, distance, cost, risk, density] =
            [point.x, point.y, distance, cost, risk, density].map(Number);
        writeln!(out, "{x},{y},{distance},{cost},{risk},{density}")?;
    }
    Ok(())
}
