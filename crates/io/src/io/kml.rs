//! Routes for programs that show the Earth: KML 2.2.

use std::io::{self, Write};

use super::{Provenance, RouteOnEarth};
use meshbrush_mesh::text::xml_text;

/// Writes a route as a line on the ground with its name. Coordinates are WGS 84.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write_kml(out: &mut dyn Write, route: &RouteOnEarth<'_>, provenance: &Provenance) -> io::Result<()> {
    let [name, description] = [route.name, &provenance.line()].map(xml_text);
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(out, r#"<kml xmlns="http://www.opengis.net/kml/2.2"><Document><name>{name}</name>"#)?;
    writeln!(out, "<Placemark><name>{name}</name><description>{description}</description>")?;
    writeln!(out, "<LineString><tessellate>1</tessellate><coordinates>")?;
    for point in &route.points {
        writeln!(out, "{:.9},{:.9}", point.at.x, point.at.y)?;
    }
    writeln!(out, "</coordinates></LineString></Placemark>\n</Document></kml>")
}
